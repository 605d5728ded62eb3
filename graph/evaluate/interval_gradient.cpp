#include "graph/evaluate/interval_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "graph/evaluate/slopes.h"
#include "graph/ir/noise.h"

namespace fw {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Beyond this, coordinates are too coarse for the functions that repeat with whole numbers.
constexpr double kFarCoordinate = 1e9;

constexpr Interval kOne{1.0, 1.0}, kZero{0.0, 0.0};

/// The slopes of an angle of the vector (x, y): (x dy - y dx) / (x² + y²), away from 0.
void angleSlopes(Interval y, Interval x, const Slopes& dy, const Slopes& dx, Slopes& result) {
    const Interval squared = square(x) + square(y);
    const Interval inverse = inverseRoot(squared);
    const Interval alongX = shareOfLength(x, square(y)), alongY = shareOfLength(y, square(x));
    Slopes first, second;
    scaled(alongX * inverse, dy, first), scaled(-(alongY * inverse), dx, second);
    const Slopes* const rows[] = {&dy, &dx};
    added(first, second, result);
    const double norm = spectralNorm(rows) * inverse.hi * (1.0 + 4.0 * kUlp);
    if (norm < result.hi[kNorm]) setNorm(result, norm);
    tightenNorm(result), cutToNorm(result);
}

/// The slopes of a function with this Lipschitz constant, whose arguments have the slopes `rows`.
void lipschitzSlopes(double constant, std::span<const Slopes* const> rows, Slopes& result) {
    if (!(constant < kHuge)) return unbounded(rows, result);
    Slopes made = kNoSlopes;
    for (std::size_t k = 0; k < 3; ++k) {
        double squared = 0.0;
        for (const Slopes* row : rows) {
            const double most = std::max(-row->lo[k], row->hi[k]);
            squared += most * most;
        }
        const double most = std::min(constant * std::sqrt(squared) * (1.0 + 8.0 * kUlp), kHuge);
        made.lo[k] = -most, made.hi[k] = most;
    }
    const double spectral = spectralNorm(rows);
    setNorm(made, spectral == 0.0 ? 0.0 : constant * spectral * (1.0 + kUlp));
    result = made;
    tightenNorm(result), cutToNorm(result);
}

void smoothMinimumSlopes(const Interval* x, const Slopes* const* d, Slopes& result) {
    constexpr double kLeastWidth = 1e-9;  // of the op's own
    const Interval width = x[2];
    if (width.hi <= 0.0) {
        if (x[0].hi < x[1].lo) return void(result = *d[0]);
        if (x[1].hi < x[0].lo) return void(result = *d[1]);
        return hullOf(*d[0], *d[1], result);
    }
    // The share of a in the blend: from 0 where b is nearer by the width to 1 where a is.
    Interval share{0.0, 1.0}, across = {0.0, 1.0};
    if (width.lo >= kLeastWidth) {
        const Interval apart = (x[1] - x[0]) / width;
        const auto shareOf = [](double t) { return std::clamp(0.5 + 0.5 * t, 0.0, 1.0); };
        share = {shareOf(apart.lo), shareOf(apart.hi)};
        const Interval away = absolute(apart);
        across = {std::clamp(1.0 - away.hi, 0.0, 1.0), std::clamp(1.0 - away.lo, 0.0, 1.0)};
    } else {
        if (x[0].hi + width.hi < x[1].lo) share = kOne, across = kZero;
        if (x[1].hi + width.hi < x[0].lo) share = kZero, across = kZero;
    }
    // Exactly w a + (1 - w) b, so the ends are at ends of w.
    Slopes least, most, rest, made;
    const auto blend = [&](double w, Slopes& to) {
        scaled({w, w}, *d[0], to);
        scaled(outward(1.0 - w, 1.0 - w), *d[1], rest);
        added(to, rest, to);
    };
    blend(share.lo, least), blend(share.hi, most), hullOf(least, most, made);
    setNorm(made, std::max(share.hi > 0.0 ? d[0]->hi[kNorm] : 0.0, share.lo < 1.0 ? d[1]->hi[kNorm] : 0.0));
    tightenNorm(made);
    if (d[2]->hi[kNorm] != 0.0) {
        const auto effect = [](double s) { return s * (0.5 - 0.25 * s); };
        const Interval byWidth =
            width.lo < kLeastWidth ? Interval{-0.5, 0.0} : outward(-effect(across.hi), -effect(across.lo));
        scaled(byWidth, *d[2], rest);
        added(made, rest, made);
    }
    result = made;
}

void powerSlopes(const Interval* x, Interval value, const Slopes* const* d, Slopes& result) {
    const std::span<const Slopes* const> both(d, 2);
    if (x[0].hi <= 0.0 && x[1].lo > 0.0) return void(result = kNoSlopes);
    Slopes made = kNoSlopes, rest;
    const bool exponentVaries = d[1]->hi[kNorm] != 0.0;
    if (x[0].lo <= 0.0) {
        if (exponentVaries || !x[1].isPoint() || (x[1].lo < 1.0 && x[1].lo != 0.0))
            return unbounded(both, result);
        if (x[1].lo == 0.0) return void(result = made);
    }
    scaled(x[1] * power(x[0], x[1] - kOne), *d[0], made);
    if (x[0].lo <= 0.0 && x[1].lo == 1.0) scaled({0.0, 1.0}, *d[0], made);
    if (exponentVaries) {
        const Interval log = outward(std::log(x[0].lo), std::log(above(x[0].hi)));
        scaled(value * outward(log.lo - 1e-13, log.hi + 1e-13), *d[1], rest);
        added(made, rest, made);
    }
    result = made;
}

void remainderSlopes(Op op, const Interval* x, const Slopes* const* d, Slopes& result) {
    const Interval quotient = x[0] / x[1];
    const auto whole = [&](double v) { return op == Op::modulo ? std::floor(v) : std::trunc(v); };
    const double first = whole(quotient.lo);
    if (!isBounded(quotient) || first != whole(quotient.hi)) return unbounded(std::span(d, 2), result);
    Slopes rest;
    scaled({-first, -first}, *d[1], rest);
    added(*d[0], rest, result);
}

bool isWhole(const Interval* x, int count) {
    for (int i = 0; i < count; ++i)
        if (!(absolute(x[i]).hi < kFarCoordinate)) return false;
    return true;
}

void noiseSlopes(Op op, const Interval* x, const Slopes* const* d, Slopes& result) {
    const double constant = op == Op::gradientNoise  ? kGradientNoiseSlope
                            : op == Op::simplexNoise ? kSimplexNoiseSlope
                                                     : 1.0;
    if (!isWhole(x, 3) || std::floor(x[3].lo) != std::floor(x[3].hi))
        return unbounded(std::span(d, 4), result);
    lipschitzSlopes(constant, std::span(d, 3), result);
}

void sampledSlopes(Op op, const SampledLayer& layer, const Interval* x, const Slopes* const* d,
                   Slopes& result) {
    if (op == Op::image) {
        if (!isWhole(x, 2)) return unbounded(std::span(d, 2), result);
        Slopes second;
        scaled({-layer.image->slopeU, layer.image->slopeU}, *d[0], result);
        scaled({-layer.image->slopeV, layer.image->slopeV}, *d[1], second);
        added(result, second, result);
        return tightenNorm(result);
    }
    if (op == Op::outline)
        return lipschitzSlopes(lipschitzConstant(*layer.outline, x[0], x[1]), std::span(d, 2), result);
    lipschitzSlopes(op == Op::volume ? lipschitzConstant(*layer.volume, x)
                                     : lipschitzConstant(*layer.spline, layer.channel, x),
                    std::span(d, 3), result);
}

/// Of functions of one operand: an interval that contains its derivative; not of those that may jump.
Interval derivative(Op op, Interval x, Interval value) {
    constexpr Interval kQuarterTurn{std::numbers::pi / 2, std::numbers::pi / 2};
    const auto upTo = [](Interval inner) {  // of 1 - x² or x: 1/sqrt(inner), or 0 where that is negative
        if (inner.lo > 0.0) return inverseRoot(inner);
        return Interval{0.0, kHuge};
    };
    switch (op) {
        case Op::squareRoot:
            return x.hi <= 0.0 ? kZero : x.lo > 0.0 ? Interval{0.5, 0.5} * inverseRoot(x) : upTo(x);
        case Op::square: return Interval{2.0, 2.0} * x;
        case Op::exponential: return value;
        case Op::logarithm: {
            constexpr double kTiny = 1e-30;  // of the op's own
            return x.hi <= kTiny ? kZero : x.lo > kTiny ? kOne / x : Interval{0.0, kHuge};
        }
        case Op::sine: return sine(x + kQuarterTurn);
        case Op::cosine: return -sine(x);
        case Op::tangent: return isBounded(value) ? kOne + square(value) : kEverything;
        case Op::arcSine: return x.lo >= 1.0 || x.hi <= -1.0 ? kZero : upTo(kOne - square(x));
        case Op::arcCosine: return x.lo >= 1.0 || x.hi <= -1.0 ? kZero : -upTo(kOne - square(x));
        case Op::arcTangent: return kOne / (kOne + square(x));
        default: return kEverything;
    }
}

}  // namespace

