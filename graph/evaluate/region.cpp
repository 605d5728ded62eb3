#include "graph/evaluate/region.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <queue>
#include <random>
#include <utility>

namespace fw {

namespace {

struct Field {
    IrId root;
    Tape tape;
    double lipschitz;  ///< that cells are judged by, too; infinite: they are not
    TapeMachine<double> machine = {};
    std::size_t pointSteps = 0;  ///< of tapes, that were run for one point

    std::size_t steps() const { return machine.intervalSteps() + pointSteps; }
    bool positive(const Box& box) { return machine.interval(tape, box).lo >= 0.0; }
};

/// A tape is shortened if of so many steps one was decided.
constexpr std::size_t kWorthShortening = 16;

/// Of octrees, in metres: far enough from kFarthest that what repeats shows up again before it.
constexpr double kLeastReach = 2.0, kMostReach = kFarthest / 32.0;

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

/// What a search may take.
struct Budget {
    std::size_t looks;  ///< boxes that are looked at
    std::size_t steps;  ///< of tapes, on intervals and points
};

/// The cells of an octree that may hold some of the solid, looked at only where the hull hangs on them.
///
/// In a round those at the hull's faces are cut in halves, and what is provably empty is dropped. But a face
/// stays where it is as soon as one cell there is left: the others wait, and catch up on the rounds that they
/// have missed when that one is gone. The hulls are those of an octree that is looked at everywhere.
class Cells {
  public:
    Cells(Field& field_, const Box& start, const Budget& budget)
        : field(field_), lastLook(budget.looks), lastStep(field.steps() + budget.steps), hulls{start} {
        add(start, 0, std::make_shared<const Tape>(field.tape));
        for (std::size_t face = 0; face < faces.size(); ++face) enter(face, 0);
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
    bool canSplit() const { return looks + 2 <= lastLook && field.steps() < lastStep; }

  private:
    struct Cell {
        Box box;
        std::size_t rounds;                // that it is through
        std::shared_ptr<const Tape> tape;  // the field there; none once it is split
        std::size_t first = 0, last = 0;   // what is left of its halves then, from `first` to before `last`
    };

    /// Where the face is after this round, outwards; none if no cell is left.
    std::optional<double> settled(std::size_t face) {
        auto& queue = faces[face];
        while (!queue.empty()) {
            const auto [at, number] = queue.top();
            if (cells[number].tape) {
                std::size_t& rounds = cells[number].rounds;
                while (rounds < hulls.size() && !holdsUp(hulls[rounds], cells[number].box)) ++rounds;
                if (rounds == hulls.size() || !canSplit()) return at;
                split(number);
            }
            queue.pop();
            for (std::size_t half = cells[number].first; half < cells[number].last; ++half) enter(face, half);
        }
        return std::nullopt;
    }

    void split(std::size_t number) {
        const Box box = cells[number].box;
        const std::size_t rounds = cells[number].rounds + 1;
        const std::shared_ptr<const Tape> tape = std::exchange(cells[number].tape, nullptr);
        cells[number].first = cells.size();
        for (const Box& half : halves(box)) look(half, rounds, tape);
        cells[number].last = cells.size();
    }

    void look(const Box& box, std::size_t rounds, std::shared_ptr<const Tape> tape) {
        TapeMachine<double>& machine = field.machine;
        ++looks;
        if (farFromSurface(*tape, box) || machine.interval(*tape, box).lo >= 0.0) return;
        const bool jumps = machine.jumps();
        if (kWorthShortening * machine.decidedSteps() > tape->steps.size())
            tape = std::make_shared<const Tape>(machine.shortenedForSigns(*tape));
        if (!jumps || !machine.positiveInEachCase(*tape, box)) add(box, rounds, std::move(tape));
    }

    /// By the value in its middle.
    bool farFromSurface(const Tape& tape, const Box& box) {
        if (std::isinf(field.lipschitz)) return false;
        Point middle;
        double squared = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            middle[axis] = 0.5 * (box.lo[axis] + box.hi[axis]);
            squared += (box.hi[axis] - middle[axis]) * (box.hi[axis] - middle[axis]);
        }
        double value = 0.0;
        field.pointSteps += tape.steps.size();
        field.machine.evaluate(tape, std::span(&middle, 1), std::span(&value, 1));
        return value > field.lipschitz * std::sqrt(squared);
    }

    void add(const Box& box, std::size_t rounds, std::shared_ptr<const Tape> tape) {
        cells.push_back({box, rounds, std::move(tape)});
    }

    void enter(std::size_t face, std::size_t number) {
        const Box& box = cells[number].box;
        faces[face].emplace(face % 2 ? box.hi[face / 2] : -box.lo[face / 2], number);
    }

