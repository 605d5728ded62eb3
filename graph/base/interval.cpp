#include "graph/base/interval.h"

#include <numbers>

namespace fw {

namespace {

/// Remainder when the quotient keeps one integer value `k` over the whole of `a`.
Interval shifted(Interval a, double k, double period) {
    const double slack = 4.5e-16 * (std::abs(k * period) + std::max(std::abs(a.lo), std::abs(a.hi)));
    return {a.lo - k * period - slack, a.hi - k * period + slack};
}

}  // namespace

Interval modulo(Interval a, Interval b) {
    if (b.isPoint() && b.lo > 0.0) {
        const double first = std::floor(a.lo / b.lo);
        if (first == std::floor(a.hi / b.lo)) return shifted(a, first, b.lo);
    }
    return outward(std::min(0.0, b.lo), std::max(0.0, b.hi));
}

Interval truncatedModulo(Interval a, Interval b) {
    const double most = std::max(std::abs(b.lo), std::abs(b.hi));
    if (b.isPoint() && b.lo != 0.0) {
        const double first = std::trunc(a.lo / most);
        if (first == std::trunc(a.hi / most)) return shifted(a, first, most);
    }
    return outward(a.lo < 0.0 ? std::max(-most, a.lo) : 0.0, a.hi > 0.0 ? std::min(most, a.hi) : 0.0);
}

Interval sine(Interval a) {
    constexpr double slack = 1e-12;
    if (a.hi - a.lo >= 2 * std::numbers::pi || std::max(std::abs(a.lo), std::abs(a.hi)) > 1e9)
        return {-1.0, 1.0};
    const auto contains = [&](double phase) {  // an x = phase (mod 2π) lies in a
        const double turns = std::ceil((a.lo - phase) / (2 * std::numbers::pi) - 1e-12);
        return phase + turns * 2 * std::numbers::pi <= a.hi + 1e-9;
    };
    const double s = std::sin(a.lo), t = std::sin(a.hi);
    return {contains(-std::numbers::pi / 2) ? -1.0 : std::min(s, t) - slack,
            contains(std::numbers::pi / 2) ? 1.0 : std::max(s, t) + slack};
}

Interval power(Interval a, Interval b) {
    a = {std::max(a.lo, 0.0), std::max(a.hi, 0.0)};
    const double p = std::pow(a.lo, b.lo), q = std::pow(a.lo, b.hi), r = std::pow(a.hi, b.lo),
                 s = std::pow(a.hi, b.hi);
    const Interval range = outward(std::min({p, q, r, s}), std::max({p, q, r, s}));
    return {range.lo - std::abs(range.lo) * 1e-13, range.hi + std::abs(range.hi) * 1e-13};
}

Interval arcTangent2(Interval y, Interval x) {
    constexpr double pi = std::numbers::pi, slack = 1e-12;
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
