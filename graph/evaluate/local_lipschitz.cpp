#include "graph/evaluate/local_lipschitz.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "graph/evaluate/interval_gradient.h"

namespace fw {

namespace {

/// How close to a lower bound of the smallest constant a constant needs to be.
constexpr double kCloseEnough = 1e-9;

struct LipschitzPart {
    Box box;
    double constant, side;
    std::shared_ptr<const Tape> tape;

    /// Whether another part is split before this one.
    bool operator<(const LipschitzPart& other) const {
        if (constant != other.constant) return constant < other.constant;
        return std::isinf(constant) ? side > other.side : side < other.side;
    }
};

std::size_t longestAxis(const Box& box) {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
        if (box.hi[axis] - box.lo[axis] > box.hi[longest] - box.lo[longest]) longest = axis;
    return longest;
}

double longestSideOf(const Box& box) {
    const std::size_t axis = longestAxis(box);
    return box.hi[axis] - box.lo[axis];
}

/// A number that no Lipschitz constant over the box is below: the least length of the gradient at its centre.
double steepnessAtCentre(IntervalGradientMachine& machine, const Tape& tape, const Box& box) {
    Box centre;
    for (std::size_t axis = 0; axis < 3; ++axis)
        centre.lo[axis] = centre.hi[axis] = 0.5 * box.lo[axis] + 0.5 * box.hi[axis];
    double squared = 0.0;
    for (const Interval& slope : machine.evaluate(tape, centre).gradient) {
        const double least = absolute(slope).lo;
        squared += least * least;
    }
    return std::sqrt(squared);
}

}  // namespace

double lipschitzOver(const Tape& tape, const Box& box, int maxBoxes) {
    IntervalGradientMachine machine;
    TapeMachine<double> simplifier;
    const double smallest = kSmallestPart * longestSideOf(box);
    std::vector<LipschitzPart> parts;
    const auto add = [&](const Box& part, const std::shared_ptr<const Tape>& own) {
        parts.push_back({part, machine.evaluate(*own, part).norm, longestSideOf(part), own});
        std::push_heap(parts.begin(), parts.end());
    };
    add(box, std::make_shared<const Tape>(tape));
    double least = 0.0;
    for (int count = 1; count + 2 <= maxBoxes; count += 2) {
        const LipschitzPart worst = parts.front();
        if (!(worst.side > smallest)) break;
        least = std::max(least, steepnessAtCentre(machine, *worst.tape, worst.box));
        if (worst.constant <= least * (1.0 + kCloseEnough)) break;
        std::pop_heap(parts.begin(), parts.end());
        parts.pop_back();
        std::shared_ptr<const Tape> own = worst.tape;
        simplifier.interval(*own, worst.box);
        if (simplifier.shortens()) own = std::make_shared<const Tape>(simplifier.shortened(*own));
        const std::size_t axis = longestAxis(worst.box);
        const double middle = 0.5 * worst.box.lo[axis] + 0.5 * worst.box.hi[axis];
        Box low = worst.box, high = worst.box;
        low.hi[axis] = high.lo[axis] = middle;
        add(low, own), add(high, own);
    }
    return parts.front().constant;
}

}  // namespace fw
