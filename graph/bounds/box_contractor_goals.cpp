// The rules by which BoxContractor takes goals apart: unions, intersections, conditions, sums.
#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/bounds/box_contractor.h"

namespace fw {

namespace {

constexpr double kSmallestFactor = 1e-12;
constexpr std::size_t kMaxSummands = 16, kMaxCases = 32;

double roundedUp(double value) { return value + std::abs(value) * 1e-15; }
double roundedDown(double value) { return value - std::abs(value) * 1e-15; }

}  // namespace

BoxContractor::Goal BoxContractor::peeled(Goal goal) const {
    while (opOf(goal.id) != Op::count) {
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
    if (rules == Rules::simple) return reachTakenApart(goal, box, depth);
    const std::optional<Box> left = reachThroughCuts(goal, box, depth);
    const bool isEnough = rules == Rules::all && left && isBounded(*left);
    return left && !isEnough ? reachTakenApart(goal, *left, depth) : left;
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
    return left && !isBounded(*left) && rules != Rules::simple ? reachFromOutside(goal, *left, depth) : left;
}

/// A chain of smooth minima of width k is at most k below the sharp minimum of all: were it lower than a - k
/// for the next operand a, it would not blend with it. One of them is at most k / 4 below, and a tree of
/// depth d at most d k / 4.
std::optional<Box> BoxContractor::reachAny(const Goal& goal, const Box& box, int depth) {
    struct Operand {
        IrId id;
        double level;
        double chainStart, chainWidth;  // of the smooth minima that it is nested in
        bool isChain = true;            // one operand at least of each of them is not one itself
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
            const double width = std::max(0.0, rangeOf(node.operands[2]).hi);
            next.level = roundedUp(at.level + 0.25 * width);
            next.isChain = at.isChain && (opOf(node.operands[0]) != Op::smoothMinimum ||
                                          opOf(node.operands[1]) != Op::smoothMinimum);
            if (next.isChain) next.level = std::min(next.level, roundedUp(at.chainStart + next.chainWidth));
        } else {
            next.chainStart = at.level, next.chainWidth = 0.0, next.isChain = true;
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
    // All operands together may bound the box even if no single one does.
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

}  // namespace fw
