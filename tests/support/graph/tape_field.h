// Fields with their tapes, and random pairs of points in a box, for tests of bounds over boxes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "graph/evaluate/evaluate.h"
#include "tests/support/graph/code_field.h"

namespace fw::test {

inline double fraction(std::mt19937& random) { return double(random() >> 8) / double(1 << 24); }
inline double between(double lo, double hi, std::mt19937& random) {
    return std::lerp(lo, hi, fraction(random));
}

/// A field as operations and as their tape.
struct TapeField {
    Ir ir;
    IrId root = 0;
    Tape tape = {};
};

inline TapeField tapeField(Ir ir, IrId root, std::span<const double> parameters = {}) {
    TapeField field{std::move(ir), root};
    field.tape = makeTape(field.ir, root, parameters);
    return field;
}

inline TapeField tapeField(const std::string& code) {
    CodeField field = fieldOfCode(code, 0.25);
    return tapeField(std::move(field.ir), field.distance);
}

/// The value at a point, the largest magnitude of an intermediate value, and a bound of the rounding errors.
struct Evaluated {
    double value, largest, rounding;
};
inline Evaluated valueAt(const TapeField& field, std::span<const double> parameters, const Point& point) {
    std::vector<double> values(field.root + 1);
    Evaluated result{0.0, 1.0, 0.0};
    for (IrId id = 0; id <= field.root; ++id) {
        const IrNode& node = field.ir[id];
        double operands[kMaxArity] = {};
        for (int i = 0; i < opInfo(node.op).arity; ++i) operands[i] = values[node.operands[std::size_t(i)]];
        values[id] = id < 3                       ? point[id]
                     : node.op == Op::parameter   ? parameters[std::size_t(node.number)]
                     : opInfo(node.op).arity == 0 ? node.number
                                                  : opInfo(node.op).value(operands, field.ir.layer(node));
        result.largest = std::isfinite(values[id]) ? std::max(result.largest, std::abs(values[id]))
                                                   : std::numeric_limits<double>::infinity();
    }
    static TapeMachine<double> machine;
    const Interval around = machine.interval(field.tape, {point, point});
    result.value = values[field.root], result.rounding = above(around.hi) - below(around.lo);
    return result;
}

inline Point pointWithin(const Box& box, std::mt19937& random) {
    Point point;
    for (std::size_t axis = 0; axis < 3; ++axis)
        point[axis] = std::clamp(between(std::max(box.lo[axis], -1e8), std::min(box.hi[axis], 1e8), random),
                                 box.lo[axis], box.hi[axis]);
    return point;
}

/// A point near another, or anywhere.
inline Point secondPoint(const Point& first, const Box& box, std::mt19937& random) {
    Point point = pointWithin(box, random);
    const double share = std::pow(10.0, -5.0 * fraction(random));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (random() % 4 == 0) point[axis] = first[axis];
        point[axis] = std::clamp(std::lerp(first[axis], point[axis], share), box.lo[axis], box.hi[axis]);
    }
    return point;
}

}  // namespace fw::test
