// Bounds of a field over a box that a jump runs through.
//
// Where floor, mod, atan2 or a choice jump within a box, their interval holds both sides and all between, and
// splitting the box never ends that: the jump stays in one of the halves. So a repeated solid would have no
// bounds, for between two copies its field might be anything. Here each side of a jump is a case of its own:
// a box is outside if it is in every case. That is the splitting of an interval analysis (Moore, "Interval
// Analysis", 1966), of values instead of the box.
//
// Lifetime: must not outlive the Ir and the parameters.
#pragma once

#include <span>
#include <vector>

#include "graph/base/box.h"
#include "graph/ir/ir.h"

namespace fw {

class JumpCases {
  public:
    JumpCases(const Ir& ir, IrId root, std::span<const double> parameters);

    /// The field is at least 0 everywhere in the box, also where it jumps there: proven, or false.
    bool outsideInEachCase(const Box& box);

  private:
    bool atLeastZero(std::size_t first, int splits);

    const Ir& ir;
    IrId root;
    std::vector<IrId> steps;  // the operations that the root needs
    std::vector<Interval> ranges;
};

}  // namespace fw
