#include "graph/compile/moving_region.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "graph/bounds/box_contractor.h"

namespace fw {

namespace {

constexpr int kMaxTimeHalvings = 4, kMaxBoxHalvings = 9;
constexpr double kMaxGrowth = 1.5;                   ///< of the hull's longest side, by one box
constexpr double kMargin = 1e-9;                     ///< of the hull's size, that counts as inside it
constexpr std::size_t kStepsOfInterval = 1'000'000;  ///< of a contractor, between two moments

/// Proves that the solid stays within a hull between two times, or enlarges the hull.
class MotionProof {
  public:
    MotionProof(const LiveProgram& live_, std::optional<Box>& hull_, std::stop_token stop_)
        : live(live_), hull(hull_), stop(std::move(stop_)) {}

    /// False if what may be outside the hull is unbounded, or far larger than it.
    bool prove(double from, double to) {
        stepsLeft = kStepsOfInterval;
        isBoundedBetween = true;
        prove(from, to, spaceOutside(), kMaxTimeHalvings);
        return isBoundedBetween;
    }

  private:
    std::vector<Box> spaceOutside() const {
        if (!hull) return {kAllSpace};
        Box inner = *hull;
        const double margin = kMargin * longestSide(inner);
        for (std::size_t axis = 0; axis < 3; ++axis) inner.lo[axis] -= margin, inner.hi[axis] += margin;
        return boxesAround(kAllSpace, inner);
    }

    void prove(double from, double to, const std::vector<Box>& boxes, int halvings) {
        BoxContractor contractor(live.program.ir, live.rangesBetween(from, to));
        contractor.setLimit(stepsLeft);
        std::vector<Box> left;
        for (const Box& box : boxes)
            if (const std::optional<Box> rest = contractor.contract(live.program.distance(), 0.0, box))
                left.push_back(*rest);
        if (left.empty()) return take(contractor);
        if (halvings > 0 && !stop.stop_requested() && contractor.steps() < stepsLeft) {
            take(contractor);
            const double middle = 0.5 * (from + to);
            prove(from, middle, left, halvings - 1);
            prove(middle, to, left, halvings - 1);
            return;
        }
        for (const Box& box : left) split(contractor, box, kMaxBoxHalvings);
        take(contractor);
    }

    void split(BoxContractor& contractor, const Box& box, int halvings) {
        const std::optional<Box> rest = contractor.contract(live.program.distance(), 0.0, box);
        // A solid is an open set: a box without thickness holds none.
        if (!rest || isFlat(*rest) || (hull && joined(*hull, *rest) == *hull)) return;
        if (!isBounded(*rest)) {
            isBoundedBetween = false;
            return;
        }
        if (halvings == 0 || stop.stop_requested() || contractor.steps() >= stepsLeft) {
            // A hull that grows much would hide the solid in few of its cells.
            if (hull && longestSide(joined(*hull, *rest)) > kMaxGrowth * longestSide(*hull))
                isBoundedBetween = false;
            else
                joinInto(hull, rest);
            return;
        }
        for (const Box& half : halvesOf(*rest)) split(contractor, half, halvings - 1);
    }

    void take(const BoxContractor& contractor) { stepsLeft -= std::min(stepsLeft, contractor.steps()); }

    const LiveProgram& live;
    std::optional<Box>& hull;
    std::stop_token stop;
    std::size_t stepsLeft = 0;
    bool isBoundedBetween = true;
};

}  // namespace

MovingRegion findMovingRegion(const LiveProgram& live, std::stop_token stop) {
    const Program& program = live.program;
    const std::vector<double> times = momentsOf(live.timeline);
    std::vector<Region> found(times.size());
    const auto search = [&](std::size_t first, std::size_t step) {
        for (std::size_t i = first; i < times.size(); i += step)
            found[i] = findRegion(program.ir, program.distance(), live.valuesAt(times[i]),
                                  program.exactness.lipschitz, stop);
    };
    const std::size_t threads = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 8);
    {
        std::vector<std::future<void>> others;
        for (std::size_t i = 1; i < threads; ++i)
            others.push_back(std::async(std::launch::async, search, i, threads));
        search(0, threads);
        for (std::future<void>& other : others) other.get();
    }
    std::optional<Box> hull;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (found[i].extent == Extent::bounded) joinInto(hull, found[i].box);
        if (found[i].extent != Extent::bounded && found[i].extent != Extent::empty)
            return {found[i], times[i], {}};
    }
    MotionProof proof(live, hull, stop);
    std::optional<std::pair<double, double>> unproven;
    for (std::size_t i = 0; i + 1 < times.size() && !stop.stop_requested(); ++i) {
        if (!proof.prove(times[i], times[i + 1]) && !unproven) unproven = {times[i], times[i + 1]};
    }
    if (stop.stop_requested()) return {{Extent::unproven, {}, {}}, times.front(), {}};
    if (!hull) return {{Extent::empty, {}, {}}, times.front(), {}};
    return {{Extent::bounded, *hull, {}}, 0.0, unproven};
}

}  // namespace fw
