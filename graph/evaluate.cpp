#include "graph/evaluate.h"

#include <algorithm>
#include <cassert>

namespace fw {

namespace {

constexpr std::size_t kBatch = 64;

/// Runs visit(id, node, operands' ids) for each non-leaf and fill(id, node) for each leaf, up to `root`.
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

}  // namespace

void evaluate(const Ir& ir, IrId root, std::span<const double> parameters, std::span<const Point> points,
              std::span<double> values) {
    assert(values.size() >= points.size());
    std::vector<std::array<double, kBatch>> registers(root + 1);
    for (std::size_t first = 0; first < points.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, points.size() - first);
        scan(
            ir, root,
            [&](IrId id, const IrNode& node) {
                for (std::size_t k = 0; k < count; ++k)
                    registers[id][k] = isPosition(node) ? points[first + k][id] : leafValue(node, parameters);
            },
            [&](IrId id, const IrNode& node, const OpInfo& info) {
                double operands[kMaxArity];
                for (std::size_t k = 0; k < count; ++k) {
                    for (int i = 0; i < info.arity; ++i) operands[i] = registers[node.operands[i]][k];
                    registers[id][k] = info.value(operands);
                }
            });
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
    std::vector<ValueGradient> registers(root + 1);
    for (std::size_t k = 0; k < points.size(); ++k) {
        scan(
            ir, root,
            [&](IrId id, const IrNode& node) {
                registers[id] = {isPosition(node) ? points[k][id] : leafValue(node, parameters), {}};
                if (isPosition(node)) registers[id].gradient[id] = 1.0;
            },
            [&](IrId id, const IrNode& node, const OpInfo& info) {
                double operands[kMaxArity], derivatives[kMaxArity];
                for (int i = 0; i < info.arity; ++i) operands[i] = registers[node.operands[i]].value;
                ValueGradient& result = registers[id];
                result.value = info.value(operands);
                for (int axis = 0; axis < 3; ++axis) {
                    for (int i = 0; i < info.arity; ++i)
                        derivatives[i] = registers[node.operands[i]].gradient[axis];
                    result.gradient[axis] =
                        node.positions ? info.gradient(operands, result.value, derivatives) : 0.0;
                }
            });
        results[k] = registers[root];
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
            registers[id] = info.interval(operands);
        });
    return registers[root];
}

}  // namespace fw
