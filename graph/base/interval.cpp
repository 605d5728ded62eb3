#include "graph/base/interval.h"

#include <numbers>

namespace fw {

namespace {

/// Remainder when the quotient keeps one integer value `k` over the whole of `a`.
Interval shifted(Interval a, double k, double period) {
    const double slack = 4.5e-16 * (std::abs(k * period) + absolute(a).hi) + 1e-300;
    return outward(below(a.lo) - k * period - slack, above(a.hi) - k * period + slack);
}

/// The quotient, or the divisor's multiple, may leave the range of doubles.
bool overflows(Interval a, Interval b) {
    return (b.lo <= 0.0 && b.hi >= 0.0) || !isBounded(a) || !(absolute(a).hi / absolute(b).lo < 1e300);
}

}  // namespace

Interval unboundedProduct(Interval a, Interval b) {
    const auto product = [](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : x * y; };
    const double p = product(below(a.lo), below(b.lo)), q = product(below(a.lo), above(b.hi)),
                 r = product(above(a.hi), below(b.lo)), s = product(above(a.hi), above(b.hi));
    return outward(std::min({p, q, r, s}), std::max({p, q, r, s}));
}

Interval operator/(Interval a, Interval b) {
    if (b.lo <= 0.0 && b.hi >= 0.0) return kEverything;
    // Of two unbounded ends the quotient may be anything between those of either with the other's bounded
    // end.
    const auto quotient = [](double x, double y) { return std::isinf(x) && std::isinf(y) ? 0.0 : x / y; };
    const double p = quotient(below(a.lo), below(b.lo)), q = quotient(below(a.lo), above(b.hi)),
                 r = quotient(above(a.hi), below(b.lo)), s = quotient(above(a.hi), above(b.hi));
    return outward(std::min({p, q, r, s}), std::max({p, q, r, s}));
}

Interval modulo(Interval a, Interval b) {
    if (overflows(a, b)) return kEverything;
    if (b.isPoint() && isBounded(b)) {
        const double first = std::floor(a.lo / b.lo);
        if (first == std::floor(a.hi / b.lo)) return shifted(a, first, b.lo);
    }
    const double slack = 4.5e-16 * absolute(a).hi + 1e-300;
    // Divided by what has no bound, a number may be too small for its sign to show, and is its own remainder.
    const Interval left = isBounded(b) ? Interval{0.0, 0.0} : a;
    return outward(std::min({0.0, b.lo, left.lo}) - slack, std::max({0.0, b.hi, left.hi}) + slack);
}

Interval truncatedModulo(Interval a, Interval b) {
    if (overflows(a, b)) return kEverything;
    const double most = absolute(b).hi;
    if (b.isPoint() && isBounded(b)) {
        const double first = std::trunc(a.lo / most);
        if (first == std::trunc(a.hi / most)) return shifted(a, first, most);
    }
    const double slack = 4.5e-16 * absolute(a).hi + 1e-300;
    return outward((a.lo < 0.0 ? std::max(-most, a.lo) : 0.0) - slack,
                   (a.hi > 0.0 ? std::min(most, a.hi) : 0.0) + slack);
}

Interval sine(Interval a) {
    constexpr double slack = 1e-12;
    if (!isBounded(a)) return kEverything;
    if (a.hi - a.lo >= 2 * std::numbers::pi || std::max(std::abs(a.lo), std::abs(a.hi)) > 1e9)
        return {-1.0, 1.0};
    const auto contains = [&](double phase) {  // an x = phase (mod 2π) lies in a
        const double turns = std::ceil((a.lo - phase) / (2 * std::numbers::pi) - 1e-12);
        return phase + turns * 2 * std::numbers::pi <= a.hi + 1e-9;
    };
    const double s = std::sin(a.lo), t = std::sin(a.hi);
    return {contains(-std::numbers::pi / 2) ? -1.0 : std::max(-1.0, std::min(s, t) - slack),
            contains(std::numbers::pi / 2) ? 1.0 : std::min(1.0, std::max(s, t) + slack)};
}

Interval power(Interval a, Interval b) {
    const double least = std::max(0.0, a.lo), most = above(std::max(0.0, a.hi));
    const double p = std::pow(least, below(b.lo)), q = std::pow(least, above(b.hi)),
                 r = std::pow(most, below(b.lo)), s = std::pow(most, above(b.hi));
    const double lo = std::min({kHuge, p, q, r, s}), hi = std::max({p, q, r, s});
    // The last denormal numbers are rounded as well as the library likes.
    return outward(std::max(0.0, lo - lo * 1e-13 - 1e-300), hi + hi * 1e-13 + 1e-300);
}

Interval arcTangent2(Interval y, Interval x) {
    constexpr double pi = std::numbers::pi, slack = 1e-12;
    y = {below(y.lo), above(y.hi)}, x = {below(x.lo), above(x.hi)};
    if (x.lo <= 0.0 && y.lo <= 0.0 && y.hi >= 0.0)
        return {-pi - slack, pi + slack};  // meets the cut or the origin
    const double a = std::atan2(y.lo, x.lo), b = std::atan2(y.lo, x.hi), c = std::atan2(y.hi, x.lo),
                 d = std::atan2(y.hi, x.hi);
    return {std::min({a, b, c, d}) - slack, std::max({a, b, c, d}) + slack};
}

Interval lipschitzRange(double centre, double slope, double radius, double least, double most) {
    return {std::clamp(centre - slope * radius, least, most),
            std::clamp(centre + slope * radius, least, most)};
}

}  // namespace fw
