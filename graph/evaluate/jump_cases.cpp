#include "graph/evaluate/jump_cases.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw {

namespace {

JumpCases remainders(Interval a, Interval b) {
    JumpCases cases;
    if (!b.isPoint() || !(b.lo > 0.0) || !isBounded(a) || !isBounded(b)) return cases;
    const double first = std::floor(a.lo / b.lo), last = std::floor(a.hi / b.lo);
    if (last - first != 1.0) return cases;
    const double slack = 9e-16 * (absolute(a).hi + b.lo);
    cases.add(outward(a.lo - first * b.lo - slack, b.lo + slack));
    cases.add(outward(-slack, a.hi - last * b.lo + slack));
    return cases;
}

/// The sides of the cut along negative x.
JumpCases angles(Interval y, Interval x) {
    JumpCases cases;
    if (!(x.hi < 0.0) || y.lo > 0.0 || y.hi < 0.0) return cases;
    constexpr double least = std::numeric_limits<double>::min();
    cases.add(arcTangent2({least, std::max(y.hi, least)}, x));
    cases.add(arcTangent2({std::min(y.lo, -least), -least}, x));
    return cases;
}

/// What is chosen from, if the choice is open and nothing joins the two: else it is no jump.
JumpCases choices(Interval condition, Interval a, Interval b) {
    JumpCases cases;
    if (condition.isPoint() || (a.lo <= b.hi && b.lo <= a.hi)) return cases;
    cases.add(a), cases.add(b);
    return cases;
}

/// The few whole numbers that the result may be.
JumpCases wholeNumbers(Interval whole) {
    JumpCases cases;
    const double steps = whole.hi - whole.lo;
    if (steps != 1.0 && steps != 2.0) return cases;
    for (double value = whole.lo; value <= whole.hi; ++value) cases.add({value, value});
    return cases;
}

}  // namespace

JumpCases jumpCases(Op op, const Interval* operands, Interval whole) {
    if (!mayJump(op)) return {};
    if (op == Op::modulo) return remainders(operands[0], operands[1]);
    if (op == Op::arcTangent2) return angles(operands[0], operands[1]);
    if (op == Op::select) return choices(operands[0], operands[1], operands[2]);
    return wholeNumbers(whole);
}

}  // namespace fw
