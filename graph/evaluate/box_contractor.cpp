#include "graph/evaluate/box_contractor.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>
#include <utility>

#include "graph/evaluate/frame_cut.h"

namespace fw {

namespace {

constexpr int kMaxDepth = 400;    // of nested goals
constexpr int kMaxRounds = 4;     // forwards and backwards through one cone
constexpr int kMaxCaseDepth = 3;  // of nested cases
/// Of shells around the origin.
constexpr double kShellRatio = 4.0, kSmallestShell = 1.0 / 1024.0;
constexpr std::size_t kShellSteps = 300'000;
constexpr int kMaxShellSplits = 24, kShellSamples = 64;
constexpr double kSmallestTrim = 1.0 / 32.0;  // of a box's side
constexpr std::size_t kTrimSteps = 20'000;
constexpr int kMaxTrimSplits = 12;
constexpr int kMaxRepeats = 4;
constexpr double kWorthRepeating = 0.95;  // of a side
constexpr double kSmallestFactor = 1e-12;
constexpr std::size_t kMaxReplacements = 4, kMaxSummands = 16, kMaxCases = 32;
/// What going through the cases within one cone may cost.
constexpr std::size_t kCaseSteps = 5'000, kCaseStepsEach = 40;

double roundedUp(double value) { return value + std::abs(value) * 1e-15; }
double roundedDown(double value) { return value - std::abs(value) * 1e-15; }

Interval sideOf(const Box& box, std::size_t axis) { return {box.lo[axis], box.hi[axis]}; }

Interval wantedBy(bool above, double level) {
    return above ? Interval{level, kHuge} : Interval{-kHuge, level};
}

void joinInto(std::optional<Box>& all, const std::optional<Box>& box) {
    if (box) all = all ? joined(*all, *box) : *box;
}

}  // namespace

bool isBounded(const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!isBounded(sideOf(box, axis))) return false;
    return true;
}

BoxContractor::BoxContractor(const Ir& ir_, std::span<const Interval> parameters)
    : ir(ir_),
      everywhere(ir.size()),
      mayBeNaN(ir.size()),
      stamps(ir.size()),
      evaluatedIn(ir.size()),
      noted(ir.size()),
      notedIn(ir.size()) {
    for (IrId id = 0; id < ir.size(); ++id) {
        const IrNode& node = ir[id];
        current.swap(everywhere);
        if (id < 3 || node.op == Op::column)
            current[id] = kEverything;
        else if (node.op == Op::parameter)
            current[id] = parameters[std::size_t(node.number)];
        else if (node.op == Op::constant)
            current[id] = {node.number, node.number};
        else
            current[id] = evaluate(id);
        if (!std::isfinite(current[id].lo) || !std::isfinite(current[id].hi)) current[id] = kEverything;
        current.swap(everywhere);
    }
    current = everywhere;
    frame.isAtom.resize(ir.size());
    findUndefined();
    findRotations();
    findSplines();
}

Interval BoxContractor::evaluate(IrId id) const {
    const IrNode& node = ir[id];
    Interval operands[kMaxArity];
    const OpInfo& info = opInfo(node.op);
    for (int i = 0; i < info.arity; ++i) operands[i] = current[node.operands[std::size_t(i)]];
    return info.interval(operands, samplesLayer(node.op) ? ir.layer(node) : SampledLayer{});
}

Box BoxContractor::variableBox() const {
    Box box;
    for (std::size_t axis = 0; axis < frame.count; ++axis) {
        box.lo[axis] = current[frame.variables[axis]].lo;
        box.hi[axis] = current[frame.variables[axis]].hi;
    }
    return box;
}

void BoxContractor::setVariables(const Box& box) {
    for (std::size_t axis = 0; axis < frame.count; ++axis) current[frame.variables[axis]] = sideOf(box, axis);
}

std::vector<BoxContractor::Part> BoxContractor::parts(IrId root, const Box& within) {
    std::vector<Part> result;
    std::vector<IrId> pending{root};
    while (!pending.empty()) {
        const IrId id = pending.back();
        pending.pop_back();
        const IrNode& node = ir[id];
        if (node.op == Op::minimum) {
            pending.insert(pending.end(), {node.operands[1], node.operands[0]});
        } else if (node.op == Op::multiply && isNumber(node.operands[1]) &&
                   everywhere[node.operands[1]].lo > 0.0) {
            pending.push_back(node.operands[0]);
        } else if (const std::optional<Box> box = contract(id, 0.0, within)) {
            result.push_back({id, *box});
        }
    }
    return result;
}

