#include "graph/bounds/hull_refinement.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace fw {

namespace {

/// Further ones follow where the hull stays larger than what samples show of the solid.
constexpr RefinementEffort kQuick{20'000, 120'000, 18, false}, kMany{100'000, 3'000'000, 18, false},
    kMedium{50'000, 1'000'000, 18, true}, kThorough{200'000, 12'000'000, 36, true};
constexpr std::size_t kSamples = 2048;
constexpr double kCloseRatio = 1.15, kFairRatio = 1.35, kFairSideRatio = 2.0;

/// A tape is simplified if at least one step in kWorthSimplifying was decided.
constexpr std::size_t kWorthSimplifying = 16;
/// A face is tight if it is closer to a point inside than this share of the hull's longest side.
constexpr double kTight = 0.004;
/// Bisections of the thickness of the empty slabs at a part's faces: to detect a slab, and to measure it.
constexpr int kShaveHalvings = 7, kPreciseHalvings = 22;

/// The hull may shrink if the cell is split.
bool touchesFace(const Box& hull, const Box& cell) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (cell.lo[axis] <= hull.lo[axis] || cell.hi[axis] >= hull.hi[axis]) return true;
    return false;
}

}  // namespace

HullRefinement::HullRefinement(const Ir& ir_, IrId root_, std::span<const double> parameters_,
                               double lipschitz_, BoxContractor& contractor_, std::stop_token stop_)
    : ir(ir_),
      root(root_),
      parameters(parameters_.begin(), parameters_.end()),
      lipschitz(lipschitz_),
      contractor(contractor_),
      stop(std::move(stop_)) {}

std::optional<Box> HullRefinement::refine(std::span<const BoxContractor::Part> parts) {
    if (parts.empty()) return std::nullopt;
    cellCount = 0;
    start(parts);
    if (!refine(kQuick)) return std::nullopt;
    Box found = hull();
    if (isSettled || isCloseToSamples(kCloseRatio, kFairSideRatio)) return found;
    // The Lipschitz constant makes cells cheap to test; without it, contracting them pays.
    if (std::isfinite(lipschitz)) {
        if (!refine(kMany)) return std::nullopt;
        found = hull();
        if (isSettled || isCloseToSamples(kFairRatio, kFairSideRatio)) return found;
    }
    for (const RefinementEffort& effort : {kMedium, kThorough}) {
        std::vector<BoxContractor::Part> tight;
        for (const BoxContractor::Part& part : parts) {
            const std::optional<Box> within = common(part.box, found);
            const std::optional<Box> box =
                within ? contractor.contractThoroughly(part.root, 0.0, *within) : std::nullopt;
            if (box) tight.push_back({part.root, *box});
        }
        if (tight.empty()) return std::nullopt;
        start(tight);
        if (!refine(effort)) return std::nullopt;
        const std::optional<Box> smaller = common(hull(), found);
        if (!smaller) return std::nullopt;
        found = *smaller;
        hulls.back() = found;
        if (isSettled || isCloseToSamples(kFairRatio, kFairSideRatio)) break;
    }
    return found;
}

void HullRefinement::start(std::span<const BoxContractor::Part> parts) {
    cells.clear(), faces = {}, isSettled = false;
    Box all = parts[0].box;
    for (const BoxContractor::Part& part : parts) {
        all = joined(all, part.box);
        cells.push_back({.box = part.box, .part = part.root});
    }
    hulls = {all};
    for (std::size_t face = 0; face < faces.size(); ++face)
        for (std::size_t number = 0; number < parts.size(); ++number) enter(face, number);
}

/// False if the solid is proven empty.
bool HullRefinement::refine(const RefinementEffort& effort) {
    isThorough = effort.isThorough;
    maxCells = cellCount + effort.cells, maxSteps = steps() + effort.steps;
    for (int idle = 0; idle < effort.patience && canSplit(); ++idle) {
        const Box before = hull();
        const std::size_t splitsBefore = splitCount;
        if (!advance()) return false;
        isSettled = splitCount == splitsBefore;
        if (isSettled) break;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double moved = hull().lo[axis] - before.lo[axis] + before.hi[axis] - hull().hi[axis];
            if (moved > 0.01 * longestSide(before)) idle = -1;
        }
    }
    return true;
}

bool HullRefinement::isCloseToSamples(double ratio, double sideRatio) {
    std::mt19937 random(1);
    std::vector<Point> points(kSamples);
    std::vector<double> values(kSamples);
    for (Point& point : points)
        for (std::size_t axis = 0; axis < 3; ++axis)
            point[axis] =
                std::lerp(hull().lo[axis], hull().hi[axis], double(random() >> 8) / double(1 << 24));
    machine.evaluate(wholeTape(), points, values);
    std::optional<Box> inner;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (values[i] < 0.0) joinInto(inner, Box{points[i], points[i]});
    if (!inner) return false;
    // The longest side determines the size of the grid's cells.
    if (longestSide(hull()) > ratio * longestSide(*inner)) return false;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (hull().hi[axis] - hull().lo[axis] > sideRatio * (inner->hi[axis] - inner->lo[axis])) return false;
    return true;
}

const Tape& HullRefinement::wholeTape() {
    if (!whole) whole = makeTape(ir, root, parameters);
    return *whole;
}

/// Another round. False if no cell is left.
bool HullRefinement::advance() {
    Box next = hull();
    for (std::size_t face = 0; face < faces.size(); ++face) {
        const std::optional<double> at = settle(face);
        if (!at) return false;
        (face % 2 ? next.hi : next.lo)[face / 2] = face % 2 ? *at : -*at;
    }
    hulls.push_back(next);
    return true;
}

