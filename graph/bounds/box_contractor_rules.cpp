// The rules by which BoxContractor narrows the values of one expression.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "graph/bounds/box_contractor.h"

namespace fw {

namespace {

/// These swallow an operand that is not a number.
bool ignoresNaN(Op op) {
    switch (op) {
        case Op::minimum:
        case Op::maximum:
        case Op::select:
        case Op::less:
        case Op::lessEqual:
        case Op::equal:
        case Op::logicalAnd:
        case Op::logicalOr:
        case Op::logicalNot: return true;
        default: return false;
    }
}

Box boxOf(const Spline& spline) {
    std::optional<Box> all;
    for (const SpaceArc& arc : spline.arcs) {
        // An arc is this close to its chord.
        const double sagitta = 0.5 * arc.half * arc.half * arc.bend + 1e-12;
        for (const double s : {-arc.half, arc.half}) {
            const glm::dvec3 end = placeOn(arc, s);
            Box box;
            for (std::size_t axis = 0; axis < 3; ++axis)
                box.lo[axis] = end[int(axis)] - sagitta, box.hi[axis] = end[int(axis)] + sagitta;
            joinInto(all, box);
        }
    }
    return all.value_or(Box{});
}

/// A round that leaves more than this share of every side is the last.
constexpr double kWorthwhile = 0.9;

/// x cos(angle) or x sin(angle), either negated.
struct TurnedTerm {
    IrId x, angle;
    bool isSine, isNegative;
};

/// The sine or cosine that a value is: the rotating nodes write mod(a, 180) == 0 ? 0 : sin(radians(a)), and
/// the cosine likewise with a - 90, so that multiples of 90 degrees are exact.
IrId exactTurn(const Ir& ir, IrId id) {
    const IrNode& choice = ir[id];
    if (choice.op != Op::select || !ir.isConstant(choice.operands[1], 0.0)) return id;
    const IrNode &condition = ir[choice.operands[0]], &turn = ir[choice.operands[2]];
    if (condition.op != Op::equal || (turn.op != Op::sine && turn.op != Op::cosine)) return id;
    const bool zeroFirst = ir.isConstant(condition.operands[0], 0.0);
    if (!zeroFirst && !ir.isConstant(condition.operands[1], 0.0)) return id;
    const IrNode &remainder = ir[condition.operands[zeroFirst ? 1 : 0]], &radians = ir[turn.operands[0]];
    if (remainder.op != Op::modulo || !ir.isConstant(remainder.operands[1], 180.0) ||
        radians.op != Op::multiply)
        return id;
    IrId degrees = remainder.operands[0];
    if (turn.op == Op::cosine) {
        if (ir[degrees].op != Op::subtract || !ir.isConstant(ir[degrees].operands[1], 90.0)) return id;
        degrees = ir[degrees].operands[0];
    }
    for (const std::size_t i : {0, 1})
        if (radians.operands[i] == degrees && ir.isConstant(radians.operands[1 - i]) &&
            std::abs(ir.number(radians.operands[1 - i]) - std::numbers::pi / 180.0) < 1e-15)
            return choice.operands[2];
    return id;
}

std::optional<TurnedTerm> turnedTerm(const Ir& ir, IrId id) {
    bool isNegative = false;
    while (ir[id].op == Op::negate) id = ir[id].operands[0], isNegative = !isNegative;
    if (ir[id].op != Op::multiply) return std::nullopt;
    for (const std::size_t i : {0, 1}) {
        const IrNode& turn = ir[exactTurn(ir, ir[id].operands[i])];
        if (turn.op == Op::sine || turn.op == Op::cosine)
            return TurnedTerm{ir[id].operands[1 - i], turn.operands[0], turn.op == Op::sine, isNegative};
    }
    return std::nullopt;
}

}  // namespace

bool BoxContractor::forwards(std::span<const IrId> cone, bool narrow) {
    stepCount += cone.size();
    if (!narrow) ++evaluation;
    for (const IrId id : cone) {
        evaluatedIn[id] = evaluation;
        if (!narrow)
            current[id] = evaluate(id);
        else if (!intersect(current[id], evaluate(id)))
            return false;
    }
    return true;
}

bool BoxContractor::backwards(std::span<const IrId> cone) {
    stepCount += cone.size();
    for (std::size_t i = cone.size(); i-- > 0;)
        if (!projectNode(cone[i]) || !projectRotations(cone[i]) || !projectSplines(cone[i]) ||
            (caseDepth > 0 && !disjoin(cone[i])))
            return false;
    return true;
}

/// The cases of a value that is one of its operands, as constraints on these; none if it is known which.
std::vector<std::vector<BoxContractor::Constraint>> BoxContractor::casesOf(IrId id) const {
    const IrNode& node = ir[id];
    const IrId a = node.operands[0], b = node.operands[1], c = node.operands[2];
    const Interval range = current[id];
    std::vector<std::vector<Constraint>> cases;
    switch (opOf(id)) {
        case Op::minimum:
        case Op::smoothMinimum: {
            const double blend = node.op == Op::minimum ? 0.0 : 0.25 * std::max(current[c].hi, 0.0);
            const Interval wanted{-kHuge, range.hi + blend + 1e-12 * std::abs(range.hi)};
            if (current[a].lo > wanted.hi || current[b].lo > wanted.hi ||
                (current[a].hi <= wanted.hi && current[b].hi <= wanted.hi))
                return {};
            if (node.op == Op::smoothMinimum) return {{{a, wanted}}, {{b, wanted}}};
            for (const IrId operand : operandsOf(id, node.op)) cases.push_back({{operand, wanted}});
            return cases;
        }
        case Op::maximum: {
            const Interval wanted{range.lo - 1e-12 * std::abs(range.lo), kHuge};
            if (current[a].hi < wanted.lo || current[b].hi < wanted.lo ||
                (current[a].lo >= wanted.lo && current[b].lo >= wanted.lo))
                return {};
            for (const IrId operand : operandsOf(id, node.op)) cases.push_back({{operand, wanted}});
            return cases;
        }
        case Op::select:
            if (current[a].isPoint()) return {};
            if (mayBeNaN[a]) return {{{b, range}}, {{c, range}}};
            return {{{a, {1.0, 1.0}}, {b, range}}, {{a, {0.0, 0.0}}, {c, range}}};
        default: return {};
    }
}

/// Narrows all operands of a minimum, a maximum or a choice to the hull of their intervals in its cases.
bool BoxContractor::disjoin(IrId id) {
    const std::vector<std::vector<Constraint>> cases = casesOf(id);
    if (cases.empty() || stepCount > caseLimit) return true;
    --caseDepth;
    std::vector<Constraint> all;
    for (const auto& constraints : cases) all.insert(all.end(), constraints.begin(), constraints.end());
    std::vector<IrId> values = coneOf(all);
    values.insert(values.begin(), frame->variables.begin(),
                  frame->variables.begin() + std::ptrdiff_t(frame->count));
    std::vector<Interval> before, hulls;
    for (const IrId value : values) before.push_back(current[value]);
    for (const auto& constraints : cases) {
        bool isPossible = true;
        for (const Constraint& constraint : constraints) {
            Interval range = current[constraint.id];
            isPossible = isPossible && intersect(range, constraint.range);
            if (isPossible && !isNumber(constraint.id)) current[constraint.id] = range;
        }
        if (isPossible && backwards(coneOf(constraints))) {
            const bool isFirst = hulls.empty();
            hulls.resize(values.size());
            for (std::size_t i = 0; i < values.size(); ++i)
                hulls[i] = isFirst ? current[values[i]] : hull(hulls[i], current[values[i]]);
        }
        for (std::size_t i = 0; i < values.size(); ++i) current[values[i]] = before[i];
    }
    ++caseDepth;
    if (hulls.empty()) return false;
    for (std::size_t i = 0; i < values.size(); ++i) current[values[i]] = hulls[i];
    return true;
}

std::size_t BoxContractor::boundedCount(std::span<const IrId> cone) const {
    std::size_t count = 0;
    for (std::size_t axis = 0; axis < frame->count; ++axis)
        count += isBounded(current[frame->variables[axis]]);
    for (const IrId id : cone) count += isBounded(current[id]);
    return count;
}

/// Goes backwards and forwards through the cone until nothing more is bounded and the box shrinks little.
bool BoxContractor::narrow(std::span<const IrId> cone, std::span<const Replacement> replacements,
                           int rounds) {
    for (int round = 0; round < rounds; ++round) {
        const Box before = variableBox();
        const std::size_t boundedBefore = boundedCount(cone);
        bool solved = false;
        if (!backwards(cone) || !solveLinear(cone, replacements, solved) || (solved && !backwards(cone)) ||
            !forwards(cone, true))
            return false;
        bool worthwhile = solved || boundedCount(cone) > boundedBefore;
        const Box after = variableBox();
        for (std::size_t axis = 0; axis < frame->count; ++axis)
            worthwhile |= after.hi[axis] - after.lo[axis] < kWorthwhile * (before.hi[axis] - before.lo[axis]);
        if (!worthwhile || isSpent()) break;
    }
    return true;
}

bool BoxContractor::projectDerived(IrId id, const LinearForm& form) {
    for (const LinearForm::Term& term : form.terms)
        if (!intersect(current[term.atom], solveForTerm(form, term.atom, current[id], current))) return false;
    return true;
}

bool BoxContractor::projectNode(IrId id) {
    if (const LinearForm* form = derivedForm(id)) return projectDerived(id, *form);
    if (opposites[id] != 0) return intersect(current[opposites[id]], -current[id]);
    const IrNode& node = ir[id];
    const int arity = opInfo(node.op).arity;
    Interval operands[kMaxArity];
    bool isUndefined = false;
    for (int i = 0; i < arity; ++i) {
        operands[i] = current[node.operands[std::size_t(i)]];
        isUndefined |= mayBeNaN[node.operands[std::size_t(i)]];
    }
    if (isUndefined && ignoresNaN(node.op)) return true;
    if (node.op == Op::multiply) {  // x x^2 has the sign of x
        for (const std::size_t i : {0, 1}) {
            const IrId x = node.operands[i], other = node.operands[1 - i];
            if (ir[other].op != Op::square || ir[other].operands[0] != x || isNumber(x)) continue;
            const Interval root{current[id].lo > -kHuge ? std::cbrt(current[id].lo) : -kHuge,
                                current[id].hi < kHuge ? std::cbrt(current[id].hi) : kHuge};
            if (!intersect(current[x],
                           outward(root.lo - 1e-14 * std::abs(root.lo), root.hi + 1e-14 * std::abs(root.hi))))
                return false;
        }
    }
    const SampledLayer layer = samplesLayer(node.op) ? ir.layer(node) : SampledLayer{};
    if (!projectOperands(node.op, current[id], operands, layer)) return false;
    for (int i = 0; i < arity; ++i) {
        const IrId operand = node.operands[std::size_t(i)];
        if (!isNumber(operand) && !intersect(current[operand], operands[i])) return false;
    }
    return true;
}

bool BoxContractor::projectRotations(IrId id) {
    const auto [first, last] = rotations.equal_range(id);
    for (auto it = first; it != last; ++it) {
        const Rotation& turn = it->second;
        if (!isCurrent(turn.p) || !isCurrent(turn.q) || !isBounded(current[turn.p]) ||
            !isBounded(current[turn.q]))
            continue;
        const double radius =
            std::hypot(absolute(current[turn.p]).hi, absolute(current[turn.q]).hi) * (1.0 + 1e-12);
        for (const IrId operand : {turn.x, turn.y})
            if (!isNumber(operand) && !intersect(current[operand], {-radius, radius})) return false;
    }
    return true;
}

/// The distance to a spline from the coordinates beside it; beyond an open end the place is as far off along
/// the spline as its coordinate says.
bool BoxContractor::projectSplines(IrId id) {
    const auto found = splines.find(id);
    if (found == splines.end()) return true;
    const SplineUse& use = found->second;
    const auto range = [&](SplineChannel channel) {
        const IrId value = use.channels[std::size_t(channel)];
        return value == 0 || !isCurrent(value) ? kEverything : current[value];
    };
    const Interval across = range(SplineChannel::across), up = range(SplineChannel::up),
                   along = range(SplineChannel::along), distance = range(SplineChannel::distance);
    double reach = kHuge;
    if (distance.hi < kHuge) reach = std::max(distance.hi, 0.0) + use.table->radius * use.table->mostShare;
    const bool isOpen = !use.table->spline->closed;
    if (isBounded(across) && isBounded(up) && (!isOpen || isBounded(along))) {
        const double over = isOpen ? std::max({0.0, -along.lo, along.hi - use.table->spline->length}) : 0.0;
        reach = std::min(reach, std::hypot(absolute(across).hi, absolute(up).hi, over));
    }
    if (reach >= kHuge) return true;
    reach *= 1.0 + 1e-6;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const IrId coordinate = use.place[axis];
        const double slack = reach + 1e-6 * (use.box.hi[axis] - use.box.lo[axis]) + 1e-12;
        const Interval narrowed{use.box.lo[axis] - slack, use.box.hi[axis] + slack};
        if (!isNumber(coordinate) && !intersect(current[coordinate], narrowed)) return false;
    }
    return true;
}

