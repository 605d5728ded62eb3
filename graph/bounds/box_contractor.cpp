#include "graph/bounds/box_contractor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "graph/bounds/undefined.h"

namespace fw {

namespace {

constexpr int kMaxRounds = 4;     // forwards and backwards through one cone
constexpr int kMaxCaseDepth = 3;  // of nested cases
constexpr int kMaxRepeats = 4;
/// Of shells around the origin. The first one is thin, so that solids near the farthest coordinates are
/// bounded.
constexpr double kFirstShellRatio = 8.0 / 7.0, kShellRatio = 4.0, kSmallestShell = 1.0 / 1024.0;
constexpr int kMaxCuts = 4;               // of nested frames
constexpr double kWorthRepeating = 0.95;  // of a side
constexpr std::size_t kMaxReplacements = 4;
/// Steps that the cases within one cone may cost.
constexpr std::size_t kCaseSteps = 5'000, kCaseStepsEach = 40;

/// Of functions with a limited range: over all values up to this one they take all of it.
constexpr double kFarPhase = 1e15;
bool hasLimitedRange(Op op) {
    return op == Op::sine || op == Op::cosine || op == Op::gradientNoise || op == Op::simplexNoise ||
           op == Op::worleyNoise || op == Op::cellWall;
}

/// a / b where b is not 0: a divisor that ends at 0 has a known sign, and 1 / (0, h] is [1 / h, infinity).
/// Points where it is 0 hold no solid, if they have no volume.
Interval quotient(Interval a, Interval b) {
    const bool isOneSided = (b.lo == 0.0) != (b.hi == 0.0), hasSign = a.lo > 0.0 || a.hi < 0.0;
    if (!isOneSided || !hasSign) return a / b;
    const Interval least = Interval{std::min(std::abs(a.lo), std::abs(a.hi)), kHuge} /
                           Interval{std::max(-b.lo, b.hi), std::max(-b.lo, b.hi)};
    const Interval size{least.lo, kHuge};
    return (a.lo > 0.0) == (b.hi > 0.0) ? size : -size;
}

/// Numbers beyond kHuge are somewhere near that end: intervals have no larger ones.
Interval rangeOfConstant(double number) {
    if (number >= kHuge) return {0.1 * kHuge, kHuge};
    if (number <= -kHuge) return {-kHuge, -0.1 * kHuge};
    return {number, number};
}

}  // namespace

bool isFinite(const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!isBounded(sideOf(box, axis))) return false;
    return true;
}
bool isBounded(const Box& box) { return isFinite(box) && longestSide(box) <= kLongestSide; }

std::vector<double> shellSizes() {
    std::vector<double> sizes{kFarthest, kFarthest / kFirstShellRatio};
    for (double size = kFarthest / kShellRatio; size > kSmallestShell; size /= kShellRatio)
        sizes.push_back(size);
    return sizes;
}

BoxContractor::BoxContractor(const Ir& ir_, std::span<const Interval> parameters)
    : ir(ir_),
      current(ir.size()),
      mayBeNaN(ir.size()),
      isAngular(ir.size()),
      opposites(ir.size()),
      stamps(ir.size()),
      evaluatedIn(ir.size()),
      noted(ir.size()),
      notedIn(ir.size()) {
    frame->isAtom.resize(ir.size());
    for (const double size : shellSizes()) {
        frame->shells.push_back(cubeAround(size));
        farShell += size > kFarShell;
    }
    const std::vector<Interval> nearby = evaluateAll(parameters, cubeAround(kOverflowDistance));
    everywhere = evaluateAll(parameters, kAllSpace);
    mayBeNaN = findUndefined(ir, everywhere, nearby);
    if (std::ranges::any_of(mayBeNaN, std::identity{})) everywhere = evaluateAll(parameters, kAllSpace);
    findAngles();
    findOpposites();
    findRotations();
    findSplines();
}

std::vector<Interval> BoxContractor::evaluateAll(std::span<const Interval> parameters, const Box& box) {
    setVariables(box);
    for (IrId id = 3; id < ir.size(); ++id) {
        const IrNode& node = ir[id];
        if (node.op == Op::column)
            current[id] = kEverything;
        else if (node.op == Op::parameter)
            current[id] = parameters[std::size_t(node.number)];
        else if (node.op == Op::constant)
            current[id] = rangeOfConstant(node.number);
        else
            current[id] = evaluate(id);
        if (!std::isfinite(current[id].lo) || !std::isfinite(current[id].hi)) current[id] = kEverything;
    }
    return current;
}

void BoxContractor::findAngles() {
    for (IrId id = 3; id < ir.size(); ++id) {
        const IrNode& node = ir[id];
        const std::span operands = std::span(node.operands).first(std::size_t(opInfo(node.op).arity));
        isAngular[id] =
            !isNumber(id) && (node.op == Op::arcTangent2 || std::ranges::all_of(operands, [&](IrId operand) {
                                  return isNumber(operand) || isAngular[operand];
                              }));
    }
}

void BoxContractor::findOpposites() {
    std::map<std::array<IrId, 2>, IrId> differences;
    for (IrId id = 3; id < ir.size(); ++id) {
        const IrNode& node = ir[id];
        if (node.op != Op::subtract || isNumber(id)) continue;
        const auto found = differences.find({node.operands[1], node.operands[0]});
        if (found != differences.end()) opposites[id] = found->second;
        differences.emplace(std::array{node.operands[0], node.operands[1]}, id);
    }
}

