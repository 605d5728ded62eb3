// Bounds of the derivatives of a value along x, y and z, and arithmetic on them.
//
// Bounded slopes take plain loops over the lanes, which the compiler turns into vectors; others take the
// operators of interval.h, which know what an unbounded end means. All results are rounded outwards.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "graph/base/interval.h"

namespace fw {

/// Along x, y, z; the fourth lane is minus and plus the greatest length of the gradient.
struct Slopes {
    double lo[4], hi[4];
};

inline constexpr std::size_t kNorm = 3;
inline constexpr double kUlp = 4.5e-16;
inline constexpr Slopes kNoSlopes{};

inline bool isBounded(const Slopes& a) {
    double most = 0.0;
    for (std::size_t k = 0; k < 4; ++k) most = std::max(most, std::max(-a.lo[k], a.hi[k]));
    return most < kHuge;
}

inline Interval lane(const Slopes& a, std::size_t k) { return {a.lo[k], a.hi[k]}; }
inline void setLane(Slopes& a, std::size_t k, Interval to) { a.lo[k] = to.lo, a.hi[k] = to.hi; }

/// Rounds outwards and cuts to the finite range.
inline void roundOutwards(Slopes& a) {
    for (std::size_t k = 0; k < 4; ++k) {
        const double lo = a.lo[k] - std::abs(a.lo[k]) * kUlp, hi = a.hi[k] + std::abs(a.hi[k]) * kUlp;
        a.lo[k] = std::max(lo, -kHuge), a.hi[k] = std::min(hi, kHuge);
    }
}

inline void negated(const Slopes& a, Slopes& result) {
    for (std::size_t k = 0; k < 4; ++k) {
        const double lo = -a.hi[k];
        result.hi[k] = -a.lo[k], result.lo[k] = lo;
    }
}

inline void hullOf(const Slopes& a, const Slopes& b, Slopes& result) {
    for (std::size_t k = 0; k < 4; ++k) {
        result.lo[k] = std::min(a.lo[k], b.lo[k]);
        result.hi[k] = std::max(a.hi[k], b.hi[k]);
    }
}

inline void scaled(Interval factor, const Slopes& a, Slopes& result) {
    if (isBounded(factor) && isBounded(a)) {
        for (std::size_t k = 0; k < 4; ++k) {
            const double p = factor.lo * a.lo[k], q = factor.lo * a.hi[k], r = factor.hi * a.lo[k],
                         s = factor.hi * a.hi[k];
            result.lo[k] = std::min(std::min(p, q), std::min(r, s));
            result.hi[k] = std::max(std::max(p, q), std::max(r, s));
        }
        roundOutwards(result);
        return;
    }
    for (std::size_t k = 0; k < 4; ++k) setLane(result, k, factor * lane(a, k));
}

inline void added(const Slopes& a, const Slopes& b, Slopes& result) {
    if (isBounded(a) && isBounded(b)) {
        for (std::size_t k = 0; k < 4; ++k)
            result.lo[k] = a.lo[k] + b.lo[k], result.hi[k] = a.hi[k] + b.hi[k];
        roundOutwards(result);
        return;
    }
    for (std::size_t k = 0; k < 4; ++k) setLane(result, k, lane(a, k) + lane(b, k));
}

inline void subtracted(const Slopes& a, const Slopes& b, Slopes& result) {
    Slopes minus;
    negated(b, minus);
    added(a, minus, result);
}

inline void setNorm(Slopes& a, double norm) {
    norm = std::min(norm, kHuge);
    a.lo[kNorm] = -norm, a.hi[kNorm] = norm;
}

/// The norm is at most that of the components' bounds.
inline void tightenNorm(Slopes& a) {
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double most = std::max(-a.lo[k], a.hi[k]);
        squared += most * most;
    }
    const double norm = std::sqrt(squared) * (1.0 + 4.0 * kUlp);
    if (norm < a.hi[kNorm]) setNorm(a, norm);
}

/// No component exceeds the norm.
inline void cutToNorm(Slopes& a) {
    for (std::size_t k = 0; k < 3; ++k) {
        a.lo[k] = std::max(a.lo[k], a.lo[kNorm]);
        a.hi[k] = std::min(a.hi[k], a.hi[kNorm]);
    }
}