/// Where the face is after this round, outwards; nothing if no cell is left.
std::optional<double> HullRefinement::settle(std::size_t face) {
    auto& queue = faces[face];
    while (!queue.empty()) {
        const auto [at, number] = queue.top();
        if (!cells[number].isSplit) {
            std::size_t& rounds = cells[number].rounds;
            while (rounds < hulls.size() && !touchesFace(hulls[rounds], cells[number].box)) ++rounds;
            if (rounds == hulls.size() || !canSplit() || isTight(face / 2, cells[number])) return at;
            split(number);
        }
        queue.pop();
        for (std::size_t half = cells[number].first; half < cells[number].last; ++half) enter(face, half);
    }
    return std::nullopt;
}

/// Whether the cell cannot go, because its centre is inside the solid, and is thin enough along the axis.
bool HullRefinement::isTight(std::size_t axis, Cell& cell) {
    if (!cell.tape || cell.box.hi[axis] - cell.box.lo[axis] > kTight * longestSide(hull())) return false;
    if (cell.centre == Cell::Centre::unknown) {
        const Point centre = centreOf(cell.box);
        double value = 0.0;
        pointSteps += cell.tape->steps.size();
        machine.evaluate(*cell.tape, std::span(&centre, 1), std::span(&value, 1));
        cell.centre = value < 0.0 ? Cell::Centre::inside : Cell::Centre::outside;
    }
    return cell.centre == Cell::Centre::inside;
}

void HullRefinement::split(std::size_t number) {
    Cell cell = cells[number];
    cell.centre = Cell::Centre::unknown;
    ++splitCount;
    cells[number].tape = nullptr;
    cells[number].isSplit = true;
    cells[number].first = cells.size();
    if (!cell.tape) {
        shave(cell);
    } else {
        ++cell.rounds;
        for (const Box& half : halvesOf(cell.box)) {
            cell.box = half;
            test(cell);
        }
    }
    cells[number].last = cells.size();
}

/// Gives a part its tape, and replaces it by the rest of it after slabs at its faces that are empty.
void HullRefinement::shave(Cell cell) {
    cell.tape = std::make_shared<const Tape>(makeTape(ir, cell.part, parameters));
    cell.isDefined = !contractor.mayBeUndefined(cell.part);
    if (!cell.isDefined) {
        cells.push_back(std::move(cell));
        return;
    }
    if (machine.interval(*cell.tape, cell.box).lo >= 0.0) return;
    if (kWorthSimplifying * machine.decidedSteps() > cell.tape->steps.size())
        cell.tape = std::make_shared<const Tape>(machine.shortenedForSigns(*cell.tape));
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool isUpper : {false, true}) {
            const double lo = cell.box.lo[axis], hi = cell.box.hi[axis];
            double empty = 0.0, unknown = 1.0;
            for (int halving = 0; halving < (empty > 0.0 ? kPreciseHalvings : kShaveHalvings); ++halving) {
                const double share = 0.5 * (empty + unknown);
                Box slab = cell.box;
                (isUpper ? slab.lo : slab.hi)[axis] = std::lerp(lo, hi, isUpper ? 1.0 - share : share);
                (machine.interval(*cell.tape, slab).lo >= 0.0 ? empty : unknown) = share;
            }
            (isUpper ? cell.box.hi : cell.box.lo)[axis] = std::lerp(lo, hi, isUpper ? 1.0 - empty : empty);
        }
    cells.push_back(std::move(cell));
}

/// Keeps the cell unless it is empty.
void HullRefinement::test(Cell cell) {
    ++cellCount;
    if (cell.isDefined) {
        if (machine.interval(*cell.tape, cell.box).lo >= 0.0) return;
        const bool jumps = machine.jumps();
        if (kWorthSimplifying * machine.decidedSteps() > cell.tape->steps.size())
            cell.tape = std::make_shared<const Tape>(machine.shortenedForSigns(*cell.tape));
        if (jumps && machine.positiveInEachCase(*cell.tape, cell.box)) return;
    }
    if (std::isfinite(lipschitz)) {
        pointSteps += wholeTape().steps.size();
        if (isProvenOutside(machine, wholeTape(), cell.box, lipschitz)) return;
    }
    if (isThorough || !cell.isDefined) {
        const std::size_t before = contractor.steps();
        const std::optional<Box> box = contractor.contract(cell.part, 0.0, cell.box);
        pointSteps += contractor.steps() - before;
        if (!box) return;
        cell.box = *box;
        pointSteps += 4 * cell.tape->steps.size();
        if (cell.isDefined && gradients.meanValue(*cell.tape, cell.box).lo >= 0.0) return;
    }
    cells.push_back(std::move(cell));
}

bool isProvenOutside(TapeMachine<double>& machine, const Tape& tape, const Box& box, double lipschitz) {
    if (std::isinf(lipschitz)) return false;
    const Point centre = centreOf(box);
    double squared = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        squared += (box.hi[axis] - centre[axis]) * (box.hi[axis] - centre[axis]);
    double value = 0.0;
    machine.evaluate(tape, std::span(&centre, 1), std::span(&value, 1));
    return value > lipschitz * std::sqrt(squared) * (1.0 + 1e-9);
}

void HullRefinement::enter(std::size_t face, std::size_t number) {
    const Box& box = cells[number].box;
    faces[face].emplace(face % 2 ? box.hi[face / 2] : -box.lo[face / 2], number);
}

}  // namespace fw
