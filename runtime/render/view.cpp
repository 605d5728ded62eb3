#include "runtime/render/view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

namespace fw {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

float usualWidth(float longest) {
    const float size = std::max(longest, std::numeric_limits<float>::min());
    return std::pow(10.0f, std::floor(std::log10(size / 50.0f)));
}

SeenBounds boundsOf(std::span<const gpu::MeshVertex> points) {
    if (points.empty()) return {};
    glm::vec3 lo(kInfinity), hi(-kInfinity);
    for (const gpu::MeshVertex& vertex : points)
        lo = glm::min(lo, vertex.position), hi = glm::max(hi, vertex.position);
    return {0.5f * (lo + hi), std::max(0.5f * glm::length(hi - lo), 1e-6f), lo.y};
}

gpu::View lookFrom(glm::vec3 eye, glm::vec3 target, float fov, float aspect, float near) {
    gpu::View view{};
    view.eye = eye;
    view.near = near;
    view.forward = glm::normalize(target - eye);
    // Straight up or down, what was ahead before is up.
    const glm::vec3 upward = std::abs(view.forward.y) < 0.9999f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    const glm::vec3 right = glm::normalize(glm::cross(view.forward, upward));
    const float tangent = std::tan(0.5f * fov);
    view.right = right * (tangent * aspect);
    view.up = glm::cross(right, view.forward) * tangent;
    return view;
}

gpu::View cameraView(const Camera& camera, const SeenBounds& bounds, float aspect) {
    gpu::View view =
        lookFrom(vector(camera.position), vector(camera.target), glm::radians(float(camera.fov)), aspect);
    const float nearest = glm::dot(view.forward, bounds.centre - view.eye) - bounds.radius;
    view.near = std::max(0.5f * nearest, 1e-3f * bounds.radius);
    return view;
}

float focusOf(const Camera& camera, const gpu::View& view) {
    return camera.focus > 0.0 ? std::max(float(camera.focus), view.near)
                              : glm::distance(vector(camera.position), vector(camera.target));
}

gpu::View throughLens(gpu::View view, const Camera& camera, glm::vec2 place) {
    const float focus = focusOf(camera, view);
    const glm::vec2 moved = 0.5f * float(camera.aperture) * place;
    view.eye += moved.x * glm::normalize(view.right) + moved.y * glm::normalize(view.up);
    view.jitter -= moved / (focus * glm::vec2(glm::length(view.right), glm::length(view.up)));
    return view;
}

gpu::View framingView(std::span<const gpu::MeshVertex> points, float aspect) {
    constexpr float kAround = 0.61f,
                    kAbove = 0.38f;      // where the camera stands, radians from +z and the ground
    constexpr float kHalfAngle = 0.25f;  // of view along the picture's shorter side
    constexpr float kFilled = 0.81f;     // of the picture; the rest is margin

    gpu::View view{};
    view.forward = -glm::vec3(std::sin(kAround) * std::cos(kAbove), std::sin(kAbove),
                              std::cos(kAround) * std::cos(kAbove));
    const glm::vec3 right = glm::normalize(glm::cross(view.forward, glm::vec3(0, 1, 0)));
    const glm::vec3 up = glm::cross(right, view.forward);
    const glm::vec2 tangent = std::tan(kHalfAngle) * glm::max(glm::vec2(aspect, 1 / aspect), glm::vec2(1));

    // A point at (x, y, z) along right, up and forward is in the picture if |x - eye.x| <= t (z - eye.z): the
    // four sides of the view are as far out as the outermost point says.
    glm::vec2 least(kInfinity), most(-kInfinity), filled = kFilled * tangent;
    float nearest = kInfinity;
    for (const gpu::MeshVertex& vertex : points) {
        const glm::vec3 p = vertex.position;
        const glm::vec2 across(glm::dot(right, p), glm::dot(up, p));
        const float along = glm::dot(view.forward, p);
        least = glm::min(least, across + filled * along);
        most = glm::max(most, across - filled * along);
        nearest = std::min(nearest, along);
    }
    const glm::vec2 at = 0.5f * (least + most), back = (least - most) / (2.0f * filled);
    const float away = std::min({back.x, back.y, nearest - 1e-6f});
    view.eye = right * at.x + up * at.y + view.forward * away;
    view.right = right * tangent.x;
    view.up = up * tangent.y;
    view.near = 0.5f * (nearest - away);
    return view;
}

Camera framingCamera(std::span<const gpu::MeshVertex> points, float aspect) {
    const gpu::View view = framingView(points, aspect);
    const float away = std::max(glm::dot(boundsOf(points).centre - view.eye, view.forward), view.near);
    const glm::vec3 target = view.eye + away * view.forward;
    return {.position = {view.eye.x, view.eye.y, view.eye.z},
            .target = {target.x, target.y, target.z},
            .fov = double(glm::degrees(2.0f * std::atan(glm::length(view.up))))};
}

glm::mat4 toClip(const gpu::View& view) {
    const glm::vec3 x = view.right / glm::dot(view.right, view.right) - view.jitter.x * view.forward,
                    y = view.up / glm::dot(view.up, view.up) - view.jitter.y * view.forward;
    const auto shift = [&](glm::vec3 axis) { return -glm::dot(axis, view.eye); };
    return {{x.x, y.x, 0, view.forward.x},
            {x.y, y.y, 0, view.forward.y},
            {x.z, y.z, 0, view.forward.z},
            {shift(x), shift(y), view.near, shift(view.forward)}};
}

gpu::TracePush raysOf(const gpu::View& view) {
    gpu::TracePush rays{};
    rays.origin = view.eye;
    rays.direction = view.forward + view.jitter.x * view.right + view.jitter.y * view.up;
    rays.directionX = view.right;
    rays.directionY = view.up;
    rays.near = view.near;
    return rays;
}

}  // namespace fw