bool BoxContractor::solveLinear(std::span<const IrId> cone, std::span<const Replacement> replacements,
                                bool& narrowed) {
    if (isBounded(variableBox())) return true;
    frame->forms.add(ir, cone, everywhere, frame->isAtom);
    std::vector<LinearForm> rows;
    std::vector<Interval> bounds;
    for (const IrId id : cone) {
        if (frame->forms[id].isAtom(id) || (current[id].lo <= -kHuge && current[id].hi >= kHuge)) continue;
        LinearForm form = substitute(frame->forms[id], replacements);
        const bool isUseful = std::ranges::any_of(
            form.terms, [&](const LinearForm::Term& term) { return !isBounded(current[term.atom]); });
        if (!isUseful) continue;
        rows.push_back(std::move(form));
        bounds.push_back(current[id]);
    }
    // A replaced value that is bounded is a form, too.
    for (const auto& [id, form] : replacements)
        if (isBounded(current[id])) rows.push_back(form), bounds.push_back(current[id]);
    for (const IrId atom : solveForUnbounded(rows, bounds, current)) {
        const bool isEmpty = current[atom].lo > current[atom].hi;
        if (isNumber(atom)) current[atom] = everywhere[atom];
        if (isEmpty) return false;
        narrowed = true;
    }
    return true;
}

