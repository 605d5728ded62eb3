#include "graph/evaluate/region.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "graph/evaluate/jump_cases.h"

namespace fw {

namespace {

struct Field {
    IrId root;
    Tape tape;
    JumpCases jumps;
    TapeMachine<double> machine = {};

    bool outside(const Box& box) { return machine.interval(tape, box).lo >= 0.0; }
    /// The same, also where the field jumps within the box.
    bool outsideInEachCase(const Box& box) { return outside(box) || jumps.outsideInEachCase(box); }
};

Box everywhere(double reach) { return {{-reach, -reach, -reach}, {reach, reach, reach}}; }

/// The box bounded by empty half-spaces; none if some direction has no empty half-space.
std::optional<Box> boundByHalfSpaces(Field& field) {
    Box box = everywhere(kFarthest);
    for (int axis = 0; axis < 3; ++axis)
        for (int side : {-1, 1}) {
            const auto empty = [&](double at) {
                Box half = everywhere(kFarthest);
                (side > 0 ? half.lo : half.hi)[axis] = side * at;
                return field.outside(half);
            };
            if (!empty(kFarthest * 0.999)) return std::nullopt;
            // `solid` is the farthest plane known to have something beyond it, `clear` one with nothing
            // beyond.
            double solid = -kFarthest, clear = kFarthest * 0.999;
            for (double reach = 1.0 / 64.0; reach < clear; reach *= 2.0)
                if (empty(reach)) clear = reach;
            if (clear > 1.0 / 64.0)
                solid = clear / 2.0;
            else
                for (double reach = 1.0 / 64.0; reach < kFarthest; reach *= 2.0) {
                    if (!empty(-reach)) {
                        solid = -reach;
                        break;
                    }
                    clear = -reach;
                }
            for (int step = 0; step < 24; ++step) {
                const double middle = 0.5 * (solid + clear);
                (empty(middle) ? clear : solid) = middle;
            }
            (side > 0 ? box.hi : box.lo)[axis] = side * clear;
        }
    return box;
}

/// The two halves of `cell` across its longest axis.
std::array<Box, 2> halves(const Box& cell) {
    int axis = 0;
    for (int other : {1, 2})
        if (cell.hi[other] - cell.lo[other] > cell.hi[axis] - cell.lo[axis]) axis = other;
    std::array<Box, 2> result = {cell, cell};
    result[0].hi[axis] = result[1].lo[axis] = 0.5 * (cell.lo[axis] + cell.hi[axis]);
    return result;
}

Box hull(const std::vector<Box>& cells) {
    Box bound = cells.front();
    for (const Box& cell : cells)
        for (int axis = 0; axis < 3; ++axis) {
            bound.lo[axis] = std::min(bound.lo[axis], cell.lo[axis]);
            bound.hi[axis] = std::max(bound.hi[axis], cell.hi[axis]);
        }
    return bound;
}

/// A cell that is at a face of the hull, so that the hull may shrink if the cell is split.
bool holdsUp(const Box& bound, const Box& cell) {
    for (int axis = 0; axis < 3; ++axis)
        if (cell.lo[axis] <= bound.lo[axis] || cell.hi[axis] >= bound.hi[axis]) return true;
    return false;
}

/// The hull of what is left of `start` when cells that are provably empty are dropped and those at the hull's
/// faces are split, round by round; none if nothing is left. Ends after `patience` rounds that did not move
/// the hull (three rounds halve the cells), or after `budget` interval evaluations.
std::optional<Box> shrink(Field& field, const Box& start, int patience, std::size_t budget) {
    std::vector<Box> cells{start};
    Box bound = start;
    for (int idle = 0; idle < patience && budget >= 2; ++idle) {
        std::vector<Box> next;
        for (const Box& cell : cells) {
            if (!holdsUp(bound, cell) || budget < 2) {
                next.push_back(cell);
                continue;
            }
            budget -= 2;
            for (const Box& half : halves(cell))
                if (!field.outsideInEachCase(half)) next.push_back(half);
        }
        if (next.empty()) return std::nullopt;
        cells = std::move(next);
        const Box smaller = hull(cells);
        for (int axis = 0; axis < 3; ++axis) {
            const double moved = smaller.lo[axis] - bound.lo[axis] + bound.hi[axis] - smaller.hi[axis];
            if (moved > 0.01 * longestSide(bound)) idle = -1;
        }
        bound = smaller;
    }
    return bound;
}

bool touches(const Box& inner, const Box& outer) {
    for (int axis = 0; axis < 3; ++axis)
        if (inner.lo[axis] <= outer.lo[axis] || inner.hi[axis] >= outer.hi[axis]) return true;
    return false;
}

/// A sampled point beyond `box` lies inside the solid: at distances spread evenly over their logarithm.
bool reachesBeyond(Field& field, const Box& box) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Point> points;
    double size = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        size = std::max({size, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
    const std::size_t samples = std::clamp<std::size_t>(20'000'000 / (field.root + 1), 500, 20'000);
    for (std::size_t i = 0; i < samples; ++i) {
        const double reach = size * std::pow(kFarthest / size, unit(random));
        // Copies may run along a line or a plane: a random set of axes is left at the box.
        const unsigned displaced = 1 + random() % 7;
        Point point;
        for (int axis = 0; axis < 3; ++axis) {
            point[axis] = box.lo[axis] + unit(random) * (box.hi[axis] - box.lo[axis]);
            if (displaced >> axis & 1) point[axis] = reach * (2.0 * unit(random) - 1.0);
        }
        bool within = true;
        for (int axis = 0; axis < 3; ++axis)
            within &= point[axis] >= box.lo[axis] && point[axis] <= box.hi[axis];
        if (!within) points.push_back(point);
    }
    std::vector<double> values(points.size());
    field.machine.evaluate(field.tape, points, values);
    return std::any_of(values.begin(), values.end(), [](double value) { return value < 0.0; });
}

}  // namespace

Box joined(const Box& a, const Box& b) {
    Box box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(a.lo[axis], b.lo[axis]);
        box.hi[axis] = std::max(a.hi[axis], b.hi[axis]);
    }
    return box;
}

double longestSide(const Box& box) {
    return std::max({0.0, box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
}

Region findRegion(const Ir& ir, IrId distance, std::span<const double> parameters) {
    Field field{distance, makeTape(ir, distance, parameters), JumpCases(ir, distance, parameters)};
    if (field.outside(everywhere(kFarthest))) return {Extent::empty, {}};
    // About 20 ms of interval arithmetic, more only where a field has tens of thousands of operations.
    const std::size_t budget = std::clamp<std::size_t>(2'000'000 / (distance + 1), 64, 20'000);
    if (const std::optional<Box> box = boundByHalfSpaces(field)) {
        for (int axis = 0; axis < 3; ++axis)
            if (box->lo[axis] >= box->hi[axis]) return {Extent::empty, {}};
        const std::optional<Box> tight = shrink(field, *box, 12, budget);
        return tight ? Region{Extent::bounded, *tight} : Region{Extent::empty, {}};
    }
    // Far enough from kFarthest that what repeats shows up again before it.
    constexpr double kMostReach = kFarthest / 32.0;
    for (double reach = 2.0; reach <= kMostReach; reach *= 4.0) {
        const Box start = everywhere(reach);
        const std::optional<Box> tight = shrink(field, start, 18, budget);
        if (tight ? touches(*tight, start) : reach < kMostReach) continue;
        if (reachesBeyond(field, tight.value_or(start))) continue;
        if (!tight) return {Extent::empty, {}};
        return {Extent::bounded, shrink(field, *tight, 18, 4 * budget).value_or(*tight)};
    }
    return {Extent::unbounded, {}};
}

Box padded(const Box& box, int resolution, double cells) {
    const double cell = longestSide(box) / std::max(resolution - 2.0 * cells, 1.0);
    Box result = box;
    for (int axis = 0; axis < 3; ++axis) result.lo[axis] -= cells * cell, result.hi[axis] += cells * cell;
    return result;
}

}  // namespace fw
