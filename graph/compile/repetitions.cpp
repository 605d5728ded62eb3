#include "graph/compile/repetitions.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "graph/compile/graph_lowering.h"
#include "graph/compile/solid_query.h"
#include "graph/evaluate/evaluate.h"

namespace fw {

namespace {

/// ExactnessArguments::constant.
using Constants = std::function<std::optional<double>(std::string_view, int)>;

/// dot(normal, p) <= offset.
struct HalfSpace {
    Point normal;
    double offset;
    std::string side;  ///< for messages
};

constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};

/// The space of one copy, as an intersection of half-spaces, and the mirror symmetry that makes the field
/// continuous for copies that do not fit.
struct Cell {
    bool known = false;                 ///< false: it depends on live values
    bool samplesAll = false;            ///< every copy is sampled everywhere
    std::vector<HalfSpace> sides = {};  ///< empty: there is one copy
    bool closed = true;                 ///< the copies have no first and no last one
    std::vector<int> mirrorAxes = {};   ///< coordinates in which the surface must be symmetric
    bool mirrorsAlongAxes = true;  ///< false: the mirror planes are oblique, and symmetry is not looked for
};

Cell repeatCell(const Constants& constant) {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> period = constant("period", axis), count = constant("count", axis);
        if (!period) return {};
        if (*period <= 0.0 || (count && std::round(*count) == 1.0)) continue;
        Point normal{};
        normal[std::size_t(axis)] = 1.0;
        const std::string side = std::string("along ") + kAxisNames[std::size_t(axis)];
        cell.sides.push_back({normal, 0.5 * *period, side});
        normal[std::size_t(axis)] = -1.0;
        cell.sides.push_back({normal, 0.5 * *period, side});
        cell.closed = cell.closed && count && std::round(*count) == 0.0;
        cell.mirrorAxes.push_back(axis);
    }
    cell.known = true;
    return cell;
}

/// The frame is that of the node's body: copies turn from u towards v.
Cell polarCell(const Constants& constant) {
    const std::optional<double> number = constant("count", 0);
    if (!number) return {};
    Cell cell{.known = true};
    const double count = std::max(std::round(*number), 1.0);
    if (count == 1.0) return cell;
    cell.samplesAll = constant("neighbours", 0) == 1.0 && count <= 4.0;
    const auto dot = [](const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const auto scaledTo1 = [&](Point a) {
        const double size = std::sqrt(dot(a, a));
        for (double& component : a) component /= size;
        return a;
    };
    Point w{};
    for (int i = 0; i < 3; ++i) {
        const std::optional<double> component = constant("axis", i);
        if (!component) return {.known = cell.samplesAll, .samplesAll = cell.samplesAll};
        w[std::size_t(i)] = *component;
    }
    w = dot(w, w) > 0.0 ? scaledTo1(w) : Point{0, 1, 0};
    Point u = std::abs(w[0]) < 0.9 ? Point{1, 0, 0} : Point{0, 1, 0};
    const double part = dot(u, w);
    for (std::size_t i = 0; i < 3; ++i) u[i] -= part * w[i];
    u = scaledTo1(u);
    const Point v{w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]};
    const double half = std::numbers::pi / count;
    for (const double sign : {1.0, -1.0}) {
        Point normal;
        for (std::size_t i = 0; i < 3; ++i) normal[i] = sign * std::cos(half) * v[i] - std::sin(half) * u[i];
        cell.sides.push_back({normal, 0.0, ""});
    }
    cell.mirrorsAlongAxes = false;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(v[std::size_t(axis)]) == 1.0) cell.mirrorAxes = {axis}, cell.mirrorsAlongAxes = true;
    return cell;
}

bool isSymmetric(const Cell& cell, const std::function<bool(int axis)>& mirrored) {
    return cell.closed && cell.mirrorsAlongAxes && std::ranges::all_of(cell.mirrorAxes, mirrored);
}

Exactness cellExactness(const ExactnessArguments& node, const Cell& cell) {
    const Exactness a = node.surface("surface");
    if (!cell.known) return distorted();
    if (cell.sides.empty() && !cell.samplesAll) return a;
    if (node.constant("neighbours", 0) != 1.0) return distorted();
    const Exactness exactCopies{a.outside, false, a.lipschitz};
    if (cell.samplesAll) return exactCopies;
    if (a.outside && std::ranges::all_of(cell.sides, [&](const HalfSpace& side) {
            return node.within("surface", side.normal, side.offset);
        }))
        return exactCopies;
    // Without a constant there is nothing to keep.
    if (!std::isfinite(a.lipschitz)) return distorted();
    const bool symmetric = isSymmetric(cell, [&](int axis) { return node.mirrored("surface", axis); });
    return symmetric ? distorted(a.lipschitz) : distorted();
}

