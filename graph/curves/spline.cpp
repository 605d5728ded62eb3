#include "graph/curves/spline.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "graph/base/hash.h"

namespace fw {

namespace {

constexpr int kMostHalvings = 12;
constexpr double kMostTurns = 200;
constexpr double kShortest = 1e-9;  // of the size: what is shorter is no arc

using Curve = std::function<glm::dvec3(double)>;

/// The direction of a vector; empty if it has none.
std::optional<glm::dvec3> directionOf(const glm::dvec3& v, double least) {
    const double length = glm::length(v);
    if (!(length > least)) return std::nullopt;
    return v / length;
}

/// The turn from `from` to `to`, both of unit length, that is the least, applied to `v`.
glm::dvec3 turnedWith(const glm::dvec3& v, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double cosine = glm::dot(from, to);
    if (cosine < -1 + 1e-12) return v;  // back again: any half turn would do
    return v * cosine + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1 + cosine));
}

/// Draws a spline's arcs one behind the other.
class Drawing3d {
  public:
    explicit Drawing3d(double size) : tolerance(kSplineTolerance * size), shortest(kShortest * size) {}

    void line(const glm::dvec3& a, const glm::dvec3& b) { add(spaceLine(a, b)); }
    void add(const SpaceArc& arc) {
        if (2 * arc.half > shortest) arcs.push_back(arc);
    }
    bool tooMany() const { return arcs.size() > kMostSpaceArcs; }

    /// A curve, with its derivative, between two parameters between which it has no corner.
    void follow(const Curve& place, const Curve& slope, double from, double to, int depth = 0) {
        if (tooMany()) return;
        const glm::dvec3 a = place(from), b = place(to);
        const double between = 0.5 * (from + to), step = 1e-3 * (to - from);
        // Where a curve stands still at an end its direction is that of what follows.
        auto start = directionOf(slope(from), 0), end = directionOf(slope(to), 0);
        if (!start || glm::length(slope(from)) * (to - from) < 1e-6 * tolerance)
            start = directionOf(place(from + step) - a, 0);
        if (!end || glm::length(slope(to)) * (to - from) < 1e-6 * tolerance)
            end = directionOf(b - place(to - step), 0);
        if (start && end) {
            if (const auto pair = biarc(a, *start, b, *end);
                pair && (depth >= kMostHalvings || isClose(*pair, place, from, to))) {
                add(pair->first), add(pair->second);
                return;
            }
        }
        if (depth >= kMostHalvings) return line(a, b);
        follow(place, slope, from, between, depth + 1);
        follow(place, slope, between, to, depth + 1);
    }

    std::vector<SpaceArc> arcs;

  private:
    using Pair = std::pair<SpaceArc, SpaceArc>;

    /// Two arcs as long as each other from their ends' directions to where they meet.
    std::optional<Pair> biarc(const glm::dvec3& a, const glm::dvec3& start, const glm::dvec3& b,
                              const glm::dvec3& end) const {
        const glm::dvec3 chord = b - a, both = start + end;
        const double squared = glm::dot(chord, chord), ahead = glm::dot(chord, both),
                     apart = 2 * (1 - glm::dot(start, end));
        if (!(squared > shortest * shortest) || ahead <= 0) return std::nullopt;
        // apart d d + 2 ahead d - chord chord = 0, d the length of the tangents.
        const double d = squared / (ahead + std::sqrt(ahead * ahead + apart * squared));
        const glm::dvec3 meeting = 0.5 * (a + b + d * (start - end)), leads = b - a - d * both;
        // Both arcs lead along `leads` where they meet.
        if (glm::dot(meeting - a, start) <= 0 || glm::dot(b - meeting, end) <= 0) return std::nullopt;
        const glm::dvec3 through = glm::length(leads) > 0 ? glm::normalize(leads) : start;
        const SpaceArc first = spaceArc(a, start, meeting), second = spaceArc(meeting, through, b);
        constexpr double kMost = 0.5 * std::numbers::pi * 0.999;
        if (2 * first.bend * first.half > kMost || 2 * second.bend * second.half > kMost) return std::nullopt;
        return Pair(first, second);
    }