const Slopes& IntervalGradientMachine::slopesOf(uint32_t name) const {
    return name & TapeValues::kNumber ? kNoSlopes : slopes_[name];
}

/// Whether the value is a remainder from which half the period is taken: mod(x, 2s) - s. Its magnitude is
/// continuous.
bool IntervalGradientMachine::readsFold(const Tape& tape, uint32_t name, uint32_t& folded) const {
    if (name < 3 || (name & TapeValues::kNumber)) return false;
    const Op op = tape.steps[name - 3].op;
    if (op != Op::add && op != Op::subtract) return false;
    for (std::size_t i = 0; i < 2; ++i) {
        const uint32_t remainder = values.operands[name - 3][i], half = values.operands[name - 3][1 - i];
        if (remainder < 3 || (remainder & TapeValues::kNumber) || tape.steps[remainder - 3].op != Op::modulo)
            continue;
        const Interval period = values.interval(tape, values.operands[remainder - 3][1]),
                       shift = values.interval(tape, half);
        const double sign = op == Op::add ? 1.0 : -1.0;
        if (!period.isPoint() || !shift.isPoint() || !(period.lo > 0.0)) continue;
        if (!(std::abs(2.0 * sign * shift.lo + period.lo) <= 4.0 * kUlp * period.lo)) continue;
        folded = values.operands[remainder - 3][0];
        return absolute(values.interval(tape, folded)).hi < kFarCoordinate * period.lo;
    }
    return false;
}

