#include "runtime/measure/completeness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <queue>
#include <vector>

#include "graph/base/words.h"
#include "graph/compile/program.h"
#include "graph/evaluate/tape.h"

namespace fw {

namespace {

constexpr double kNearestSample = 1e-3;  // of the region's size
constexpr std::size_t kMaxSamples = 8192, kMinSamples = 96;
constexpr std::size_t kStartsPerOctave = 6;  // of a descent
constexpr int kDescentSteps = 16;
constexpr double kConverged = 1e-6;       // a step of a descent, of the region's size
constexpr std::size_t kGradientCost = 4;  // of a step with gradients, in steps with values
// Depths inside the solid that descents aim at, as parts of the region's size.
constexpr std::array kDepths = {1e-4, 1e-3, 1e-2, 1e-1};
constexpr std::size_t kMaxOperands = 2000;
constexpr std::size_t kOperandStarts = 12;
constexpr std::size_t kTapeCost = 16;     // of making a step of a tape
constexpr std::size_t kSamplingCost = 8;  // of an operation that samples data, by its weight
constexpr double kShellGrowth = 4.0;
constexpr double kSmallestCell = 1e-3;  // of its distance to the region's centre
constexpr std::size_t kSamplesPerCell = 8;
constexpr double kWorthSimplifying = 0.8;

/// Pseudo-random numbers, the same with every standard library.
class SampleSequence {
  public:
    double unit() {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        return double(state >> 11) / 9007199254740992.0;
    }
    double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
    std::size_t below(std::size_t count) { return std::min(std::size_t(unit() * double(count)), count - 1); }

  private:
    uint64_t state = 0x9e3779b97f4a7c15u;
};

/// The box grown by `margin` on every side, within the cube of size kFarthest.
Box grownBox(const Box& box, double margin) {
    Box grown;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grown.lo[axis] = std::max(box.lo[axis] - margin, std::min(box.lo[axis], -kFarthest));
        grown.hi[axis] = std::min(box.hi[axis] + margin, std::max(box.hi[axis], kFarthest));
    }
    return grown;
}

/// The part of `outer` outside `inner`, which it contains, as up to six boxes.
std::vector<Box> boxesBetween(Box outer, const Box& inner) {
    std::vector<Box> boxes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Box below = outer, above = outer;
        below.hi[axis] = inner.lo[axis], above.lo[axis] = inner.hi[axis];
        if (below.lo[axis] < below.hi[axis]) boxes.push_back(below);
        if (above.lo[axis] < above.hi[axis]) boxes.push_back(above);
        outer.lo[axis] = inner.lo[axis], outer.hi[axis] = inner.hi[axis];
    }
    return boxes;
}

/// The operands of minima and choices that `root` is made of, as far as they depend on the position: small
/// expressions first. Minima within minima are replaced by their operands.
std::vector<IrId> solidOperands(const Ir& ir, IrId root) {
    std::vector<bool> isNeeded(root + 1), isOperand(root + 1);
    std::vector<double> size(root + 1, 1.0);  // of the expression written as a tree
    isNeeded[root] = true;
    for (IrId id = root + 1; id-- > 0;) {
        if (!isNeeded[id]) continue;
        const IrNode& node = ir[id];
        const int arity = opInfo(node.op).arity;
        const bool isUnion = node.op == Op::minimum || node.op == Op::smoothMinimum;
        for (int i = 0; i < arity; ++i) {
            isNeeded[node.operands[std::size_t(i)]] = true;
            if ((isUnion && i < 2) || (node.op == Op::select && i > 0))
                isOperand[node.operands[std::size_t(i)]] = true;
        }
    }
    std::vector<IrId> operands;
    for (IrId id = 0; id <= root; ++id) {
        if (!isNeeded[id]) continue;
        const IrNode& node = ir[id];
        for (int i = 0; i < opInfo(node.op).arity; ++i) size[id] += size[node.operands[std::size_t(i)]];
        if (isOperand[id] && id > 2 && node.positions != 0 && node.op != Op::minimum) operands.push_back(id);
    }
    std::ranges::stable_sort(operands, {}, [&](IrId id) { return size[id]; });
    if (operands.size() > kMaxOperands) {
        for (std::size_t i = 0; i < kMaxOperands; ++i)
            operands[i] = operands[i * operands.size() / kMaxOperands];
        operands.resize(kMaxOperands);
    }
    return operands;
}

/// A tape and its cost: the sum of the weights of its operations.
struct CostedTape {
    explicit CostedTape(Tape made) : tape(std::move(made)) {
        for (const TapeStep& step : tape.steps)
            cost += std::size_t(std::max(opInfo(step.op).weight, 1)) *
                    (samplesLayer(step.op) ? kSamplingCost : 1);
    }
    Tape tape;
    std::size_t cost = 1;
};