    bool isClose(const Pair& pair, const Curve& place, double from, double to) const {
        for (int i = 1; i < 8; ++i) {
            const glm::dvec3 p = place(from + (to - from) * i / 8.0);
            if (std::min(nearestOn(pair.first, p).distance, nearestOn(pair.second, p).distance) > tolerance)
                return false;
        }
        return true;
    }

    double tolerance, shortest;
};

/// Numbers at places along a line, and the smooth function through them that rises only where they do
/// (Fritsch and Carlson 1980). Of a closed one the last is the first again.
class Along {
  public:
    Along(std::vector<double> at_, std::vector<double> values_, bool closed)
        : at(std::move(at_)), values(std::move(values_)), slopes(at.size(), 0.0) {
        const std::size_t n = at.size();
        const auto rise = [&](std::size_t i) { return (values[i + 1] - values[i]) / (at[i + 1] - at[i]); };
        for (std::size_t i = 0; i < n; ++i) {
            if (!closed && (i == 0 || i + 1 == n)) {
                slopes[i] = n < 2 ? 0.0 : rise(i == 0 ? 0 : n - 2);
                continue;
            }
            const double before = rise(i == 0 ? n - 2 : i - 1), after = rise(i + 1 == n ? 0 : i);
            slopes[i] = before * after > 0 ? 2 * before * after / (before + after) : 0.0;
        }
    }
    double operator()(double x) const {
        const std::size_t last = at.size() - 1;
        const auto above = std::size_t(std::ranges::upper_bound(at, x) - at.begin());
        const std::size_t i = std::clamp<std::size_t>(above, 1, last) - 1;
        const double width = at[i + 1] - at[i], t = std::clamp((x - at[i]) / width, 0.0, 1.0), u = 1 - t;
        // What is the same at both ends is so between, to the last bit: of balls that do not change much less
        // is to be computed.
        return values[i] + (values[i + 1] - values[i]) * t * t * (1 + 2 * u) +
               width * t * u * (slopes[i] * u - slopes[i + 1] * t);
    }

  private:
    std::vector<double> at, values, slopes;
};

/// Begins, frames, length and hash of arcs that follow each other.
void finish(Spline& spline) {
    double s = 0;
    for (SpaceArc& arc : spline.arcs) arc.begin = s, s += 2 * arc.half;
    spline.length = s;
    // What was given as `turn` is the twist; the frame's own turn goes beneath it.
    const SpaceArc& first = spline.arcs.front();
    glm::dvec3 leads = directionOn(first, -first.half);
    // Of a frame that is at rest the first direction is up as far as it can, so that shapes stand upright.
    const glm::dvec3 up = std::abs(leads.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    const glm::dvec3 second = glm::normalize(up - leads * glm::dot(up, leads)),
                     firstCarried = glm::cross(second, leads), firstLeads = leads;
    glm::dvec3 carried = firstCarried;
    std::vector<double> own;
    for (const SpaceArc& arc : spline.arcs) {
        carried = turnedWith(carried, leads, directionOn(arc, -arc.half));
        const glm::dvec3 towards = towardsOn(arc, -arc.half);
        own.push_back(std::atan2(glm::dot(carried, arc.across()), glm::dot(carried, towards)));
        carried = std::cos(own.back()) * towardsOn(arc, arc.half) + std::sin(own.back()) * arc.across();
        leads = directionOn(arc, arc.half);
    }
    double spread = 0;
    if (spline.closed) {
        carried = turnedWith(carried, leads, firstLeads);
        spread = std::atan2(glm::dot(glm::cross(carried, firstCarried), firstLeads),
                            glm::dot(carried, firstCarried)) /
                 s;
    }
    spline.hash = spline.arcs.size() + (spline.closed ? 1u << 31 : 0u);
    for (std::size_t i = 0; i < spline.arcs.size(); ++i) {
        SpaceArc& arc = spline.arcs[i];
        arc.turn += own[i] + spread * (arc.begin + arc.half);
        arc.turnSlope += spread;
        for (const glm::dvec3& v : {arc.middle, arc.along, arc.towards})
            for (int k = 0; k < 3; ++k) spline.hash = mixed(spline.hash, std::bit_cast<uint64_t>(v[k]));
        for (const double x : {arc.bend, arc.half, arc.radius, arc.radiusSlope, arc.turn, arc.turnSlope})
            spline.hash = mixed(spline.hash, std::bit_cast<uint64_t>(x));
    }
}

Error tooManyArcs() {
    return {.message = "the spline has more than " + std::to_string(kMostSpaceArcs) +
                       " arcs: take fewer or smoother curves"};
}

/// The largest side of the places' box.
double sizeOf(std::span<const Knot> knots) {
    glm::dvec3 lo = knots[0].place, hi = lo;
    for (const Knot& knot : knots) lo = glm::min(lo, knot.place), hi = glm::max(hi, knot.place);
    return std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
}

/// Cubic Bézier curves through the knots, each four places.
std::vector<std::array<glm::dvec3, 4>> smoothCurves(std::span<const Knot> knots, bool closed) {
    const std::size_t n = knots.size();
    const auto at = [&](std::ptrdiff_t i) {
        const auto count = std::ptrdiff_t(n);
        if (closed) return knots[std::size_t((i + count) % count)].place;
        if (i < 0) return 2.0 * knots[0].place - knots[1].place;
        if (i >= count) return 2.0 * knots[n - 1].place - knots[n - 2].place;
        return knots[std::size_t(i)].place;
    };
    std::vector<std::array<glm::dvec3, 4>> curves;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
        const auto k = std::ptrdiff_t(i);
        const glm::dvec3 p0 = at(k - 1), p1 = at(k), p2 = at(k + 1), p3 = at(k + 2);
        const double a = std::sqrt(glm::distance(p0, p1)), b = std::sqrt(glm::distance(p1, p2)),
                     c = std::sqrt(glm::distance(p2, p3));
        // The derivatives at the ends, of a parameter that goes from 0 to 1 (Yuksel et al. 2011, section 2).
        const glm::dvec3 m1 = (p2 - p1) + b * ((p1 - p0) / a - (p2 - p0) / (a + b)),
                         m2 = (p2 - p1) + b * ((p3 - p2) / c - (p3 - p1) / (b + c));
        curves.push_back({p1, p1 + m1 / 3.0, p2 - m2 / 3.0, p2});
    }
    return curves;
}

