// Values, gradients and intervals of a field at given places, in double: the reference that the GPU is tested
// against.
//
// Each call makes a tape (tape.h) of what the root needs and runs it. Who asks again and again makes the tape
// once, and a TapeMachine for it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "graph/base/box.h"
#include "graph/evaluate/tape.h"
#include "graph/ir/ir.h"

namespace fw {

/// Value and gradient at a point.
struct ValueGradient {
    double value;
    Point gradient;
};

/// Values of `root` at each of `points`, with `parameters` in their slots. `values` has one entry a point.
void evaluate(const Ir& ir, IrId root, std::span<const double> parameters, std::span<const Point> points,
              std::span<double> values);
double evaluate(const Ir& ir, IrId root, std::span<const double> parameters, const Point& point);
/// The values of each of the roots at one point.
std::vector<double> evaluate(const Ir& ir, std::span<const IrId> roots, std::span<const double> parameters,
                             const Point& point);

/// Values and gradients, as above.
void evaluateGradient(const Ir& ir, IrId root, std::span<const double> parameters,
                      std::span<const Point> points, std::span<ValueGradient> results);
void evaluateGradient(TapeMachine<double>& machine, const Tape& tape, std::span<const Point> points,
                      std::span<ValueGradient> results);

/// An interval that contains every value of `root` over the box, edges included.
Interval evaluateInterval(const Ir& ir, IrId root, std::span<const double> parameters, const Box& box);

}  // namespace fw
