// ReferenceField: a field that is evaluated operation by operation in double precision.
//
// It computes every operation that the root needs, at every point, with the value functions of the op table.
// It uses no tapes, vector kernels, intervals, gradients or families, so it can judge all of these. It does
// use the Ir, so it cannot find faults in the lowering of nodes or in the folding of constants.
//
// Speed: about 3 ns for each operation and point.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "graph/base/box.h"
#include "graph/compile/program.h"
#include "graph/ir/ir.h"

namespace fw::test {

/// Writes the field's value at each point. Thread-safe.
using PointField = std::function<void(std::span<const Point> points, std::span<double> values)>;

/// A field as a function of one point.
PointField pointField(std::function<double(const Point&)> value);

class ReferenceField {
  public:
    /// `ir` must outlive the field. `parameters` are the values of the live parameters, by slot.
    ReferenceField(const Ir& ir, IrId root, std::span<const double> parameters);
    /// The distance of a program, which must outlive the field.
    explicit ReferenceField(const Program& program);

    void operator()(std::span<const Point> points, std::span<double> values) const;
    double operator()(const Point& point) const;

    /// How many operations each evaluation computes.
    std::size_t operations() const { return steps.size(); }

  private:
    /// One operation. Operands and the result are row numbers.
    struct Step {
        double (*value)(const double* operands, SampledLayer layer);
        SampledLayer layer;
        int arity;
        std::array<std::size_t, kMaxArity> operands;
        std::size_t result;
    };

    std::vector<Step> steps;
    std::vector<std::pair<std::size_t, double>> numbers;  ///< rows of constants and parameters
    std::size_t rows = 0, root = 0;
};

}  // namespace fw::test