/// sqrt(a² + b² + … + w): a length where there is no w.
void IntervalGradientMachine::root(const Tape& tape, uint32_t name, Slopes& result) const {
    constexpr std::size_t kMaxTerms = 8;
    uint32_t open[kMaxTerms] = {name}, squares[kMaxTerms], others[kMaxTerms];
    std::size_t openCount = 1, squareCount = 0, otherCount = 0;
    while (openCount > 0) {
        const uint32_t term = open[--openCount];
        const bool isStep = term >= 3 && !(term & TapeValues::kNumber);
        const Op op = isStep ? tape.steps[term - 3].op : Op::constant;
        const auto* const x = isStep ? values.operands[term - 3].data() : nullptr;
        if (isStep && op == Op::add && openCount + squareCount + otherCount + 2 <= kMaxTerms)
            open[openCount++] = x[0], open[openCount++] = x[1];
        else if (isStep && (op == Op::square || (op == Op::multiply && x[0] == x[1])))
            squares[squareCount++] = x[0];
        else
            others[otherCount++] = term;
    }
    const Interval under = values.interval(tape, name);
    Interval ranges[kMaxTerms], rest = kZero;
    for (std::size_t i = 0; i < otherCount; ++i) rest = rest + values.interval(tape, others[i]);
    if (squareCount == 0 || rest.lo < 0.0) {
        scaled(derivative(Op::squareRoot, under, {}), slopesOf(name), result);
        return;
    }
    for (std::size_t i = 0; i < squareCount; ++i) ranges[i] = square(values.interval(tape, squares[i]));
    Slopes sum = kNoSlopes, part;
    const Slopes* rows[kMaxTerms];
    for (std::size_t i = 0; i < squareCount; ++i) {
        Interval others_ = rest;
        for (std::size_t j = 0; j < squareCount; ++j)
            if (j != i) others_ = others_ + ranges[j];
        rows[i] = &slopesOf(squares[i]);
        scaled(shareOfLength(values.interval(tape, squares[i]), others_), *rows[i], part);
        added(sum, part, sum);
    }
    const double norm = spectralNorm(std::span(rows, squareCount));
    if (norm < sum.hi[kNorm]) setNorm(sum, norm);
    tightenNorm(sum), cutToNorm(sum);
    for (std::size_t i = 0; i < otherCount; ++i) {
        scaled(derivative(Op::squareRoot, under, {}), slopesOf(others[i]), part);
        added(sum, part, sum);
    }
    result = sum;
}