std::optional<Box> BoxContractor::contract(IrId root, double level, const Box& box) {
    std::optional<Box> left = repeat({root, false, level}, box);
    if (!left || isBounded(*left)) return left;
    left = contractThoroughly(root, level, *left);
    return left && isBounded(*left) ? repeat({root, false, level}, *left) : left;
}

std::optional<Box> BoxContractor::contractThoroughly(IrId root, double level, const Box& box) {
    isThorough = true;
    const std::optional<Box> left = reach({root, false, level}, box, 0);
    isThorough = false;
    return left;
}

/// Within a bounded box all values have narrower ranges, which bound the box further.
std::optional<Box> BoxContractor::repeat(const Goal& goal, const Box& box) {
    std::optional<Box> left = box;
    for (int round = 0; round < kMaxRepeats && left; ++round) {
        const Box before = *left;
        if (isBounded(before)) noteRanges(goal.id, before);
        left = reach(goal, before, 0);
        ++rangeGeneration;
        if (!left || !isBounded(*left)) break;
        bool isSmaller = !isBounded(before);
        for (std::size_t axis = 0; axis < 3; ++axis)
            isSmaller |=
                left->hi[axis] - left->lo[axis] < kWorthRepeating * (before.hi[axis] - before.lo[axis]);
        if (!isSmaller) break;
    }
    return left;
}

/// Makes rangeOf() that over the box, for all operations up to `root`.
void BoxContractor::noteRanges(IrId root, const Box& box) {
    const std::vector<IrId> cone = coneOf(std::array{Constraint{root, {}}});
    setVariables(box);
    forwards(cone, false);
    ++rangeGeneration;
    for (const IrId id : cone) noted[id] = current[id], notedIn[id] = rangeGeneration;
}

BoxContractor::Goal BoxContractor::peeled(Goal goal) const {
    while (!isVariable(goal.id)) {
        const IrNode& node = ir[goal.id];
        const IrId a = node.operands[0], b = node.operands[1];
        const bool firstIsNumber = opInfo(node.op).arity == 2 && isNumber(a),
                   secondIsNumber = opInfo(node.op).arity == 2 && isNumber(b);
        Interval level{goal.level, goal.level};
        bool flips = false;
        IrId rest = a;
        if (node.op == Op::negate) {
            level = -level, flips = true;
        } else if (node.op == Op::add && (firstIsNumber || secondIsNumber)) {
            level = level - everywhere[firstIsNumber ? a : b];
            rest = firstIsNumber ? b : a;
        } else if (node.op == Op::subtract && secondIsNumber) {
            level = level + everywhere[b];
        } else if (node.op == Op::subtract && firstIsNumber) {
            level = everywhere[a] - level, flips = true, rest = b;
        } else if (node.op == Op::multiply || node.op == Op::divide) {
            // The factor may vary as long as its sign is known.
            const auto hasSign = [&](IrId id) {
                return (rangeOf(id).lo > 0.0 || rangeOf(id).hi < 0.0) && !mayBeNaN[id];
            };
            const bool isProduct = node.op == Op::multiply;
            if (!hasSign(b) && !(isProduct && hasSign(a))) return goal;
            const Interval factor = rangeOf(hasSign(b) ? b : a);
            level = isProduct ? level / factor : level * factor;
            flips = factor.hi < 0.0, rest = hasSign(b) ? a : b;
        } else {
            return goal;
        }
        if (isNumber(rest)) return goal;
        const bool above = goal.above != flips;
        goal = {rest, above, above ? level.lo : level.hi};
        if (std::abs(goal.level) >= kHuge) return goal;
    }
    return goal;
}

bool BoxContractor::isUnion(const Goal& goal) const {
    const Op op = opOf(goal.id);
    return goal.above ? op == Op::maximum : op == Op::minimum || op == Op::smoothMinimum;
}

