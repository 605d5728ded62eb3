#include "graph/bounds/region.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "graph/bounds/box_contractor.h"
#include "graph/bounds/hull_refinement.h"

namespace fw {

namespace {

constexpr double kLargestRatio = 64.0;  // of an incomplete region's sides and those of samples of the solid
constexpr std::size_t kPartSamples = 1024;
constexpr int kMaxPartSplits = 24;
constexpr std::size_t kPartSteps = 300'000;  // of operations on intervals, for one part
constexpr std::size_t kContractionSteps = 15'000'000, kFirstExhaustiveSteps = 800'000,
                      kExhaustiveSteps = 7'000'000;

/// Bounds a part that the contractor alone does not bound.
class ShellSearch {
  public:
    ShellSearch(const Ir& ir_, IrId root, std::span<const double> parameters_, double lipschitz_,
                BoxContractor& contractor_, std::stop_token stop_)
        : ir(ir_),
          parameters(parameters_),
          tape(makeTape(ir, root, parameters)),
          lipschitz(lipschitz_),
          contractor(contractor_),
          stop(std::move(stop_)) {}

    /// The part's region within `box`. Where a shell is not proven empty it is the box around that.
    Region bound(IrId part, const Box& box) {
        isComplete = true;
        std::optional<Box> outer = common(box, cubeAround(kFarthest));
        if (!outer) return {Extent::empty, {}, {}};
        prepare(part);
        const Box inHalf = cubeAround(0.5 * kFarthest);
        if (joined(*outer, inHalf) != inHalf && reachesTo(*outer)) return {Extent::unbounded, {}, *outer};
        const std::vector<double> sizes = shellSizes();
        for (std::size_t i = 1; i < sizes.size(); ++i) {
            const std::optional<Box> inner = common(*outer, cubeAround(sizes[i]));
            if (inner == outer) continue;
            const std::size_t limit = contractor.steps() + pointSteps + kPartSteps;
            std::optional<Box> left;
            for (const Box& slab : boxesAround(*outer, inner))
                if (!isEmpty(part, slab, limit, kMaxPartSplits, left)) break;
            isComplete = !left;
            if (left) return {i == 1 ? Extent::unproven : Extent::bounded, *outer, *left};
            if (!inner) return {Extent::empty, {}, {}};
            outer = contractor.contract(part, 0.0, *inner);
            if (!outer) return {Extent::empty, {}, {}};
        }
        return {Extent::bounded, *outer, {}};
    }

    /// Whether samples within the box find the part.
    bool isHit(IrId part, const Box& box) {
        prepare(part);
        std::mt19937 random(1);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        std::vector<Point> points(kPartSamples);
        for (Point& point : points)
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] = std::lerp(box.lo[axis], box.hi[axis], unit(random));
        return anyInside(points);
    }

    /// Whether the last part's region is bounded by its solid, not only by the work that was done.
    bool isComplete = true;

  private:
    /// Whether samples find solid in the outer half of the box.
    bool reachesTo(const Box& box) {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        std::vector<Point> points(kPartSamples);
        for (Point& point : points) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] = std::lerp(box.lo[axis], box.hi[axis], unit(random));
            // At least one coordinate of an unbounded side is in its outer half.
            for (std::size_t axis = random() % 3, tries = 0; tries < 3; axis = (axis + 1) % 3, ++tries)
                if (std::max(-box.lo[axis], box.hi[axis]) >= kFarthest) {
                    const double sign =
                        box.hi[axis] < kFarthest || (box.lo[axis] <= -kFarthest && random() & 1) ? -1.0 : 1.0;
                    point[axis] = sign * kFarthest * (0.5 + 0.5 * unit(random));
                    break;
                }
        }
        return anyInside(points);
    }
    bool anyInside(std::span<const Point> points) {
        std::vector<double> values(points.size());
        machine.evaluate(tape, points, values);
        return std::ranges::any_of(values, [](double value) { return value < 0.0; });
    }
    void prepare(IrId part) {
        if (!std::isfinite(lipschitz)) tape = makeTape(ir, part, parameters);
    }

    /// Proves that the part has nothing within the box; else `left` is a box where it may have something.
    bool isEmpty(IrId part, const Box& whole, std::size_t limit, int splits, std::optional<Box>& left) {
        if (std::isfinite(lipschitz)) pointSteps += tape.steps.size();
        if (isProvenOutside(machine, tape, whole, lipschitz)) return true;
        const std::optional<Box> box = contractor.contract(part, 0.0, whole);
        if (!box) return true;
        if (splits == 0 || contractor.steps() + pointSteps > limit || stop.stop_requested()) {
            left = box;
            return false;
        }
        for (const Box& half : halvesOf(*box))
            if (!isEmpty(part, half, limit, splits - 1, left)) return false;
        return true;
    }

    const Ir& ir;
    std::span<const double> parameters;
    Tape tape;  ///< of the whole solid if it has a Lipschitz constant, else of the part
    double lipschitz;
    BoxContractor& contractor;
    std::stop_token stop;
    TapeMachine<double> machine;
    std::size_t pointSteps = 0;
};

}  // namespace

