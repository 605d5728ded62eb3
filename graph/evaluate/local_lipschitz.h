// Proven Lipschitz constants of a field over a box, by interval differentiation and subdivision.
//
// The constant of a box is the largest over its parts: a segment between two points of the box is cut by the
// parts, the field is continuous along it, and so the differences add up. The part with the largest constant
// is split first, and each half has a simplified tape. A part whose constant is unbounded is split depth
// first, and where it stays unbounded down to kSmallestPart of the box there is no constant.
#pragma once

#include "graph/base/box.h"
#include "graph/evaluate/tape.h"

namespace fw {

/// Longest side of the smallest part that is split, relative to the box's.
inline constexpr double kSmallestPart = 1e-5;

/// A number k with |f(p) - f(q)| <= k |p - q| for all p and q in the box, f being the tape's first root;
/// infinity where none is proven. At most `maxBoxes` parts are looked at, at least one.
double lipschitzOver(const Tape& tape, const Box& box, int maxBoxes);

}  // namespace fw
