// The search by which BoxContractor bounds goals that their expression alone does not: shell by shell from
// outside.
#include <algorithm>
#include <cmath>
#include <random>

#include "graph/bounds/box_contractor.h"

namespace fw {

namespace {

constexpr std::size_t kShellSteps = 300'000;
constexpr int kMaxShellSplits = 24, kShellSamples = 64;
constexpr double kNearestSample = 1e-3, kFarEnd = 0.25;
constexpr double kSmallestTrim = 1.0 / 32.0;  // of a box's side
constexpr std::size_t kTrimSteps = 20'000;
constexpr int kMaxTrimSplits = 12;

}  // namespace

/// Proves the shells around the origin free of the goal, from kFarthest inwards.
std::optional<Box> BoxContractor::reachFromOutside(const Goal& goal, const Box& box, int depth) {
    return once(frame->fromOutside, goal, 0, box, [&] { return boundFromOutside(goal, depth); });
}

std::optional<Box> BoxContractor::boundFromOutside(const Goal& goal, int depth) {
    std::optional<Box> outer =
        propagate({{goal.id, wantedBy(goal.above, goal.level)}}, limits(), depth + 1, Effort::quick);
    if (!outer) return std::nullopt;
    if (isSeenFarAway(goal, *outer, kShellSamples)) return kAllSpace;
    shellLimit = stepCount + kShellSteps;
    bool isFound = false, isFree = true;
    for (std::size_t i = 1; isFree && outer && i < frame->shells.size(); ++i) {
        const std::optional<Box> inner = common(*outer, frame->shells[i]);
        if (inner == outer) continue;
        for (const Box& slab : boxesAround(*outer, inner))
            isFree = isFree && isUnreachable(goal, slab, kMaxShellSplits, depth);
        if (isFree) outer = inner, isFound = true;
    }
    if (!isFound) return kAllSpace;
    if (outer) trim(goal, *outer, depth);
    // Other cuts may bound the goal better.
    const Box& far = frame->shells[farShell];
    if (!isFree && outer && joined(*outer, far) != far) return kAllSpace;
    if (outer) extendToLimits(*outer);
    return outer;
}

/// Opens the sides of a box that are where the search began.
void BoxContractor::extendToLimits(Box& box) const {
    const Box ranges = rangesOfVariables();
    for (std::size_t i = 0; i < frame->count; ++i) {
        if (box.lo[i] <= limits().lo[i]) box.lo[i] = ranges.lo[i];
        if (box.hi[i] >= limits().hi[i]) box.hi[i] = ranges.hi[i];
    }
}

/// Takes slabs off the box's faces in which the goal cannot be met.
void BoxContractor::trim(const Goal& goal, Box& box, int depth) {
    for (std::size_t axis = 0; axis < frame->count; ++axis)
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

/// Whether the goal is met at some sample far away within `box`: one of the variables that the goal reads is
/// far, the others have any magnitude.
bool BoxContractor::isSeenFarAway(const Goal& goal, const Box& box, int samples) {
    const std::vector<IrId> cone = coneOf(std::array{Constraint{goal.id, {}}});
    std::vector<std::size_t> read;
    for (std::size_t i = 0; i < frame->count; ++i)
        if (std::ranges::any_of(cone, [&](IrId id) {
                return std::ranges::count(dependenciesOf(id), frame->variables[i]) > 0;
            }))
            read.push_back(i);
    if (read.empty()) return false;
    std::mt19937 random(1);
    const auto unit = [&] { return double(random() >> 8) / double(1 << 24); };
    for (int n = 0; n < samples; ++n) {
        Box point{};
        for (const std::size_t i : read) {
            const double farthest = random() & 1 ? box.lo[i] : box.hi[i];
            const double magnitude = std::pow(std::max(std::abs(farthest), 1.0) / kNearestSample, unit());
            const double value = std::copysign(kNearestSample * magnitude, farthest);
            point.lo[i] = point.hi[i] = std::clamp(value, box.lo[i], box.hi[i]);
        }
        const std::size_t i = read[std::size_t(n) % read.size()];
        const double below = std::abs(box.lo[i]), above = std::abs(box.hi[i]);
        const bool isBelow =
            std::min(below, above) < kFarEnd * std::max(below, above) ? below > above : random() & 1;
        point.lo[i] = point.hi[i] = (isBelow ? box.lo[i] : box.hi[i]) * (0.5 + 0.5 * unit());
        setVariables(point);
        forwards(cone, false);
        if (goal.above ? current[goal.id].hi >= goal.level : current[goal.id].lo <= goal.level) return true;
    }
    return false;
}

/// The halves of a box whose sides are measured by those of the frame's limits.
std::array<Box, 2> BoxContractor::halvesInFrame(const Box& box) const {
    std::size_t longest = 0;
    double longestShare = -1.0;
    for (std::size_t i = 0; i < frame->count; ++i) {
        const double side = box.hi[i] - box.lo[i], whole = limits().hi[i] - limits().lo[i];
        if (whole > 0.0 && side / whole > longestShare) longest = i, longestShare = side / whole;
    }
    std::array<Box, 2> halves = {box, box};
    halves[0].hi[longest] = halves[1].lo[longest] = 0.5 * (box.lo[longest] + box.hi[longest]);
    return halves;
}

bool BoxContractor::isUnreachable(const Goal& goal, const Box& box, int splits, int depth) {
    const std::optional<Box> left =
        propagate({{goal.id, wantedBy(goal.above, goal.level)}}, box, depth + 1, Effort::quick);
    if (!left) return true;
    if (splits == 0 || stepCount > shellLimit || isSpent()) return false;
    for (const Box& half : halvesInFrame(*left))
        if (!isUnreachable(goal, half, splits - 1, depth)) return false;
    return true;
}

}  // namespace fw