    Field& field;
    std::size_t looks = 0, lastLook, lastStep;
    std::vector<Box> hulls;  // before each round
    std::vector<Cell> cells;
    /// Cells by how far out they are at each of the hull's faces; of those at one place the last first, as it
    /// is through the most rounds. Halves take the place of their cell once it is the first.
    std::array<std::priority_queue<std::pair<double, std::size_t>>, 6> faces;
};

/// The hull of what is left of `start`; none if nothing is. Ends after `patience` rounds that did not move
/// the hull (three rounds halve the cells), or once the budget is spent, which `spent` is told.
std::optional<Box> shrink(Field& field, const Box& start, int patience, const Budget& budget,
                          bool* spent = nullptr) {
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
    if (spent) *spent = !cells.canSplit();
    return cells.hull();
}

bool touches(const Box& inner, const Box& outer) {
    for (int axis = 0; axis < 3; ++axis)
        if (inner.lo[axis] <= outer.lo[axis] || inner.hi[axis] >= outer.hi[axis]) return true;
    return false;
}

/// The farthest, by a coordinate, of sampled points beyond `box` that lie inside the solid: at distances
/// spread evenly over their logarithm. None if none does.
std::optional<double> reachBeyond(Field& field, const Box& box) {
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
    std::optional<double> farthest;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < 3 && values[i] < 0.0; ++axis)
            farthest = std::max(farthest.value_or(0.0), std::abs(points[i][axis]));
    return farthest;
}

/// From octrees that begin ever larger, from `reach` on; none if there is always something at their faces.
/// `budget` is for each, `most` the steps for all of them.
std::optional<Region> boundByCells(Field& field, double reach, const Budget& budget,
                                   std::size_t most = std::numeric_limits<std::size_t>::max()) {
    const std::size_t before = field.steps();
    for (; reach <= kMostReach; reach *= 4.0) {
        const Box start = everywhere(reach);
        const std::size_t left = most - std::min(most, field.steps() - before);
        const std::optional<Box> tight =
            shrink(field, start, 18, {budget.looks, std::min(budget.steps, left)});
        if (tight ? touches(*tight, start) : reach < kMostReach) continue;
        if (reachBeyond(field, tight.value_or(start))) continue;
        return tight ? Region{Extent::bounded, *tight} : Region{Extent::empty, {}};
    }
    return std::nullopt;
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

Region findRegion(const Ir& ir, IrId distance, std::span<const double> parameters, double lipschitz) {
    Field field{distance, makeTape(ir, distance, parameters), std::numeric_limits<double>::infinity()};
    if (field.positive(everywhere(kFarthest))) return {Extent::empty, {}};
    // Some 5 ms of interval arithmetic, more only where a field has tens of thousands of operations. Where
    // that is not enough some tenth of a second, and for long fields more only with their constant, which
    // gets further.
    constexpr std::size_t kLooks = 20'000, kSteps = 400'000, kPatience = 32;
    const Budget budget{kLooks, std::max(kSteps, 64 * field.tape.steps.size())};
    const Budget patient{kPatience * kLooks, std::isinf(lipschitz)
                                                 ? std::max(kPatience * kSteps, budget.steps)
                                                 : kPatience * budget.steps};
    bool spent = false;
    std::optional<Box> box = boundByHalfSpaces(field);
    if (box) {
        for (int axis = 0; axis < 3; ++axis)
            if (box->lo[axis] >= box->hi[axis]) return {Extent::empty, {}};
        const double before = longestSide(*box);
        box = shrink(field, *box, 12, budget, &spent);
        if (!box) return {Extent::empty, {}};
        // Half-spaces are tight but for what is turned.
        spent = spent && longestSide(*box) < 0.5 * before;
    } else if (const std::optional<Region> found = boundByCells(field, kLeastReach, budget)) {
        if (found->extent != Extent::bounded) return *found;
        box =
            shrink(field, found->box, 18, {4 * budget.looks, 4 * budget.steps}, &spent).value_or(found->box);
    } else {
        // From where samples say that nothing is beyond, with room to show it.
        const double seen = reachBeyond(field, everywhere(kLeastReach)).value_or(0.0);
        double reach = kLeastReach;
        while (reach < 2.0 * seen) reach *= 4.0;
        field.lipschitz = lipschitz;
        return boundByCells(field, reach, {patient.looks, patient.steps / 4}, patient.steps)
            .value_or(Region{Extent::unbounded, {}});
    }
    if (!spent) return {Extent::bounded, *box};
    field.lipschitz = lipschitz;
    const std::optional<Box> tight = shrink(field, *box, 18, patient);
    return tight ? Region{Extent::bounded, *tight} : Region{Extent::empty, {}};
}

Box padded(const Box& box, int resolution, double cells) {
    const double cell = longestSide(box) / std::max(resolution - 2.0 * cells, 1.0);
    Box result = box;
    for (int axis = 0; axis < 3; ++axis) result.lo[axis] -= cells * cell, result.hi[axis] += cells * cell;
    return result;
}

}  // namespace fw
