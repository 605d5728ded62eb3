// Values and gradients of many fields at one point, in double: of all that a graph's nodes give, at once.
//
// Forwards through the operations in the order of their ids, each with the meanings of the op table's row, so
// the values are those of a tape (tape.h) bit for bit. A thousand nodes take some tenths of a millisecond.
// Who asks for one field at many points makes a tape of it.
#pragma once

#include <span>
#include <vector>

#include "graph/evaluate/evaluate.h"

namespace fw {

/// Of each of the roots, with `parameters` in their slots. Where a derivative is not known, as at an edge, it
/// is that of one side.
std::vector<ValueGradient> evaluateGradients(const Ir& ir, std::span<const IrId> roots,
                                             std::span<const double> parameters, const Point& point);

}  // namespace fw
