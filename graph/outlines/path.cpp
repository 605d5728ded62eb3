#include "graph/outlines/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace fw {

namespace {

constexpr int kMostHalvings = 14;  // halvings of a curve
constexpr int kProbes = 8;

struct Cubic {
    std::array<glm::dvec2, 4> p;
    glm::dvec2 operator()(double t) const {
        const double s = 1 - t;
        return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
    }
    glm::dvec2 slope(double t) const {
        const double s = 1 - t;
        return s * s * (p[1] - p[0]) + 2 * s * t * (p[2] - p[1]) + t * t * (p[3] - p[2]);
    }
};

struct Ellipse {
    glm::dvec2 centre, u, v;
    glm::dvec2 operator()(double w) const { return centre + std::cos(w) * u + std::sin(w) * v; }
    glm::dvec2 slope(double w) const { return std::cos(w) * v - std::sin(w) * u; }
};

/// A curve of which no slopes are known.
struct AnyCurve {
    const std::function<glm::dvec2(double)>& curve;
    glm::dvec2 operator()(double t) const { return curve(t); }
    glm::dvec2 slope(double) const { return {0, 0}; }  // asked of places close by
};

/// An arc through a map that makes ellipses of circles.
struct Moved {
    const Arc& arc;
    const PlaneTransform& affine;
    glm::dvec2 operator()(double t) const { return affine(placeOn(arc, t)); }
    glm::dvec2 slope(double t) const {
        const glm::dvec2 normal = arc.normal - arc.bend * (placeOn(arc, t) - arc.a);
        return affine.direction(rightOf(normal));
    }
};

/// The direction of growing parameters at one end of a part of a curve: of its slope; where that is 0 or
/// unknown, by places close by, to the second order, but at a cusp, where that is 0 too, to the first.
template <class Curve>
glm::dvec2 directionAt(const Curve& curve, double at, double other) {
    const double step = 1e-3 * (other - at), forward = other > at ? 1 : -1;
    glm::dvec2 found = curve.slope(at);
    if (glm::length(found) <= 1e-9 * glm::distance(curve(at), curve(other))) {
        const glm::dvec2 here = curve(at), first = curve(at + step) - here,
                         second = 4.0 * first - (curve(at + 2 * step) - here);
        found = forward * (glm::length(second) > 0.1 * glm::length(first) ? second : first);
    }
    const double length = glm::length(found);
    return length > 0 ? found / length : glm::dvec2(0);
}

/// Two arcs from `a` to `b` with these directions of unit length at their ends, as far to their joint along
/// the one as along the other; none if there is no such pair that turns by less than half a circle.
std::optional<std::pair<Arc, Arc>> biarc(glm::dvec2 a, glm::dvec2 from, glm::dvec2 b, glm::dvec2 to) {
    const glm::dvec2 chord = b - a, sum = from + to;
    const double along = glm::dot(chord, sum), twist = 2 * (1 - glm::dot(from, to)),
                 size2 = glm::dot(chord, chord);
    if (!(along > 0)) return std::nullopt;
    const double reach =
        size2 / (along + std::sqrt(along * along + twist * size2));  // stable where directions agree
    const glm::dvec2 joint = 0.5 * (a + b + reach * (from - to));
    if (!(glm::dot(joint - a, from) > 0 && glm::dot(b - joint, to) > 0)) return std::nullopt;
    return std::pair(arcAlong(a, from, joint), reversed(arcAlong(b, -to, joint)));
}

}  // namespace

PlaneTransform operator*(const PlaneTransform& outer, const PlaneTransform& inner) {
    return {outer.direction(inner.x), outer.direction(inner.y), outer(inner.origin)};
}

double greatestScale(const PlaneTransform& affine) {
    const double half = 0.5 * (glm::dot(affine.x, affine.x) + glm::dot(affine.y, affine.y));
    const double determinant = affine.determinant();
    return std::sqrt(half + std::sqrt(std::max(0.0, half * half - determinant * determinant)));
}

bool isSimilarity(const PlaneTransform& affine) {
    const double size = glm::dot(affine.x, affine.x) + glm::dot(affine.y, affine.y);
    return std::abs(glm::dot(affine.x, affine.x) - glm::dot(affine.y, affine.y)) <= 1e-9 * size &&
           std::abs(glm::dot(affine.x, affine.y)) <= 1e-9 * size;
}

void Pen::add(const Arc& arc) {
    at = arc.b;
    std::vector<Arc>& arcs = contours.back().arcs;
    if (arc.a == arc.b && !arcs.empty()) return;
    if (arcs.size() == 1 && arcs[0].a == arcs[0].b) arcs.clear(), --drawn;  // only a place alone is a dot
    arcs.push_back(arc);
    ++drawn;
}

