#include "graph/evaluate/switching_set.h"

#include <algorithm>
#include <cmath>

namespace fw {

namespace {

constexpr int kMaxVisits = 96, kMaxSwitchDepth = 16;

bool isEmpty(Interval a) { return a.lo > a.hi; }
Interval common(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)}; }

}  // namespace

void SwitchingSet::Sum::add(uint32_t term, double factor) {
    for (int i = 0; i < count; ++i)
        if (terms[std::size_t(i)] == term) {
            factors[std::size_t(i)] += factor;
            return;
        }
    if (count == kMaxTerms) {
        tooLong = true;
        return;
    }
    terms[std::size_t(count)] = term, factors[std::size_t(count++)] = factor;
}

const TapeStep* SwitchingSet::stepOf(uint32_t name) const {
    return name < 3 || (name & TapeValues::kNumber) ? nullptr : &tape->steps[name - 3];
}

void SwitchingSet::expand(Sum& sum, uint32_t name, double factor, int depth) const {
    if (name & TapeValues::kNumber) {
        sum.constant += factor * values->interval(*tape, name).lo;
        return;
    }
    const TapeStep* const step = stepOf(name);
    if (!step || depth == 0) return sum.add(name, factor);
    const auto& x = values->operands[name - 3];
    switch (step->op) {
        case Op::constant: sum.constant += factor * values->intervals[name].lo; return;
        case Op::negate: return expand(sum, x[0], -factor, depth - 1);
        case Op::add:
        case Op::subtract:
            expand(sum, x[0], factor, depth - 1);
            return expand(sum, x[1], step->op == Op::add ? factor : -factor, depth - 1);
        case Op::multiply:
            for (std::size_t i = 0; i < 2; ++i)
                if (const Interval k = values->interval(*tape, x[i]); k.isPoint() && isBounded(k))
                    return expand(sum, x[1 - i], factor * k.lo, depth - 1);
            return sum.add(name, factor);
        default: return sum.add(name, factor);
    }
}

SwitchingSet::Entry* SwitchingSet::find(uint32_t name) {
    const auto found = std::ranges::find(entries, name, &Entry::name);
    return found == entries.end() ? nullptr : &*found;
}

Interval SwitchingSet::narrowed(uint32_t name) const {
    const auto found = std::ranges::find(entries, name, &Entry::name);
    return found == entries.end() ? values->interval(*tape, name) : found->interval;
}

/// Narrows the interval of a value and of those that it is made of; false if nothing is left.
bool SwitchingSet::narrow(uint32_t name, Interval to, int depth) {
    const Interval before = narrowed(name), now = common(before, to);
    if (isEmpty(now)) return false;
    const TapeStep* const step = stepOf(name);
    const bool unchanged = now.lo == before.lo && now.hi == before.hi;
    if ((name & TapeValues::kNumber) || unchanged || --visits < 0) return true;
    if (Entry* const entry = find(name))
        entry->interval = now;
    else
        entries.push_back({name, now});
    if (!step || depth == 0) return true;
    const auto& x = values->operands[name - 3];
    switch (step->op) {
        case Op::negate: return narrow(x[0], -now, depth - 1);
        case Op::absolute: return narrow(x[0], {-now.hi, now.hi}, depth - 1);
        case Op::square: {
            const double most = std::sqrt(std::max(above(now.hi), 0.0)) * (1.0 + 1e-15);
            return narrow(x[0], {-most, most}, depth - 1);
        }
        case Op::squareRoot:
            return now.hi >= kHuge || narrow(x[0], {-kHuge, square({0.0, now.hi}).hi}, depth - 1);
        case Op::maximum:
            for (std::size_t i = 0; i < 2; ++i) {
                const bool decides = narrowed(x[1 - i]).hi < now.lo;
                if (!narrow(x[i], {decides ? now.lo : -kHuge, now.hi}, depth - 1)) return false;
            }
            return true;
        case Op::minimum:
            for (std::size_t i = 0; i < 2; ++i) {
                const bool decides = narrowed(x[1 - i]).lo > now.hi;
                if (!narrow(x[i], {now.lo, decides ? now.hi : kHuge}, depth - 1)) return false;
            }
            return true;
        case Op::add:
        case Op::subtract:
        case Op::multiply:
            // Two operands that both vary narrow each other too little to be worth the time.
            for (std::size_t i = 0; i < 2; ++i) {
                const Interval other = narrowed(x[1 - i]);
                if (!other.isPoint()) continue;
                const Interval operand = step->op == Op::add        ? now - other
                                         : step->op == Op::multiply ? now / other
                                         : i == 0                   ? now + other
                                                                    : other - now;
                if (!narrow(x[i], operand, depth - 1)) return false;
            }
            return true;
        default: return true;
    }
}

