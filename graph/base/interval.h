// Closed intervals of doubles, rounded outwards, and the elementary functions on them.
//
// Theory: Moore, "Interval Analysis" (1966). [f](X) contains every f(x), x in X; so a box on which the
// interval of a field excludes zero holds no surface. Deviations from a textbook: results are widened by a
// few units in the last place instead of switching the rounding mode, and an unbounded or undefined result is
// the finite interval [-kHuge, kHuge], so that no NaN can appear and wrongly empty a later minimum. An end at
// -kHuge (below) or kHuge (above) says that values go on without a bound. What is no number at all stays
// unknown to functions whose range is limited, as a sine.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw {

/// Magnitude that stands for "unbounded". The intervals of shaders, in float, have 1e30.
inline constexpr double kHuge = 1e100;

struct Interval {
    double lo = 0.0, hi = 0.0;

    bool contains(double value) const { return lo <= value && value <= hi; }
    bool isPoint() const { return lo == hi; }
};

inline constexpr Interval kEverything{-kHuge, kHuge};

/// The interval grown by the rounding error of one operation and cut to the finite range; NaN becomes
/// everything.
inline Interval outward(double lo, double hi) {
    constexpr double ulp = 4.5e-16;
    lo -= std::abs(lo) * ulp, hi += std::abs(hi) * ulp;
    if (!(lo <= hi)) return kEverything;
    return {std::clamp(lo, -kHuge, kHuge), std::clamp(hi, -kHuge, kHuge)};
}

inline Interval hull(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
inline Interval operator-(Interval a) { return {-a.hi, -a.lo}; }

/// Ends as they are meant: infinite where they stand for no bound.
inline double below(double lo) { return lo <= -kHuge ? -std::numeric_limits<double>::infinity() : lo; }
inline double above(double hi) { return hi >= kHuge ? std::numeric_limits<double>::infinity() : hi; }
inline bool isBounded(Interval a) { return a.lo > -kHuge && a.hi < kHuge; }

inline Interval operator+(Interval a, Interval b) {
    return outward(below(a.lo) + below(b.lo), above(a.hi) + above(b.hi));
}
inline Interval operator-(Interval a, Interval b) {
    return outward(below(a.lo) - above(b.hi), above(a.hi) - below(b.lo));
}
Interval unboundedProduct(Interval a, Interval b);
inline Interval operator*(Interval a, Interval b) {
    if (!isBounded(a) || !isBounded(b)) return unboundedProduct(a, b);
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    return outward(std::min({p, q, r, s}), std::max({p, q, r, s}));
}
/// Everything if b may be 0.
Interval operator/(Interval a, Interval b);
inline Interval minimum(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)}; }
inline Interval maximum(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)}; }
inline Interval absolute(Interval a) { return {std::max({0.0, a.lo, -a.hi}), std::max(-a.lo, a.hi)}; }
inline Interval square(Interval a) {
    const Interval m = absolute(a);
    return outward(m.lo * m.lo, m.hi * m.hi);
}

/// a - b floor(a / b), everything if b may be 0. Quotients are rounded: what is left of an exact multiple may
/// be a little below 0, or above b.
Interval modulo(Interval a, Interval b);
/// a - b trunc(a / b).
Interval truncatedModulo(Interval a, Interval b);
Interval sine(Interval a);
/// max(a, 0)^b.
Interval power(Interval a, Interval b);
Interval arcTangent2(Interval y, Interval x);
/// The range centre ± slope·radius, cut to [least, most]: for functions known by their Lipschitz constant
/// `slope` over the box of half diagonal `radius`.
Interval lipschitzRange(double centre, double slope, double radius, double least, double most);

}  // namespace fw
