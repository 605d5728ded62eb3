// Frame cuts: small vertex cuts between an expression and its variables.
//
// A field behind a twist, a bend or a turn reads the position only through three values, the coordinates that
// the operation makes of it. In the graph of operations they are a vertex cut: every path from the root to
// the position goes through one of them. Such a cut is found without knowing what made it, as a minimum
// vertex cut by augmenting paths (Menger 1927; Ford and Fulkerson 1956).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "graph/ir/ir.h"

namespace fw {

/// Selects one of several smallest cuts: that next to the variables, or that next to the root.
enum class CutSide : unsigned char { variables, root };

/// At most three values of the cone, without its last one, through which all paths from that one to the
/// `variables` go; as few as possible. Empty if no such cut exists. `cone`: ids, ascending, without
/// variables; `operandsOf`: the operands of a value that are in the cone, or variables; `mayCut`: whether a
/// value may belong to the cut.
std::vector<IrId> frameCut(std::span<const IrId> cone, std::span<const IrId> variables, CutSide side,
                           const std::function<std::vector<IrId>(IrId)>& operandsOf,
                           const std::function<bool(IrId)>& mayCut);

}  // namespace fw
