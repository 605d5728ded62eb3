#include "tests/support/graph/reference_field.h"

#include <algorithm>
#include <cassert>

namespace fw::test {

PointField pointField(std::function<double(const Point&)> value) {
    return [value = std::move(value)](std::span<const Point> points, std::span<double> values) {
        std::transform(points.begin(), points.end(), values.begin(), value);
    };
}

ReferenceField::ReferenceField(const Program& program)
    : ReferenceField(program.ir, program.distance(), program.parameters()) {}

ReferenceField::ReferenceField(const Ir& ir, IrId rootId, std::span<const double> parameters) {
    std::vector<bool> isNeeded(std::size_t(rootId) + 1);
    isNeeded[rootId] = true;
    for (IrId id = rootId + 1; id-- > 0;) {
        if (!isNeeded[id]) continue;
        for (int i = 0; i < opInfo(ir[id].op).arity; ++i) isNeeded[ir[id].operands[std::size_t(i)]] = true;
    }
    std::vector<std::size_t> rowOf(std::size_t(rootId) + 1);
    rows = 3;  // x, y and z
    for (IrId id = 0; id <= rootId; ++id) {
        if (id < 3) rowOf[id] = id;
        if (id < 3 || !isNeeded[id]) continue;
        const IrNode& node = ir[id];
        const OpInfo& info = opInfo(node.op);
        rowOf[id] = rows++;
        if (info.arity == 0) {
            assert(node.op == Op::constant || node.op == Op::parameter);
            const bool isParameter = node.op == Op::parameter;
            numbers.push_back({rowOf[id], isParameter ? parameters[std::size_t(node.number)] : node.number});
            continue;
        }
        Step step{
            info.value, samplesLayer(node.op) ? ir.layer(node) : SampledLayer{}, info.arity, {}, rowOf[id]};
        for (std::size_t i = 0; i < std::size_t(info.arity); ++i) step.operands[i] = rowOf[node.operands[i]];
        steps.push_back(step);
    }
    root = rowOf[rootId];
}

void ReferenceField::operator()(std::span<const Point> points, std::span<double> values) const {
    constexpr std::size_t kMaxBatch = 64;
    const std::size_t batch = std::min(kMaxBatch, points.size());
    if (batch == 0) return;
    std::vector<double> table(rows * batch);
    for (const auto& [row, number] : numbers) std::fill_n(&table[row * batch], batch, number);
    for (std::size_t first = 0; first < points.size(); first += batch) {
        const std::size_t count = std::min(batch, points.size() - first);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) table[axis * batch + i] = points[first + i][axis];
        for (const Step& step : steps) {
            const double* operands[kMaxArity] = {};
            for (int k = 0; k < step.arity; ++k) operands[k] = &table[step.operands[std::size_t(k)] * batch];
            double* results = &table[step.result * batch];
            for (std::size_t i = 0; i < count; ++i) {
                double numbersOfPoint[kMaxArity];
                for (int k = 0; k < step.arity; ++k) numbersOfPoint[k] = operands[k][i];
                results[i] = step.value(numbersOfPoint, step.layer);
            }
        }
        std::copy_n(&table[root * batch], count, &values[first]);
    }
}

double ReferenceField::operator()(const Point& point) const {
    double value = 0.0;
    (*this)(std::span(&point, 1), std::span(&value, 1));
    return value;
}

}  // namespace fw::test
