#include "graph/outlines/stroke.h"

#include <algorithm>
#include <cmath>

namespace fw {

namespace {

constexpr double kMostDashes = 50'000;  // of all contours: those for which none are left have none

/// Makes the pieces of one contour.
class Stroker {
  public:
    Stroker(const StrokeStyle& style_, std::vector<Contour>& to_)
        : style(style_), half(0.5 * style.width), to(to_) {}

    void run(const Contour& contour) {
        std::vector<Arc> arcs;
        for (const Arc& arc : contour.arcs)
            if (arc.a != arc.b) arcs.push_back(arc);
        if (arcs.empty()) {  // a dot
            cap(contour.arcs.front().a, {1, 0}), cap(contour.arcs.front().a, {-1, 0});
            return;
        }
        for (const Arc& arc : arcs) sweep(arc);
        for (std::size_t i = 1; i < arcs.size(); ++i) join(arcs[i - 1], arcs[i]);
        if (contour.closed) return join(arcs.back(), arcs.front());
        cap(arcs.back().b, tangentAtEnd(arcs.back()));
        cap(arcs.front().a, -tangentAtStart(arcs.front()));
    }

  private:
    void sweep(const Arc& arc) {
        const glm::dvec2 n = arc.normal, m = normalAtEnd(arc);
        // How far to the left: as far as the pen reaches, or to the centre.
        const double left = arc.bend * half >= 1 ? 1 / arc.bend : half,
                     right = arc.bend * half <= -1 ? -1 / arc.bend : half;
        const auto beside = [&](double by) {
            const double straightened = 1 - arc.bend * by;
            return arcBetween(arc.a + by * n, arc.b + by * m,
                              straightened > 1e-9 ? arc.bend / straightened : 0);
        };
        piece({beside(-right), arcBetween(arc.b - right * m, arc.b + left * m), reversed(beside(left)),
               arcBetween(arc.a + left * n, arc.a - right * n)});
        const double beyond = arc.bend == 0 ? 0 : half - 1 / std::abs(arc.bend);
        if (beyond <= 0) return;
        const glm::dvec2 centre = arc.a + n / arc.bend;
        const double side = arc.bend > 0 ? 1 : -1;  // beyond the centre the sector lies the other way
        const Arc rim = arcBetween(centre + side * beyond * n, centre + side * beyond * m, side / beyond);
        const Arc wound = side > 0 ? rim : reversed(rim);
        piece({arcBetween(centre, wound.a), wound, arcBetween(wound.b, centre)});
    }

    void join(const Arc& one, const Arc& next) {
        const glm::dvec2 p = one.b, from = tangentAtEnd(one), along = tangentAtStart(next);
        const double turn = cross(from, along), same = glm::dot(from, along);
        if (std::abs(turn) < 1e-6 && same > 0) return;
        // The corner lies on the side away from which the line turns.
        const double side = turn > 0 ? -half : half;
        const glm::dvec2 a = p + side * leftOf(from), b = p + side * leftOf(along);
        const bool forth = turn > 0;  // from the first normal to the second is to the left about p
        const auto wound = [&](std::vector<Arc> arcs) {
            if (!forth) reverse(arcs);
            piece(std::move(arcs));
        };
        if (style.join == StrokeStyle::Join::round)
            return wound({arcBetween(p, a), arcBetween(a, b, (forth ? 1 : -1) / half), arcBetween(b, p)});
        // A miter is as long as 1 / sin of half the angle between the arms, which is 1 / cos of half the
        // turn.
        const double cosine = std::sqrt(std::max(0.0, 0.5 * (1 + same)));
        if (style.join == StrokeStyle::Join::miter && cosine * style.miterLimit >= 1) {
            const glm::dvec2 outward = leftOf(from) + leftOf(along);
            const glm::dvec2 tip = p + side / (cosine * glm::length(outward)) * outward;
            return wound({arcBetween(p, a), arcBetween(a, tip), arcBetween(tip, b), arcBetween(b, p)});
        }
        wound({arcBetween(p, a), arcBetween(a, b), arcBetween(b, p)});
    }

    void cap(glm::dvec2 p, glm::dvec2 out) {
        const glm::dvec2 a = p + half * rightOf(out), b = p + half * leftOf(out), far = half * out;
        if (style.cap == StrokeStyle::Cap::round) {
            const glm::dvec2 tip = p + far;  // in quarters, whose sides are certain
            piece({arcBetween(a, tip, 1 / half), arcBetween(tip, b, 1 / half), arcBetween(b, a)});
        }
        if (style.cap == StrokeStyle::Cap::square)
            piece({arcBetween(a, a + far), arcBetween(a + far, b + far), arcBetween(b + far, b),
                   arcBetween(b, a)});
    }

    void piece(std::vector<Arc> arcs) {
        std::erase_if(arcs, [](const Arc& arc) { return arc.a == arc.b; });
        to.push_back({std::move(arcs), true});
    }

    const StrokeStyle& style;
    double half;
    std::vector<Contour>& to;
};

/// The dashes of a contour, fewer than `most`, which becomes so many less: open ones, of which the last goes
/// on into the first where a closed one begins within a dash.
std::vector<Contour> dashed(const Contour& contour, const StrokeStyle& style, double& most) {
    std::vector<double> pattern = style.dashes;
    if (pattern.size() % 2 != 0) pattern.insert(pattern.end(), style.dashes.begin(), style.dashes.end());
    double period = 0, length = 0;
    for (const double dash : pattern) period += dash;
    for (const Arc& arc : contour.arcs) length += lengthOf(arc);
    const double count = length / period * double(pattern.size());
    if (!(period > 0) || !(count < most)) return {contour};
    most -= count;
    std::size_t at = 0;
    double rest = std::fmod(style.dashOffset, period);
    if (rest < 0) rest += period;
    while (rest >= pattern[at]) rest -= pattern[at], at = (at + 1) % pattern.size();
    double left = pattern[at] - rest;  // of this dash or gap
    std::vector<Contour> dashes;
    const bool beginsOn = at % 2 == 0;
    if (beginsOn) dashes.emplace_back();
    for (const Arc& arc : contour.arcs) {
        const double whole = lengthOf(arc);
        double done = 0;
        while (whole - done > left) {
            if (at % 2 == 0) dashes.back().arcs.push_back(partOf(arc, done / whole, (done + left) / whole));
            done += left;
            at = (at + 1) % pattern.size();
            left = pattern[at];
            if (at % 2 == 0) dashes.emplace_back();
        }
        if (at % 2 == 0) dashes.back().arcs.push_back(partOf(arc, done / whole, 1));
        left -= whole - done;
    }
    if (contour.closed && beginsOn && at % 2 == 0 && dashes.size() > 1) {
        Contour& last = dashes.back();
        last.arcs.insert(last.arcs.end(), dashes.front().arcs.begin(), dashes.front().arcs.end());
        dashes.erase(dashes.begin());
    } else if (contour.closed && dashes.size() == 1 && beginsOn && at % 2 == 0) {
        dashes.front().closed = true;
    }
    return dashes;
}

}  // namespace

std::vector<Contour> strokeOf(const std::vector<Contour>& contours, const StrokeStyle& style) {
    std::vector<Contour> pieces;
    Stroker stroker(style, pieces);
    double mostDashes = kMostDashes;
    for (const Contour& contour : contours) {
        if (contour.arcs.empty()) continue;
        if (style.dashes.empty())
            stroker.run(contour);
        else
            for (const Contour& dash : dashed(contour, style, mostDashes))
                if (!dash.arcs.empty()) stroker.run(dash);
    }
    return pieces;
}

}  // namespace fw
