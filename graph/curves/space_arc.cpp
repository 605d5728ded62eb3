#include "graph/curves/space_arc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fw {

namespace {

/// sin(k s) / k and (1 - cos(k s)) / k.
glm::dvec2 offsetOn(double bend, double s) {
    const double halved = 0.5 * bend * s, sine = std::sin(halved),
                 share = std::abs(halved) < 1e-9 ? 1.0 : sine / halved;  // sin(h) / h
    return {s * share * std::cos(halved), s * share * sine};
}

glm::dvec3 anyAcross(const glm::dvec3& direction) {
    const glm::dvec3 size = glm::abs(direction);
    const glm::dvec3 axis = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                            : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                 : glm::dvec3(0, 0, 1);
    return glm::normalize(axis - direction * glm::dot(axis, direction));
}

}  // namespace

SpaceArc spaceLine(const glm::dvec3& a, const glm::dvec3& b) {
    SpaceArc line;
    line.middle = 0.5 * (a + b);
    const double length = glm::distance(a, b);
    line.half = 0.5 * length;
    if (length > 0) line.along = (b - a) / length;
    line.towards = anyAcross(line.along);
    return line;
}

SpaceArc spaceArc(const glm::dvec3& a, const glm::dvec3& direction, const glm::dvec3& b) {
    const glm::dvec3 chord = b - a, start = glm::normalize(direction);
    const double length = glm::length(chord), ahead = glm::dot(chord, start);
    const glm::dvec3 beside = chord - ahead * start;
    const double off = glm::length(beside);
    // The chord is turned from the direction by half of what the arc turns.
    const double quarter = std::min(0.5 * std::atan2(off, ahead), std::numbers::pi / 8);
    if (!(length > 0) || !(off > 1e-12 * length) || ahead <= 0) return spaceLine(a, b);
    const glm::dvec3 aside = beside / off;
    SpaceArc arc;
    // At the middle it leads along the chord.
    arc.along = chord / length;
    arc.towards = glm::normalize(aside - arc.along * glm::dot(aside, arc.along));
    const double sine = std::sin(2 * quarter);
    arc.bend = 2 * sine / length;
    arc.half = 2 * quarter / arc.bend;
    arc.middle = 0.5 * (a + b) - arc.towards * (0.5 * length * std::tan(quarter));
    return arc;
}

glm::dvec3 placeOn(const SpaceArc& arc, double s) {
    const glm::dvec2 off = offsetOn(arc.bend, s);
    return arc.middle + off.x * arc.along + off.y * arc.towards;
}
glm::dvec3 directionOn(const SpaceArc& arc, double s) {
    return std::cos(arc.bend * s) * arc.along + std::sin(arc.bend * s) * arc.towards;
}
glm::dvec3 towardsOn(const SpaceArc& arc, double s) {
    return std::cos(arc.bend * s) * arc.towards - std::sin(arc.bend * s) * arc.along;
}
glm::dvec3 frameOn(const SpaceArc& arc, double s, int direction) {
    const double angle = arc.turn + arc.turnSlope * s;
    const glm::dvec3 towards = towardsOn(arc, s), across = arc.across();
    return direction == 0 ? std::cos(angle) * towards + std::sin(angle) * across
                          : std::cos(angle) * across - std::sin(angle) * towards;
}

SpaceFoot nearestOn(const SpaceArc& arc, const glm::dvec3& p, double times) {
    const glm::dvec3 q = p - arc.middle;
    const double radius = times * arc.radius, m = times * arc.radiusSlope, k = arc.bend,
                 x = glm::dot(q, arc.along), y = glm::dot(q, arc.towards), z = glm::dot(q, arc.across()),
                 c = 1 - k * y, h = std::hypot(c, k * x), beside = (k * (x * x + y * y) - 2 * y) / (1 + h),
                 off2 = beside * beside + z * z;
    const glm::dvec2 end = offsetOn(k, arc.half);
    const auto distanceToEnd = [&](double side) {
        return std::sqrt((x - side * end.x) * (x - side * end.x) + (y - end.y) * (y - end.y) + z * z);
    };
    const double at = k * arc.half < 1e-9 ? x : std::atan2(k * x, c) / k;  // of the circle's nearest place
    if (m == 0) {
        const double side = x < 0 ? -1 : 1;
        if (std::abs(at) <= arc.half) return {at, std::sqrt(off2) - radius, false};
        return {side * arc.half, distanceToEnd(side) - radius, true};
    }
    // The distance squared to the place u metres on is off2 + h t with t = (2 sin(k u / 2) / k)^2. Less the
    // radius it is the least where h h t (1 - k k t / 4) = m m (off2 + h t), m the radius' slope: of the two
    // t the smaller one.
    SpaceFoot best{0, 1e300, true};
    for (const double side : {-1.0, 1.0})
        if (const double distance = distanceToEnd(side) - radius - m * side * arc.half;
            distance < best.distance)
            best = {side * arc.half, distance, true};
    const double b = h * (h - m * m), root = b * b - k * k * h * h * m * m * off2;
    if (b > 0 && root >= 0) {
        const double t = 2 * m * m * off2 / (b + std::sqrt(root)), chord = std::sqrt(t),
                     u = std::copysign(
                         k * chord < 1e-9 ? chord : 2 / k * std::asin(std::min(0.5 * k * chord, 1.0)), m),
                     s = at + u;
        const double distance = std::sqrt(off2 + h * t) - radius - m * s;
        if (std::abs(s) <= arc.half && distance < best.distance) best = {s, distance, false};
    }
    return best;
}

}  // namespace fw
