#include "editor/viewport/orbit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fw::editor {

namespace {

constexpr double kTurnPerHeight = 3.0;  // radians
constexpr double kOverhead = 0.5 * std::numbers::pi;
/// While turning: straight up or down, the azimuth would be lost in the camera.
constexpr double kSteepest = 1.55;
constexpr double kZoomPerNotch = 0.88;
constexpr double kNearest = 1e-4, kFarthest = 1e5;  // metres from the target
constexpr double kFast = 5.0;
constexpr double kMargin = 1.1;  // about what is framed

/// Half the height of what is seen at the distance of 1.
double tangent(const Orbit& orbit) { return std::tan(orbit.fov * std::numbers::pi / 360.0); }

void shift(Vector& place, const Vector& along, double by) {
    for (std::size_t i = 0; i < 3; ++i) place[i] += by * along[i];
}

void rotate(Orbit& orbit, double dx, double dy) {
    orbit.azimuth = std::remainder(orbit.azimuth - kTurnPerHeight * dx, 2.0 * std::numbers::pi);
    orbit.elevation = std::clamp(orbit.elevation - kTurnPerHeight * dy, -kSteepest, kSteepest);
}

}  // namespace

Axes axesOf(const Orbit& orbit) {
    const double s = std::sin(orbit.azimuth), c = std::cos(orbit.azimuth), rise = std::sin(orbit.elevation),
                 level = std::cos(orbit.elevation);
    return {.right = {c, 0.0, -s}, .up = {-rise * s, level, -rise * c}, .back = {level * s, rise, level * c}};
}

void turn(Orbit& orbit, double dx, double dy) { rotate(orbit, dx, dy); }

void pan(Orbit& orbit, double dx, double dy) {
    const Axes axes = axesOf(orbit);
    const double metres = 2.0 * orbit.distance * tangent(orbit);
    shift(orbit.target, axes.right, -dx * metres);
    shift(orbit.target, axes.up, -dy * metres);
}

void zoom(Orbit& orbit, double notches, double x, double y, double aspect) {
    const double before = orbit.distance;
    orbit.distance = std::clamp(before * std::pow(kZoomPerNotch, notches), kNearest, kFarthest);
    const Axes axes = axesOf(orbit);
    const double by = (before - orbit.distance) * tangent(orbit);
    shift(orbit.target, axes.right, x * aspect * by);
    shift(orbit.target, axes.up, y * by);
}

void look(Orbit& orbit, double dx, double dy) {
    shift(orbit.target, axesOf(orbit).back, orbit.distance);
    rotate(orbit, dx, dy);
    shift(orbit.target, axesOf(orbit).back, -orbit.distance);
}

void fly(Orbit& orbit, double forward, double right, double up, double seconds, bool fast) {
    const Axes axes = axesOf(orbit);
    const double metres = orbit.distance * seconds * (fast ? kFast : 1.0);
    shift(orbit.target, axes.back, -forward * metres);
    shift(orbit.target, axes.right, right * metres);
    shift(orbit.target, axes.up, up * metres);
}

void lookFrom(Orbit& orbit, Side side) {
    orbit.azimuth = side == Side::right                          ? kOverhead
                    : side == Side::left                         ? -kOverhead
                    : side == Side::back || side == Side::bottom ? std::numbers::pi
                                                                 : 0.0;
    orbit.elevation = side == Side::top ? kOverhead : side == Side::bottom ? -kOverhead : 0.0;
}

void frame(Orbit& orbit, const Vector& centre, double radius, double aspect) {
    orbit.target = centre;
    const double half = std::atan(tangent(orbit) * std::min(aspect, 1.0));
    orbit.distance = std::clamp(kMargin * radius / std::sin(half), kNearest, kFarthest);
}

}  // namespace fw::editor
