// Arcs in space, of circles or straight: what every spline is made of.
//
// An arc is told from its middle: the place, the direction there, and the direction to its circle's centre.
// With x along the one, y along the other and z across both, k the bend, and h = |(1 - k y, k x)|, a place is
// (k (x x + y y) - 2 y) / (1 + h) beyond the circle in its plane. As of flat arcs (outlines/arc.h) no centre
// and no radius is ever formed, so that this holds for straight ones too. An arc is at most a quarter of a
// circle, and alike on both sides of its middle: a place's nearest end is the one on its side.
//
// A ball may run along an arc and change its radius evenly. The least of "distance to its centre less its
// radius" is where its surface comes the closest; it is found in closed form.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace fw {

struct SpaceArc {
    glm::dvec3 middle{0};         ///< metres
    glm::dvec3 along{1, 0, 0};    ///< where it leads at its middle, of unit length
    glm::dvec3 towards{0, 1, 0};  ///< to its circle's centre, of unit length, across `along`
    double bend = 0;              ///< 1 / radius, at least 0, 1/m
    double half = 0;              ///< of its length, metres

    double radius = 0, radiusSlope = 0;  ///< of the ball: at the middle, metres, and per metre
    /// Of a frame whose first direction is `towards`, turned about `along` towards `across`: at the middle,
    /// radians, and per metre. The frame of a turn that does not change keeps still as far as it can.
    double turn = 0, turnSlope = 0;
    double begin = 0;  ///< metres of its spline that lie before it

    glm::dvec3 across() const { return glm::cross(along, towards); }
    bool operator==(const SpaceArc&) const = default;
};

/// The arc that leaves `a` along a direction (of any length but 0) and ends in `b`, cut off at a quarter of a
/// circle; a line where that would lead backwards.
SpaceArc spaceArc(const glm::dvec3& a, const glm::dvec3& direction, const glm::dvec3& b);
SpaceArc spaceLine(const glm::dvec3& a, const glm::dvec3& b);

/// A place on it, and where it leads there; `s` metres from the middle.
glm::dvec3 placeOn(const SpaceArc& arc, double s);
glm::dvec3 directionOn(const SpaceArc& arc, double s);
/// To the circle's centre there.
glm::dvec3 towardsOn(const SpaceArc& arc, double s);
/// The frame's two directions there, of unit length, across where it leads.
glm::dvec3 frameOn(const SpaceArc& arc, double s, int direction);

/// Where on an arc a place's nearest is, metres from the middle; and what is left of the distance to it;
/// `times`: the balls are so many times as large.
struct SpaceFoot {
    double s = 0;
    double distance = 0;  ///< less the ball's radius, metres
    bool beyond = false;  ///< an end is the nearest
};
SpaceFoot nearestOn(const SpaceArc& arc, const glm::dvec3& p, double times = 1);

}  // namespace fw