class ExteriorSearch {
  public:
    ExteriorSearch(const Ir& ir_, IrId root_, std::span<const double> parameters_, const Box& region,
                   const std::atomic<bool>* cancel_, const CompletenessBudget& budget_)
        : ir(ir_),
          root(root_),
          parameters(parameters_),
          field(std::make_shared<CostedTape>(makeTape(ir_, root_, parameters_))),
          cancel(cancel_),
          budget(budget_),
          centre(centreOf(region)),
          size(std::max(longestSide(region), 1e-9)) {
        result.region = region;
    }

    Completeness run() {
        const Box space = grownBox(result.region, 4.0 * kFarthest);
        result.proven = isProven(boxesBetween(space, result.region));
        if (result.proven) return result;
        sample();
        if (!isOver()) searchOperands();
        if (!isOver()) searchShells(space);
        return result;
    }

  private:
    struct Start {
        double rank;  ///< value by distance to the region
        Point point;
    };
    struct Cell {
        double rank;  ///< lowest value found, by size
        Box box;
        std::shared_ptr<const CostedTape> tape;
        bool operator<(const Cell& other) const { return rank > other.rank; }
    };

    bool isOver() const { return result.solidOutside || (cancel && *cancel); }

    bool isOutside(const Point& point) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (point[axis] < result.region.lo[axis] || point[axis] > result.region.hi[axis]) return true;
        return false;
    }

    /// From the region to a point outside, along the axis on which it is farthest.
    double distanceTo(const Point& point) const {
        double distance = kNearestSample * size;
        for (std::size_t axis = 0; axis < 3; ++axis)
            distance = std::max(
                {distance, result.region.lo[axis] - point[axis], point[axis] - result.region.hi[axis]});
        return distance;
    }

    /// Takes a value of the field as a result if it is solid outside the region.
    void notice(const Point& point, double value) {
        if (!(value < 0.0) || !isOutside(point) || (result.solidOutside && value >= lowest)) return;
        if (isInSpace(point)) result.solidOutside = point, lowest = value;
    }
    static bool isInSpace(const Point& point) {
        return std::ranges::all_of(point, [](double x) { return std::abs(x) <= kFarthest; });
    }

    /// The values of a tape of the field at the points.
    std::vector<double> valuesAt(const CostedTape& by, std::span<const Point> points) {
        std::vector<double> values(points.size());
        machine.evaluate(by.tape, points, values);
        result.pointWork += by.cost * points.size();
        for (std::size_t i = 0; i < points.size(); ++i) notice(points[i], values[i]);
        return values;
    }

    /// A point at that distance from the region, measured along the axis that is farthest out.
    Point pointAt(double distance, std::size_t kind) {
        const Box& region = result.region;
        const std::size_t main = random.below(3);
        const Box shell = grownBox(region, distance);
        Point point;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t place = axis == main ? 0 : kind % 4 < 2 ? 1 : random.below(4) + 1;
            switch (place) {
                case 0: point[axis] = random.unit() < 0.5 ? shell.lo[axis] : shell.hi[axis]; break;
                case 1: point[axis] = random.between(shell.lo[axis], shell.hi[axis]); break;
                case 2: point[axis] = random.between(region.lo[axis], region.hi[axis]); break;
                case 3: point[axis] = centre[axis]; break;
                default: point[axis] = 0.0; break;
            }
        }
        return point;
    }

    /// Samples, and descents from the lowest of each octave of distances.
    void sample() {
        const std::size_t affordable = budget.pointWork / 4 / field->cost;
        const std::size_t count = std::clamp(affordable, kMinSamples, kMaxSamples);
        const double nearest = kNearestSample * size;
        const double octaves = std::max(std::log2(kFarthest / nearest), 1.0);
        std::vector<std::vector<Start>> starts(std::size_t(octaves) + 1);
        constexpr std::size_t kBatch = 1024;
        for (std::size_t first = 0; first < count && !isOver(); first += kBatch) {
            std::vector<Point> points(std::min(kBatch, count - first));
            std::vector<double> distances(points.size());
            for (std::size_t i = 0; i < points.size(); ++i) {
                distances[i] = nearest * std::exp2(octaves * random.unit());
                points[i] = pointAt(distances[i], i);
            }
            const std::vector<double> values = valuesAt(*field, points);
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (!std::isfinite(values[i])) continue;
                const auto octave = std::size_t(std::max(std::log2(distances[i] / nearest), 0.0));
                starts[std::min(octave, starts.size() - 1)].push_back({values[i] / distances[i], points[i]});
            }
        }
        std::vector<Start> lowestStarts;
        for (std::vector<Start>& octave : starts) {
            const std::size_t kept = std::min(octave.size(), kStartsPerOctave);
            const auto end = octave.begin() + std::ptrdiff_t(kept);
            std::ranges::partial_sort(octave, end, {}, &Start::rank);
            lowestStarts.insert(lowestStarts.end(), octave.begin(), end);
        }
        std::ranges::sort(lowestStarts, {}, &Start::rank);
        const std::size_t limit = result.pointWork + budget.pointWork / 4;
        for (std::size_t first = 0; first < lowestStarts.size() && result.pointWork < limit && !isOver();
             first += kLanes) {
            std::vector<Point> points;
            for (std::size_t i = first; i < std::min(first + kLanes, lowestStarts.size()); ++i)
                points.push_back(lowestStarts[i].point);
            descend(*field, std::move(points), true);
        }
    }

    /// Moves each point by Newton's method to where the tape's value is some depth below 0. Returns the
    /// points that are there, or still on the way, outside the region. With `isField` the tape is the
    /// field's: values on the way count, and points that enter the region are dropped.
    std::vector<Point> descend(const CostedTape& by, std::vector<Point> points, bool isField) {
        std::vector<Point> reached;
        std::vector<double> depths(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) depths[i] = kDepths[i % kDepths.size()] * size;
        for (int step = 0; step < kDescentSteps && !points.empty() && !isOver(); ++step) {
            for (std::size_t i = 0; i < points.size(); ++i)
                for (std::size_t axis = 0; axis < 3; ++axis) machine.position(int(axis))[i] = points[i][axis];
            const TapeMachine<double>::Gradients g = machine.gradient(by.tape, points.size());
            result.pointWork += kGradientCost * by.cost * points.size();
            std::size_t kept = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (isField) notice(points[i], g.values[i]);
                double squared = 0.0;
                for (const double* slope : g.gradients) squared += slope[i] * slope[i];
                const double factor = (g.values[i] + depths[i]) / squared;
                Point next = points[i];
                for (std::size_t axis = 0; axis < 3; ++axis) next[axis] -= factor * g.gradients[axis][i];
                if (!isInSpace(next) || (isField && !isOutside(next))) continue;
                if (std::abs(factor) * std::sqrt(squared) < kConverged * size) {
                    reached.push_back(next);
                } else {
                    points[kept] = next, depths[kept++] = depths[i];
                }
            }
            points.resize(kept), depths.resize(kept);
        }
        reached.insert(reached.end(), points.begin(), points.end());
        std::erase_if(reached, [&](const Point& point) { return !isOutside(point); });
        return reached;
    }

    /// Descents on the field's operands.
    void searchOperands() {
        const std::size_t limit = result.pointWork + budget.pointWork / 2;
        std::vector<Point> starts;
        for (std::size_t i = 0; i < kOperandStarts; ++i)
            starts.push_back(pointAt(size * std::exp2(2.0 * double(i) - 2.0), i));
        std::vector<Point> candidates;
        for (const IrId operand : solidOperands(ir, root)) {
            if (isOver() || result.pointWork > limit) break;
            const CostedTape tape(makeTape(ir, operand, parameters));
            result.pointWork += kTapeCost * tape.tape.steps.size() + operand / 4;
            const std::vector<Point> reached = descend(tape, starts, false);
            candidates.insert(candidates.end(), reached.begin(), reached.end());
            const std::size_t cost = candidates.size() * field->cost;
            if (candidates.size() >= TapeMachine<double>::kPoints || result.pointWork + cost > limit)
                testCandidates(candidates);
        }
        if (!isOver()) testCandidates(candidates);
    }

    /// Evaluates the field at the points, descends from the lowest, and removes all.
    void testCandidates(std::vector<Point>& candidates) {
        const std::vector<double> values = valuesAt(*field, candidates);
        std::vector<Start> starts;
        for (std::size_t i = 0; i < candidates.size(); ++i)
            if (std::isfinite(values[i]))
                starts.push_back({values[i] / distanceTo(candidates[i]), candidates[i]});
        std::ranges::sort(starts, {}, &Start::rank);
        starts.resize(std::min(starts.size(), kLanes));
        candidates.clear();
        for (const Start& start : starts) candidates.push_back(start.point);
        if (!isOver()) descend(*field, candidates, true);
        candidates.clear();
    }

    /// Whether the value over the box is proven not to be negative.
    bool isProven(const CostedTape& by, const Box& box) {
        result.intervalWork += by.cost;
        return machine.interval(by.tape, box).lo >= 0.0;
    }
    bool isProven(const std::vector<Box>& boxes) {
        return std::ranges::all_of(boxes, [&](const Box& box) { return isProven(*field, box); });
    }

    /// Subdivides shells around the region, each of kShellGrowth times the size of the one within it.
    void searchShells(const Box& space) {
        std::vector<Box> shells = {result.region};
        for (double margin = 0.5 * size; shells.back() != space; margin = kShellGrowth * margin + size)
            shells.push_back(grownBox(result.region, margin));
        bool proven = true;
        for (std::size_t i = 1; i < shells.size() && !isOver(); ++i) {
            const std::size_t left = budget.intervalWork - std::min(result.intervalWork, budget.intervalWork);
            if (!searchShell(boxesBetween(shells[i], shells[i - 1]), left / (shells.size() - i)))
                proven = false;
        }
        result.proven = proven && !isOver();
    }

    /// Whether the boxes are proven to be empty with that much work.
    bool searchShell(const std::vector<Box>& boxes, std::size_t work) {
        const std::size_t limit = result.intervalWork + work;
        std::priority_queue<Cell> cells;
        bool proven = true;
        for (const Box& box : boxes) {
            if (result.intervalWork + field->cost > limit) return false;
            if (!isProven(*field, box)) addCell(cells, box, field);
        }
        while (!cells.empty()) {
            const Cell cell = cells.top();
            cells.pop();
            if (result.intervalWork + 2 * cell.tape->cost > limit || isOver()) return false;
            std::size_t axis = 0;
            const auto side = [&](std::size_t a) { return cell.box.hi[a] - cell.box.lo[a]; };
            for (const std::size_t other : {1, 2})
                if (side(other) > side(axis)) axis = other;
            double distance = size;
            for (std::size_t a = 0; a < 3; ++a)
                distance = std::max({distance, cell.box.hi[a] - centre[a], centre[a] - cell.box.lo[a]});
            if (side(axis) < kSmallestCell * distance) {
                proven = false;
                continue;
            }
            Box half = cell.box;
            half.hi[axis] = 0.5 * (cell.box.lo[axis] + cell.box.hi[axis]);
            if (!isProven(*cell.tape, half)) addCell(cells, half, cell.tape);
            half.lo[axis] = half.hi[axis], half.hi[axis] = cell.box.hi[axis];
            if (!isProven(*cell.tape, half)) addCell(cells, half, cell.tape);
        }
        return proven;
    }

    /// Adds the box that isProven() was last asked about, with its own tape if that is much shorter.
    void addCell(std::priority_queue<Cell>& cells, const Box& box, std::shared_ptr<const CostedTape> by) {
        if (machine.shortens()) {
            result.intervalWork += by->tape.steps.size();
            auto simplified = std::make_shared<CostedTape>(machine.shortenedForSigns(by->tape));
            if (double(simplified->cost) < kWorthSimplifying * double(by->cost)) by = std::move(simplified);
        }
        std::array<Point, kSamplesPerCell> points;
        points[0] = centreOf(box);
        for (std::size_t i = 1; i < points.size(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
                points[i][axis] = random.between(box.lo[axis], box.hi[axis]);
        double rank = INFINITY;
        for (const double value : valuesAt(*by, points))
            if (value < rank) rank = value;
        cells.push({rank / longestSide(box), box, std::move(by)});
    }

    const Ir& ir;
    IrId root;
    std::span<const double> parameters;
    std::shared_ptr<const CostedTape> field;
    const std::atomic<bool>* cancel;
    const CompletenessBudget& budget;
    Point centre;
    double size;  ///< the region's longest side
    SampleSequence random;
    TapeMachine<double> machine;
    Completeness result;
    double lowest = 0.0;  ///< the field at result.solidOutside
    static constexpr std::size_t kLanes = TapeMachine<double>::kGradientPoints;
};

}  // namespace

Completeness checkCompleteness(const Ir& ir, IrId distance, std::span<const double> parameters,
                               const Box& region, const std::atomic<bool>* cancel,
                               const CompletenessBudget& budget) {
    return ExteriorSearch(ir, distance, parameters, region, cancel, budget).run();
}

Completeness checkCompleteness(const Program& program, const Box& region, const std::atomic<bool>* cancel) {
    return checkCompleteness(program.ir, program.distance(), program.parameters(), region, cancel);
}

std::string describeMissing(const Completeness& completeness) {
    const auto point = [](const Point& p, const char* separator) {
        return "(" + shortNumber(p[0]) + separator + shortNumber(p[1]) + separator + shortNumber(p[2]) + ")";
    };
    return "there is solid at " + point(*completeness.solidOutside, ", ") + ", outside the meshed region " +
           point(completeness.region.lo, " ") + " to " + point(completeness.region.hi, " ");
}

}  // namespace fw
