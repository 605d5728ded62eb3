// How BoxContractor bounds goals by values that stand between an expression and the position (frame_cut.h).
#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

#include "graph/bounds/box_contractor.h"
#include "graph/bounds/frame_cut.h"

namespace fw {

namespace {

constexpr std::size_t kMaxOperands = 2;
constexpr int kFarSamples = 24;
/// Powers of two between which the corner of a quadrant is searched, and bisections after that.
constexpr int kSmallestCorner = -16, kLargestCorner = 16, kCornerBisections = 4;

}  // namespace

/// Bounds the goal by the values that its expression is a function of.
std::optional<Box> BoxContractor::reachThroughCuts(const Goal& goal, const Box& box, int depth) {
    if (goal.id < 3 || isVariable(goal.id) || isNumber(goal.id)) return box;
    return once(frame->throughCuts, goal, rules == Rules::all ? cutsLeft : -1, box, [&] {
        return rules == Rules::all ? boundThroughCuts(goal, depth) : boundThroughOneCut(goal, depth);
    });
}

std::optional<Box> BoxContractor::boundThroughOneCut(const Goal& goal, int depth) {
    const std::vector<IrId> cone = coneOf(std::array{Constraint{goal.id, {}}});
    const Cut cut = vertexCut(cone, variables(), CutSide::variables);
    return cut.values.empty() ? kAllSpace : boundInSpaceOf(cut, goal, depth);
}

/// A box around all of space that meets the goal.
std::optional<Box> BoxContractor::boundThroughCuts(const Goal& goal, int depth) {
    if (cutsLeft == 0 || isSeenFarAway(goal, limits(), kFarSamples)) return kAllSpace;
    std::optional<Box> left = kAllSpace;
    std::set<std::vector<IrId>> tried{{}};
    const auto isOpen = [&] { return left && !isBounded(*left) && !isSpent(); };
    const auto narrowTo = [&](const std::optional<Box>& found) {
        left = found && left ? common(*left, *found) : std::nullopt;
    };
    const auto tryInSpaceOf = [&](const Cut& cut) {
        if (isOpen() && tried.insert(cut.values).second) narrowTo(boundInSpaceOf(cut, goal, depth));
    };
    const auto tryOperands = [&](const Cut& cut) {
        if (isOpen() && !cut.values.empty() && cut.values.size() <= kMaxOperands)
            narrowTo(boundByOperands(cut, goal, depth));
    };
    const std::vector<IrId> cone = coneOf(std::array{Constraint{goal.id, {}}});
    tryInSpaceOf(linearCut(cone));
    const Cut nearVariables = isOpen() ? vertexCut(cone, variables(), CutSide::variables) : Cut{};
    tryInSpaceOf(nearVariables);
    // Some variables are replaced, the others stay: {x, y + x^2, z} of a field that is bent along x.
    for (std::size_t some = 1; some + 1 < std::size_t(1) << frame->count; ++some) {
        std::vector<IrId> replaced, kept;
        for (std::size_t i = 0; i < frame->count; ++i)
            (some >> i & 1 ? replaced : kept).push_back(frame->variables[i]);
        Cut cut = isOpen() ? vertexCut(cone, replaced, CutSide::variables) : Cut{};
        if (cut.values.empty() || cut.values.size() > replaced.size()) continue;
        cut.values.insert(cut.values.end(), kept.begin(), kept.end());
        tryInSpaceOf(cut);
    }
    tryOperands(nearVariables);
    if (isOpen()) tryOperands(vertexCut(cone, variables(), CutSide::root));
    return left;
}

/// Values between the last one of the cone and some of the variables.
BoxContractor::Cut BoxContractor::vertexCut(std::span<const IrId> cone, std::span<const IrId> some,
                                            CutSide side) {
    stepCount += 8 * cone.size();
    const auto operandsOf = [&](IrId id) {
        std::vector<IrId> operands = dependenciesOf(id);
        std::erase_if(operands, [&](IrId operand) {
            return isVariable(operand) && std::ranges::find(some, operand) == some.end();
        });
        return operands;
    };
    return {frameCut(cone, some, side, operandsOf, [&](IrId id) { return !isAngular[id]; })};
}

/// Whether a variable, or a value whose form is known, is linear in the variables.
bool BoxContractor::isLinear(IrId id) const {
    return isVariable(id) || std::ranges::all_of(frame->forms[id].terms, [&](const LinearForm::Term& term) {
               return isVariable(term.atom);
           });
}

/// Values that are linear in the variables and determine the last one of the cone. A solid that was turned
/// and then distorted has its own coordinates for them, although others are sums of them.
BoxContractor::Cut BoxContractor::linearCut(std::span<const IrId> cone) {
    stepCount += cone.size();
    frame->forms.add(ir, cone, everywhere, frame->isAtom);
    if (isLinear(cone.back())) return {};
    std::vector<IrId> values;
    for (const IrId id : cone)
        if (!isLinear(id))
            for (const IrId operand : dependenciesOf(id))
                if (isLinear(operand) && std::ranges::find(values, operand) == values.end())
                    values.push_back(operand);
    std::vector<LinearForm> forms;
    bool isMixed = false;
    for (const IrId id : values) {
        forms.push_back(isVariable(id) ? LinearForm{.terms = {{id, 1.0}}, .constant = 0.0}
                                       : frame->forms[id]);
        isMixed |= forms.back().terms.size() > 1;
    }
    if (!isMixed) return {};
    const LinearBasis basis = basisOf(forms, variables());
    if (basis.chosen.empty()) return {};
    Cut cut;
    for (const std::size_t i : basis.chosen) cut.values.push_back(values[i]);
    if (std::ranges::all_of(cut.values, [&](IrId id) { return isVariable(id); })) return {};
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::ranges::find(cut.values, values[i]) != cut.values.end()) continue;
        LinearForm form{.terms = {}, .constant = basis.forms[i].constant};
        for (const LinearForm::Term& term : basis.forms[i].terms)
            form.terms.push_back({cut.values[term.atom], term.factor});
        std::ranges::sort(form.terms, {}, &LinearForm::Term::atom);
        cut.derived.emplace(values[i], std::move(form));
    }
    return cut;
}

