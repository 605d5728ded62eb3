#include "editor/probe/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace fw::editor {

namespace {

constexpr double kStepOfSize = 1e-5;  // between gradients, of the solid's size
constexpr double kFlat = 1e-3;        // of one over its size: curvature that is none
constexpr double kOnALine = 1e-9;     // sine of an angle
constexpr double kSameRadius = 2e-3;  // of it

glm::dvec3 vectorOf(const Point& p) { return {p[0], p[1], p[2]}; }
Point pointOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::optional<double> angleOf(const std::array<Point, 3>& points) {
    const glm::dvec3 corner = vectorOf(points[1]), a = vectorOf(points[0]) - corner,
                     b = vectorOf(points[2]) - corner;
    if (glm::length(a) == 0.0 || glm::length(b) == 0.0) return std::nullopt;
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

std::optional<Circle> circleThrough(const std::array<Point, 3>& points) {
    const glm::dvec3 origin = vectorOf(points[0]), a = vectorOf(points[1]) - origin,
                     b = vectorOf(points[2]) - origin, normal = glm::cross(a, b);
    const double area = glm::length(normal);
    if (!(area > kOnALine * glm::length(a) * glm::length(b))) return std::nullopt;
    const glm::dvec3 middle =
        glm::cross(glm::dot(a, a) * b - glm::dot(b, b) * a, normal) * (0.5 / (area * area));
    const glm::dvec3 across = glm::normalize(-middle), along = glm::cross(normal / area, across);
    return Circle{pointOf(origin + middle), glm::length(middle), pointOf(across), pointOf(along)};
}

std::optional<Bend> bendAt(const Tape& tape, const Point& surface, double size) {
    const double step = kStepOfSize * size;
    std::array<Point, 7> points;
    points.fill(surface);
    for (std::size_t axis = 0; axis < 3; ++axis)
        points[1 + 2 * axis][axis] += step, points[2 + 2 * axis][axis] -= step;
    std::array<ValueGradient, 7> at{};
    TapeMachine<double> machine;
    evaluateGradient(machine, tape, points, at);
    const glm::dvec3 gradient = vectorOf(at[0].gradient);
    const double slope = glm::length(gradient);
    if (!(slope > 0.0) || !std::isfinite(slope)) return std::nullopt;
    const glm::dvec3 n = gradient / slope,
                     u = glm::normalize(
                         glm::cross(n, std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))),
                     v = glm::cross(n, u);
    std::array<glm::dvec3, 3> columns;
    for (std::size_t axis = 0; axis < 3; ++axis)
        columns[axis] =
            (vectorOf(at[1 + 2 * axis].gradient) - vectorOf(at[2 + 2 * axis].gradient)) / (2.0 * step);
    const auto turned = [&](const glm::dvec3& along) {
        return (columns[0] * along.x + columns[1] * along.y + columns[2] * along.z) / slope;
    };
    const double uu = glm::dot(u, turned(u)), vv = glm::dot(v, turned(v)),
                 uv = 0.5 * (glm::dot(u, turned(v)) + glm::dot(v, turned(u)));
    const double mean = 0.5 * (uu + vv), off = std::hypot(0.5 * (uu - vv), uv);
    Bend bend{mean + off, mean - off};
    if (std::abs(bend.least) > std::abs(bend.most)) std::swap(bend.most, bend.least);
    if (!std::isfinite(bend.most)) return std::nullopt;
    return bend;
}

std::string bendWords(const Bend& bend, double size, const LengthUnit& lengths) {
    const double flat = kFlat / size;
    if (std::abs(bend.most) < flat) return "Flat";
    const auto radius = [&](double curvature) {
        return withSign(1.0 / std::abs(curvature), "m", lengths) + (curvature < 0.0 ? " hollow" : "");
    };
    if (std::abs(bend.least) < flat) return "Radius " + radius(bend.most) + ", straight across";
    if (std::abs(bend.most - bend.least) < kSameRadius * std::abs(bend.most))
        return "Radius " + radius(bend.most);
    return "Radii " + radius(bend.most) + " and " + radius(bend.least);
}

}  // namespace fw::editor