void follow(Drawing3d& drawing, const std::array<glm::dvec3, 4>& c) {
    drawing.follow(
        [c](double t) {
            const double u = 1 - t;
            return u * u * u * c[0] + 3 * u * u * t * c[1] + 3 * u * t * t * c[2] + t * t * t * c[3];
        },
        [c](double t) {
            const double u = 1 - t;
            return 3 * u * u * (c[1] - c[0]) + 6 * u * t * (c[2] - c[1]) + 3 * t * t * (c[3] - c[2]);
        },
        0, 1);
}

/// Lines whose corners are rounded off. Gets where along the arcs each knot is.
void drawLines(Drawing3d& drawing, std::span<const Knot> knots, bool closed, double bend,
               std::vector<std::size_t>& arcsBefore) {
    const std::size_t n = knots.size(), lines = closed ? n : n - 1;
    const auto place = [&](std::size_t i) { return knots[i % n].place; };
    // How much of the two lines at a corner its arc takes, and the tangent of a quarter of its turn.
    const auto cut = [&](std::size_t corner) {
        if (!closed && (corner == 0 || corner + 1 == n)) return 0.0;
        const glm::dvec3 before = place(corner + n - 1), own = place(corner), after = place(corner + 1);
        const double room = 0.5 * std::min(glm::distance(before, own), glm::distance(own, after));
        const double cosine =
            std::clamp(glm::dot(glm::normalize(own - before), glm::normalize(after - own)), -1.0, 1.0);
        if (cosine < -0.9999) return 0.0;  // back again
        return std::min(room, bend * std::tan(0.5 * std::acos(cosine)));
    };
    arcsBefore.push_back(0);
    for (std::size_t i = 0; i < lines; ++i) {
        const glm::dvec3 a = place(i), b = place(i + 1), leads = glm::normalize(b - a);
        const double from = cut(i % n), to = cut((i + 1) % n);
        const glm::dvec3 begin = a + from * leads, end = b - to * leads;
        if (glm::dot(end - begin, leads) > 0) drawing.line(begin, end);
        if (to > 0) {  // in two, or in four where it turns by more than half a turn's half
            const glm::dvec3 next = place(i + 2), after = b + to * glm::normalize(next - b),
                             chord = after - end, direction = glm::normalize(chord);
            const double half = std::acos(std::clamp(glm::dot(direction, leads), -1.0, 1.0)),
                         radius = 0.5 * glm::length(chord) / std::max(std::sin(half), 1e-12);
            const glm::dvec3 inwards = glm::normalize(chord - leads * glm::dot(chord, leads));
            const int parts = std::max(2, 2 * int(std::ceil(half / (0.45 * std::numbers::pi))));
            const auto on = [&](double angle) {
                return end + radius * (std::sin(angle) * leads + (1 - std::cos(angle)) * inwards);
            };
            for (int part = 0; part < parts; ++part) {
                if (part == parts / 2) arcsBefore.push_back(drawing.arcs.size());
                const double angle = 2 * half * part / parts;
                drawing.add(spaceArc(on(angle), std::cos(angle) * leads + std::sin(angle) * inwards,
                                     on(2 * half * (part + 1) / parts)));
            }
        } else {
            arcsBefore.push_back(drawing.arcs.size());
        }
    }
}