std::optional<Box> BoxContractor::reach(const Goal& whole, const Box& box, int depth) {
    if (depth > kMaxDepth || isSpent()) return box;
    const Goal goal = peeled(whole);
    const Interval range = rangeOf(goal.id);
    if (goal.above ? range.hi < goal.level : range.lo > goal.level) return std::nullopt;
    if (goal.above ? range.lo >= goal.level : range.hi <= goal.level) return box;
    if (std::abs(goal.level) >= kHuge) return box;
    if (!isThorough) return reachTakenApart(goal, box, depth);
    const std::optional<Box> left = reachThroughCut(goal, box, depth);
    return left ? reachTakenApart(goal, *left, depth) : left;
}

std::optional<Box> BoxContractor::reachTakenApart(const Goal& goal, const Box& box, int depth) {
    const IrNode& node = ir[goal.id];
    const IrId a = node.operands[0];
    const auto both = [&](double least, double most) -> std::optional<Box> {  // least <= a <= most
        const std::optional<Box> first = reach({a, false, most}, box, depth + 1);
        return first ? reach({a, true, least}, *first, depth + 1) : std::nullopt;
    };
    const auto either = [&](double most, double least) {  // a <= most or a >= least
        std::optional<Box> all = reach({a, false, most}, box, depth + 1);
        joinInto(all, reach({a, true, least}, box, depth + 1));
        return all;
    };
    switch (opOf(goal.id)) {
        case Op::minimum:
        case Op::maximum:
        case Op::smoothMinimum:
            return isUnion(goal) ? reachAny(goal, box, depth) : reachAll(goal, box, depth);
        case Op::select: return reachSelected(goal, box, depth);
        case Op::absolute:
            return goal.above ? either(-goal.level, goal.level) : both(-goal.level, goal.level);
        case Op::squareRoot:
            return reach(
                {a, goal.above,
                 goal.above ? roundedDown(goal.level * goal.level) : roundedUp(goal.level * goal.level)},
                box, depth + 1);
        case Op::square: {
            const double size = std::sqrt(goal.level);
            return goal.above ? either(-roundedDown(size), roundedDown(size))
                              : both(-roundedUp(size), roundedUp(size));
        }
        default: return reachLeaf(goal, box, depth);
    }
}

std::optional<Box> BoxContractor::reachLeaf(const Goal& goal, const Box& box, int depth) {
    const Op op = opOf(goal.id);
    const std::optional<Box> left =
        op == Op::add || op == Op::subtract
            ? reachSum(goal, box, depth)
            : propagate({{goal.id, wantedBy(goal.above, goal.level)}}, box, depth + 1);
    return left && !isBounded(*left) && isThorough ? reachFromOutside(goal, *left, depth) : left;
}

/// By the space of the values that stand between the goal and the variables, if there are such.
std::optional<Box> BoxContractor::reachThroughCut(const Goal& goal, const Box& box, int depth) {
    if (goal.id < 3 || isVariable(goal.id)) return box;
    const std::tuple key{goal.id, goal.above, goal.level};
    if (!frame.throughCuts.contains(key)) {
        const std::optional<Box> found = boundThroughCut(goal, depth);
        frame.throughCuts[key] = found;
    }
    const std::optional<Box>& known = frame.throughCuts[key];
    return known ? common(*known, box) : std::nullopt;
}