void BoxContractor::findRotations() {
    // By the angle and both turned values, in order of their ids: the sums that were seen.
    struct Seen {
        IrId id;
        bool firstIsSine, signsDiffer;
    };
    std::map<std::tuple<IrId, IrId, IrId>, std::vector<Seen>> sums;
    const auto note = [&](IrId id, const TurnedTerm& first, IrId y, bool signsDiffer) {
        std::vector<Seen>& others = sums[{first.angle, first.x, y}];
        for (const Seen& other : others)
            if (other.firstIsSine != first.isSine && (y == first.x || other.signsDiffer != signsDiffer)) {
                rotations.insert({std::min(id, other.id), {id, other.id, first.x, y}});
                frame->isAtom[id] = frame->isAtom[other.id] = true;
            }
        others.push_back({id, first.isSine, signsDiffer});
    };
    for (IrId id = 3; id < ir.size(); ++id) {
        const IrNode& node = ir[id];
        if (node.positions == 0) continue;
        if (const auto single = turnedTerm(ir, id); single && node.op == Op::multiply)
            note(id, *single, single->x, false);
        if (node.op != Op::add && node.op != Op::subtract) continue;
        auto first = turnedTerm(ir, node.operands[0]), second = turnedTerm(ir, node.operands[1]);
        if (!first || !second || first->angle != second->angle || first->isSine == second->isSine ||
            first->x == second->x)
            continue;
        if (node.op == Op::subtract) second->isNegative = !second->isNegative;
        if (second->x < first->x) std::swap(first, second);
        note(id, *first, second->x, first->isNegative != second->isNegative);
    }
}

void BoxContractor::findSplines() {
    std::map<std::tuple<const SplineTable*, IrId, IrId, IrId>, SplineUse> uses;
    for (IrId id = 3; id < ir.size(); ++id) {
        const IrNode& node = ir[id];
        if (node.op != Op::spline) continue;
        const SampledLayer layer = ir.layer(node);
        SplineUse& use = uses[{layer.spline, node.operands[0], node.operands[1], node.operands[2]}];
        use.table = layer.spline;
        use.channels[std::size_t(layer.channel)] = id;
        use.place = {node.operands[0], node.operands[1], node.operands[2]};
    }
    std::map<const SplineTable*, Box> boxes;
    for (auto& [key, use] : uses) {
        if (!boxes.contains(use.table)) boxes[use.table] = boxOf(*use.table->spline);
        use.box = boxes[use.table];
        IrId smallest = ~IrId(0);
        for (const IrId channel : use.channels)
            if (channel != 0) smallest = std::min(smallest, channel);
        splines[smallest] = use;
    }
}

}  // namespace fw