/// Of arcs whose balls are all alike; null if there are none.
Result<SplinePtr> evenSpline(std::vector<SpaceArc> arcs, bool closed) {
    if (arcs.size() > kMostSpaceArcs) return tooManyArcs();
    if (arcs.empty()) return SplinePtr();
    auto spline = std::make_shared<Spline>();
    spline->arcs = std::move(arcs);
    spline->closed = closed;
    for (SpaceArc& arc : spline->arcs) arc.radius = 1;
    finish(*spline);
    return SplinePtr(std::move(spline));
}

}  // namespace

std::vector<Knot> knotsFrom(std::span<const double> numbers) {
    std::vector<Knot> knots;
    for (std::size_t i = 0; i + 4 < numbers.size(); i += 5)
        knots.push_back({{numbers[i], numbers[i + 1], numbers[i + 2]},
                         std::max(numbers[i + 3], 0.0),
                         numbers[i + 4] * std::numbers::pi / 180});
    return knots;
}

SplineKind splineKindNamed(std::string_view word) {
    return word == "straight" ? SplineKind::straight
           : word == "bezier" ? SplineKind::bezier
                              : SplineKind::smooth;
}

Result<SplinePtr> splineThrough(std::span<const Knot> given, SplineKind kind, bool closed, double bend) {
    if (given.size() > kMostKnots)
        return Error{.message = "a spline of " + std::to_string(given.size()) + " points: at most " +
                                std::to_string(kMostKnots) + " are allowed"};
    const bool bezier = kind == SplineKind::bezier;
    if (bezier && given.size() >= 2 && given.size() % 3 != (closed ? 0 : 1))
        return Error{.message = "a Bézier spline of " + std::to_string(given.size()) +
                                (closed ? " points: a closed one takes a point and two handles by turns, "
                                          "three times as many as it has points"
                                        : " points: it takes a point, two handles, a point and so on, and "
                                          "ends with a point: 4, 7, 10 …")};
    std::vector<Knot> knots;  // those that it goes through
    std::vector<std::array<glm::dvec3, 4>> curves;
    if (given.size() < 2) return SplinePtr();
    const double size = sizeOf(given), shortest = kShortest * size;
    if (!(size > 0)) return SplinePtr();
    if (bezier) {
        for (std::size_t i = 0; i < given.size(); i += 3) {
            knots.push_back(given[i]);
            if (i + 3 < given.size() + (closed ? 1 : 0))
                curves.push_back({given[i].place, given[i + 1].place, given[i + 2].place,
                                  given[(i + 3) % given.size()].place});
        }
    } else {
        for (const Knot& knot : given)
            if (knots.empty() || glm::distance(knots.back().place, knot.place) > shortest)
                knots.push_back(knot);
        if (closed && glm::distance(knots.back().place, knots.front().place) <= shortest) knots.pop_back();
        closed = closed && knots.size() > 2;
        if (kind == SplineKind::smooth) curves = smoothCurves(knots, closed);
    }
    Drawing3d drawing(size);
    std::vector<std::size_t> arcsBefore;  // each knot
    if (kind == SplineKind::straight) {
        drawLines(drawing, knots, closed, bend, arcsBefore);
    } else {
        for (const auto& curve : curves) {
            arcsBefore.push_back(drawing.arcs.size());
            follow(drawing, curve);
        }
        arcsBefore.push_back(drawing.arcs.size());
    }
    if (drawing.tooMany()) return tooManyArcs();
    if (drawing.arcs.empty()) return SplinePtr();

    auto spline = std::make_shared<Spline>();
    spline->arcs = std::move(drawing.arcs);
    spline->closed = closed;
    std::vector<double> begins = {0}, at, radii, twists;
    for (const SpaceArc& arc : spline->arcs) begins.push_back(begins.back() + 2 * arc.half);
    for (std::size_t i = 0; i < arcsBefore.size(); ++i) {
        const Knot& knot = knots[i % knots.size()];
        const double s = begins[arcsBefore[i]];
        if (!at.empty() && !(s > at.back())) continue;
        at.push_back(s);
        radii.push_back(knot.radius);
        // A closed one's last twist is the first, as many whole turns away as is nearest.
        const bool again = closed && i == knots.size();
        const double turn = 2 * std::numbers::pi;
        twists.push_back(again ? knot.twist + turn * std::round((twists.back() - knot.twist) / turn)
                               : knot.twist);
    }
    if (at.size() > 1) {
        const Along radiusAt(at, radii, closed), twistAt(at, twists, closed);
        for (std::size_t i = 0; i < spline->arcs.size(); ++i) {
            SpaceArc& arc = spline->arcs[i];
            const double a = radiusAt(begins[i]), b = radiusAt(begins[i + 1]), c = twistAt(begins[i]),
                         d = twistAt(begins[i + 1]);
            arc.radius = 0.5 * (a + b), arc.radiusSlope = (b - a) / (2 * arc.half);
            arc.turn = 0.5 * (c + d), arc.turnSlope = (d - c) / (2 * arc.half);
        }
    } else {
        for (SpaceArc& arc : spline->arcs) arc.radius = knots[0].radius, arc.turn = knots[0].twist;
    }
    spline->knots = std::move(at);
    finish(*spline);
    return SplinePtr(std::move(spline));
}

