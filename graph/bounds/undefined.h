// Undefined values: operations of an Ir whose value may be NaN in some volume of space.
//
// Comparisons, minima and maxima ignore NaN, so intervals say nothing of fields that contain it. A NaN at
// single points or surfaces, as of 1 / x, is harmless: such a set holds no solid. In a volume NaN comes from
// * a quotient whose divisor is 0 in a volume, which only values that may be constant there are: roundings,
//   choices, values at a clamp, exponentials that underflow;
// * sums, products and quotients of infinite values, and sines, remainders and noise of these. A value is
//   infinite in a volume after such a quotient, or where it overflows.
#pragma once

#include <span>
#include <vector>

#include "graph/base/interval.h"
#include "graph/ir/ir.h"

namespace fw {

/// Overflows farther from the origin do not count.
inline constexpr double kOverflowDistance = 1e6;

/// Whether each operation may be NaN in some volume. `everywhere`: intervals of the operations over all of
/// space; `nearby`: over the cube of half size kOverflowDistance around the origin.
std::vector<bool> findUndefined(const Ir& ir, std::span<const Interval> everywhere,
                                std::span<const Interval> nearby);

}  // namespace fw