/// A box around all of space that meets the goal.
std::optional<Box> BoxContractor::boundThroughCut(const Goal& goal, int depth) {
    const std::vector<IrId> cone = coneOf(std::array{Constraint{goal.id, {}}});
    stepCount += 8 * cone.size();
    const std::vector<IrId> cut = frameCut(ir, cone, std::span(frame.variables).first(frame.count),
                                           [&](IrId id) { return isNumber(id); });
    if (cut.empty()) return kAllSpace;
    Frame inner;
    inner.count = cut.size();
    inner.isAtom = frame.isAtom;
    std::vector<Constraint> ranges;
    Box start{};
    setVariables(frame.limits);
    std::vector<Constraint> unconstrained;
    for (const IrId id : cut) unconstrained.push_back({id, kEverything});
    forwards(coneOf(unconstrained), false);
    for (std::size_t i = 0; i < cut.size(); ++i) {
        inner.variables[i] = cut[i];
        inner.isAtom[cut[i]] = true;
        inner.limits.lo[i] = current[cut[i]].lo, inner.limits.hi[i] = current[cut[i]].hi;
        start.lo[i] = everywhere[cut[i]].lo, start.hi[i] = everywhere[cut[i]].hi;
    }
    // What holds within the box at hand does not hold in all of the cut's space.
    const uint32_t outerGeneration = std::exchange(rangeGeneration, 0u);
    std::swap(frame, inner);
    isThorough = false;
    std::optional<Box> found = reach(goal, start, depth + 1);
    isThorough = true;
    if (found && !isBounded(*found)) found = reach(goal, *found, depth + 1);
    std::swap(frame, inner);
    rangeGeneration = outerGeneration;
    if (!found) return std::nullopt;
    for (std::size_t i = 0; i < cut.size(); ++i) ranges.push_back({cut[i], sideOf(*found, i)});
    isThorough = false;
    found = propagate(std::move(ranges), kAllSpace, depth + 1);
    isThorough = true;
    return found;
}

/// Proves the shells around the origin free of the goal, from kFarthest inwards.
std::optional<Box> BoxContractor::reachFromOutside(const Goal& goal, const Box& box, int depth) {
    const std::tuple key{goal.id, goal.above, goal.level};
    if (!frame.fromOutside.contains(key)) {
        std::optional<Box> known = kAllSpace;
        // From all of space, whatever the box at hand, for the result serves other boxes too.
        std::optional<Box> outer =
            propagate({{goal.id, wantedBy(goal.above, goal.level)}}, frame.limits, depth + 1, Effort::quick);
        shellLimit = stepCount + kShellSteps;
        double farthest = 0.0;
        for (std::size_t axis = 0; axis < frame.count; ++axis)
            farthest = std::max({farthest, -frame.limits.lo[axis], frame.limits.hi[axis]});
        bool isFree = !outer || !isSeenFarAway(goal, *outer);
        bool isBoundedByShells = !outer;
        for (double size = farthest / kShellRatio; isFree && outer && size > kSmallestShell;
             size /= kShellRatio) {
            const std::optional<Box> inner = common(*outer, cubeAround(size));
            if (inner == outer) continue;
            for (const Box& slab : boxesAround(*outer, inner))
                isFree = isFree && isUnreachable(goal, slab, kMaxShellSplits, depth);
            if (isFree) outer = inner, isBoundedByShells = true;
        }
        if (isBoundedByShells && outer) trim(goal, *outer, depth);
        if (isBoundedByShells) known = outer;
        frame.fromOutside[key] = known;
    }
    const std::optional<Box>& known = frame.fromOutside[key];
    return known ? common(*known, box) : std::nullopt;
}

/// Takes slabs off the box's faces in which the goal cannot be met.
void BoxContractor::trim(const Goal& goal, Box& box, int depth) {
    for (std::size_t axis = 0; axis < frame.count; ++axis)
        for (const bool isUpper : {false, true})
            for (double share = 0.5; share > kSmallestTrim; share *= 0.5) {
                shellLimit = stepCount + kTrimSteps;
                const double lo = box.lo[axis], hi = box.hi[axis],
                             at = std::lerp(lo, hi, isUpper ? 1.0 - share : share);
                Box slab = box;
                (isUpper ? slab.lo : slab.hi)[axis] = at;
                if (isUnreachable(goal, slab, kMaxTrimSplits, depth)) (isUpper ? box.hi : box.lo)[axis] = at;
            }
}

/// Whether the goal is met at some sample in the outermost shell.
bool BoxContractor::isSeenFarAway(const Goal& goal, const Box& box) {
    const std::vector<IrId> cone = coneOf(std::array{Constraint{goal.id, {}}});
    std::mt19937 random(1);
    const auto unit = [&] { return double(random() >> 8) / double(1 << 24); };
    for (int i = 0; i < kShellSamples; ++i) {
        Box point;
        for (std::size_t axis = 0; axis < frame.count; ++axis)
            point.lo[axis] = point.hi[axis] =
                std::lerp(box.lo[axis], box.hi[axis], i % 2 ? std::round(unit()) : unit());
        setVariables(point);
        forwards(cone, false);
        if (goal.above ? current[goal.id].hi >= goal.level : current[goal.id].lo <= goal.level) return true;
    }
    return false;
}

