#include "graph/compile/solid_query.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "graph/bounds/region.h"
#include "graph/compile/graph_lowering.h"
#include "graph/evaluate/evaluate.h"

namespace fw {

namespace {

/// The only search in space of this file.
Region searchSolid(const Ir& ir, IrId distance, std::span<const double> parameters) {
    return findRegion(ir, distance, parameters);
}

/// A field, apart from the graph's own IR, so that questions leave no operations there.
struct Apart {
    Ir ir;
    IrId root;
};
Apart apartFrom(const Ir& ir, IrId root) {
    Ir own = ir.compact(std::span(&root, 1));
    return {std::move(own), root};
}

/// offset - dot(normal, p): negative beyond the plane.
IrId beyond(Ir& ir, const Point& normal, double offset) {
    IrId sum = ir.constant(offset);
    for (int axis = 0; axis < 3; ++axis)
        if (normal[std::size_t(axis)] != 0.0)
            sum = ir.add(Op::subtract, sum,
                         ir.add(Op::multiply, ir.constant(normal[std::size_t(axis)]), ir.position(axis)));
    return sum;
}

/// How a value changes if one coordinate changes its sign.
enum class Parity : unsigned char { even, odd, unknown };

Parity parityOf(const IrNode& node, std::span<const Parity> operands) {
    const auto all = [&](Parity parity) {
        return std::ranges::all_of(operands, [&](Parity operand) { return operand == parity; });
    };
    if (all(Parity::even)) return Parity::even;
    if (std::ranges::find(operands, Parity::unknown) != operands.end()) return Parity::unknown;
    switch (node.op) {
        case Op::absolute:
        case Op::square:
        case Op::cosine: return Parity::even;
        case Op::negate:
        case Op::sign:
        case Op::sine:
        case Op::tangent:
        case Op::arcSine:
        case Op::arcTangent: return Parity::odd;
        case Op::add:
        case Op::subtract: return all(Parity::odd) ? Parity::odd : Parity::unknown;
        case Op::multiply:
        case Op::divide: return all(Parity::odd) ? Parity::even : Parity::odd;
        case Op::select:
            return operands[0] == Parity::even && operands[1] == Parity::odd && operands[2] == Parity::odd
                       ? Parity::odd
                       : Parity::unknown;
        default: return Parity::unknown;
    }
}

}  // namespace

bool isWithin(const Ir& ir, IrId distance, const Point& normal, double offset) {
    if (movingIn(ir, distance)) return false;
    // Beyond a plane across an axis one interval may do, even if the solid touches the plane or has no end.
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::abs(normal[axis]) != 1.0) continue;
        Box half{{-kFarthest, -kFarthest, -kFarthest}, {kFarthest, kFarthest, kFarthest}};
        (normal[axis] > 0.0 ? half.lo : half.hi)[axis] = normal[axis] * (offset + 2.0 * kHair);
        if (evaluateInterval(ir, distance, {}, half).lo >= kHair) return true;
    }
    Apart field = apartFrom(ir, distance);
    const IrId grown = field.ir.add(Op::subtract, field.root, field.ir.constant(kHair));
    const IrId outside = beyond(field.ir, normal, offset + 2.0 * kHair);
    const IrId both = field.ir.add(Op::maximum, grown, outside);
    return searchSolid(field.ir, both, {}).extent == Extent::empty;
}

std::optional<Box> levelBounds(const Ir& ir, IrId distance, double level) {
    if (movingIn(ir, distance)) return std::nullopt;
    Apart field = apartFrom(ir, distance);
    const IrId grown = field.ir.add(Op::subtract, field.root, field.ir.constant(level));
    const Region region = searchSolid(field.ir, grown, {});
    if (region.extent == Extent::empty) return Box{{1, 1, 1}, {-1, -1, -1}};
    return region.extent == Extent::bounded ? std::optional(region.box) : std::nullopt;
}

bool isMirrored(const Ir& ir, IrId root, int axis) {
    if (movingIn(ir, root)) return false;
    std::vector<Parity> parities(root + 1, Parity::even);
    for (IrId id = 0; id <= root; ++id) {
        const IrNode& node = ir[id];
        if ((node.positions >> axis & 1) == 0) continue;
        if (id == ir.position(axis)) {
            parities[id] = Parity::odd;
            continue;
        }
        std::array<Parity, kMaxArity> operands{};
        const auto arity = std::size_t(opInfo(node.op).arity);
        for (std::size_t i = 0; i < arity; ++i) operands[i] = parities[node.operands[i]];
        parities[id] = parityOf(node, std::span(operands).first(arity));
    }
    return parities[root] == Parity::even;
}

Box solidBounds(const Ir& ir, IrId distance, std::span<const double> parameters) {
    constexpr double kWide = 64.0;  // metres
    const Apart field = apartFrom(ir, distance);
    const Region region = searchSolid(field.ir, field.root, parameters);
    const bool isFound = region.extent == Extent::bounded || region.extent == Extent::empty;
    return isFound ? region.box : cubeAround(kWide);
}

std::vector<Point> pointsOfSolid(const Ir& ir, IrId distance, std::span<const double> parameters,
                                 const Box& within) {
    constexpr int kSamples = 4096;
    // A lattice of powers of the plastic number's relative (Roberts, "The unreasonable effectiveness of
    // quasirandom sequences", 2018).
    constexpr double kRatio = 1.22074408460575947536;
    std::vector<Point> points, found;
    for (int i = 0; i < kSamples; ++i) {
        Point& p = points.emplace_back();
        double factor = 1.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            factor /= kRatio;
            double t = 0.5 + factor * i;
            t -= std::floor(t);
            p[axis] = within.lo[axis] + t * (within.hi[axis] - within.lo[axis]);
        }
    }
    std::vector<double> values(points.size());
    evaluate(ir, distance, parameters, points, values);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (values[i] < -kHair) found.push_back(points[i]);
    return found;
}

}  // namespace fw
