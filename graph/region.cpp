#include "graph/region.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace fw {

namespace {

struct Field {
    const Ir& ir;
    IrId root;
    std::span<const double> parameters;

    bool outside(const Box& box) const { return evaluateInterval(ir, root, parameters, box).lo > 0.0; }
};

Box everywhere(double reach) { return {{-reach, -reach, -reach}, {reach, reach, reach}}; }

/// The box bounded by empty half-spaces; none if some direction has no empty half-space.
std::optional<Box> boundByHalfSpaces(const Field& field) {
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

/// The hull of what an octree over `start` cannot prove empty, at most `budget` interval evaluations; none if
/// nothing is left.
std::optional<Box> shrink(const Field& field, const Box& start, std::size_t budget) {
    std::vector<Box> cells{start};
    std::optional<Box> bound = start;
    while (!cells.empty() && cells.size() * 8 <= budget) {
        budget -= cells.size() * 8;
        std::vector<Box> next;
        for (const Box& cell : cells)
            for (int octant = 0; octant < 8; ++octant) {
                Box child = cell;
                for (int axis = 0; axis < 3; ++axis) {
                    const double middle = 0.5 * (cell.lo[axis] + cell.hi[axis]);
                    (octant >> axis & 1 ? child.lo : child.hi)[axis] = middle;
                }
                if (!field.outside(child)) next.push_back(child);
            }
        cells = std::move(next);
        if (cells.empty()) return std::nullopt;
        bound = cells.front();
        for (const Box& cell : cells)
            for (int axis = 0; axis < 3; ++axis) {
                bound->lo[axis] = std::min(bound->lo[axis], cell.lo[axis]);
                bound->hi[axis] = std::max(bound->hi[axis], cell.hi[axis]);
            }
        // Cells well inside the hull no longer move it; keep the ones near its faces.
        std::erase_if(cells, [&](const Box& cell) {
            for (int axis = 0; axis < 3; ++axis) {
                const double size = cell.hi[axis] - cell.lo[axis];
                if (cell.lo[axis] < bound->lo[axis] + 0.5 * size ||
                    cell.hi[axis] > bound->hi[axis] - 0.5 * size)
                    return false;
            }
            return true;
        });
    }
    return bound;
}

bool touches(const Box& inner, const Box& outer) {
    for (int axis = 0; axis < 3; ++axis)
        if (inner.lo[axis] <= outer.lo[axis] || inner.hi[axis] >= outer.hi[axis]) return true;
    return false;
}

/// A sampled point beyond `box` lies inside the solid: at distances spread evenly over their logarithm.
bool reachesBeyond(const Field& field, const Box& box) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Point> points;
    double size = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        size = std::max({size, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
    for (int i = 0; i < 20'000; ++i) {
        const double reach = size * std::pow(kFarthest / size, unit(random));
        Point point;
        for (double& c : point) c = reach * (2.0 * unit(random) - 1.0);
        bool within = true;
        for (int axis = 0; axis < 3; ++axis)
            within &= point[axis] >= box.lo[axis] && point[axis] <= box.hi[axis];
        if (!within) points.push_back(point);
    }
    std::vector<double> values(points.size());
    evaluate(field.ir, field.root, field.parameters, points, values);
    return std::any_of(values.begin(), values.end(), [](double value) { return value < 0.0; });
}

}  // namespace

Region findRegion(const Ir& ir, IrId distance, std::span<const double> parameters) {
    const Field field{ir, distance, parameters};
    if (field.outside(everywhere(kFarthest))) return {Extent::empty, {}};
    // About 20 ms of interval arithmetic at most.
    const std::size_t budget = std::clamp<std::size_t>(2'000'000 / (distance + 1), 512, 20'000);
    if (const std::optional<Box> box = boundByHalfSpaces(field)) {
        const std::optional<Box> tight = shrink(field, *box, budget);
        return tight ? Region{Extent::bounded, *tight} : Region{Extent::empty, {}};
    }
    for (double reach = 2.0; reach <= kFarthest; reach *= 4.0) {
        const Box start = everywhere(reach);
        const std::optional<Box> tight = shrink(field, start, budget * 4);
        const Box found = tight.value_or(Box{});
        if (tight && touches(*tight, start)) continue;
        if (tight && !reachesBeyond(field, found)) return {Extent::bounded, found};
    }
    return {Extent::unbounded, {}};
}

Box padded(const Box& box, int resolution, double cells) {
    double longest = 0.0;
    for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, box.hi[axis] - box.lo[axis]);
    const double cell = longest / std::max(resolution - 2.0 * cells, 1.0);
    Box result = box;
    for (int axis = 0; axis < 3; ++axis) result.lo[axis] -= cells * cell, result.hi[axis] += cells * cell;
    return result;
}

}  // namespace fw
