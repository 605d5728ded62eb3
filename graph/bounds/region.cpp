#include "graph/bounds/region.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "graph/bounds/box_contractor.h"
#include "graph/bounds/hull_refinement.h"

namespace fw {

namespace {

constexpr double kPartShellRatio = 4.0;                // of a shell's outer and inner size
constexpr double kFirstPartShell = 0.875 * kFarthest;  // inner size of the first one
constexpr double kSmallestPartShell = 1.0 / 1024.0;
constexpr int kMaxPartSplits = 24;
constexpr std::size_t kPartSteps = 300'000;  // of operations on intervals, for one part
constexpr std::size_t kContractionSteps = 12'000'000, kFirstExhaustiveSteps = 800'000,
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

    /// The part's region within `box`.
    Region bound(IrId part, const Box& box) {
        std::optional<Box> outer = common(box, cubeAround(kFarthest));
        if (!outer) return {Extent::empty, {}, {}};
        if (!std::isfinite(lipschitz)) tape = makeTape(ir, part, parameters);
        if (reachesTo(*outer)) return {Extent::unbounded, {}, *outer};
        std::vector<double> sizes{kFirstPartShell};
        for (double size = kFarthest / kPartShellRatio; size > kSmallestPartShell; size /= kPartShellRatio)
            sizes.push_back(size);
        for (const double size : sizes) {
            const std::optional<Box> inner = common(*outer, cubeAround(size));
            if (inner == outer) continue;
            const std::size_t limit = contractor.steps() + pointSteps + kPartSteps;
            std::optional<Box> left;
            for (const Box& slab : boxesAround(*outer, inner))
                if (!isEmpty(part, slab, limit, kMaxPartSplits, left)) break;
            if (left && size == kFirstPartShell) return {Extent::unproven, *outer, *left};
            if (left) return {Extent::bounded, *outer, {}};
            if (!inner) return {Extent::empty, {}, {}};
            outer = contractor.contract(part, 0.0, *inner);
            if (!outer) return {Extent::empty, {}, {}};
        }
        return {Extent::bounded, *outer, {}};
    }

  private:
    /// Whether samples find solid in the outer half of the box.
    bool reachesTo(const Box& box) {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        std::vector<Point> points(1024);
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
        std::vector<double> values(points.size());
        machine.evaluate(tape, points, values);
        return std::ranges::any_of(values, [](double value) { return value < 0.0; });
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
    const auto bound = [&](const BoxContractor::Part& part) -> Region {
        const auto exhaustively = [&](std::size_t steps) -> Region {
            const std::optional<Box> box = contractor.contractExhaustively(part.root, 0.0, part.box, steps);
            if (!box) return {Extent::empty, {}, {}};
            return {isBounded(*box) ? Extent::bounded : Extent::unproven, *box, {}};
        };
        Region region = exhaustively(kFirstExhaustiveSteps);
        if (region.extent != Extent::unproven) return region;
        if (!shells) shells.emplace(ir, distance, parameters, lipschitz, contractor, stop);
        region = shells->bound(part.root, part.box);
        if (region.extent != Extent::unproven) return region;
        const Region last = exhaustively(kExhaustiveSteps);
        return last.extent == Extent::unproven ? region : last;
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