Region findRegion(const Ir& ir, IrId distance, std::span<const double> parameters, double lipschitz,
                  std::stop_token stop) {
    std::vector<Interval> values;
    for (const double value : parameters) values.push_back({value, value});
    BoxContractor contractor(ir, values);
    contractor.setLimit(kContractionSteps);
    contractor.setStop(stop);
    std::vector<BoxContractor::Part> parts = contractor.parts(distance);
    std::optional<ShellSearch> shells;
    double loosest = 0.0;  // longest side of the regions that are incomplete
    Box unproven{};        // in the last one
    const auto bound = [&](const BoxContractor::Part& part) -> Region {
        const auto exhaustively = [&](std::size_t steps) -> Region {
            const std::optional<Box> box = contractor.contractExhaustively(part.root, 0.0, part.box, steps);
            if (!box) return {Extent::empty, {}, {}};
            return {isBounded(*box) ? Extent::bounded : Extent::unproven, *box, {}};
        };
        const Region first = exhaustively(kFirstExhaustiveSteps);
        if (first.extent == Extent::empty) return first;
        if (!shells) shells.emplace(ir, distance, parameters, lipschitz, contractor, stop);
        if (first.extent == Extent::bounded && shells->isHit(part.root, first.box)) return first;
        Region region = shells->bound(part.root, first.box);
        if (shells->isComplete) return region;
        if (first.extent == Extent::bounded) return region.extent == Extent::unproven ? first : region;
        const Region last = exhaustively(kExhaustiveSteps);
        if (last.extent != Extent::unproven) return last;
        if (region.extent == Extent::bounded) {
            loosest = std::max(loosest, longestSide(region.box));
            unproven = std::exchange(region.unproven, {});
        }
        return region;
    };
    for (std::size_t i = 0; i < parts.size();) {
        const Region region =
            isBounded(parts[i].box) ? Region{Extent::bounded, parts[i].box, {}} : bound(parts[i]);
        if (region.extent == Extent::unbounded || region.extent == Extent::unproven) return region;
        if (region.extent == Extent::empty)
            parts.erase(parts.begin() + std::ptrdiff_t(i));
        else
            parts[i++].box = region.box;
    }
    // A solid is an open set: a box without thickness holds none.
    std::erase_if(parts, [](const BoxContractor::Part& part) { return isFlat(part.box); });
    if (parts.empty()) return {Extent::empty, {}, {}};
    HullRefinement refinement(ir, distance, parameters, lipschitz, contractor, stop);
    const std::optional<Box> box = refinement.refine(parts);
    if (stop.stop_requested()) return {Extent::unproven, cubeAround(kFarthest), cubeAround(kFarthest)};
    // A region that is large only for want of proof would hide the solid in one of its cells.
    if (box && loosest > kFarShell && !refinement.isCloseToSamples(kLargestRatio, kLargestRatio))
        return {Extent::unproven, *box, unproven};
    return box ? Region{Extent::bounded, *box, {}} : Region{Extent::empty, {}, {}};
}

Box padded(const Box& box, int resolution, double cells) {
    const double cell = longestSide(box) / std::max(resolution - 2.0 * cells, 1.0);
    Box result = box;
    for (std::size_t axis = 0; axis < 3; ++axis)
        result.lo[axis] -= cells * cell, result.hi[axis] += cells * cell;
    return result;
}

}  // namespace fw
