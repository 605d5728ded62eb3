// The CPU evaluators, in double: value, interval, and value with gradient (forward mode), all driven by the
// op table. They are the reference the GPU is tested against, find the region of a solid, and serve
// `fieldwright eval`.
//
// Points are evaluated in batches of kBatch, one operation over the batch at a time, so that the
// interpretation costs little beside the arithmetic.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "graph/base/box.h"
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

/// Values and gradients, as above.
void evaluateGradient(const Ir& ir, IrId root, std::span<const double> parameters,
                      std::span<const Point> points, std::span<ValueGradient> results);

/// An interval that contains every value of `root` over the box, edges included.
Interval evaluateInterval(const Ir& ir, IrId root, std::span<const double> parameters, const Box& box);

}  // namespace fw
