#include "graph/compile/single_precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "graph/base/words.h"
#include "graph/evaluate/evaluate.h"
#include "graph/evaluate/tape.h"
#include "graph/ir/ops.h"

namespace fw {

namespace {

constexpr double kMaxFloat = std::numeric_limits<float>::max(), kMinFloat = std::numeric_limits<float>::min();
constexpr double kLargeFactor = 1e6;
constexpr std::size_t kSamples = 2048;
/// Numbers closer to 0 than this have squares and products that are too small.
constexpr double kSmallFactor = 1e-12;
constexpr double kSmallestExponent = -80.0;  ///< of exp()
constexpr double kLargePower = 8.0;

/// The operations that the roots are computed from, ascending.
std::vector<IrId> operationsOf(const Ir& ir, std::span<const IrId> roots) {
    std::vector<bool> isNeeded(ir.size());
    for (const IrId root : roots) isNeeded[root] = true;
    std::vector<IrId> operations;
    for (IrId id = IrId(ir.size()); id-- > 0;) {
        if (!isNeeded[id]) continue;
        operations.push_back(id);
        for (int i = 0; i < opInfo(ir[id].op).arity; ++i) isNeeded[ir[id].operands[std::size_t(i)]] = true;
    }
    std::ranges::reverse(operations);
    return operations;
}

/// The first operation whose value at the point is out of range; nothing if none is.
struct OutOfRange {
    IrId id;
    double value;
};
std::optional<OutOfRange> firstOutOfRange(const Ir& ir, std::span<const IrId> operations,
                                          std::span<const double> parameters, const Point& point,
                                          bool countsSmall) {
    const std::vector<double> values = evaluate(ir, operations, parameters, point);
    for (std::size_t i = 0; i < operations.size(); ++i) {
        const double size = std::abs(values[i]);
        const bool isConstant = opInfo(ir[operations[i]].op).arity == 0 && !countsSmall;
        if (!isConstant && (size > kMaxFloat || (countsSmall && size > 0.0 && size < kMinFloat)))
            return OutOfRange{operations[i], values[i]};
    }
    return std::nullopt;
}

/// Whether intervals or factors let an operation leave the range of floats.
bool mayLeaveRange(const Ir& ir, std::span<const IrId> operations, std::span<const double> parameters,
                   const Box& box) {
    std::vector<Interval> ranges(ir.size());
    for (const IrId id : operations) {
        const IrNode& node = ir[id];
        const OpInfo& info = opInfo(node.op);
        std::array<Interval, kMaxArity> operands;
        for (int i = 0; i < info.arity; ++i) operands[std::size_t(i)] = ranges[node.operands[std::size_t(i)]];
        if (id < 3) {
            ranges[id] = {box.lo[id], box.hi[id]};
        } else if (node.op == Op::parameter) {
            const double value = parameters[std::size_t(node.number)];
            ranges[id] = {value, value};
        } else if (node.op == Op::column) {
            ranges[id] = {-kLargeFactor, kLargeFactor};
        } else if (node.op == Op::constant) {
            ranges[id] = {node.number, node.number};
        } else {
            ranges[id] =
                info.interval(operands.data(), samplesLayer(node.op) ? ir.layer(node) : SampledLayer{});
        }
        if (absolute(ranges[id]).hi > kMaxFloat) return true;
        if (node.op == Op::constant && node.number != 0.0 && std::abs(node.number) < kSmallFactor)
            return true;
        if (node.op == Op::exponential && operands[0].lo < kSmallestExponent) return true;
        if (node.op == Op::power && absolute(operands[1]).hi > kLargePower) return true;
    }
    return false;
}

}  // namespace

std::optional<Error> largeNumbers(const Graph& graph, const Ir& ir, std::span<const IrId> roots,
                                  std::span<const double> parameters, std::span<const std::string> origins) {
    const std::vector<IrId> operations = operationsOf(ir, roots);
    if (std::ranges::none_of(
            operations, [&](IrId id) { return ir.isConstant(id) && std::abs(ir.number(id)) > kLargeFactor; }))
        return std::nullopt;
    for (const Point& point : {Point{0.37, -0.61, 0.83}, Point{-3.1, 4.7, -2.3}})
        if (const auto found = firstOutOfRange(ir, operations, parameters, point, false))
            return warningAt(graph, origins[ir.origin(found->id)],
                             "numbers grow to " + shortNumber(found->value) +
                                 " here, where a device holds no more than 3.4e38: the surface would be "
                                 "wrong; use smaller ones");
    return std::nullopt;
}

std::optional<Error> precisionLoss(const Graph& graph, const Program& program, const Box& box) {
    const IrId root = program.distance();
    const std::vector<double> parameters = program.parameters();
    const std::vector<IrId> operations = operationsOf(program.ir, std::span(&root, 1));
    if (!mayLeaveRange(program.ir, operations, parameters, box)) return std::nullopt;
    std::mt19937 random(1);
    std::vector<Point> points(kSamples);
    for (Point& point : points)
        for (std::size_t axis = 0; axis < 3; ++axis)
            point[axis] = std::lerp(box.lo[axis], box.hi[axis], double(random() >> 8) / double(1 << 24));
    std::vector<double> exact(kSamples), single(kSamples);
    const Tape tape = makeTape(program.ir, root, parameters);
    TapeMachine<double>().evaluate(tape, points, exact);
    TapeMachine<float>().evaluate(tape, points, single);
    for (std::size_t i = 0; i < kSamples; ++i) {
        if ((exact[i] < 0.0) == (single[i] < 0.0)) continue;
        const auto found = firstOutOfRange(program.ir, operations, parameters, points[i], true);
        if (!found) continue;
        std::string place = "(";
        for (std::size_t axis = 0; axis < 3; ++axis)
            place += (axis ? " " : "") + shortNumber(points[i][axis]);
        return warningAt(
            graph, program.origins[program.ir.origin(found->id)],
            "a number is " + shortNumber(found->value) + " at " + place +
                "), beyond single precision (1.2e-38 to 3.4e38): the mesh lacks solid there, or has "
                "too much; use numbers closer to 1");
    }
    return std::nullopt;
}

}  // namespace fw