void Pen::begin() {
    if (!std::exchange(down, true)) contours.emplace_back();
}

void Pen::moveTo(glm::dvec2 p) {
    start = at = p;
    down = false;
}

void Pen::lineTo(glm::dvec2 p) {
    begin();
    add(arcBetween(at, p));
}

template <class Curve>
void Pen::follow(const Curve& curve, double from, double to, int depth) {
    const glm::dvec2 a = at, b = curve(to), chord = b - a;
    const double size = glm::length(chord);
    const double forth = to > from ? 1 : -1;
    const glm::dvec2 leaves = forth * directionAt(curve, from, to),
                     arrives = forth * directionAt(curve, to, from);
    const auto near = [&](const auto& isNear) {
        for (int i = 1; i < kProbes; ++i)
            if (!isNear(curve(from + (to - from) * i / kProbes))) return false;
        return true;
    };
    if (glm::dot(leaves, chord) > 0.5 * size && glm::dot(arrives, chord) > 0.5 * size)
        if (const auto pair = biarc(a, leaves, b, arrives);
            pair && near([&](glm::dvec2 p) {
                return std::min(distanceTo(pair->first, p), distanceTo(pair->second, p)) <= tolerance;
            })) {
            add(pair->first);
            return add(pair->second);
        }
    if (depth == 0 ||
        (size <= tolerance && near([&](glm::dvec2 p) { return glm::distance(p, a) <= tolerance; })))
        return add(arcBetween(a, b));
    const double middle = 0.5 * (from + to);
    follow(curve, from, middle, depth - 1);
    follow(curve, middle, to, depth - 1);
}

void Pen::curveTo(glm::dvec2 control, glm::dvec2 p) {
    curveTo((at + 2.0 * control) / 3.0, (p + 2.0 * control) / 3.0, p);
}

void Pen::curveTo(glm::dvec2 control, glm::dvec2 second, glm::dvec2 p) {
    begin();
    follow(Cubic{{at, control, second, p}}, 0, 1, kMostHalvings);
}

void Pen::ellipse(glm::dvec2 centre, glm::dvec2 u, glm::dvec2 v, double from, double to) {
    const Ellipse curve{centre, u, v};
    lineTo(curve(from));
    const int parts = std::max(1, int(std::ceil(std::abs(to - from) / (0.5 * std::numbers::pi) - 1e-9)));
    for (int i = 0; i < parts; ++i)
        follow(curve, from + (to - from) * i / parts, from + (to - from) * (i + 1) / parts, kMostHalvings);
}

void Pen::along(const std::function<glm::dvec2(double)>& curve, double from, double to) {
    begin();
    if (glm::distance(at, curve(from)) > tolerance) lineTo(curve(from));
    for (int i = 0; i < 4; ++i)
        follow(AnyCurve{curve}, from + (to - from) * i / 4, from + (to - from) * (i + 1) / 4, kMostHalvings);
}

void Pen::close() {
    if (!down) return;
    std::vector<Arc>& arcs = contours.back().arcs;
    if (at != start && !arcs.empty() && glm::distance(at, start) < 1e-3 * tolerance)  // a circle's rounding
        arcs.back() = arcBetween(arcs.back().a, start, arcs.back().bend), at = start;
    if (at != start) add(arcBetween(at, start));
    contours.back().closed = true;
    down = false;
}

std::vector<Contour> Pen::taken() {
    std::vector<Contour> all = std::exchange(contours, {});
    *this = Pen(tolerance);
    return all;
}

std::vector<Contour> moved(const std::vector<Contour>& contours, const PlaneTransform& affine,
                           double tolerance) {
    std::vector<Contour> result;
    if (isSimilarity(affine)) {
        const double turned = affine.determinant() < 0 ? -1 : 1, scale = greatestScale(affine);
        for (const Contour& contour : contours) {
            Contour& to = result.emplace_back(Contour{{}, contour.closed});
            for (const Arc& arc : contour.arcs)
                to.arcs.push_back(arcBetween(affine(arc.a), affine(arc.b), turned * arc.bend / scale));
        }
        return result;
    }
    for (const Contour& contour : contours) {
        if (contour.arcs.empty()) continue;
        Pen pen(tolerance);
        pen.moveTo(affine(contour.arcs.front().a));
        pen.begin();
        for (const Arc& arc : contour.arcs)
            if (arc.bend == 0)
                pen.lineTo(affine(arc.b));
            else
                pen.follow(Moved{arc, affine}, 0, 1, kMostHalvings);
        for (Contour& part : pen.taken()) {
            part.closed = contour.closed;
            result.push_back(std::move(part));
        }
    }
    return result;
}

}  // namespace fw
