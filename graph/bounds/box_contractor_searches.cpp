// The searches by which BoxContractor bounds goals that their expression alone does not: in the space of the
// values that a part of the expression is a function of, and shell by shell from outside.
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "graph/bounds/box_contractor.h"
#include "graph/bounds/frame_cut.h"

namespace fw {

namespace {

/// Of shells around the origin.
constexpr double kShellRatio = 4.0, kSmallestShell = 1.0 / 1024.0;
constexpr std::size_t kShellSteps = 300'000;
constexpr int kMaxShellSplits = 24, kShellSamples = 64;
constexpr double kSmallestTrim = 1.0 / 32.0;  // of a box's side
constexpr std::size_t kTrimSteps = 20'000;
constexpr int kMaxTrimSplits = 12;

}  // namespace

/// Bounds the goal in the space of a frame cut, if there is one.
std::optional<Box> BoxContractor::reachThroughCut(const Goal& goal, const Box& box, int depth) {
    if (goal.id < 3 || isVariable(goal.id)) return box;
    const std::tuple key{goal.id, goal.above, goal.level};
    if (!frame.throughCuts.contains(key)) {
        const std::optional<Box> found = boundThroughCut(goal, depth);
        frame.throughCuts[key] = found;
    }
    const std::optional<Box>& known = frame.throughCuts[key];
    return known ? common(*known, box) : std::nullopt;
}

/// A box around all of space that meets the goal.
std::optional<Box> BoxContractor::boundThroughCut(const Goal& goal, int depth) {
    const std::vector<IrId> cone = coneOf(std::array{Constraint{goal.id, {}}});
    stepCount += 8 * cone.size();
    const std::vector<IrId> cut = frameCut(ir, cone, std::span(frame.variables).first(frame.count),
                                           [&](IrId id) { return isNumber(id); });
    if (cut.empty()) return kAllSpace;
    Frame inner;
    inner.count = cut.size();
    inner.isAtom = frame.isAtom;
    std::vector<Constraint> ranges;
    Box start{};
    setVariables(frame.limits);
    std::vector<Constraint> unconstrained;
    for (const IrId id : cut) unconstrained.push_back({id, kEverything});
    forwards(coneOf(unconstrained), false);
    for (std::size_t i = 0; i < cut.size(); ++i) {
        inner.variables[i] = cut[i];
        inner.isAtom[cut[i]] = true;
        inner.limits.lo[i] = current[cut[i]].lo, inner.limits.hi[i] = current[cut[i]].hi;
        start.lo[i] = everywhere[cut[i]].lo, start.hi[i] = everywhere[cut[i]].hi;
    }
    // The ranges over the current box are not valid in all of the cut's space.
    const uint32_t outerGeneration = std::exchange(rangeGeneration, 0u);
    std::swap(frame, inner);
    isThorough = false;
    std::optional<Box> found = reach(goal, start, depth + 1);
    isThorough = true;
    if (found && !isBounded(*found)) found = reach(goal, *found, depth + 1);
    std::swap(frame, inner);
    rangeGeneration = outerGeneration;
    if (!found) return std::nullopt;
    for (std::size_t i = 0; i < cut.size(); ++i) ranges.push_back({cut[i], sideOf(*found, i)});
    isThorough = false;
    found = propagate(std::move(ranges), kAllSpace, depth + 1);
    isThorough = true;
    return found;
}

/// Proves the shells around the origin free of the goal, from kFarthest inwards.
std::optional<Box> BoxContractor::reachFromOutside(const Goal& goal, const Box& box, int depth) {
    const std::tuple key{goal.id, goal.above, goal.level};
    if (!frame.fromOutside.contains(key)) {
        std::optional<Box> known = kAllSpace;
        // The search covers all of space, because its result is used for other boxes too.
        std::optional<Box> outer =
            propagate({{goal.id, wantedBy(goal.above, goal.level)}}, frame.limits, depth + 1, Effort::quick);
        shellLimit = stepCount + kShellSteps;
        double farthest = 0.0;
        for (std::size_t axis = 0; axis < frame.count; ++axis)
            farthest = std::max({farthest, -frame.limits.lo[axis], frame.limits.hi[axis]});
        bool isFree = !outer || !isSeenFarAway(goal, *outer);
        bool isBoundedByShells = !outer;
        for (double size = farthest / kShellRatio; isFree && outer && size > kSmallestShell;
             size /= kShellRatio) {
            const std::optional<Box> inner = common(*outer, cubeAround(size));
            if (inner == outer) continue;
            for (const Box& slab : boxesAround(*outer, inner))
                isFree = isFree && isUnreachable(goal, slab, kMaxShellSplits, depth);
            if (isFree) outer = inner, isBoundedByShells = true;
        }
        if (isBoundedByShells && outer) trim(goal, *outer, depth);
        if (isBoundedByShells) known = outer;
        frame.fromOutside[key] = known;
    }
    const std::optional<Box>& known = frame.fromOutside[key];
    return known ? common(*known, box) : std::nullopt;
}

/// Takes slabs off the box's faces in which the goal cannot be met.
void BoxContractor::trim(const Goal& goal, Box& box, int depth) {
    for (std::size_t axis = 0; axis < frame.count; ++axis)
        for (const bool isUpper : {false, true})
            for (double share = 0.5; share > kSmallestTrim; share *= 0.5) {
                shellLimit = stepCount + kTrimSteps;
                const double lo = box.lo[axis], hi = box.hi[axis],
                             at = std::lerp(lo, hi, isUpper ? 1.0 - share : share);
                Box slab = box;
                (isUpper ? slab.lo : slab.hi)[axis] = at;
                if (isUnreachable(goal, slab, kMaxTrimSplits, depth)) (isUpper ? box.hi : box.lo)[axis] = at;
            }
}

/// Whether the goal is met at some sample in the outermost shell.
bool BoxContractor::isSeenFarAway(const Goal& goal, const Box& box) {
    const std::vector<IrId> cone = coneOf(std::array{Constraint{goal.id, {}}});
    std::mt19937 random(1);
    const auto unit = [&] { return double(random() >> 8) / double(1 << 24); };
    for (int i = 0; i < kShellSamples; ++i) {
        Box point;
        for (std::size_t axis = 0; axis < frame.count; ++axis)
            point.lo[axis] = point.hi[axis] =
                std::lerp(box.lo[axis], box.hi[axis], i % 2 ? std::round(unit()) : unit());
        setVariables(point);
        forwards(cone, false);
        if (goal.above ? current[goal.id].hi >= goal.level : current[goal.id].lo <= goal.level) return true;
    }
    return false;
}

bool BoxContractor::isUnreachable(const Goal& goal, const Box& box, int splits, int depth) {
    const std::optional<Box> left =
        propagate({{goal.id, wantedBy(goal.above, goal.level)}}, box, depth + 1, Effort::quick);
    if (!left) return true;
    if (splits == 0 || stepCount > shellLimit || isSpent()) return false;
    for (const Box& half : halvesOf(*left))
        if (!isUnreachable(goal, half, splits - 1, depth)) return false;
    return true;
}

}  // namespace fw