/// The interval of a value over the narrowed ones that it is made of.
Interval SwitchingSet::again(uint32_t name, int depth) {
    const TapeStep* const step = stepOf(name);
    const Interval before = narrowed(name);
    if (!step || depth == 0 || samplesLayer(step->op) || step->op == Op::constant || visits < 0)
        return before;
    if (find(name)) return before;
    const OpInfo& info = opInfo(step->op);
    if (info.weight > 10) return before;
    --visits;
    Interval operands[kMaxArity];
    for (std::size_t i = 0; i < std::size_t(info.arity); ++i)
        operands[i] = again(values->operands[name - 3][i], depth - 1);
    const Interval now = common(before, info.interval(operands, {}));
    if (isEmpty(now)) return before;
    entries.push_back({name, now});
    return now;
}

bool SwitchingSet::isSmall(const Sum& sum, double tolerance) {
    if (sum.tooLong) return false;
    Interval total{sum.constant, sum.constant};
    for (int i = 0; i < sum.count; ++i) {
        const double factor = sum.factors[std::size_t(i)];
        if (factor == 0.0) continue;
        const Interval term = again(sum.terms[std::size_t(i)], kMaxSwitchDepth);
        if (!isBounded(term)) return false;
        total = total + Interval{factor, factor} * term;
    }
    return total.lo >= -tolerance && total.hi <= tolerance;
}

bool SwitchingSet::meetWhereEqual(uint32_t g, uint32_t h, uint32_t a, uint32_t b) {
    // A side that jumps makes the condition change where the sides are not equal.
    for (const uint32_t side : {g, h})
        if (!(side & TapeValues::kNumber) && !values->continuous[side]) return false;
    const Interval sides = common(values->interval(*tape, g), values->interval(*tape, h));
    if (isEmpty(sides)) return true;
    const Interval first = values->interval(*tape, a), second = values->interval(*tape, b);
    const double size = std::max(absolute(first).hi, absolute(second).hi);
    if (!(size < kHuge)) return false;
    const double tolerance = std::min(kJumpRounding * size, kMaxJump);
    Sum switching, difference;
    expand(switching, g, 1.0, kMaxSwitchDepth), expand(switching, h, -1.0, kMaxSwitchDepth);
    expand(difference, a, 1.0, kMaxSwitchDepth), expand(difference, b, -1.0, kMaxSwitchDepth);
    if (difference.tooLong) return false;
    entries.clear();
    visits = kMaxVisits;
    // The factor that cancels the largest term of g - h.
    Sum rest = difference;
    if (!switching.tooLong && switching.count > 0) {
        const auto end = switching.factors.begin() + switching.count;
        const auto largest = std::max_element(switching.factors.begin(), end,
                                              [](double x, double y) { return std::abs(x) < std::abs(y); });
        const uint32_t term = switching.terms[std::size_t(largest - switching.factors.begin())];
        double scale = 0.0;
        for (int i = 0; i < difference.count; ++i)
            if (difference.terms[std::size_t(i)] == term && *largest != 0.0)
                scale = difference.factors[std::size_t(i)] / *largest;
        for (int i = 0; i < switching.count && scale != 0.0; ++i)
            rest.add(switching.terms[std::size_t(i)], -scale * switching.factors[std::size_t(i)]);
        rest.constant -= scale * switching.constant;
        if (isSmall(rest, tolerance)) return true;
    }
    entries.clear();
    visits = kMaxVisits;
    if (!narrow(g, sides, kMaxSwitchDepth) || !narrow(h, sides, kMaxSwitchDepth)) return true;
    return isSmall(difference, tolerance) || isSmall(rest, tolerance);
}

/// Whether a and b meet wherever the condition changes.
bool SwitchingSet::meetsAlong(uint32_t condition, uint32_t a, uint32_t b, int depth) {
    if (values->interval(*tape, condition).isPoint()) return true;
    const TapeStep* const step = stepOf(condition);
    if (!step || depth == 0) return false;
    const auto& x = values->operands[condition - 3];
    switch (step->op) {
        case Op::less:
        case Op::lessEqual:
        case Op::equal: return meetWhereEqual(x[0], x[1], a, b);
        case Op::logicalNot: return meetsAlong(x[0], a, b, depth - 1);
        case Op::logicalAnd:
        case Op::logicalOr: return meetsAlong(x[0], a, b, depth - 1) && meetsAlong(x[1], a, b, depth - 1);
        default: return false;
    }
}

bool SwitchingSet::branchesMeet(const Tape& tape_, const TapeValues& values_, uint32_t choice) {
    tape = &tape_, values = &values_;
    const auto& x = values->operands[choice - 3];
    return meetsAlong(x[0], x[1], x[2], kMaxSwitchDepth);
}

}  // namespace fw
