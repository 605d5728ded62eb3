// The sides of a jump in an operation's result.
//
// Where floor, mod, atan2 or a choice jump within a box, their interval holds both sides and all between, and
// splitting the box never ends that: the jump stays in one of the halves. So a repeated solid would have no
// bounds, for between two copies its field might be anything. Here each side of a jump is a case of its own:
// a box is outside if it is in every case (TapeMachine::positiveInEachCase). That is the splitting of an
// interval analysis (Moore, "Interval Analysis", 1966), of values instead of the box.
#pragma once

#include <array>

#include "graph/ir/ops.h"

namespace fw {

struct JumpCases {
    std::array<Interval, 3> ranges;
    int count = 0;
    void add(Interval range) { ranges[std::size_t(count++)] = range; }
};

/// Whether the operation jumps between values that jumpCases() may tell.
constexpr bool mayJump(Op op) {
    switch (op) {
        case Op::floor:
        case Op::ceil:
        case Op::round:
        case Op::truncate:
        case Op::modulo:
        case Op::arcTangent2:
        case Op::select: return true;
        default: return false;
    }
}

/// What the operation's result may be over these operands, side by side; none if it does not jump there, or
/// too often. `whole` is its interval.
JumpCases jumpCases(Op op, const Interval* operands, Interval whole);

}  // namespace fw