/// Evaluates all values of the goal's cone as linear forms that are some.
void BoxContractor::deriveLinear(const Goal& goal) {
    const std::vector<IrId> cone = coneOf(std::array{Constraint{goal.id, {}}});
    frame->forms.add(ir, cone, everywhere, frame->isAtom);
    for (const IrId id : cone)
        if (isLinear(id)) frame->derived.emplace(id, frame->forms[id]);
}

/// The frame whose variables are the values of the cut.
BoxContractor::Frame& BoxContractor::frameOf(const Cut& cut) {
    const auto [found, isNew] = frames.try_emplace(cut.values);
    Frame& inner = found->second;
    const auto derive = [&](IrId id, const LinearForm& form) {
        if (inner.derived.emplace(id, form).second) inner.forms.set(id, form);
    };
    for (const auto& [id, form] : cut.derived) derive(id, form);
    // Variables that stay keep the forms of them.
    for (const auto& [id, form] : frame->derived)
        if (std::ranges::find(cut.values, id) == cut.values.end() &&
            std::ranges::all_of(form.terms, [&](const LinearForm::Term& term) {
                return std::ranges::find(cut.values, term.atom) != cut.values.end();
            }))
            derive(id, form);
    if (!isNew) return inner;
    for (IrId id = 3; id < ir.size(); ++id)
        if (opposites[id] != 0 && std::ranges::find(cut.values, opposites[id]) != cut.values.end())
            derive(id, {.terms = {{opposites[id], -1.0}}, .constant = 0.0});
    inner.count = cut.values.size();
    inner.isAtom = frames.begin()->second.isAtom;
    std::ranges::copy(cut.values, inner.variables.begin());
    std::vector<Constraint> unconstrained;
    for (const IrId id : cut.values) {
        inner.isAtom[id] = true;
        unconstrained.push_back({id, kEverything});
    }
    const std::vector<IrId> cone = coneOf(unconstrained);
    for (const Box& shell : frame->shells) {
        setVariables(shell);
        forwards(cone, false);
        Box& image = inner.shells.emplace_back();
        for (std::size_t i = 0; i < cut.values.size(); ++i)
            image.lo[i] = current[cut.values[i]].lo, image.hi[i] = current[cut.values[i]].hi;
    }
    return inner;
}

bool BoxContractor::isFunctionOfVariables(IrId id) {
    // A coordinate in the cone is no variable, but it may be a linear form of the variables.
    return std::ranges::none_of(coneOf(std::array{Constraint{id, {}}}),
                                [&](IrId at) { return at < 3 && !derivedForm(at); });
}

Box BoxContractor::rangesOfVariables() const {
    Box box{};
    for (std::size_t i = 0; i < frame->count; ++i) {
        box.lo[i] = everywhere[frame->variables[i]].lo;
        box.hi[i] = everywhere[frame->variables[i]].hi;
    }
    return box;
}

