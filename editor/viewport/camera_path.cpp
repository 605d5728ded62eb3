#include "editor/viewport/camera_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "editor/viewport/gizmo.h"

namespace fw::editor {

namespace {

constexpr int kPathSteps = 160;
constexpr ImU32 kPathShadow = IM_COL32(0, 0, 0, 120);

/// What a track of the scene moves of a vector at this path: a component, or all of it (-1); none otherwise.
std::optional<int> moves(const Track& track, std::string_view path) {
    if (track.target != Track::Target::scene || !track.name.starts_with(path)) return std::nullopt;
    const std::string rest = track.name.substr(path.size());
    if (rest.empty()) return -1;
    if (rest.size() == 2 && rest[0] == '.' && rest[1] >= 'x' && rest[1] <= 'z') return rest[1] - 'x';
    if (rest.size() == 2 && rest[0] == '.' && rest[1] >= '0' && rest[1] <= '2') return rest[1] - '0';
    return std::nullopt;
}

constexpr std::string_view kPosition = "camera.position", kTarget = "camera.target";

/// Where the tracks of the camera's place bring it at a time.
glm::dvec3 placeAt(const Timeline& timeline, glm::dvec3 place, double time) {
    for (const Track& track : timeline.tracks) {
        const auto component = moves(track, kPosition);
        if (!component) continue;
        const std::vector<double> value = evaluate(track, time);
        if (*component >= 0)
            place[*component] = value[0];
        else
            for (int c = 0; c < 3 && std::size_t(c) < value.size(); ++c) place[c] = value[std::size_t(c)];
    }
    return place;
}

}  // namespace

std::optional<CameraPath> cameraPathOf(const Graph& graph, const Timeline& timeline, double seconds) {
    bool any = false, travels = false;
    for (const Track& track : timeline.tracks) {
        travels |= moves(track, kPosition).has_value();
        any |= travels || moves(track, kTarget);
    }
    if (!any) return std::nullopt;
    const Result<Scene> scene = readScene(sceneAt(graph, timeline, seconds));
    if (!scene || !scene->camera) return std::nullopt;
    CameraPath path;
    path.now = *scene->camera;
    if (!travels) return path;
    const auto& p = path.now.position;
    const glm::dvec3 now(p[0], p[1], p[2]);
    for (int i = 0; i <= kPathSteps; ++i)
        path.line.push_back(placeAt(timeline, now, timeline.length * i / kPathSteps));
    std::vector<double> times;
    for (const Track& track : timeline.tracks)
        if (moves(track, kPosition))
            for (const Key& key : track.keys)
                if (times.size() < 1000) times.push_back(key.time);
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    for (double time : times) path.keys.push_back(placeAt(timeline, now, time));
    return path;
}

std::vector<glm::dvec3> frustumOf(const Camera& camera, double aspect, double distance) {
    const Lens lens(camera, {{0.0f, 0.0f}, {float(aspect), 1.0f}});
    std::vector<glm::dvec3> points = {lens.eye};
    for (const ImVec2 corner : {ImVec2(0, 1), ImVec2(1, 1), ImVec2(1, 0), ImVec2(0, 0)}) {
        const glm::dvec3 ray = lens.ray({corner.x * float(aspect), corner.y});
        points.push_back(lens.eye + ray * (distance / glm::dot(ray, lens.forward)));
    }
    return points;
}

void showCameraPath(Editor& editor) {
    Viewport& view = editor.viewport;
    if (!view.ownCamera || !view.texture) return;
    const Timeline* timeline = timelineOf(editor);
    if (!timeline) return;
    const auto path = cameraPathOf(editor.document.graph(), *timeline, view.seconds);
    if (!path) return;
    const Lens lens(view.shown.seen, view.place);
    const float scale = editor.shell.scale();
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(view.place.lo, view.place.hi, true);
    const auto line = [&](const glm::dvec3& from, const glm::dvec3& to, ImU32 color, float thick) {
        const auto a = lens.project(from), b = lens.project(to);
        if (!a || !b) return;
        list->AddLine(*a, *b, kPathShadow, (thick + 1.5f) * scale);
        list->AddLine(*a, *b, color, thick * scale);
    };
    for (std::size_t i = 1; i < path->line.size(); ++i)
        line(path->line[i - 1], path->line[i], themeColor(ThemeColor::selected), 1.5f);
    for (const glm::dvec3& key : path->keys)
        if (const auto at = lens.project(key)) {
            list->AddCircleFilled(*at, 4.5f * scale, kPathShadow);
            list->AddCircleFilled(*at, 3.5f * scale, themeColor(ThemeColor::text));
        }
    const auto &p = path->now.position, &t = path->now.target;
    const double reach = std::hypot(p[0] - t[0], p[1] - t[1], p[2] - t[2]);
    const std::vector<glm::dvec3> frustum = frustumOf(path->now, double(view.aspect()), 0.15 * reach);
    const ImU32 ink = themeColor(ThemeColor::active);
    for (std::size_t i = 1; i <= 4; ++i) {
        line(frustum[0], frustum[i], ink, 1.0f);
        line(frustum[i], frustum[i % 4 + 1], ink, 1.5f);
    }
    list->PopClipRect();

    if (view.split.hand != 0) return;
    // In the picture's upper right corner; what it is busy with is said in the other.
    const char* words = "The camera's track is not followed";
    const ImVec2 size = ImGui::CalcTextSize(words);
    const float pad = 5.0f * scale, high = ImGui::GetFrameHeight();
    const float button = ImGui::CalcTextSize("Follow it").x + 2.0f * ImGui::GetStyle().FramePadding.x;
    const float wide = size.x + button + 3.0f * pad;
    if (wide + 2.0f * pad > view.place.width()) return;
    const ImVec2 at(view.place.hi.x - wide - pad, view.place.lo.y + pad);
    list->AddRectFilled(at, {at.x + wide, at.y + high + 2.0f}, themeColor(ThemeColor::plate), 4.0f * scale);
    list->AddText({at.x + pad, at.y + 0.5f * (high + 2.0f - size.y)}, themeColor(ThemeColor::text), words);
    ImGui::SetCursorScreenPos({at.x + size.x + 2.0f * pad, at.y + 1.0f});
    if (ImGui::Button("Follow it", {button, high})) view.ownCamera = false;
}

}  // namespace fw::editor
