// Families: members of a large minimum or maximum, sharp or smooth, that are the same operations on different
// numbers.
//
// A union of a thousand boxes lowers to a thousand copies of one expression. Compiled as such, every sample
// pays for all of them, and a device that runs the branches it does not take (LLVM's vectors) cannot leave
// any out. As a family they are one loop over a table of their numbers, and a list for each part of space
// tells which rows can matter there: a sample then pays for its neighbourhood. Members are left out as in
// Duff's "Interval Arithmetic and Recursive Subdivision for Implicit Functions" (SIGGRAPH 1992): of a
// minimum, one whose least value over a box exceeds the greatest value that the minimum can have there.
//
// What is alike is found in the IR, not in the graph, so it does not matter by which nodes the members were
// made. A chain or tree of minima is one group, whatever its order. Members that are alike have a common form
// (common_form.h), new operations of the Ir that only the loop has. What is the same in every member (a
// position that all are turned by), and the few values among which they choose (the two cells about a
// position), is computed once, ahead of the loop. Numbers that agree in all members fold into the code.
//
// Smooth minima are taken one after the other, and a different order is a different surface: of those a run
// of members that follow one another in a chain is a family. Over a box a member can be left out if the chain
// up to it is further below than the width of the blend, and all before it if it is that far below them; both
// change no bit.
//
// Lifetime: plain values that refer to an Ir by ids.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "graph/ir/ir.h"

namespace fw {

inline constexpr uint32_t kTexel = 4;  ///< numbers that a device loads at once

struct Family {
    std::vector<IrId> steps;   ///< what stands for every member, in order; no other value needs them
    std::vector<IrId> inputs;  ///< what the steps use beside each other: values outside the family
    IrId value = 0;            ///< of a member
    IrId blend = 0;            ///< of a chain, the width of a member's smooth minimum
    uint32_t firstColumn = 0;  ///< that number the columns' leaves (Op::column) count from
    uint32_t members = 0, width = 0;
    std::vector<float>
        table;  ///< `members` rows of `width` numbers, a multiple of kTexel; what is too much is 0
};

/// A minimum or maximum of several operands, some of which are members of families; or a chain of smooth
/// minima with the members of one family, in order.
struct FamilyGroup {
    Op op;
    std::vector<uint32_t> families;  ///< places in Families::all
    std::vector<IrId> others;        ///< operands of no family; of a chain what it begins with

    bool chain() const { return op == Op::smoothMinimum; }
};

struct Families {
    std::vector<Family> all;  ///< those first whose members can be left out by lists
    uint32_t listed = 0;      ///< how many these are
    std::map<IrId, FamilyGroup>
        groups;  ///< by the id of the minimum or maximum as a whole, or a chain's last

    bool empty() const { return all.empty(); }
};

/// The families in what `root` needs; their steps join the Ir. Those too small for a loop to pay are left as
/// they are.
Families findFamilies(Ir& ir, IrId root);

}  // namespace fw
