#include "graph/evaluate/region.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <random>
#include <utility>

namespace fw {

namespace {

struct Field {
    IrId root;
    Tape tape;
    TapeMachine<double> machine = {};

    bool positive(const Box& box) { return machine.interval(tape, box).lo >= 0.0; }
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
                return field.positive(half);
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

/// A cell that is at a face of the hull, so that the hull may shrink if the cell is split.
bool holdsUp(const Box& bound, const Box& cell) {
    for (int axis = 0; axis < 3; ++axis)
        if (cell.lo[axis] <= bound.lo[axis] || cell.hi[axis] >= bound.hi[axis]) return true;
    return false;
}

/// The cells of an octree that may hold some of the solid, looked at only where the hull hangs on them.
///
/// In a round those at the hull's faces are cut in halves, and what is provably empty is dropped. But a face
/// stays where it is as soon as one cell there is left: the others wait, and catch up on the rounds that they
/// have missed when that one is gone. The hulls are those of an octree that is looked at everywhere.
class Cells {
  public:
    Cells(Field& field_, const Box& start, std::size_t budget_)
        : field(field_), budget(budget_), hulls{start} {
        add(start, 0);
    }

    /// Another round; false if nothing is left.
    bool advance() {
        Box next = hull();
        for (std::size_t face = 0; face < faces.size(); ++face) {
            const std::optional<double> at = settled(face);
            if (!at) return false;
            (face % 2 ? next.hi : next.lo)[face / 2] = face % 2 ? *at : -*at;
        }
        hulls.push_back(next);
        return true;
    }
    const Box& hull() const { return hulls.back(); }
    bool canSplit() const { return budget >= 2; }
    std::size_t left() const { return budget; }

  private:
    struct Cell {
        Box box;
        std::size_t rounds;  // that it is through
        bool split = false;
    };

    /// Where the face is after this round, outwards; none if no cell is left.
    std::optional<double> settled(std::size_t face) {
        auto& queue = faces[face];
        while (!queue.empty()) {
            const auto [at, number] = queue.top();
            Cell& cell = cells[number];
            while (!cell.split && cell.rounds < hulls.size() && !holdsUp(hulls[cell.rounds], cell.box))
                ++cell.rounds;
            if (!cell.split && (cell.rounds == hulls.size() || !canSplit())) return at;
            queue.pop();
            if (std::exchange(cell.split, true)) continue;
            budget -= 2;
            const std::size_t rounds = cell.rounds + 1;
            for (const Box& half : halves(cell.box))
                if (!field.machine.outside(field.tape, half)) add(half, rounds);
        }
        return std::nullopt;
    }

    void add(const Box& box, std::size_t rounds) {
        for (std::size_t face = 0; face < faces.size(); ++face)
            faces[face].emplace(face % 2 ? box.hi[face / 2] : -box.lo[face / 2], cells.size());
        cells.push_back({box, rounds});
    }

    Field& field;
    std::size_t budget;
    std::vector<Box> hulls;  // before each round
    std::vector<Cell> cells;
    /// Cells by how far out they are at each of the hull's faces; of those at one place the last first, as it
    /// is through the most rounds.
    std::array<std::priority_queue<std::pair<double, std::size_t>>, 6> faces;
};

/// The hull of what is left of `start`; none if nothing is. Ends after `patience` rounds that did not move
/// the hull (three rounds halve the cells), or after `budget` interval evaluations.
std::optional<Box> shrink(Field& field, const Box& start, int patience, std::size_t budget) {
    Cells cells(field, start, budget);
    for (int idle = 0; idle < patience && cells.canSplit(); ++idle) {
        const Box before = cells.hull();
        if (!cells.advance()) return std::nullopt;
        const Box& smaller = cells.hull();
        for (int axis = 0; axis < 3; ++axis) {
            const double moved = smaller.lo[axis] - before.lo[axis] + before.hi[axis] - smaller.hi[axis];
            if (moved > 0.01 * longestSide(before)) idle = -1;
        }
    }
    return cells.hull();
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
    Field field{distance, makeTape(ir, distance, parameters)};
    if (field.positive(everywhere(kFarthest))) return {Extent::empty, {}};
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