/// Bounds the values of the cut, and then the variables by these.
std::optional<Box> BoxContractor::boundInSpaceOf(const Cut& cut, const Goal& goal, int depth) {
    // The ranges over the current box are not valid in all of the cut's space.
    const uint32_t outerGeneration = std::exchange(rangeGeneration, 0u);
    Frame* const outer = std::exchange(frame, &frameOf(cut));
    assert(isFunctionOfVariables(goal.id));
    const std::size_t outerLimit = shellLimit;
    const Rules outerRules = std::exchange(rules, Rules::simple);
    std::optional<Box> found = reach(goal, rangesOfVariables(), depth + 1);
    if (found && !isBounded(*found)) found = reach(goal, *found, depth + 1);
    if (outerRules == Rules::all && found && !isBounded(*found)) {
        rules = Rules::all;
        --cutsLeft;
        found = reach(goal, *found, depth + 1);
        ++cutsLeft;
        rules = Rules::simple;
    }
    shellLimit = outerLimit;
    frame = outer;
    if (found) {
        std::vector<Constraint> ranges;
        for (std::size_t i = 0; i < cut.values.size(); ++i)
            ranges.push_back({cut.values[i], sideOf(*found, i)});
        found = propagate(ranges, kAllSpace, depth + 1);
        rules = outerRules;
        // Each range is also a goal.
        for (const Constraint& range : ranges) {
            const bool isNew = rules == Rules::all && !isVariable(range.id) && found && !isBounded(*found);
            if (isNew && range.range.hi < everywhere[range.id].hi)
                found = reach({range.id, false, range.range.hi}, *found, depth + 1);
            if (isNew && found && range.range.lo > everywhere[range.id].lo)
                found = reach({range.id, true, range.range.lo}, *found, depth + 1);
        }
    }
    rules = outerRules;
    rangeGeneration = outerGeneration;
    return found;
}

/// Bounds what a blend of any form has of each operand. For operands a and b the goal is free in the quadrant
/// a > c, b > c if intervals prove so; then a <= c or b <= c wherever it is met. `cut`: the operands.
std::optional<Box> BoxContractor::boundByOperands(const Cut& cut, const Goal& goal, int depth) {
    for (const IrId id : cut.values)
        if (mayBeNaN[id]) return kAllSpace;
    const uint32_t outerGeneration = std::exchange(rangeGeneration, 0u);
    Frame* const outer = std::exchange(frame, &frameOf(cut));
    const std::size_t outerLimit = std::exchange(shellLimit, stepLimit);
    assert(isFunctionOfVariables(goal.id));
    // As a linear form a + (b - a) t grows with both a and b, which the intervals of its operations hide.
    const std::map<IrId, LinearForm> derived = frame->derived;
    deriveLinear(goal);
    std::vector<std::vector<Goal>> alternatives;
    for (std::size_t signs = 0; signs < std::size_t(1) << cut.values.size(); ++signs) {
        const auto isFree = [&](double corner) {
            Box quadrant = rangesOfVariables();
            for (std::size_t i = 0; i < cut.values.size(); ++i) {
                if (signs >> i & 1)
                    quadrant.hi[i] = std::min(quadrant.hi[i], -corner);
                else
                    quadrant.lo[i] = std::max(quadrant.lo[i], corner);
                if (quadrant.lo[i] > quadrant.hi[i]) return true;
            }
            return isUnreachable(goal, quadrant, 0, depth);
        };
        int first = kSmallestCorner, last = kLargestCorner;
        if (!isFree(std::ldexp(1.0, last))) continue;
        while (first < last) {
            const int middle = (first + last) >> 1;
            if (isFree(std::ldexp(1.0, middle)))
                last = middle;
            else
                first = middle + 1;
        }
        double corner = isFree(0.0) ? 0.0 : std::ldexp(1.0, last), inside = 0.5 * corner;
        for (int i = 0; i < kCornerBisections && corner > 0.0; ++i) {
            const double middle = 0.5 * (inside + corner);
            (isFree(middle) ? corner : inside) = middle;
        }
        std::vector<Goal> either;
        for (std::size_t i = 0; i < cut.values.size(); ++i) {
            const bool isNegative = signs >> i & 1;
            either.push_back({cut.values[i], isNegative, isNegative ? -corner : corner});
        }
        alternatives.push_back(std::move(either));
    }
    frame->derived = derived;
    shellLimit = outerLimit;
    frame = outer;
    std::optional<Box> left = kAllSpace;
    for (const std::vector<Goal>& either : alternatives) {
        std::optional<Box> all;
        for (const Goal& one : either) {
            joinInto(all, reach(one, *left, depth + 1));
            if (all == left) break;
        }
        left = all;
        if (!left) break;
    }
    rangeGeneration = outerGeneration;
    return left;
}

}  // namespace fw
