// A colour or a number as a function of a number, through stops or points: what color_ramp() and curve() are
// made of.
//
// Between two stops stands a piece, cut off at its ends, so that its range over an interval is that of what
// it gives there; which piece holds is a balanced tree of choices, which intervals and boxes decide early.
// Two stops in one place are a jump. A smooth curve is a monotone cubic: Fritsch and Carlson, "Monotone
// Piecewise Cubic Interpolation" (1980), with slopes from three points each, kept within the square of their
// region; so it never leaves the range of two neighbours.
//
// The numbers of the stops may be live. What they are is checked where they are given; here once more, as
// code can hand on a list from elsewhere.
#pragma once

#include <span>

#include "graph/language/value.h"

namespace fw::language {

/// The nodes' arguments in their order; what is left out is as the table of nodes has it, and so are the
/// choices. Errors without a place.
Result<Value> colorRamp(Lowering& state, std::span<const Value> arguments);
Result<Value> curveThrough(Lowering& state, std::span<const Value> arguments);

}  // namespace fw::language