bool BoxContractor::isUnreachable(const Goal& goal, const Box& box, int splits, int depth) {
    const std::optional<Box> left =
        propagate({{goal.id, wantedBy(goal.above, goal.level)}}, box, depth + 1, Effort::quick);
    if (!left) return true;
    if (splits == 0 || stepCount > shellLimit || isSpent()) return false;
    for (const Box& half : halvesOf(*left))
        if (!isUnreachable(goal, half, splits - 1, depth)) return false;
    return true;
}

/// A chain of smooth minima of width k is at most k below the sharp minimum of all: were it lower than a - k
/// for the next operand a, it would not blend with it. One of them is at most k / 4 below.
std::optional<Box> BoxContractor::reachAny(const Goal& goal, const Box& box, int depth) {
    struct Operand {
        IrId id;
        double level;
        double chainStart, chainWidth;  // of the smooth minima that it is nested in
    };
    std::optional<Box> all;
    std::vector<Operand> pending{{goal.id, goal.level, goal.level, 0.0}};
    while (!pending.empty()) {
        const Operand at = pending.back();
        pending.pop_back();
        const IrNode& node = ir[at.id];
        if (!isUnion({at.id, goal.above, at.level})) {
            joinInto(all, reach({at.id, goal.above, at.level}, box, depth + 1));
            if (all == box) break;
            continue;
        }
        Operand next = at;
        if (node.op == Op::smoothMinimum) {
            next.chainWidth = std::max(at.chainWidth, rangeOf(node.operands[2]).hi);
            next.level = std::min(roundedUp(at.level + 0.25 * rangeOf(node.operands[2]).hi),
                                  roundedUp(at.chainStart + next.chainWidth));
        } else {
            next.chainStart = at.level, next.chainWidth = 0.0;
        }
        for (const std::size_t i : {1, 0}) next.id = node.operands[i], pending.push_back(next);
    }
    return all;
}

std::optional<Box> BoxContractor::reachAll(const Goal& goal, const Box& box, int depth) {
    Box left = box;
    std::vector<IrId> pending{goal.id};
    const Op op = opOf(goal.id);
    while (!pending.empty()) {
        const IrId id = pending.back();
        pending.pop_back();
        if (opOf(id) == op) {
            // The larger of a number and NaN is the number: nothing is known of the operand then.
            for (const std::size_t i : {1, 0})
                if (!mayBeNaN[ir[id].operands[i]]) pending.push_back(ir[id].operands[i]);
            continue;
        }
        const std::optional<Box> next = reach({id, goal.above, goal.level}, left, depth + 1);
        if (!next) return std::nullopt;
        left = *next;
    }
    if (isBounded(left)) return left;
    // What none of the operands bounds alone, all of them may.
    return propagate({{goal.id, wantedBy(goal.above, goal.level)}}, left, depth + 1);
}

std::optional<Box> BoxContractor::reachSelected(const Goal& goal, const Box& box, int depth) {
    const IrNode& node = ir[goal.id];
    const IrId condition = node.operands[0];
    std::optional<Box> all;
    const Interval known = rangeOf(condition);
    for (const std::size_t branch : {1, 2}) {
        if (branch == 1 ? known.hi < 0.5 : known.lo > 0.5) continue;
        const IrId value = node.operands[branch];
        std::optional<Box> part = reach({value, goal.above, goal.level}, box, depth + 1);
        if (part && !isBounded(*part) && !mayBeNaN[condition])
            part = reachCondition(condition, branch == 1, *part, depth + 1);
        if (part && !isBounded(*part) && !mayBeNaN[condition] && !isNumber(value)) {
            const double truth = branch == 1 ? 1.0 : 0.0;
            part = propagate({{condition, {truth, truth}}, {value, wantedBy(goal.above, goal.level)}}, *part,
                             depth + 1);
        }
        joinInto(all, part);
        if (all == box) break;
    }
    return all;
}

