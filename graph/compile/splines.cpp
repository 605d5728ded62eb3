// What is moved along splines.
#include <algorithm>
#include <cmath>

#include "graph/compile/graph_lowering.h"
#include "graph/curves/spline_table.h"
#include "graph/evaluate/evaluate.h"

namespace fw {

using language::Value;

namespace {

constexpr double kFarAway = 1e4;    // metres
constexpr int kMostSquares = 4096;  // looked at
constexpr double kSmallest = 0.01;  // of how far the solid reaches

/// How far a solid reaches from the z axis at most, metres; none if that is not known: it moves, or has no
/// end.
std::optional<double> reachOf(const Ir& ir, IrId distance) {
    if (movingIn(ir, distance)) return std::nullopt;
    const Tape tape = makeTape(ir, distance, {});
    TapeMachine<double> machine;
    struct Square {
        double x, y, half;
        double reach() const { return std::hypot(std::abs(x) + half, std::abs(y) + half); }
    };
    // Of the squares that the solid may be in, the one that reaches the farthest is halved until it is small.
    std::vector<Square> heap = {{0, 0, kFarAway}};
    const auto nearer = [](const Square& a, const Square& b) { return a.reach() < b.reach(); };
    for (int looked = 0; looked < kMostSquares; ++looked) {
        if (heap.empty()) return 0.0;
        const Square square = heap.front();
        if (square.half < kSmallest * square.reach()) break;
        std::ranges::pop_heap(heap, nearer);
        heap.pop_back();
        for (int k = 0; k < 4; ++k) {
            const double half = 0.5 * square.half, x = square.x + (k & 1 ? half : -half),
                         y = square.y + (k & 2 ? half : -half);
            const Box column{{x - half, y - half, -kFarAway}, {x + half, y + half, kFarAway}};
            if (machine.interval(tape, column).lo > 0) continue;
            heap.push_back({x, y, half});
            std::ranges::push_heap(heap, nearer);
        }
    }
    const double reach = heap.front().reach();
    if (reach > 0.5 * kFarAway) return std::nullopt;
    return reach;
}

}  // namespace

/// A place is never nearer to the shape than to the spline less the shape's reach; of true distances this
/// changes no value.
Lowered lowerSweep(GraphLowering& lowering, const NodeAt& at) {
    const auto inputs = lowering.inputs(at);
    if (!inputs) return lowering.failure(at.type.outputs);
    Lowered result = lowering.lowerBody(at, *inputs);
    if (result.failed) return result;
    const SplinePtr& spline = inputOf(*inputs, "spline").spline;
    if (!spline) return result;
    Ir& ir = lowering.state.ir;
    const std::optional<double> reach = reachOf(ir, inputOf(*inputs, "surface").ids[distanceComponent]);
    if (!reach) return result;
    const SplineTablePtr table = splineTable(spline, 0);
    const bool scaled = !ir.isConstant(inputOf(*inputs, "scaled").id(), 0.0);
    const Value& place = inputOf(*inputs, "p");
    const IrId away =
        ir.sample(ir.addSpline(table), SplineChannel::distance, {place.ids[0], place.ids[1], place.ids[2]});
    IrId& distance = result.outputs[0].value.ids[distanceComponent];
    distance = ir.add(
        Op::maximum, distance,
        ir.add(Op::subtract, away, ir.constant(*reach * (scaled ? std::max(table->mostShare, 1e-3) : 1.0))));
    return result;
}

}  // namespace fw
