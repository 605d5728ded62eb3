#include "runtime/pictures/wish.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "graph/bounds/region.h"
#include "graph/document/unit.h"
#include "graph/language/typed_number.h"
#include "runtime/render/light_picture.h"
#include "runtime/render/renderer.h"

namespace fw {

namespace {

namespace fs = std::filesystem;

constexpr int kBounces = 8;  // of a reference that does not say

std::optional<std::pair<int, int>> sizeOfPng(const std::string& path) {
    std::array<unsigned char, 24> head{};
    std::array<unsigned char, 8> tail{};  // name and checksum of the last chunk
    std::ifstream file(path, std::ios::binary);
    const auto read = [&](auto& bytes) -> bool {
        return bool(file.read(reinterpret_cast<char*>(bytes.data()), bytes.size()));
    };
    if (!read(head) || std::memcmp(head.data() + 1, "PNG", 3) != 0 || !file.seekg(-8, std::ios::end) ||
        !read(tail) || std::memcmp(tail.data(), "IEND", 4) != 0)
        return std::nullopt;
    const auto number = [&](std::size_t at) {
        return head[at] << 24 | head[at + 1] << 16 | head[at + 2] << 8 | head[at + 3];
    };
    return std::pair(number(16), number(20));
}

}  // namespace

std::string nameOf(PictureFormat format) { return format == PictureFormat::exr ? "exr" : "png"; }

const std::vector<std::string>& renderViews() {
    static const std::vector<std::string> names = {"picture", "ao",        "normals",   "color",  "shadow",
                                                   "steps",   "slice",     "exactness", "cells",  "thickness",
                                                   "gap",     "wireframe", "points",    "spheres"};
    return names;
}

RenderOptions renderOptions(const PictureWish& wish, const Player& player) {
    RenderOptions render{.width = wish.width, .height = wish.height, .samples = wish.samples};
    render.reference = wish.reference;
    const Result<Scene> scene = player.scene();
    const bool wanted = player.program().transmits() || (scene && (scene->bounce || scene->reflections));
    render.bounces = wish.bounces > 0                            ? wish.bounces
                     : wanted && player.program().stages.empty() ? kBounces
                                                                 : 0;
    render.show = wish.view;
    render.cutout = wish.transparent;
    render.leastWidth = wish.leastWidth.empty()
                            ? usualWidth(float(longestSide(player.region())))
                            : float(*typedNumber(wish.leastWidth, "m", unitOf(player.graph())));
    return render;
}

FieldBy renderedBy(const PictureWish& wish) {
    return wish.reference || wish.view == RENDER_AMBIENT || showsField(wish.view) ? FieldBy::kernels
                                                                                  : wish.quality;
}

bool tracesPaths(const RenderOptions& render) {
    return render.reference && render.bounces > 0 && render.show == RENDER_PICTURE;
}

bool leavesOutFog(const RenderOptions& render, const Player& player) {
    const Result<Scene> scene = player.scene();
    return tracesPaths(render) && scene && scene->fog && scene->fog->density > 0.0;
}

Done save(const Picture& picture, const LightPicture& light, PictureFormat format, const std::string& path,
          const std::function<void()>& kept) {
    return format == PictureFormat::exr ? saveLight(light, path, kept) : savePicture(picture, path, kept);
}

std::optional<std::pair<int, int>> sizeOfPicture(const std::string& path, PictureFormat format) {
    std::error_code failure;
    if (!fs::is_regular_file(path, failure)) return std::nullopt;  // a pipe would never answer
    return format == PictureFormat::png ? sizeOfPng(path) : sizeOfLight(path);
}

}  // namespace fw
