#include "graph/language/splines.h"

#include <algorithm>
#include <cmath>

#include "graph/curves/spline_table.h"
#include "graph/outlines/drawing.h"

namespace fw::language {

namespace {

Value numberValue(Lowering& state, double number) { return Value{Type::scalar, {state.ir.constant(number)}}; }

/// Numbers that must be known; none if one is not.
std::optional<std::vector<double>> knownNumbers(const Lowering& state, std::span<const Value> values) {
    std::vector<double> numbers;
    for (const Value& value : values) {
        if (!state.ir.isConstant(value.ids[0])) return std::nullopt;
        numbers.push_back(state.ir.number(value.ids[0]));
    }
    return numbers;
}
Error notKnown() {
    return {.message =
                "the numbers of a spline must be known when the graph is compiled: they cannot depend "
                "on the place"};
}

Result<Value> asValue(const Result<SplinePtr>& spline) {
    if (!spline) return spline.error();
    Value value{Type::spline};
    value.spline = *spline;
    return value;
}

std::array<IrId, 3> placeIds(const Value& place) { return {place.ids[0], place.ids[1], place.ids[2]}; }

IrId sampled(Lowering& state, const SplineTablePtr& table, SplineChannel channel, const Value& place) {
    return state.ir.sample(state.ir.addSpline(table), channel, placeIds(place));
}

}  // namespace

Result<Value> splineThroughKnots(Lowering& state, std::span<const Value> a) {
    const auto numbers = knownNumbers(state, a.subspan(2));
    if (!numbers) return notKnown();
    return asValue(splineThrough(knotsFrom(*a[0].points), splineKindNamed(a[1].text), (*numbers)[0] != 0,
                                 std::max((*numbers)[1], 0.0)));
}

Result<Value> splineOfHelixAt(Lowering& state, std::span<const Value> a) {
    const auto numbers = knownNumbers(state, a);
    if (!numbers) return notKnown();
    const std::vector<double>& n = *numbers;
    return asValue(
        splineOfHelix({std::max(n[0], 0.0), std::max(n[1], 0.0), n[2], std::max(n[3], 0.0), n[4] == 0}));
}

Result<Value> splineOfDrawing(Lowering& state, std::span<const Value> a) {
    const auto numbers = knownNumbers(state, a.subspan(2));
    if (!numbers) return notKnown();
    const std::vector<double>& n = *numbers;
    const Result<DrawnPathsPtr> drawn = readPaths(state.graphPath, a[0].text, a[1].text);
    if (!drawn) return drawn.error();
    const std::vector<Contour>& paths = (*drawn)->paths;
    if (!(n[0] >= 1 && n[0] <= double(paths.size())))
        return Error{.message = "the drawing has no path " + shortNumber(n[0]) + ": it has " +
                                std::to_string(paths.size()) + ", the first of which is 1"};
    Contour path = paths[std::size_t(n[0]) - 1];
    if (n[2] != 0) { reverse(path.arcs); }
    const double unit = n[1] > 0 ? n[1] : (*drawn)->scale * state.metre;
    const Result<SplinePtr> made = splineAlong(moved({path}, {{unit, 0}, {0, unit}, {0, 0}}, 1e-6 * unit)[0]);
    if (!made || !*made) return asValue(made);
    Spline spline = **made;
    spline.file = (*drawn)->file;
    return asValue(SplinePtr(std::make_shared<const Spline>(std::move(spline))));
}

Result<Value> splineDistance(Lowering& state, std::span<const Value> a) {
    if (!a[1].spline) return numberValue(state, kEmptyDistance);
    const IrId radius = a[2].ids[0];
    const SplineTablePtr bare = splineTable(a[1].spline, 0);
    const bool even = bare->leastShare == bare->mostShare;
    if (!even && state.ir.isConstant(radius) && state.ir.number(radius) > 0)
        return Value{Type::scalar,
                     {sampled(state, splineTable(a[1].spline, state.ir.number(radius)),
                              SplineChannel::distance, a[0])}};
    const IrId share =
        even ? state.ir.constant(bare->mostShare) : sampled(state, bare, SplineChannel::share, a[0]);
    return Value{Type::scalar,
                 {state.ir.add(Op::subtract, sampled(state, bare, SplineChannel::distance, a[0]),
                               state.ir.add(Op::multiply, share, radius))}};
}

Result<Value> splinePlace(Lowering& state, std::span<const Value> a) {
    Value place{Type::vec3};
    place.ids = a[0].ids;
    if (!a[1].spline) return place;
    const SplineTablePtr table = splineTable(a[1].spline, 0);
    for (int i = 0; i < 3; ++i)
        place.ids[std::size_t(i)] =
            sampled(state, table, SplineChannel(int(SplineChannel::across) + i), a[0]);
    return place;
}

Result<Value> splineShare(Lowering& state, std::span<const Value> a) {
    if (!a[1].spline) return numberValue(state, 1);
    return Value{Type::scalar, {sampled(state, splineTable(a[1].spline, 0), SplineChannel::share, a[0])}};
}

Result<Value> splineLength(Lowering& state, std::span<const Value> a) {
    return numberValue(state, a[0].spline ? a[0].spline->length : 0.0);
}

Result<Value> splineClosed(Lowering& state, std::span<const Value> a) {
    return Value{Type::boolean, {state.ir.constant(a[0].spline && a[0].spline->closed ? 1.0 : 0.0)}};
}

}  // namespace fw::language