void IntervalGradientMachine::choose(const Tape& tape, uint32_t name, const Slopes* const* slopes,
                                     Slopes& result) {
    const Interval condition = values.interval(tape, values.operands[name - 3][0]);
    if (condition.lo > 0.5) {
        result = *slopes[1];
    } else if (condition.hi < 0.5) {
        result = *slopes[2];
    } else if (isBounded(*slopes[1]) && isBounded(*slopes[2]) && switching.branchesMeet(tape, values, name)) {
        hullOf(*slopes[1], *slopes[2], result);
    } else {
        unbounded(std::span(slopes, 3), result);
    }
}

IntervalGradient IntervalGradientMachine::evaluate(const Tape& tape, const Box& box) {
    const std::size_t count = tape.steps.size() + 3;
    if (slopes_.size() < count) {
        slopes_.resize(count), values.intervals.resize(count), values.continuous.resize(count);
        values.operands.resize(count - 3);
    }
    if (names.size() < tape.registers) names.resize(tape.registers);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        values.intervals[axis] = {box.lo[axis], box.hi[axis]};
        values.continuous[axis] = true;
        slopes_[axis] = kNoSlopes;
        setLane(slopes_[axis], axis, kOne);
        setNorm(slopes_[axis], 1.0);
        names[axis] = uint32_t(axis);
    }
    const OpInfo* const table = opTable().data();
    for (std::size_t i = 0; i < tape.steps.size(); ++i) {
        const TapeStep& step = tape.steps[i];
        const uint32_t name = uint32_t(i) + 3;
        Interval& value = values.intervals[name];
        Slopes& slope = slopes_[name];
        auto& operands = values.operands[i];
        if (step.op == Op::constant) {
            operands[0] = step.operands[0] | TapeValues::kNumber;
            value = values.interval(tape, operands[0]);
            slope = kNoSlopes;
            values.continuous[name] = true;
            names[step.result] = name;
            continue;
        }
        const OpInfo& info = table[std::size_t(step.op)];
        Interval x[kMaxArity];
        const Slopes* d[kMaxArity];
        for (std::size_t k = 0; k < std::size_t(info.arity); ++k) {
            const uint32_t place = step.operands[k];
            if (step.numbers >> k & 1) {
                operands[k] = place | TapeValues::kNumber;
                x[k].lo = x[k].hi = tape.numbers->doubles[place];
                d[k] = &kNoSlopes;
            } else {
                operands[k] = names[place];
                x[k].lo = values.intervals[operands[k]].lo, x[k].hi = values.intervals[operands[k]].hi;
                d[k] = &slopes_[operands[k]];
            }
        }
        names[step.result] = name;
        const SampledLayer layer =
            samplesLayer(step.op) ? tape.numbers->layers[step.operands[kMaxArity - 1]] : SampledLayer{};
        const std::span<const Slopes* const> all(d, std::size_t(info.arity));
        Slopes part;
        switch (step.op) {
            case Op::add: value = x[0] + x[1]; break;
            case Op::subtract: value = x[0] - x[1]; break;
            case Op::multiply: value = x[0] * x[1]; break;
            default: value = info.interval(x, layer);
        }
        switch (step.op) {
            case Op::negate: negated(*d[0], slope); break;
            case Op::absolute:
                if (uint32_t folded; x[0].lo >= 0.0) {
                    slope = *d[0];
                } else if (x[0].hi <= 0.0) {
                    negated(*d[0], slope);
                } else {
                    const bool folds = !isBounded(*d[0]) && readsFold(tape, operands[0], folded);
                    const Slopes& inner = folds ? slopesOf(folded) : *d[0];
                    negated(inner, part), hullOf(inner, part, slope);
                }
                break;
            case Op::add:
                added(*d[0], *d[1], slope);
                if (step.numbers == 0) tightenNorm(slope);
                break;
            case Op::subtract:
                subtracted(*d[0], *d[1], slope);
                if (step.numbers == 0) tightenNorm(slope);
                break;
            case Op::multiply:
                if (step.numbers != 0) {
                    const std::size_t k = step.numbers & 1 ? 1 : 0;
                    scaled(x[1 - k], *d[k], slope);
                } else if (operands[0] == operands[1]) {
                    scaled(Interval{2.0, 2.0} * x[0], *d[0], slope);
                } else {
                    scaled(x[1], *d[0], slope), scaled(x[0], *d[1], part);
                    added(slope, part, slope), tightenNorm(slope);
                }
                break;
            case Op::divide:
                if (x[1].lo <= 0.0 && x[1].hi >= 0.0) {
                    unbounded(all, slope);
                } else {
                    scaled(value, *d[1], part), subtracted(*d[0], part, part);
                    scaled(kOne / x[1], part, slope), tightenNorm(slope);
                }
                break;
            case Op::minimum:
            case Op::maximum: {
                const bool least = step.op == Op::minimum;
                if (least ? x[0].hi < x[1].lo : x[0].lo > x[1].hi)
                    slope = *d[0];
                else if (least ? x[1].hi < x[0].lo : x[1].lo > x[0].hi)
                    slope = *d[1];
                else
                    hullOf(*d[0], *d[1], slope);
                break;
            }
            case Op::squareRoot: root(tape, operands[0], slope); break;
            case Op::square:
            case Op::exponential:
            case Op::logarithm:
            case Op::sine:
            case Op::cosine:
            case Op::tangent:
            case Op::arcSine:
            case Op::arcCosine:
            case Op::arcTangent: scaled(derivative(step.op, x[0], value), *d[0], slope); break;
            case Op::power: powerSlopes(x, value, d, slope); break;
            case Op::modulo:
            case Op::truncatedModulo: remainderSlopes(step.op, x, d, slope); break;
            case Op::arcTangent2:
                if ((x[1].lo > 0.0 || x[0].lo > 0.0 || x[0].hi < 0.0) && isBounded(x[0]) && isBounded(x[1]))
                    angleSlopes(x[0], x[1], *d[0], *d[1], slope);
                else
                    unbounded(all, slope);
                break;
            case Op::select: choose(tape, name, d, slope); break;
            case Op::smoothMinimum: smoothMinimumSlopes(x, d, slope); break;
            case Op::gradientNoise:
            case Op::simplexNoise:
            case Op::worleyNoise:
            case Op::cellWall: noiseSlopes(step.op, x, d, slope); break;
            case Op::image:
            case Op::volume:
            case Op::outline:
            case Op::spline: sampledSlopes(step.op, layer, x, d, slope); break;
            default:  // sign, floor and its relatives, comparisons, hashes: constant or a jump
                if (value.isPoint())
                    slope = kNoSlopes;
                else
                    unbounded(all, slope);
        }
        values.continuous[name] = slope.hi[kNorm] < kHuge;
    }
    const uint32_t first = names[tape.roots[0]];
    Slopes last = slopes_[first];
    tightenNorm(last), cutToNorm(last);
    return {values.intervals[first],
            {lane(last, 0), lane(last, 1), lane(last, 2)},
            last.hi[kNorm] < kHuge ? last.hi[kNorm] : kInfinity};
}

Interval IntervalGradientMachine::meanValue(const Tape& tape, const Box& box) {
    const IntervalGradient whole = evaluate(tape, box);
    for (const Interval& slope : whole.gradient)
        if (!isBounded(slope)) return whole.value;
    Box middle;
    for (std::size_t axis = 0; axis < 3; ++axis)
        middle.lo[axis] = middle.hi[axis] = 0.5 * box.lo[axis] + 0.5 * box.hi[axis];
    Interval sum = centre.interval(tape, middle);
    for (std::size_t axis = 0; axis < 3; ++axis)
        sum = sum + whole.gradient[axis] *
                        (Interval{box.lo[axis], box.hi[axis]} - Interval{middle.lo[axis], middle.lo[axis]});
    const Interval both{std::max(sum.lo, whole.value.lo), std::min(sum.hi, whole.value.hi)};
    return both.lo <= both.hi ? both : whole.value;
}

std::size_t IntervalGradientMachine::bytes() const {
    return slopes_.capacity() * sizeof(Slopes) + values.intervals.capacity() * sizeof(Interval) +
           values.continuous.capacity() + values.operands.capacity() * sizeof(values.operands[0]) +
           names.capacity() * sizeof(uint32_t) + centre.bytes();
}

}  // namespace fw