std::vector<IrId> BoxContractor::coneOf(std::span<const Constraint> constraints) {
    std::vector<IrId> cone, pending;
    ++stamp;
    const auto visit = [&](IrId id) {
        if (isVariable(id) || isNumber(id) || stamps[id] == stamp) return;
        stamps[id] = stamp;
        pending.push_back(id);
    };
    for (const Constraint& constraint : constraints) visit(constraint.id);
    while (!pending.empty()) {
        const IrId id = pending.back();
        pending.pop_back();
        cone.push_back(id);
        for (int i = 0; i < opInfo(ir[id].op).arity; ++i) visit(ir[id].operands[std::size_t(i)]);
    }
    std::ranges::sort(cone);
    return cone;
}

/// Where a condition can be true, or false.
std::optional<Box> BoxContractor::reachCondition(IrId id, bool truth, const Box& box, int depth) {
    if (depth > kMaxDepth || isSpent() || mayBeNaN[id]) return box;
    const IrNode& node = ir[id];
    const IrId a = node.operands[0], b = node.operands[1];
    switch (opOf(id)) {
        case Op::logicalNot: return reachCondition(a, !truth, box, depth + 1);
        case Op::logicalAnd:
        case Op::logicalOr: {
            const std::optional<Box> first = reachCondition(a, truth, box, depth + 1);
            if (truth == (node.op == Op::logicalAnd))
                return first ? reachCondition(b, truth, *first, depth + 1) : std::nullopt;
            std::optional<Box> all = first;
            joinInto(all, reachCondition(b, truth, box, depth + 1));
            return all;
        }
        case Op::less:
        case Op::lessEqual:
            if (isNumber(b))
                return reach({a, !truth, truth ? everywhere[b].hi : everywhere[b].lo}, box, depth + 1);
            if (isNumber(a))
                return reach({b, truth, truth ? everywhere[a].lo : everywhere[a].hi}, box, depth + 1);
            return box;
        default: return box;
    }
}

/// The operands of nested operations `op`.
std::vector<IrId> BoxContractor::operandsOf(IrId id, Op op) const {
    std::vector<IrId> operands, pending{id};
    while (!pending.empty() && operands.size() + pending.size() < kMaxCases) {
        const IrId at = pending.back();
        pending.pop_back();
        if (opOf(at) != op)
            operands.push_back(at);
        else
            pending.insert(pending.end(), {ir[at].operands[0], ir[at].operands[1]});
    }
    operands.insert(operands.end(), pending.begin(), pending.end());
    return operands;
}

/// The sum that a value is, with equal terms collected: a + (b - a) t as (1 - t) a + t b.
std::vector<BoxContractor::Summand> BoxContractor::summandsOf(IrId id) const {
    std::vector<Summand> summands, pending{{id, 1.0}};
    while (!pending.empty()) {
        const Summand at = pending.back();
        const IrNode& node = ir[at.id];
        pending.pop_back();
        const IrId a = node.operands[0], b = node.operands[1];
        const Op op = opOf(at.id);
        const auto isFactor = [&](IrId value) { return isNumber(value) && everywhere[value].isPoint(); };
        const bool isFull = summands.size() + pending.size() >= kMaxSummands;
        if (!isFull && (op == Op::add || op == Op::subtract)) {
            pending.push_back({a, at.factor});
            pending.push_back({b, op == Op::subtract ? -at.factor : at.factor});
        } else if (!isFull && op == Op::negate) {
            pending.push_back({a, -at.factor});
        } else if (!isFull && op == Op::multiply && (isFactor(a) || isFactor(b))) {
            pending.push_back({isFactor(a) ? b : a, at.factor * everywhere[isFactor(a) ? a : b].lo});
        } else if (const auto same = std::ranges::find(summands, at.id, &Summand::id);
                   same != summands.end()) {
            same->factor += at.factor;
        } else {
            summands.push_back(at);
        }
    }
    return summands;
}

/// The goal as a sum that is at most a level; nothing if a factor is too small to divide by.
std::optional<BoxContractor::Sum> BoxContractor::sumOf(const Goal& goal) const {
    Sum sum{.terms = {}, .level = goal.above ? -goal.level : goal.level};
    for (Summand term : summandsOf(goal.id)) {
        if (goal.above) term.factor = -term.factor;
        if (!add(sum, term)) return std::nullopt;
    }
    return sum;
}