/// How a scatter node drops copies.
struct ScatterCell {
    bool known = false;
    double reach = 0.5e9;           ///< copies are capped there
    std::array<double, 3> clear{};  ///< from a copy's centre to where it is dropped; 0: along this axis never
    double leastSize = 1;
    bool turns = false;
};

ScatterCell scatterCell(const Constants& constant) {
    const std::optional<double> jitter = constant("jitter", 0), turn = constant("turn", 0),
                                variation = constant("size_variation", 0);
    if (!jitter || !turn || !variation) return {};
    ScatterCell cell{.known = true, .leastSize = std::max(1.0 - *variation, 0.01), .turns = *turn != 0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> period = constant("period", axis);
        if (!period) return {};
        if (*period <= 0.0) continue;
        cell.reach = std::min(cell.reach, 0.5 * *period);
        cell.clear[std::size_t(axis)] = (1.5 - 0.5 * *jitter) * *period;
    }
    return cell;
}

/// The extent of a box along each axis from the origin, whichever way it is turned about y.
std::array<double, 3> extentOf(const Box& box, bool turns) {
    std::array<double, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        extent[axis] = std::max({0.0, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
    if (turns) extent[0] = extent[2] = std::hypot(extent[0], extent[2]);
    return extent;
}

bool keepsClear(const ScatterCell& cell, const Box& box, double size, double margin) {
    if (box.lo[0] > box.hi[0]) return true;  // there is nothing
    const std::array<double, 3> extent = extentOf(box, cell.turns);
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (cell.clear[axis] > 0.0 && size * extent[axis] + margin > cell.clear[axis] * (1.0 + kHair))
            return false;
    return true;
}

// ---- warnings

std::vector<double> liveValues(const GraphLowering& lowering) {
    std::vector<double> values;
    for (const LiveParameter& parameter : lowering.live) values.push_back(parameter.value);
    return values;
}

/// Whether some of these points of the first copy are outside all copies, as the field has it.
bool loses(const GraphLowering& lowering, IrId field, const std::vector<Point>& points) {
    std::vector<double> values(points.size());
    evaluate(lowering.state.ir, field, liveValues(lowering), points, values);
    return std::ranges::any_of(values, [](double value) { return value > kHair; });
}

Constants constantsOf(const GraphLowering& lowering, const std::vector<NodeInput>& inputs) {
    return [&lowering, &inputs](std::string_view name, int component) -> std::optional<double> {
        const IrId id = inputOf(inputs, name).ids[component];
        const Ir& ir = lowering.state.ir;
        return ir.isConstant(id) ? std::optional(ir.number(id)) : std::nullopt;
    };
}

/// Points of the solid beyond the plane, within the solid's bounds.
std::vector<Point> pointsBeyond(const GraphLowering& lowering, IrId surface, Box bounds, const Point& normal,
                                double offset) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (normal[axis] == 1.0) bounds.lo[axis] = std::max(bounds.lo[axis], offset);
        if (normal[axis] == -1.0) bounds.hi[axis] = std::min(bounds.hi[axis], -offset);
        if (bounds.lo[axis] >= bounds.hi[axis]) return {};
    }
    std::vector<Point> points = pointsOfSolid(lowering.state.ir, surface, liveValues(lowering), bounds);
    std::erase_if(points, [&](const Point& p) {
        return normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2] <= offset + kHair;
    });
    return points;
}

/// The first side that the surface crosses with an effect: copies are cut off, or the field jumps between
/// them. nullptr if sampling finds no such side.
const HalfSpace* overfull(const GraphLowering& lowering, const std::vector<NodeInput>& inputs,
                          const Cell& cell, const NodeOutput& made) {
    const bool neighbours = constantsOf(lowering, inputs)("neighbours", 0) == 1.0;
    if (!cell.known || cell.samplesAll || cell.sides.empty() || (neighbours && made.exactness.outside))
        return nullptr;
    const Ir& ir = lowering.state.ir;
    const IrId surface = inputOf(inputs, "surface").ids[distanceComponent];
    const Box bounds = solidBounds(ir, surface, liveValues(lowering));
    std::optional<bool> jumps;
    for (const HalfSpace& side : cell.sides) {
        const std::vector<Point> points = pointsBeyond(lowering, surface, bounds, side.normal, side.offset);
        if (points.empty()) continue;
        if (neighbours && !jumps)
            jumps = !isSymmetric(cell, [&](int axis) { return isMirrored(ir, surface, axis); });
        if (jumps.value_or(false) || loses(lowering, made.value.ids[distanceComponent], points)) return &side;
    }
    return nullptr;
}

