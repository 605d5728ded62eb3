// Sines and cosines that a compiler makes loops over lanes of: a call of the C library is one lane at a time.
//
// In single precision the argument is reduced to within an eighth of a turn in double precision, which is
// exact enough for any |x| up to 1e7, and the polynomials of Cephes' sinf and cosf follow; errors stay below
// 1e-7 and 1.6 units in the last place. Beyond, where neighbouring floats lie further apart than a turn, the
// result is merely some number in [-1, 1]. In double precision they are the C library's.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace fw {

/// The sine of x and so many quarter turns, x in radians.
[[gnu::always_inline]] inline float sineOfTurned(float x, uint32_t quarterTurns) {
    constexpr double kWhole = 6755399441055744.0;  // 1.5 * 2^52: in a sum with it stand only whole numbers
    constexpr double kQuarterHigh = 1.57079632673412561417, kQuarterLow = 6.07710050650619224932e-11;
    constexpr float kMost = 0.7854f;
    const double shifted = double(x) * 0.63661977236758134308 + kWhole;
    const double quarters = shifted - kWhole;
    const double rest = (double(x) - quarters * kQuarterHigh) - quarters * kQuarterLow;
    const float a = std::max(std::min(float(rest), kMost), -kMost), a2 = a * a;
    const float sine = a + a * a2 * (-1.6666654611e-1f + a2 * (8.3321608736e-3f - a2 * 1.9515295891e-4f));
    const float cosine =
        1 - 0.5f * a2 +
        a2 * a2 * (4.166664568298827e-2f + a2 * (-1.388731625493765e-3f + a2 * 2.443315711809948e-5f));
    const uint32_t quadrant = uint32_t(std::bit_cast<uint64_t>(shifted)) + quarterTurns;
    const float value = quadrant & 1 ? cosine : sine;
    return std::bit_cast<float>(std::bit_cast<uint32_t>(value) ^ (quadrant & 2) << 30);
}

inline float sineOf(float x) { return sineOfTurned(x, 0); }
inline float cosineOf(float x) { return sineOfTurned(x, 1); }
inline double sineOf(double x) { return std::sin(x); }
inline double cosineOf(double x) { return std::cos(x); }

}  // namespace fw
