#include "graph/evaluate/evaluate.h"

#include <algorithm>
#include <cassert>

namespace fw {

void evaluate(const Ir& ir, IrId root, std::span<const double> parameters, std::span<const Point> points,
              std::span<double> values) {
    TapeMachine<double>().evaluate(makeTape(ir, root, parameters), points, values);
}

double evaluate(const Ir& ir, IrId root, std::span<const double> parameters, const Point& point) {
    return evaluate(ir, std::span(&root, 1), parameters, point)[0];
}

std::vector<double> evaluate(const Ir& ir, std::span<const IrId> roots, std::span<const double> parameters,
                             const Point& point) {
    if (roots.empty()) return {};
    const Tape tape = makeTape(ir, roots, parameters);
    TapeMachine<double> machine;
    for (int axis = 0; axis < 3; ++axis) *machine.position(axis) = point[std::size_t(axis)];
    machine.value(tape, 1);
    std::vector<double> values;
    for (std::size_t i = 0; i < roots.size(); ++i) values.push_back(*machine.root(tape, i));
    return values;
}

void evaluateGradient(const Ir& ir, IrId root, std::span<const double> parameters,
                      std::span<const Point> points, std::span<ValueGradient> results) {
    TapeMachine<double> machine;
    evaluateGradient(machine, makeTape(ir, root, parameters), points, results);
}

void evaluateGradient(TapeMachine<double>& machine, const Tape& tape, std::span<const Point> points,
                      std::span<ValueGradient> results) {
    assert(results.size() >= points.size());
    constexpr std::size_t kBatch = TapeMachine<double>::kGradientPoints;
    for (std::size_t first = 0; first < points.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, points.size() - first);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t k = 0; k < count; ++k) machine.position(int(axis))[k] = points[first + k][axis];
        const auto [values, gradients] = machine.gradient(tape, count);
        for (std::size_t k = 0; k < count; ++k)
            results[first + k] = {values[k], {gradients[0][k], gradients[1][k], gradients[2][k]}};
    }
}

Interval evaluateInterval(const Ir& ir, IrId root, std::span<const double> parameters, const Box& box) {
    return TapeMachine<double>().interval(makeTape(ir, root, parameters), box);
}

}  // namespace fw
