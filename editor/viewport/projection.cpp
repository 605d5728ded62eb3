#include "editor/viewport/projection.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "editor/preview/pinned.h"
#include "editor/viewport/viewport.h"

namespace fw::editor {

namespace {

constexpr double kSameSide = 1e-6;  // of axes of unit length

constexpr std::pair<Side, const char*> kSides[] = {{Side::front, "Front"}, {Side::back, "Back"},
                                                   {Side::right, "Right"}, {Side::left, "Left"},
                                                   {Side::top, "Top"},     {Side::bottom, "Bottom"}};

double halfAngle(double fov) { return fov * std::numbers::pi / 360.0; }

bool near(const Vector& a, const Vector& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < kSameSide;
}

}  // namespace

Orbit throughLensOf(Orbit orbit, double fov) {
    orbit.distance *= std::tan(halfAngle(orbit.fov)) / std::tan(halfAngle(fov));
    orbit.fov = fov;
    return orbit;
}

bool isParallel(const Orbit& orbit) { return orbit.fov <= kParallelFov; }

std::optional<Side> sideOf(const Orbit& orbit) {
    const Axes axes = axesOf(orbit);
    for (const auto& [side, name] : kSides) {
        Orbit from = orbit;
        lookFrom(from, side);
        const Axes its = axesOf(from);
        if (near(axes.back, its.back) && near(axes.up, its.up)) return side;
    }
    return std::nullopt;
}

std::string wordsOf(const Orbit& orbit, bool orthographic) {
    std::string words = "User";
    const std::optional<Side> side = sideOf(orbit);
    for (const auto& [each, name] : kSides)
        if (side == each) words = name;
    return words + (orthographic ? " · orthographic" : " · perspective");
}

std::string wordsOf(const Viewport& viewport, const Graph& graph) {
    std::string words;
    if (viewport.ownCamera)
        words = wordsOf(viewport.orbit, viewport.orthographic);
    else
        words = graph.scene->is_object() && graph.scene->contains("camera") ? "Scene camera" : "Whole solid";
    const std::size_t pinned = pinnedNodes(viewport.pinned).size();
    return pinned == 0 ? words
                       : words + (pinned == 1 ? " · one node" : " · " + std::to_string(pinned) + " nodes");
}

double roundUp125(double metres) {
    const double ten = std::pow(10.0, std::floor(std::log10(metres)));
    for (const double by : {1.0, 2.0, 5.0})
        if (by * ten >= metres * (1.0 - 1e-9)) return by * ten;
    return 10.0 * ten;
}

double roundDown125(double metres) {
    const double ten = std::pow(10.0, std::floor(std::log10(metres) + 1e-9));
    for (const double by : {5.0, 2.0})
        if (by * ten <= metres * (1.0 + 1e-9)) return by * ten;
    return ten;
}

}  // namespace fw::editor