/// False if the term's factor is too small to divide by.
bool BoxContractor::add(Sum& sum, const Summand& term) const {
    if (isNumber(term.id)) {
        sum.level = roundedUp(sum.level - leastOf(term));
        return true;
    }
    const auto same = std::ranges::find(sum.terms, term.id, &Summand::id);
    if (same == sum.terms.end()) {
        if (term.factor != 0.0) sum.terms.push_back(term);
        return term.factor == 0.0 || std::abs(term.factor) > kSmallestFactor;
    }
    const double before = std::abs(same->factor);
    same->factor += term.factor;
    const double rest = std::abs(same->factor);
    if (rest == 0.0) sum.terms.erase(same);
    return rest == 0.0 || rest > kSmallestFactor * std::max(1.0, before);
}

double BoxContractor::leastOf(const Summand& term) const {
    return (Interval{term.factor, term.factor} * rangeOf(term.id)).lo;
}

/// |a| + b <= level as a + b <= level and -a + b <= level, if terms of a and b cancel: so a box whose height
/// and position depend on the same number is bounded.
std::vector<BoxContractor::Sum> BoxContractor::unfolded(const Sum& sum) const {
    for (const Summand& magnitude : sum.terms) {
        if (opOf(magnitude.id) != Op::absolute || magnitude.factor < 0.0) continue;
        std::vector<Sum> both;
        for (const double sign : {1.0, -1.0}) {
            Sum one{.terms = {}, .level = sum.level};
            std::size_t count = 0;
            bool isExact = true;
            for (const Summand& term : sum.terms)
                if (&term != &magnitude) isExact = isExact && add(one, term), ++count;
            for (Summand term : summandsOf(ir[magnitude.id].operands[0])) {
                term.factor *= sign * magnitude.factor;
                count += !isNumber(term.id);
                isExact = isExact && add(one, term);
            }
            if (isExact && one.terms.size() < count) both.push_back(std::move(one));
        }
        if (!both.empty()) return both;
    }
    return {};
}

/// Each term is at most the level less the least values of the others.
std::optional<Box> BoxContractor::reachTerms(const Sum& sum, const Box& box, int depth) {
    std::optional<Box> left = box;
    for (const Summand& term : sum.terms) {
        double most = sum.level;
        for (const Summand& other : sum.terms)
            if (&other != &term) most = roundedUp(most - leastOf(other));
        if (left && most < kHuge) left = reachTerm(term, most, *left, depth);
    }
    return left;
}

std::optional<Box> BoxContractor::reachTerm(const Summand& term, double most, const Box& box, int depth) {
    const Interval bound = Interval{most, most} / Interval{term.factor, term.factor};
    return reach({term.id, term.factor < 0.0, term.factor < 0.0 ? bound.lo : bound.hi}, box, depth + 1);
}

std::optional<Box> BoxContractor::reachSum(const Goal& goal, const Box& box, int depth) {
    const Constraint whole{goal.id, wantedBy(goal.above, goal.level)};
    std::optional<Box> left = propagate({whole}, box, depth + 1, Effort::quick);
    const std::optional<Sum> sum = left ? sumOf(goal) : std::nullopt;
    if (!sum) return left && !isBounded(*left) ? propagate({whole}, *left, depth + 1) : left;
    for (const Sum& one : unfolded(*sum))
        if (left) left = reachTerms(one, *left, depth);
    // max(q, 0)^2 as in the distance to a box: there may be more to q.
    const bool hasExtents = std::ranges::any_of(sum->terms, [&](const Summand& term) {
        return opOf(term.id) == Op::square && opOf(ir[term.id].operands[0]) == Op::maximum;
    });
    if (!left || (isBounded(*left) && !hasExtents)) return left;
    left = reachTerms(*sum, *left, depth);
    if (left && !isBounded(*left)) left = propagate({whole}, *left, depth + 1);
    if (!left || isBounded(*left) || sum->terms.size() < 2) return left;
    std::optional<Box> all;
    const double part = roundedUp(sum->level / double(sum->terms.size()));
    for (const Summand& term : sum->terms) {
        joinInto(all, reachTerm(term, part, *left, depth));
        if (all == left) break;
    }
    return all;
}

