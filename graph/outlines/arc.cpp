#include "graph/outlines/arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fw {

namespace {

constexpr double kStraight = 1e-13;  // a bend times a chord that makes no difference

}  // namespace

Arc arcBetween(glm::dvec2 a, glm::dvec2 b, double bend) {
    const glm::dvec2 chord = b - a;
    const double length = glm::length(chord);
    if (!(length > 0)) return {a, b, 0, {0, 0}};
    const double sine = std::clamp(0.5 * bend * length, -1.0, 1.0);
    const glm::dvec2 along = chord / length;
    if (std::abs(sine) < kStraight) return {a, b, 0, leftOf(along)};
    return {a, b, 2 * sine / length, std::sqrt(1 - sine * sine) * leftOf(along) + sine * along};
}

Arc arcAlong(glm::dvec2 a, glm::dvec2 tangent, glm::dvec2 b) {
    const glm::dvec2 chord = b - a;
    const double length2 = squared(chord), size = glm::length(tangent);
    if (!(length2 > 0) || !(size > 0)) return arcBetween(a, b);
    if (glm::dot(tangent, chord) < 0)
        return arcBetween(a, b, (cross(tangent, chord) < 0 ? -2 : 2) / std::sqrt(length2));
    return arcBetween(a, b, 2 * cross(tangent, chord) / (size * length2));
}

Arc reversed(const Arc& arc) { return {arc.b, arc.a, -arc.bend, -normalAtEnd(arc)}; }
void reverse(std::vector<Arc>& arcs) {
    std::ranges::reverse(arcs);
    for (Arc& arc : arcs) arc = reversed(arc);
}

glm::dvec2 normalAtEnd(const Arc& arc) { return arc.normal - arc.bend * (arc.b - arc.a); }

double turnOf(const Arc& arc) {
    return 2 * std::asin(std::clamp(0.5 * arc.bend * glm::distance(arc.a, arc.b), -1.0, 1.0));
}

double lengthOf(const Arc& arc) {
    return arc.bend == 0 ? glm::distance(arc.a, arc.b) : turnOf(arc) / arc.bend;
}

glm::dvec2 placeOn(const Arc& arc, double share) {
    if (share <= 0) return arc.a;
    if (share >= 1) return arc.b;
    if (arc.bend == 0) return arc.a + share * (arc.b - arc.a);
    const double half = 0.5 * share * turnOf(arc), chord = 2 * std::sin(half) / arc.bend;
    return arc.a + chord * (std::cos(half) * tangentAtStart(arc) + std::sin(half) * arc.normal);
}

Arc partOf(const Arc& arc, double from, double to) {
    return arcBetween(placeOn(arc, from), placeOn(arc, to), arc.bend);
}

double sideOf(const Arc& arc, glm::dvec2 p) {
    const glm::dvec2 q = p - arc.a;
    return (2 * glm::dot(q, arc.normal) - arc.bend * squared(q)) /
           (1 + glm::length(arc.bend * q - arc.normal));
}

bool isLeft(const Arc& arc, glm::dvec2 p) {
    const glm::dvec2 chord = arc.b - arc.a, q = p - arc.a;
    const double beside = cross(chord, q);
    const bool leftOfChord = beside > 0 || (beside == 0 && chord.x > 0);
    if (arc.bend == 0 || leftOfChord == (arc.bend > 0)) return leftOfChord;  // beyond the chord from the arc
    const double side = sideOf(arc, p);
    return side > 0 || (side == 0 && arc.normal.y > arc.bend * q.y);
}

bool facesInside(const Arc& arc, glm::dvec2 p) {
    return glm::dot(p - arc.a, tangentAtStart(arc)) > 0 && glm::dot(p - arc.b, tangentAtEnd(arc)) < 0;
}

double distanceTo(const Arc& arc, glm::dvec2 p) {
    return facesInside(arc, p) ? std::abs(sideOf(arc, p))
                               : std::sqrt(std::min(squared(p - arc.a), squared(p - arc.b)));
}

void addPlain(const Arc& arc, std::vector<Arc>& to) {
    if (arc.bend == 0) return to.push_back(arc);
    // Where its tangent is along an axis: quarters of a turn.
    const glm::dvec2 start = tangentAtStart(arc);
    const double quarter = 0.5 * std::numbers::pi, turn = turnOf(arc), first = std::atan2(start.y, start.x);
    const double least = std::min(first, first + turn), most = std::max(first, first + turn);
    std::vector<double> shares;
    for (double at = quarter * std::ceil(least / quarter); at < most; at += quarter)
        if (const double share = (at - first) / turn; share > 1e-9 && share < 1 - 1e-9)
            shares.push_back(share);
    std::ranges::sort(shares);
    shares.push_back(1);
    double from = 0;
    for (const double share : shares) to.push_back(partOf(arc, std::exchange(from, share), share));
}

double twiceAreaBeside(const Arc& arc) {
    const double turn = turnOf(arc);
    // The segment between arc and chord: of a small turn by its series.
    const double chord = glm::distance(arc.a, arc.b);
    const double segment =
        std::abs(turn) < 1e-3 ? chord * chord * turn / 6 : (turn - std::sin(turn)) / (arc.bend * arc.bend);
    return cross(arc.a, arc.b) + segment;
}

}  // namespace fw