Interval BoxContractor::evaluate(IrId id) const {
    if (const LinearForm* form = derivedForm(id)) return rangeOver(*form, current);
    if (opposites[id] != 0) return -current[opposites[id]];
    const IrNode& node = ir[id];
    Interval operands[kMaxArity];
    const OpInfo& info = opInfo(node.op);
    for (int i = 0; i < info.arity; ++i) operands[i] = current[node.operands[std::size_t(i)]];
    // These are NaN of an infinite value; but an unbounded one need not be infinite, or it is in mayBeNaN.
    if (hasLimitedRange(node.op))
        for (int i = 0; i < info.arity; ++i)
            if (!isBounded(operands[i])) operands[i] = {-kFarPhase, kFarPhase};
    if (node.op == Op::divide && !mayBeNaN[id]) return quotient(operands[0], operands[1]);
    Interval result = info.interval(operands, samplesLayer(node.op) ? ir.layer(node) : SampledLayer{});
    // A comparison with NaN is false.
    if (node.op == Op::less || node.op == Op::lessEqual || node.op == Op::equal)
        if (mayBeNaN[id]) result = hull(result, {0.0, 0.0});
    // The other operand, where one is NaN.
    if (node.op == Op::minimum || node.op == Op::maximum)
        for (const std::size_t i : {0, 1})
            if (mayBeNaN[node.operands[i]]) result = hull(result, operands[1 - i]);
    return result;
}

Box BoxContractor::variableBox() const {
    Box box;
    for (std::size_t axis = 0; axis < frame->count; ++axis) {
        box.lo[axis] = current[frame->variables[axis]].lo;
        box.hi[axis] = current[frame->variables[axis]].hi;
    }
    return box;
}

void BoxContractor::setVariables(const Box& box) {
    for (std::size_t axis = 0; axis < frame->count; ++axis)
        current[frame->variables[axis]] = sideOf(box, axis);
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
        } else if (everywhere[id].lo >= 0.0) {
            continue;  // a solid is where its field is below 0
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
    return contractBy(Rules::thorough, {root, false, level}, box);
}

std::optional<Box> BoxContractor::contractExhaustively(IrId root, double level, const Box& box,
                                                       std::size_t steps) {
    const std::size_t wholeLimit = stepLimit;
    std::optional<Box> left = box;
    // Iterative deepening: what few frames bound is found before many are tried.
    for (int cuts = 1; cuts <= kMaxCuts && left && !isBounded(*left); ++cuts) {
        cutsLeft = cuts;
        stepLimit = std::min(wholeLimit, stepCount + (steps >> (kMaxCuts + 1 - std::max(cuts, 2))));
        left = contractBy(Rules::all, {root, false, level}, *left);
    }
    cutsLeft = 0;
    stepLimit = wholeLimit;
    return left && isBounded(*left) ? repeat({root, false, level}, *left) : left;
}

std::optional<Box> BoxContractor::contractBy(Rules wanted, const Goal& goal, const Box& box) {
    rules = wanted;
    const std::optional<Box> left = reach(goal, box, 0);
    rules = Rules::simple;
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
        if (derivedForm(id)) continue;
        if (opposites[id] != 0) {
            visit(opposites[id]);
            continue;
        }
        for (int i = 0; i < opInfo(ir[id].op).arity; ++i) visit(ir[id].operands[std::size_t(i)]);
    }
    std::ranges::sort(cone);
    return cone;
}

bool BoxContractor::mayBeUndefined(IrId root) {
    return std::ranges::any_of(coneOf(std::array{Constraint{root, {}}}),
                               [&](IrId id) { return mayBeNaN[id]; });
}

std::vector<IrId> BoxContractor::dependenciesOf(IrId id) const {
    std::vector<IrId> values;
    if (const LinearForm* form = derivedForm(id)) {
        for (const LinearForm::Term& term : form->terms) values.push_back(term.atom);
        return values;
    }
    if (opposites[id] != 0) return {opposites[id]};
    for (int i = 0; i < opInfo(ir[id].op).arity; ++i)
        if (const IrId operand = ir[id].operands[std::size_t(i)]; isVariable(operand) || !isNumber(operand))
            values.push_back(operand);
    return values;
}

std::optional<Box> BoxContractor::propagate(std::vector<Constraint> constraints, const Box& box, int depth,
                                            Effort effort, std::vector<Replacement> replacements) {
    if (depth > kMaxDepth || isSpent()) return box;
    const std::vector<IrId> cone = coneOf(constraints);
    setVariables(box);
    forwards(cone, false);
    for (const Constraint& constraint : constraints) {
        Interval range = current[constraint.id];
        if (!intersect(range, constraint.range)) return std::nullopt;
        if (!isNumber(constraint.id)) current[constraint.id] = range;
    }
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
        if (isNumber(id) && everywhere[id].isPoint())
            return LinearForm{.terms = {}, .constant = everywhere[id].lo};
        if (isNumber(id)) return LinearForm{.terms = {{id, 1.0}}, .constant = 0.0};
        if (isVariable(id)) return LinearForm{.terms = {{id, 1.0}}, .constant = 0.0};
        return substitute(frame->forms[id], replacements);
    };
    const auto piece = [](Constraint constraint, Replacement replacement) {
        Piece made{.constraints = {}, .replacements = {std::move(replacement)}};
        if (constraint.id != 0) made.constraints.push_back(constraint);
        return made;
    };
    for (const IrId row : cone) {
        if (frame->forms[row].terms.size() < 2 || !isBounded(current[row])) continue;
        for (const LinearForm::Term& term : frame->forms[row].terms) {
            const IrId id = term.atom;
            if (isVariable(id) || isBounded(current[id]) || isReplaced(id)) continue;
            const IrNode& node = ir[id];
            const IrId a = node.operands[0], b = node.operands[1], c = node.operands[2];
            switch (opOf(id)) {
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
                        if (same == id || opOf(same) != Op::select || ir[same].operands[0] != a ||
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
