// A document's picture.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "runtime/pictures/wish.h"
#include "runtime/render/view.h"
#include "runtime/serve/document.h"

namespace fw::serve {

namespace {

/// Where from, as a direction; of "three_quarters" as a picture without a camera is seen.
const std::vector<std::pair<std::string, glm::vec3>> kSides = {
    {"three_quarters", {}}, {"front", {0, 0, 1}},    {"back", {0, 0, -1}},       {"left", {-1, 0, 0}},
    {"right", {1, 0, 0}},   {"top", {0, 1, 0.001f}}, {"bottom", {0, -1, 0.001f}}};

/// The camera that has all of the points in the picture from there. There is at least one.
Camera cameraFrom(const std::string& side, std::span<const gpu::MeshVertex> points, float aspect) {
    const auto found = std::ranges::find(kSides, side, &std::pair<std::string, glm::vec3>::first);
    if (found == kSides.begin()) return framingCamera(points, aspect);
    const SeenBounds bounds = boundsOf(points);
    Camera camera;
    const float half = glm::radians(float(camera.fov)) / 2;
    const float narrow = std::min(half, std::atan(std::tan(half) * aspect));
    const glm::vec3 eye = bounds.centre + glm::normalize(found->second) * (bounds.radius / std::sin(narrow));
    camera.position = {eye.x, eye.y, eye.z};
    camera.target = {bounds.centre.x, bounds.centre.y, bounds.centre.z};
    return camera;
}

}  // namespace

Answer Document::picture(Params& params, Task& task) {
    PictureWish wish;
    wish.width = params.whole("width", 640, kLeastPictureSide, kMostPictureSide);
    wish.height = params.whole("height", 360, kLeastPictureSide, kMostPictureSide);
    wish.samples = params.whole("samples", 1, 1, kMostSamples);
    const std::string view = params.oneOf("view", renderViews(), "picture");
    wish.view = uint32_t(std::ranges::find(renderViews(), view) - renderViews().begin());
    wish.transparent = params.flag("transparent", false);
    static const std::vector<std::string> qualities = {"auto", "draft", "live"}, formats = {"rgba8", "png"};
    const std::string quality = params.oneOf("quality", qualities, "auto");
    const bool draft = quality == "draft";
    const bool png = params.oneOf("format", formats, "rgba8") == "png";
    std::vector<std::string> sides;
    for (const auto& [name, direction] : kSides) sides.push_back(name);
    const std::string from = params.oneOf("from", sides, "");
    const Json* camera = params.any("camera");
    Result<Scene> seen = readScene(camera ? Json{{"camera", *camera}} : Json(nullptr));
    if (!seen) params.refuse("camera", "is none: " + seen.error().message);
    if (camera && !from.empty()) params.refuse("from", "goes without a camera: leave one of them out");
    if (const Done fits = checkPictureSize(wish.width, wish.height); !fits)
        params.refuse("width", "and \"height\": " + fits.error().message);
    if (draft && wish.view != RENDER_PICTURE)
        params.refuse("quality", "is draft of the picture alone: leave out \"view\"");
    if (std::optional<Fault> fault = playAs(params, task)) return *fault;
    if (task.cancelled) return cancelledFault();
    RenderOptions render = renderOptions(wish, *player);
    if (quality == "live") render.primary = Primary::measured;
    render.scene.camera = seen->camera;
    if (!from.empty()) {
        const auto points = player->outline();
        if (!points) return Fault(points.error());
        if (!points->empty())
            render.scene.camera = cameraFrom(from, *points, float(wish.width) / float(wish.height));
        // The ground would be in between.
        if (from == "bottom" && wish.view == RENDER_PICTURE) render.cutout = true;
    }
    render.cancel = &task.cancelled;
    render.progress = [&task](int percent) {
        if (percent > 0) task.progress("picture", percent / 100.0);
    };
    auto picture = std::make_shared<Picture>();
    if (quality == "auto") {
        Result<Picture> drawn = player->frame(render);
        if (task.cancelled) return cancelledFault();
        if (!drawn) return Fault(drawn.error());
        *picture = std::move(*drawn);
    } else {
        // What would be the same as the last one is not drawn again.
        Picture& last = draft ? sketched : lived;
        const Result<bool> drawn = draft ? player->sketch(render, last) : player->show(render, last);
        if (task.cancelled) return cancelledFault();
        if (!drawn) return Fault(drawn.error());
        *picture = last;
    }
    Reply reply;
    reply.result = {
        {"width", wish.width}, {"height", wish.height}, {"draft", draft || !player->whyDraft().empty()}};
    if (!draft && !player->whyDraft().empty()) reply.result["why"] = player->whyDraft();
    if (png) {
        const auto bytes = std::make_shared<const std::string>(pngOf(*picture));
        reply.blobs = {{"picture", "png", {}, *bytes}};
        reply.keeps = bytes;
        return reply;
    }
    reply.blobs = {
        {"picture", "u8", {std::size_t(wish.height), std::size_t(wish.width), 4}, bytesOf(picture->pixels)}};
    reply.keeps = picture;
    return reply;
}

}  // namespace fw::serve