/// The slopes of an operation that may jump or be infinitely steep: unbounded along each axis that an operand
/// depends on.
inline void unbounded(std::span<const Slopes* const> operands, Slopes& result) {
    Slopes made = kNoSlopes;
    for (const Slopes* operand : operands)
        for (std::size_t k = 0; k < 4; ++k)
            if (operand->lo[k] != 0.0 || operand->hi[k] != 0.0) setLane(made, k, kEverything);
    result = made;
}

inline double dotBound(const Slopes& a, const Slopes& b) {
    double lo = 0.0, hi = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double p = a.lo[k] * b.lo[k], q = a.lo[k] * b.hi[k], r = a.hi[k] * b.lo[k],
                     s = a.hi[k] * b.hi[k];
        const double least = std::min(std::min(p, q), std::min(r, s)),
                     most = std::max(std::max(p, q), std::max(r, s));
        lo += least - std::abs(least) * kUlp, hi += most + std::abs(most) * kUlp;
    }
    return std::max(std::abs(lo), std::abs(hi)) * (1.0 + 4.0 * kUlp);
}

/// Bounds the spectral norm of the matrix with these rows: the root of the largest eigenvalue of its Gram
/// matrix, all of whose entries are replaced by bounds of their magnitudes.
inline double spectralNorm(std::span<const Slopes* const> rows) {
    constexpr std::size_t kMaxRows = 4;
    const std::size_t n = rows.size();
    double frobenius = 0.0;
    for (const Slopes* row : rows) {
        if (row->hi[kNorm] >= kHuge) return std::numeric_limits<double>::infinity();
        frobenius += row->hi[kNorm] * row->hi[kNorm];
    }
    frobenius = std::sqrt(frobenius) * (1.0 + 8.0 * kUlp);
    if (n > kMaxRows || n < 2) return frobenius;
    double gram[kMaxRows][kMaxRows], vector[kMaxRows];
    for (std::size_t i = 0; i < n; ++i) {
        gram[i][i] = rows[i]->hi[kNorm] * rows[i]->hi[kNorm] * (1.0 + kUlp);
        vector[i] = 1.0;
        for (std::size_t j = 0; j < i; ++j) gram[i][j] = gram[j][i] = dotBound(*rows[i], *rows[j]);
    }
    // For every positive vector the largest quotient (A v)_i / v_i is at least the largest eigenvalue of a
    // matrix A without negative entries.
    double least = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < 4; ++iteration) {
        double next[kMaxRows], quotient = 0.0, largest = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            next[i] = 0.0;
            for (std::size_t j = 0; j < n; ++j) next[i] += gram[i][j] * vector[j];
            quotient = std::max(quotient, next[i] / vector[i]);
            largest = std::max(largest, next[i]);
        }
        least = std::min(least, quotient);
        if (largest == 0.0) return 0.0;
        for (std::size_t i = 0; i < n; ++i) vector[i] = next[i] / largest + 1e-3;
    }
    return std::min(frobenius, std::sqrt(least) * (1.0 + 16.0 * kUlp));
}

/// 1/sqrt(a) of a positive interval.
inline Interval inverseRoot(Interval a) {
    return outward(1.0 / std::sqrt(above(a.hi)), 1.0 / std::sqrt(a.lo));
}

/// The range of a / sqrt(a² + rest), rest >= 0; of which the quotient grows with a.
inline Interval shareOfLength(Interval a, Interval rest) {
    const double least = std::max(rest.lo, 0.0), most = above(std::max(rest.hi, 0.0));
    const auto share = [](double x, double r) {
        if (x == 0.0) return 0.0;
        if (std::isinf(r)) return 0.0;
        if (!(std::abs(x) < 1e150)) return x < 0.0 ? -1.0 : 1.0;
        return x / std::sqrt(x * x + r);
    };
    // Where both are 0 the vector may have any direction.
    double lo = share(a.lo, a.lo < 0.0 ? least : most), hi = share(a.hi, a.hi > 0.0 ? least : most);
    if (least == 0.0 && a.lo <= 0.0 && a.hi >= 0.0) lo = a.lo < 0.0 ? -1.0 : 0.0, hi = a.hi > 0.0 ? 1.0 : 0.0;
    return {std::max(-1.0, lo - std::abs(lo) * 4.0 * kUlp), std::min(1.0, hi + std::abs(hi) * 4.0 * kUlp)};
}

}  // namespace fw