std::optional<Box> BoxContractor::propagate(std::vector<Constraint> constraints, const Box& box, int depth,
                                            Effort effort, std::vector<Replacement> replacements) {
    if (depth > kMaxDepth || isSpent()) return box;
    const std::vector<IrId> cone = coneOf(constraints);
    setVariables(box);
    forwards(cone, false);
    for (const Constraint& constraint : constraints)
        if (!intersect(current[constraint.id], constraint.range)) return std::nullopt;
    if (!narrow(cone, replacements, kMaxRounds)) return std::nullopt;
    if (!isBounded(variableBox()) && effort == Effort::cases) {
        caseDepth = kMaxCaseDepth;
        caseLimit = stepCount + kCaseSteps + kCaseStepsEach * cone.size();
        const bool isPossible = narrow(cone, replacements, kMaxRounds);
        caseDepth = 0;
        if (!isPossible) return std::nullopt;
    }
    const Box left = variableBox();
    if (effort == Effort::quick) return left;
    if (isBounded(left) || replacements.size() >= kMaxReplacements) return left;
    const std::vector<Piece> pieces = piecesOfUnbounded(cone, replacements);
    if (pieces.empty()) return left;
    std::optional<Box> all;
    for (const Piece& piece : pieces) {
        std::vector<Constraint> together = constraints;
        together.insert(together.end(), piece.constraints.begin(), piece.constraints.end());
        std::vector<Replacement> replaced = replacements;
        replaced.insert(replaced.end(), piece.replacements.begin(), piece.replacements.end());
        joinInto(all, propagate(std::move(together), left, depth + 1, effort, std::move(replaced)));
    }
    return all;
}

/// The cases of an unbounded |a|, minimum, maximum or choice that is a term of a bounded linear form.
std::vector<BoxContractor::Piece> BoxContractor::piecesOfUnbounded(
    std::span<const IrId> cone, std::span<const Replacement> replacements) {
    const auto isReplaced = [&](IrId id) {
        return std::ranges::find(replacements, id, &Replacement::first) != replacements.end();
    };
    const auto formOf = [&](IrId id) {
        if (isNumber(id)) return LinearForm{.terms = {}, .constant = everywhere[id].lo};
        if (isVariable(id)) return LinearForm{.terms = {{id, 1.0}}, .constant = 0.0};
        return substitute(frame.forms[id], replacements);
    };
    const auto piece = [](Constraint constraint, Replacement replacement) {
        Piece made{.constraints = {}, .replacements = {std::move(replacement)}};
        if (constraint.id != 0) made.constraints.push_back(constraint);
        return made;
    };
    for (const IrId row : cone) {
        if (frame.forms[row].terms.size() < 2 || !isBounded(current[row])) continue;
        for (const LinearForm::Term& term : frame.forms[row].terms) {
            const IrId id = term.atom;
            if (isVariable(id) || isBounded(current[id]) || isReplaced(id)) continue;
            const IrNode& node = ir[id];
            const IrId a = node.operands[0], b = node.operands[1], c = node.operands[2];
            switch (node.op) {
                case Op::absolute:
                    return {piece({a, {0.0, kHuge}}, {id, formOf(a)}),
                            piece({a, {-kHuge, 0.0}}, {id, sum({}, formOf(a), -1.0)})};
                case Op::minimum:
                case Op::maximum: return {piece({}, {id, formOf(a)}), piece({}, {id, formOf(b)})};
                case Op::select: {
                    // All that is chosen by the same condition is chosen together.
                    const bool isKnown = !mayBeNaN[a];
                    Piece taken = piece({isKnown ? a : 0, {1.0, 1.0}}, {id, formOf(b)}),
                          other = piece({isKnown ? a : 0, {0.0, 0.0}}, {id, formOf(c)});
                    for (const IrId same : cone) {
                        if (same == id || ir[same].op != Op::select || ir[same].operands[0] != a ||
                            isReplaced(same))
                            continue;
                        taken.replacements.push_back({same, formOf(ir[same].operands[1])});
                        other.replacements.push_back({same, formOf(ir[same].operands[2])});
                    }
                    return {std::move(taken), std::move(other)};
                }
                default: break;
            }
        }
    }
    return {};
}

}  // namespace fw
