// Inverse interval operations: which operands can give a result.
//
// A contractor narrows a box to the points that can satisfy a constraint such as f(p) <= 0. It evaluates an
// expression forwards on intervals, intersects the root with the constraint, and then goes backwards: each
// operation narrows its operands to the values for which its result can still be reached. This file holds the
// backward step of each operation; box_contractor.h has the rest.
//
// Theory: Benhamou, Goualard, Granvilliers and Puget, "Revising Hull and Box Consistency" (ICLP 1999), the
// HC4-revise algorithm.
#pragma once

#include "graph/base/interval.h"
#include "graph/ir/ops.h"

namespace fw {

/// Narrows `a` to its common part with `b`. False if they have none.
inline bool intersect(Interval& a, Interval b) {
    a = {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
    return a.lo <= a.hi;
}

/// Narrows `operands` (as many as the operation has) to a superset of the values for which the operation's
/// result is in `result`. False if no operands give such a result. Operands and result are numbers: NaN is
/// not covered.
bool projectOperands(Op op, Interval result, Interval* operands, const SampledLayer& layer);

}  // namespace fw
