#include "runtime/window/viewer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fw {

namespace {

constexpr double kSteepest = 1.55;       // radians
constexpr double kOrbitPerHeight = 3.0;  // radians for a drag over the window's height
constexpr double kZoomPerNotch = 0.88;
constexpr double kNearest = 1e-4, kFarthestAway = 1e5;  // metres

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

const std::vector<KeyHelp>& viewerKeys() {
    static const std::vector<KeyHelp> keys = {
        {"left drag", "orbit"},
        {"right drag", "pan"},
        {"wheel", "zoom"},
        {"R", "back to the graph's own camera"},
        {"Space", "pause, play"},
        {"left, right", "one frame back, forward"},
        {"Home, End", "start, end"},
        {"bar", "drag to any time"},
        {"F11", "full screen"},
        {"F1", "show or hide this"},
        {"Esc", "leave full screen, quit"},
    };
    return keys;
}

Orbit Orbit::from(const Camera& camera) {
    const Vector &p = camera.position, &t = camera.target;
    const Vector away = {p[0] - t[0], p[1] - t[1], p[2] - t[2]};
    Orbit orbit;
    orbit.target = t;
    orbit.fov = camera.fov;
    orbit.distance = std::clamp(std::hypot(away[0], away[1], away[2]), kNearest, kFarthestAway);
    orbit.azimuth = std::atan2(away[0], away[2]);
    orbit.elevation =
        std::clamp(std::asin(std::clamp(away[1] / orbit.distance, -1.0, 1.0)), -kSteepest, kSteepest);
    return orbit;
}

Camera Orbit::camera() const {
    const double level = distance * std::cos(elevation);
    return {.position = {target[0] + level * std::sin(azimuth), target[1] + distance * std::sin(elevation),
                         target[2] + level * std::cos(azimuth)},
            .target = target,
            .fov = fov};
}

void Viewer::resize(int newWidth, int newHeight) {
    dirty = dirty || newWidth != width || newHeight != height;
    width = newWidth, height = newHeight;
}

void Viewer::key(ViewerKey pressed) {
    dirty = true;
    const double frame = std::round(seconds * framesPerSecond);
    switch (pressed) {
        case ViewerKey::pause: paused = !paused; break;
        case ViewerKey::back: paused = true, seconds = std::max(frame - 1.0, 0.0) / framesPerSecond; break;
        case ViewerKey::forward: paused = true, seconds = (frame + 1.0) / framesPerSecond; break;
        case ViewerKey::start: seconds = 0.0; break;
        case ViewerKey::end: paused = true, seconds = length; break;
        case ViewerKey::fullScreen: fullScreen = !fullScreen; break;
        case ViewerKey::help: help = !help; break;
        case ViewerKey::resetCamera: ownCamera = false; break;
        case ViewerKey::leave:
            if (fullScreen)
                fullScreen = false;
            else
                closed = true;
            break;
        case ViewerKey::quit: closed = true; break;
    }
}

int Viewer::barHeight() const { return moves && height > 120 ? 28 : 0; }

void Viewer::press(MouseButton button) {
    if (button != MouseButton::left) {
        drag = Drag::pan;
    } else if (lastY >= height - barHeight()) {
        drag = Drag::scrub;
        scrubTo(lastX);
    } else {
        drag = Drag::orbit;
    }
}

void Viewer::release(MouseButton) { drag = Drag::none; }

void Viewer::scrubTo(double x) {
    seconds = length * std::clamp(x / std::max(width, 1), 0.0, 1.0);
    // The end of a loop is its beginning: the last frame stands there.
    if (loop == Loop::repeat) seconds = std::min(seconds, std::max(length - 1.0 / framesPerSecond, 0.0));
    paused = true;
    dirty = true;
}

void Viewer::takeCamera() {
    if (!ownCamera) orbit = Orbit::from(seen);
    ownCamera = true;
    dirty = true;
}

void Viewer::move(double x, double y) {
    const double dx = x - lastX, dy = y - lastY;
    lastX = x, lastY = y;
    if (drag == Drag::none || (dx == 0.0 && dy == 0.0)) return;
    if (drag == Drag::scrub) return scrubTo(x);
    takeCamera();
    const double side = std::max(height, 1);
    if (drag == Drag::orbit) {
        orbit.azimuth = std::remainder(orbit.azimuth - kOrbitPerHeight * dx / side, 2.0 * std::numbers::pi);
        orbit.elevation = std::clamp(orbit.elevation + kOrbitPerHeight * dy / side, -kSteepest, kSteepest);
        return;
    }
    // What is at the target's distance stays under the mouse.
    const double metres = 2.0 * orbit.distance * std::tan(orbit.fov * std::numbers::pi / 360.0) / side;
    const Vector right = {std::cos(orbit.azimuth), 0.0, -std::sin(orbit.azimuth)};
    const Vector back = {std::cos(orbit.elevation) * std::sin(orbit.azimuth), std::sin(orbit.elevation),
                         std::cos(orbit.elevation) * std::cos(orbit.azimuth)};
    const Vector up = cross(back, right);
    for (std::size_t i = 0; i < 3; ++i) orbit.target[i] += metres * (dy * up[i] - dx * right[i]);
}

void Viewer::scroll(double notches) {
    takeCamera();
    orbit.distance = std::clamp(orbit.distance * std::pow(kZoomPerNotch, notches), kNearest, kFarthestAway);
}

void Viewer::pass(double elapsed) {
    if (paused || !moves || drag == Drag::scrub) return;
    seconds += elapsed;
    dirty = true;
}

double Viewer::shownTime() const {
    Timeline timeline;
    timeline.length = length, timeline.loop = loop;
    return timelineTime(timeline, seconds);
}

}  // namespace fw
