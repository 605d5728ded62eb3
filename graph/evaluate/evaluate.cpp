#include "graph/evaluate/evaluate.h"

#include <algorithm>
#include <cassert>

namespace fw {

namespace {

constexpr std::size_t kBatch = 64;
using Batch = std::array<double, kBatch>;

/// Runs leaf(id, node) for each leaf and operation(id, node, info) for the rest, up to `root`.
template <class Leaf, class Operation>
void scan(const Ir& ir, IrId root, Leaf leaf, Operation operation) {
    for (IrId id = 0; id <= root; ++id) {
        const IrNode& node = ir[id];
        if (opInfo(node.op).arity == 0)
            leaf(id, node);
        else
            operation(id, node, opInfo(node.op));
    }
}

double leafValue(const IrNode& node, std::span<const double> parameters) {
    return node.op == Op::parameter ? parameters[static_cast<std::size_t>(node.number)] : node.number;
}

bool isPosition(const IrNode& node) { return node.op >= Op::positionX && node.op <= Op::positionZ; }

/// The arrays of a node's operands; what lies beyond its arity repeats the first.
std::array<const double*, kMaxArity> gather(const std::vector<Batch>& registers, const IrNode& node,
                                            int arity) {
    std::array<const double*, kMaxArity> operands;
    for (int i = 0; i < kMaxArity; ++i) operands[i] = registers[node.operands[i < arity ? i : 0]].data();
    return operands;
}

/// Values of all operations up to `root` at points[first, first + count).
void evaluateBatch(const Ir& ir, IrId root, std::span<const double> parameters, std::span<const Point> points,
                   std::size_t first, std::size_t count, std::vector<Batch>& registers) {
    scan(
        ir, root,
        [&](IrId id, const IrNode& node) {
            for (std::size_t k = 0; k < count; ++k)
                registers[id][k] = isPosition(node) ? points[first + k][id] : leafValue(node, parameters);
        },
        [&](IrId id, const IrNode& node, const OpInfo& info) {
            info.values(gather(registers, node, info.arity).data(), registers[id].data(), count,
                        ir.layer(node));
        });
}

}  // namespace

void evaluate(const Ir& ir, IrId root, std::span<const double> parameters, std::span<const Point> points,
              std::span<double> values) {
    assert(values.size() >= points.size());
    std::vector<Batch> registers(root + 1);
    for (std::size_t first = 0; first < points.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, points.size() - first);
        evaluateBatch(ir, root, parameters, points, first, count, registers);
        std::copy_n(registers[root].begin(), count, values.begin() + first);
    }
}

double evaluate(const Ir& ir, IrId root, std::span<const double> parameters, const Point& point) {
    double value = 0.0;
    evaluate(ir, root, parameters, std::span(&point, 1), std::span(&value, 1));
    return value;
}

void evaluateGradient(const Ir& ir, IrId root, std::span<const double> parameters,
                      std::span<const Point> points, std::span<ValueGradient> results) {
    assert(results.size() >= points.size());
    std::vector<Batch> registers(root + 1), slopes(root + 1);
    for (std::size_t first = 0; first < points.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, points.size() - first);
        evaluateBatch(ir, root, parameters, points, first, count, registers);
        for (std::size_t k = 0; k < count; ++k) results[first + k].value = registers[root][k];
        for (int axis = 0; axis < 3; ++axis) {
            scan(
                ir, root, [&](IrId id, const IrNode&) { slopes[id].fill(id == IrId(axis) ? 1.0 : 0.0); },
                [&](IrId id, const IrNode& node, const OpInfo& info) {
                    if (!(node.positions >> axis & 1)) return slopes[id].fill(0.0);
                    info.gradients(gather(registers, node, info.arity).data(), registers[id].data(),
                                   gather(slopes, node, info.arity).data(), slopes[id].data(), count,
                                   ir.layer(node));
                });
            for (std::size_t k = 0; k < count; ++k) results[first + k].gradient[axis] = slopes[root][k];
        }
    }
}

Interval evaluateInterval(const Ir& ir, IrId root, std::span<const double> parameters, const Box& box) {
    std::vector<Interval> registers(root + 1);
    scan(
        ir, root,
        [&](IrId id, const IrNode& node) {
            const double value = isPosition(node) ? 0.0 : leafValue(node, parameters);
            registers[id] = isPosition(node) ? Interval{box.lo[id], box.hi[id]} : Interval{value, value};
        },
        [&](IrId id, const IrNode& node, const OpInfo& info) {
            Interval operands[kMaxArity];
            for (int i = 0; i < info.arity; ++i) operands[i] = registers[node.operands[i]];
            registers[id] = info.interval(operands, ir.layer(node));
        });
    return registers[root];
}

}  // namespace fw