/// Lowers the body, and hands what it gives to `test` if there is a surface.
template <class Test>
Lowered lowerTested(GraphLowering& lowering, const NodeAt& at, Test test) {
    const auto inputs = lowering.inputs(at);
    if (!inputs) return lowering.failure(at.type.outputs);
    Lowered result = lowering.lowerBody(at, *inputs);
    const NodeInput& surface = inputs->front();
    if (!result.failed && surface.from && !lowering.state.opaquePart) test(*inputs, result.outputs[0]);
    return result;
}

}  // namespace

Exactness repeatExactness(const ExactnessArguments& node) {
    return cellExactness(node, repeatCell(node.constant));
}

Exactness polarRepeatExactness(const ExactnessArguments& node) {
    return cellExactness(node, polarCell(node.constant));
}

Exactness scatterExactness(const ExactnessArguments& node) {
    const Exactness a = node.surface("surface");
    const ScatterCell cell = scatterCell(node.constant);
    if (!cell.known || !std::isfinite(a.lipschitz)) return distorted();
    if (a.outside) {
        const std::optional<Box> solid = node.bounds("surface", kHair);
        if (solid && solid->lo[0] <= solid->hi[0] && keepsClear(cell, *solid, 1.0, cell.reach))
            return distorted(a.lipschitz);
    }
    // Copies of sizes between `small` and `large` have the value `reach` where f has at least reach / small.
    constexpr int kSteps = 4;
    const double ratio = std::pow(1.0 / cell.leastSize, 1.0 / kSteps);
    double small = cell.leastSize;
    for (int step = 0; step < (ratio > 1.0 ? kSteps : 1); ++step, small *= ratio) {
        const std::optional<Box> level = node.bounds("surface", cell.reach / small);
        if (!level || !keepsClear(cell, *level, std::min(small * ratio, 1.0), 0.0)) return distorted();
    }
    return distorted(a.lipschitz);
}

Lowered lowerRepeat(GraphLowering& lowering, const NodeAt& at) {
    return lowerTested(lowering, at, [&](const std::vector<NodeInput>& inputs, const NodeOutput& made) {
        const Cell cell = repeatCell(constantsOf(lowering, inputs));
        if (const HalfSpace* side = overfull(lowering, inputs, cell, made))
            lowering.warn(
                at, "surface",
                "the surface does not fit into one period " + side->side +
                    ", so copies are cut off or the field jumps between them: increase the period, or "
                    "centre the surface on the origin and move the result");
    });
}

Lowered lowerPolarRepeat(GraphLowering& lowering, const NodeAt& at) {
    return lowerTested(lowering, at, [&](const std::vector<NodeInput>& inputs, const NodeOutput& made) {
        const Cell cell = polarCell(constantsOf(lowering, inputs));
        if (overfull(lowering, inputs, cell, made))
            lowering.warn(
                at, "surface",
                "the surface does not fit into its sector around +x (+y if the axis is x), so copies "
                "are cut off or the field jumps between them: move the surface away from the axis "
                "along that direction, make it smaller, or lower the count");
    });
}

Lowered lowerScatter(GraphLowering& lowering, const NodeAt& at) {
    return lowerTested(lowering, at, [&](const std::vector<NodeInput>& inputs, const NodeOutput& made) {
        if (std::isfinite(made.exactness.lipschitz)) return;
        const ScatterCell cell = scatterCell(constantsOf(lowering, inputs));
        if (!cell.known) return;
        const IrId surface = inputOf(inputs, "surface").ids[distanceComponent];
        const Box bounds = solidBounds(lowering.state.ir, surface, liveValues(lowering));
        for (int axis = 0; axis < 3; ++axis) {
            const double clear = cell.clear[std::size_t(axis)];
            if (clear <= 0.0) continue;
            // A turned copy reaches along x and z as far as it reaches from the y axis.
            const bool around = cell.turns && axis != 1;
            const double room = clear - cell.reach;
            for (const int k : around ? std::vector{0, 2} : std::vector{axis})
                for (const double sign : {1.0, -1.0}) {
                    Point normal{};
                    normal[std::size_t(k)] = sign;
                    std::vector<Point> points = pointsBeyond(lowering, surface, bounds, normal,
                                                             around ? room * std::numbers::sqrt2 / 2 : room);
                    if (around)
                        std::erase_if(points, [&](const Point& p) { return std::hypot(p[0], p[2]) <= room; });
                    if (points.empty()) continue;
                    lowering.warn(at, "surface",
                                  std::string("the surface does not fit into a cell along ") +
                                      kAxisNames[std::size_t(axis)] +
                                      (around ? " whichever way it is turned" : "") +
                                      ", so copies are cut off or the field jumps between them: increase the "
                                      "period, lower the jitter, or centre a smaller surface on the origin");
                    return;
                }
        }
    });
}

}  // namespace fw