Result<SplinePtr> splineOfHelix(const Helix& helix) {
    const double turn = 2 * std::numbers::pi, angle = turn * helix.turns, sign = helix.right ? -1 : 1,
                 size = std::max({2 * helix.radius, 2 * helix.topRadius, std::abs(helix.height)});
    if (!(size > 0) || !(helix.turns > 0)) return SplinePtr();
    if (helix.turns > kMostTurns) return Error{.message = "a helix of more than 200 turns: take fewer"};
    Drawing3d drawing(size);
    const double grows = helix.topRadius - helix.radius;
    const auto place = [&](double t) {
        const double r = helix.radius + grows * t, a = angle * t;
        return glm::dvec3(r * std::cos(a), helix.height * t, sign * r * std::sin(a));
    };
    const auto slope = [&](double t) {
        const double r = helix.radius + grows * t, a = angle * t;
        return glm::dvec3(grows * std::cos(a) - r * angle * std::sin(a), helix.height,
                          sign * (grows * std::sin(a) + r * angle * std::cos(a)));
    };
    const int parts = std::max(1, int(std::ceil(8 * helix.turns)));
    for (int i = 0; i < parts; ++i) drawing.follow(place, slope, double(i) / parts, double(i + 1) / parts);
    return evenSpline(std::move(drawing.arcs), false);
}

Result<SplinePtr> splineAlong(const Contour& contour) {
    std::vector<SpaceArc> arcs;
    for (const Arc& arc : contour.arcs) {
        const int parts = std::max(1, int(std::ceil(std::abs(turnOf(arc)) / (0.499 * std::numbers::pi))));
        for (int i = 0; i < parts; ++i) {
            const Arc part = partOf(arc, double(i) / parts, double(i + 1) / parts);
            if (!(lengthOf(part) > 0)) continue;
            const glm::dvec2 leads = tangentAtStart(part);
            const glm::dvec3 a(part.a, 0), b(part.b, 0);
            arcs.push_back(part.bend == 0 ? spaceLine(a, b) : spaceArc(a, glm::dvec3(leads, 0), b));
        }
    }
    return evenSpline(std::move(arcs), contour.closed);
}

}  // namespace fw
