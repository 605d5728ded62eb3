// Arcs in the plane, of circles or straight: what every outline is made of.
//
// An arc is at most half a circle, so that two ends and a bend say all of it. Everything is asked by one
// formula that holds for straight ones too: with q the place from the first end, n the unit normal there (to
// the left) and k the bend, a place's signed distance to the whole circle is (2 q.n - k q.q) / (1 + |k q -
// n|). No centre and no radius is ever formed, which would be far away and lose all digits where an arc is
// nearly straight.
//
// An arc is *plain* if it goes only one way along x and only one way along y: then every line along an axis
// that parts its ends meets it once.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <vector>

namespace fw {

struct Arc {
    glm::dvec2 a, b;         ///< its ends, metres
    double bend = 0;         ///< 1 / radius, above 0 where it turns left, 1/m
    glm::dvec2 normal = {};  ///< at `a`, to the left, of unit length; 0 of an arc without length
    bool operator==(const Arc&) const = default;
};

inline double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }
inline double squared(glm::dvec2 a) { return glm::dot(a, a); }
inline glm::dvec2 leftOf(glm::dvec2 a) { return {-a.y, a.x}; }
inline glm::dvec2 rightOf(glm::dvec2 a) { return {a.y, -a.x}; }

/// The arc of a bend, which is cut off at that of half a circle.
Arc arcBetween(glm::dvec2 a, glm::dvec2 b, double bend = 0);
/// The arc that leaves `a` along a tangent (of any length but 0). One that would be more than half a circle
/// is half of one.
Arc arcAlong(glm::dvec2 a, glm::dvec2 tangent, glm::dvec2 b);
Arc reversed(const Arc& arc);
/// Arcs that follow each other, the other way round.
void reverse(std::vector<Arc>& arcs);

glm::dvec2 normalAtEnd(const Arc& arc);
inline glm::dvec2 tangentAtStart(const Arc& arc) { return rightOf(arc.normal); }
inline glm::dvec2 tangentAtEnd(const Arc& arc) { return rightOf(normalAtEnd(arc)); }

/// By how much it turns left, radians.
double turnOf(const Arc& arc);
double lengthOf(const Arc& arc);
/// A place on it, 0 at `a` and 1 at `b`.
glm::dvec2 placeOn(const Arc& arc, double share);
/// The part between two shares, whose ends are those of the arc where they are 0 and 1.
Arc partOf(const Arc& arc, double from, double to);

/// The signed distance to the whole circle or line, above 0 to its left.
double sideOf(const Arc& arc, glm::dvec2 p);
/// Whether a place is to the left of the arc, prolonged beyond its ends by its chord. A place is taken to lie
/// a little above where it is.
bool isLeft(const Arc& arc, glm::dvec2 p);
/// Whether the nearest place of the circle is one of the arc, its ends not among them.
bool facesInside(const Arc& arc, glm::dvec2 p);
double distanceTo(const Arc& arc, glm::dvec2 p);

/// The arc in plain pieces, in order.
void addPlain(const Arc& arc, std::vector<Arc>& to);

/// Twice the area that lies to the left of arcs which make closed contours, less what lies to their right, is
/// the sum of this.
double twiceAreaBeside(const Arc& arc);

}  // namespace fw
