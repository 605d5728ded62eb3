#include "graph/evaluate/gradients.h"

#include <algorithm>

namespace fw {

std::vector<ValueGradient> evaluateGradients(const Ir& ir, std::span<const IrId> roots,
                                             std::span<const double> parameters, const Point& point) {
    if (roots.empty()) return {};
    // Of each operation its value and its slopes along x, y and z: a batch of three directions.
    struct Forward {
        double values[3], slopes[3];
    };
    const IrId last = *std::ranges::max_element(roots);
    std::vector<bool> needed(last + 1);
    for (const IrId root : roots) needed[root] = true;
    for (IrId id = last + 1; id-- > 0;)
        if (needed[id])
            for (int i = 0; i < opInfo(ir[id].op).arity; ++i) needed[ir[id].operands[std::size_t(i)]] = true;
    std::vector<Forward> all(last + 1);
    const auto kernels = opKernels<double>();
    for (IrId id = 0; id <= last; ++id) {
        if (!needed[id]) continue;
        const IrNode& node = ir[id];
        const OpInfo& info = opInfo(node.op);
        Forward& own = all[id];
        if (info.arity == 0) {
            const double value = id < 3                     ? point[id]
                                 : node.op == Op::parameter ? parameters[std::size_t(node.number)]
                                                            : node.number;
            for (std::size_t axis = 0; axis < 3; ++axis)
                own.values[axis] = value, own.slopes[axis] = id == axis ? 1.0 : 0.0;
            continue;
        }
        const double *values[kMaxArity], *slopes[kMaxArity];
        for (int i = 0; i < kMaxArity; ++i) {
            const Forward& operand = all[node.operands[std::size_t(i < info.arity ? i : 0)]];
            values[i] = operand.values, slopes[i] = operand.slopes;
        }
        const OpKernels<double>& kernel = *kernels[std::size_t(node.op)];
        kernel.values[0](values, own.values, 3, ir.layer(node));
        if (node.positions != 0) kernel.slopes[0](values, own.values, slopes, own.slopes, 3, ir.layer(node));
    }
    std::vector<ValueGradient> results;
    results.reserve(roots.size());
    for (const IrId root : roots) {
        const Forward& own = all[root];
        results.push_back({own.values[0], {own.slopes[0], own.slopes[1], own.slopes[2]}});
    }
    return results;
}

}  // namespace fw
