#include "graph/evaluate/affine.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <vector>

#include "graph/evaluate/evaluate.h"

namespace fw {

namespace {

/// Of each value up to `last`: whether it is built as an affine function of the position.
std::vector<bool> affineUpTo(const Ir& ir, IrId last) {
    std::vector<bool> affine(last + 1);
    for (IrId id = 0; id <= last; ++id) {
        const IrNode& node = ir[id];
        const auto flat = [&](std::size_t i) { return ir[node.operands[i]].positions == 0; };
        const auto operands = std::span(node.operands).first(std::size_t(opInfo(node.op).arity));
        const bool all = std::ranges::all_of(operands, [&](IrId operand) { return bool(affine[operand]); });
        switch (node.op) {
            case Op::positionX:
            case Op::positionY:
            case Op::positionZ: affine[id] = true; break;
            case Op::negate:
            case Op::add:
            case Op::subtract: affine[id] = all; break;
            case Op::multiply: affine[id] = all && (flat(0) || flat(1)); break;
            case Op::divide: affine[id] = all && flat(1); break;
            case Op::select: affine[id] = all && flat(0); break;
            case Op::column: affine[id] = false; break;
            default: affine[id] = node.positions == 0 && all;
        }
    }
    return affine;
}

}  // namespace

std::optional<Affine> affineOf(const Ir& ir, const std::array<IrId, 3>& values,
                               std::span<const double> parameters) {
    const std::vector<bool> affine = affineUpTo(ir, std::ranges::max(values));
    Affine map;
    for (int row = 0; row < 3; ++row) {
        const IrId id = values[std::size_t(row)];
        if (!affine[id]) return std::nullopt;
        const Point origin{};
        ValueGradient at{};
        evaluateGradient(ir, id, parameters, std::span(&origin, 1), std::span(&at, 1));
        map.offset[row] = at.value;
        for (int axis = 0; axis < 3; ++axis) map.linear[axis][row] = at.gradient[std::size_t(axis)];
    }
    const double volume = std::abs(glm::determinant(map.linear));
    if (!(volume > 1e-30) || !std::isfinite(volume) || !std::isfinite(glm::dot(map.offset, glm::dvec3(1.0))))
        return std::nullopt;
    return map;
}

Affine inverse(const Affine& map) {
    const glm::dmat3 back = glm::inverse(map.linear);
    return {back, -(back * map.offset)};
}

}  // namespace fw
