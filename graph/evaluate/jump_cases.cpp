#include "graph/evaluate/jump_cases.h"

#include <array>
#include <cmath>
#include <limits>

namespace fw {

namespace {

/// So many jumps are split in one box; more meet only where it is large.
constexpr int kMostSplits = 6;

struct Cases {
    std::array<Interval, 3> ranges;
    int count = 0;
    void add(Interval range) { ranges[std::size_t(count++)] = range; }
};

bool jumpsAnywhere(Op op) {
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

Cases remainders(Interval a, Interval b) {
    Cases cases;
    if (!b.isPoint() || !(b.lo > 0.0) || !isBounded(a) || !isBounded(b)) return cases;
    const double first = std::floor(a.lo / b.lo), last = std::floor(a.hi / b.lo);
    if (last - first != 1.0) return cases;
    const double slack = 9e-16 * (absolute(a).hi + b.lo);
    cases.add(outward(a.lo - first * b.lo - slack, b.lo + slack));
    cases.add(outward(-slack, a.hi - last * b.lo + slack));
    return cases;
}

/// The sides of the cut along negative x.
Cases angles(Interval y, Interval x) {
    Cases cases;
    if (!(x.hi < 0.0) || y.lo > 0.0 || y.hi < 0.0) return cases;
    constexpr double least = std::numeric_limits<double>::min();
    cases.add(arcTangent2({least, std::max(y.hi, least)}, x));
    cases.add(arcTangent2({std::min(y.lo, -least), -least}, x));
    return cases;
}

/// What is chosen from, if the choice is open and nothing joins the two: else it is no jump.
Cases choices(Interval condition, Interval a, Interval b) {
    Cases cases;
    if (condition.isPoint() || (a.lo <= b.hi && b.lo <= a.hi)) return cases;
    cases.add(a), cases.add(b);
    return cases;
}

/// What the operation's result may be, side by side; none if it does not jump there, or too often. `whole` is
/// its interval.
Cases casesOf(Op op, const Interval* operands, Interval whole) {
    if (op == Op::modulo) return remainders(operands[0], operands[1]);
    if (op == Op::arcTangent2) return angles(operands[0], operands[1]);
    if (op == Op::select) return choices(operands[0], operands[1], operands[2]);
    Cases cases;
    const double steps = whole.hi - whole.lo;
    if (steps != 1.0 && steps != 2.0) return cases;
    for (double value = whole.lo; value <= whole.hi; ++value) cases.add({value, value});
    return cases;
}

}  // namespace

JumpCases::JumpCases(const Ir& ir_, IrId root_, std::span<const double> parameters)
    : ir(ir_), root(root_), ranges(root_ + 1) {
    std::vector<bool> needed(root + 1);
    needed[root] = true;
    for (IrId id = root + 1; id-- > 0;)
        for (int i = 0; needed[id] && i < opInfo(ir[id].op).arity; ++i) needed[ir[id].operands[i]] = true;
    for (IrId id = 0; id <= root; ++id) {
        if (!needed[id]) continue;
        if (opInfo(ir[id].op).arity > 0) {
            steps.push_back(id);
        } else if (id >= 3) {
            const double value =
                ir[id].op == Op::parameter ? parameters[std::size_t(ir[id].number)] : ir[id].number;
            ranges[id] = {value, value};
        }
    }
}

bool JumpCases::outsideInEachCase(const Box& box) {
    for (IrId axis = 0; axis < 3 && axis <= root; ++axis) ranges[axis] = {box.lo[axis], box.hi[axis]};
    return atLeastZero(0, kMostSplits);
}

bool JumpCases::atLeastZero(std::size_t first, int splits) {
    for (std::size_t i = first; i < steps.size(); ++i) {
        const IrNode& node = ir[steps[i]];
        const OpInfo& info = opInfo(node.op);
        Interval operands[kMaxArity];
        for (int k = 0; k < info.arity; ++k) operands[k] = ranges[node.operands[k]];
        Interval& range = ranges[steps[i]];
        range = info.interval(operands, ir.layer(node));
        if (splits == 0 || !jumpsAnywhere(node.op) || node.positions == 0) continue;
        const Cases cases = casesOf(node.op, operands, range);
        if (cases.count == 0) continue;
        for (int c = 0; c < cases.count; ++c) {
            range = cases.ranges[std::size_t(c)];
            if (!atLeastZero(i + 1, splits - 1)) return false;
        }
        return true;
    }
    return ranges[root].lo >= 0.0;
}

}  // namespace fw
