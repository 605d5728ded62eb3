// Where a solid lies: a box around f < 0, found by interval analysis.
//
// First each of the six directions is searched for the nearest half-space that is provably empty; this is
// tight for shapes along the axes. Then an octree drops every cell that is provably outside, which tightens
// the box around rotated and blended shapes, and finds one where half-spaces prove nothing (a twist mixes
// coordinates, so over an endless box its interval is everything). Of its cells only those are looked at that
// the box hangs on, each with a tape of its own (tape.h). Cells that a jump runs through, as those between
// the copies of a repetition, are looked at side by side (jump_cases.h).
#pragma once

#include <limits>
#include <span>

#include "graph/base/result.h"
#include "graph/evaluate/evaluate.h"

namespace fw {

enum class Extent : unsigned char { bounded, empty, unbounded };

struct Region {
    Extent extent = Extent::bounded;
    Box box;  ///< contains the solid, if bounded; not padded
};

/// Searches within ±kFarthest metres of the origin. A solid that reaches farther, or repeats without end, is
/// unbounded. What lies beyond an octree's start is known by samples, all else is proven; so `empty` is a
/// proof within kFarthest, or within 512 metres where half-spaces prove nothing.
/// `lipschitz`: of the distance, infinite where it is not known. Intervals of turned shapes are loose; where
/// they prove nothing soon, so does it, from the values in the middle of cells.
Region findRegion(const Ir& ir, IrId distance, std::span<const double> parameters,
                  double lipschitz = std::numeric_limits<double>::infinity());

inline constexpr double kFarthest = 16384.0;

/// The least box that has both.
Box joined(const Box& a, const Box& b);

/// The box's longest side; 0 if none has a length.
double longestSide(const Box& box);

/// `box` grown on every side by `cells` cells of the grid that has `resolution` cells along the longest side
/// of the result.
Box padded(const Box& box, int resolution, double cells);

}  // namespace fw
