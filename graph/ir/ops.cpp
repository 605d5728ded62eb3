#include "graph/ir/ops.h"

#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "graph/ir/kernels.h"
#include "graph/ir/noise.h"
#include "graph/ir/sine.h"

namespace fw {

namespace {

using I = const Interval*;  // operands' intervals
using L = SampledLayer;

constexpr const char* kChainRule = "dot(%s.xyz, vec3(%A, %B, %C))";
constexpr double kTiny = 1e-30;  // least argument of a logarithm

constexpr auto zeroSlope = []<class T>(const T*, T, const T*) { return T(0); };
constexpr auto leaf = []<class T>(const T*) { return assert(false), T(0); };
constexpr auto leafInterval = [](I) { return assert(false), Interval{}; };

template <int count>
using Arity = std::integral_constant<int, count>;

/// What a value's rounding depends on; see ops.h.
constexpr Rounding roundingOf(Op op, bool boolean) {
    switch (op) {
        case Op::negate:
        case Op::absolute:
        case Op::sign:
        case Op::floor:
        case Op::ceil:
        case Op::truncate:
        case Op::minimum:
        case Op::maximum:
        case Op::select: return Rounding::none;
        case Op::round:
        case Op::modulo:
        case Op::truncatedModulo:
        case Op::smoothMinimum: return Rounding::magnitude;
        case Op::gradientNoise:
        case Op::simplexNoise:
        case Op::worleyNoise:
        case Op::cellWall: return Rounding::noise;
        default: return boolean ? Rounding::none : Rounding::result;
    }
}

/// A row of the table, its meanings lambdas: only their types are used. The loops over arrays are made from
/// the scalar meanings (kernels.h), which compile into them.
template <int arity, class Value, class Range, class Slope>
constexpr OpInfo row(Op op, const char* name, Arity<arity>, bool boolean, bool commutative, Value, Range,
                     Slope, const char* glsl, const char* glslInterval, const char* glslGradient,
                     const char* glslSample = "", int weight = arity > 0) {
    static_assert(std::is_empty_v<Value> && std::is_empty_v<Range> && std::is_empty_v<Slope>);
    constexpr auto value = [](const double* operands, L layer) { return call<Value>(layer, operands); };
    constexpr auto interval = [](I operands, L layer) { return call<Range>(layer, operands); };
    return {op,
            name,
            arity,
            boolean,
            commutative,
            roundingOf(op, boolean),
            value,
            interval,
            {&kKernels<Value, Slope, arity, double, false>, &kKernels<Value, Slope, arity, double, true>},
            {&kKernels<Value, Slope, arity, float, false>, &kKernels<Value, Slope, arity, float, true>},
            glsl,
            glslInterval,
            glslGradient,
            glslSample,
            weight};
}

Interval monotone(double (*f)(double), Interval a, double slack) {
    // Infinity times no slack would not be a number.
    const double lo = std::min(f(below(a.lo)), kHuge), hi = std::min(f(above(a.hi)), kHuge);
    return outward(lo - std::abs(lo) * slack, hi + std::abs(hi) * slack);
}
Interval exponential(Interval a) {
    const Interval range = monotone([](double v) { return std::exp(v); }, a, 1e-13);
    return outward(std::max(0.0, range.lo - 1e-300), range.hi + 1e-300);  // denormal numbers round coarsely
}
Interval truth(bool certain, bool impossible) { return {certain ? 1.0 : 0.0, impossible ? 0.0 : 1.0}; }
/// Quadratic smooth minimum (Quilez): the corner where a = b is filled k / 4 deep, and nothing is changed
/// where they are k apart.
template <class T>
constexpr T smoothMinimum(T a, T b, T k) {
    const T h = std::max(k - std::abs(a - b), T(0));
    return std::min(a, b) - h * h * (T(0.25) / std::max(k, T(1e-9)));
}
/// It grows with a and b, and falls with k: so its ends are those of the operands, however wide these are.
Interval smoothMinimumInterval(I x) {
    const auto size = [&](double a, double b) {
        return 1e-15 * (std::abs(a) + std::abs(b) + absolute(x[2]).hi);
    };
    const bool bounded = x[0].lo > -kHuge && x[1].lo > -kHuge && x[2].hi < kHuge;
    const double a = above(x[0].hi), b = above(x[1].hi);
    return outward(bounded ? smoothMinimum(x[0].lo, x[1].lo, x[2].hi) - size(x[0].lo, x[1].lo) : -kHuge,
                   std::isinf(a) && std::isinf(b)
                       ? kHuge
                       : smoothMinimum(a, b, x[2].lo) + size(std::min(std::abs(a), std::abs(b)), 0.0));
}
template <class T>
constexpr T smoothMinimumSlope(const T* x, const T* d) {
    const T share = std::max(x[2] - std::abs(x[0] - x[1]), T(0)) / std::max(x[2], T(1e-9));
    const T nearer = x[0] <= x[1] ? d[0] : d[1], other = x[0] <= x[1] ? d[1] : d[0];
    if (share == T(0)) return nearer;
    return nearer + T(0.5) * share * (other - nearer) - share * (T(0.5) - T(0.25) * share) * d[2];
}
template <class T>
constexpr T clampUnit(T x) {
    return std::clamp(x, T(-1), T(1));
}

/// Interval of a noise from its value at the box's centre and its greatest slope.
Interval noiseInterval(I x, NoiseSample (*noise)(double, double, double, double), double slope, double least,
                       double most) {
    if (!isBounded(x[0]) || !isBounded(x[1]) || !isBounded(x[2])) return kEverything;
    if (!x[3].isPoint()) return {least, most};
    double centre[3], squared = 0.0, rounding = 1e-9;
    for (int i = 0; i < 3; ++i) {
        centre[i] = 0.5 * (x[i].lo + x[i].hi);
        squared += 0.25 * (x[i].hi - x[i].lo) * (x[i].hi - x[i].lo);
        rounding += 4e-15 * absolute(x[i]).hi;
    }
    return lipschitzRange(noise(centre[0], centre[1], centre[2], x[3].lo).value, slope,
                          std::sqrt(squared) + rounding, least, most);
}
template <class N, class T>
T noiseSlope(const NoiseOf<N>& sample, const T* d) {
    return T(sample.gradient[0] * d[0] + sample.gradient[1] * d[1] + sample.gradient[2] * d[2]);
}
/// Meanings in two parts: what most places need becomes vectors, the others follow (kernels.h).
struct WorleyNoise {
    template <class T>
    static T most(const T* x) {
        return worleyNearby(x[0], x[1], x[2], x[3]).value;
    }
    template <class T>
    static bool needsAll(const T* x, T found) {
        return !(found <= worleyClear(x[0], x[1], x[2]));
    }
    template <class T>
    T operator()(const T* x) const {
        const T near = most(x);
        return needsAll(x, near) ? T(worleyNoise(x[0], x[1], x[2], x[3]).value) : near;
    }
};
struct WorleySlope {
    template <class T>
    static T most(const T* x, const T* d) {
        return noiseSlope(worleyNearby(x[0], x[1], x[2], x[3]), d);
    }
    template <class T>
    static bool needsAll(const T* x, T found) {
        return WorleyNoise::needsAll(x, found);
    }
    template <class T>
    T operator()(const T* x, T, const T* d) const {
        return noiseSlope(worleyNoise(x[0], x[1], x[2], x[3]), d);
    }
};
Interval hashInterval(I x) {
    for (int i = 0; i < 4; ++i)
        if (std::floor(x[i].lo) != std::floor(x[i].hi)) return {0.0, 1.0};
    const double value = cellHash(x[0].lo, x[1].lo, x[2].lo, x[3].lo);
    return {value, value};
}

constexpr std::array<OpInfo, static_cast<size_t>(Op::count)> kTable = {{
    row(Op::constant, "constant", Arity<0>(), false, false, leaf, leafInterval, zeroSlope, "", "", ""),
    row(Op::parameter, "parameter", Arity<0>(), false, false, leaf, leafInterval, zeroSlope, "", "", ""),
    row(Op::column, "column", Arity<0>(), false, false, leaf, leafInterval, zeroSlope, "", "", ""),
    row(Op::positionX, "x", Arity<0>(), false, false, leaf, leafInterval, zeroSlope, "p.x",
        "vec2(lo.x, hi.x)", "1.0"),
    row(Op::positionY, "y", Arity<0>(), false, false, leaf, leafInterval, zeroSlope, "p.y",
        "vec2(lo.y, hi.y)", "1.0"),
    row(Op::positionZ, "z", Arity<0>(), false, false, leaf, leafInterval, zeroSlope, "p.z",
        "vec2(lo.z, hi.z)", "1.0"),

    row(
        Op::negate, "negate", Arity<1>(), false, false, []<class T>(const T* x) { return -x[0]; },
        [](I x) { return -x[0]; }, []<class T>(const T*, T, const T* d) { return -d[0]; }, "-%a", "-%a.yx",
        "-%A"),
    row(
        Op::absolute, "abs", Arity<1>(), false, false, []<class T>(const T* x) { return std::abs(x[0]); },
        [](I x) { return absolute(x[0]); },
        []<class T>(const T* x, T, const T* d) { return x[0] < T(0) ? -d[0] : d[0]; }, "abs(%a)", "iAbs(%a)",
        "%a < 0.0 ? -%A : %A"),
    row(
        Op::sign, "sign", Arity<1>(), false, false,
        []<class T>(const T* x) { return T(x[0] > T(0)) - T(x[0] < T(0)); },
        [](I x) {
            return Interval{double(x[0].lo > 0.0) - double(x[0].lo < 0.0),
                            double(x[0].hi > 0.0) - double(x[0].hi < 0.0)};
        },
        zeroSlope, "sign(%a)", "sign(%a)", ""),
    row(
        Op::floor, "floor", Arity<1>(), false, false, []<class T>(const T* x) { return std::floor(x[0]); },
        [](I x) {
            return Interval{std::floor(x[0].lo), std::floor(x[0].hi)};
        },
        zeroSlope, "floor(%a)", "floor(%a)", ""),
    row(
        Op::ceil, "ceil", Arity<1>(), false, false, []<class T>(const T* x) { return std::ceil(x[0]); },
        [](I x) {
            return Interval{std::ceil(x[0].lo), std::ceil(x[0].hi)};
        },
        zeroSlope, "ceil(%a)", "ceil(%a)", ""),
    row(
        Op::round, "round", Arity<1>(), false, false,
        []<class T>(const T* x) { return std::floor(x[0] + T(0.5)); },
        [](I x) {
            return Interval{std::floor(x[0].lo + 0.5), std::floor(x[0].hi + 0.5)};
        },
        zeroSlope, "floor(%a + 0.5)", "floor(%a + 0.5)", ""),
    row(
        Op::truncate, "trunc", Arity<1>(), false, false, []<class T>(const T* x) { return std::trunc(x[0]); },
        [](I x) {
            return Interval{std::trunc(x[0].lo), std::trunc(x[0].hi)};
        },
        zeroSlope, "trunc(%a)", "trunc(%a)", ""),
    row(
        Op::squareRoot, "sqrt", Arity<1>(), false, false,
        []<class T>(const T* x) { return std::sqrt(std::max(x[0], T(0))); },
        [](I x) { return monotone([](double v) { return std::sqrt(std::max(v, 0.0)); }, x[0], 0.0); },
        []<class T>(const T*, T v, const T* d) { return v > T(0) ? T(0.5) * d[0] / v : T(0); },
        "sqrt(max(%a, 0.0))", "iOut(sqrt(max(%a, 0.0)))", "%v > 0.0 ? (0.5 / %v) * %A : 0.0"),
    row(
        Op::square, "square", Arity<1>(), false, false, []<class T>(const T* x) { return x[0] * x[0]; },
        [](I x) { return square(x[0]); },
        []<class T>(const T* x, T, const T* d) { return T(2) * x[0] * d[0]; }, "%a * %a", "iSquare(%a)",
        "(2.0 * %a) * %A"),
    row(
        Op::exponential, "exp", Arity<1>(), false, false, []<class T>(const T* x) { return std::exp(x[0]); },
        [](I x) { return exponential(x[0]); }, []<class T>(const T*, T v, const T* d) { return v * d[0]; },
        "exp(%a)", "iExp(%a)", "%v * %A"),
    row(
        Op::logarithm, "log", Arity<1>(), false, false,
        []<class T>(const T* x) { return std::log(std::max(x[0], T(kTiny))); },
        [](I x) { return monotone([](double v) { return std::log(std::max(v, kTiny)); }, x[0], 1e-13); },
        []<class T>(const T* x, T, const T* d) { return x[0] > T(kTiny) ? d[0] / x[0] : T(0); },
        "log(max(%a, 1e-30))", "iSlack(log(max(%a, 1e-30)))", "%a > 1e-30 ? %A / %a : 0.0"),
    row(
        Op::sine, "sin", Arity<1>(), false, false, []<class T>(const T* x) { return sineOf(x[0]); },
        [](I x) { return sine(x[0]); },
        []<class T>(const T* x, T, const T* d) { return cosineOf(x[0]) * d[0]; }, "sin(%a)", "iSin(%a)",
        "cos(%a) * %A", "", 5),
    row(
        Op::cosine, "cos", Arity<1>(), false, false, []<class T>(const T* x) { return cosineOf(x[0]); },
        [](I x) {
            return sine(x[0] + Interval{std::numbers::pi / 2, std::numbers::pi / 2});
        },
        []<class T>(const T* x, T, const T* d) { return -sineOf(x[0]) * d[0]; }, "cos(%a)",
        "iSin(%a + 1.57079633)", "-sin(%a) * %A", "", 5),
    row(
        Op::tangent, "tan", Arity<1>(), false, false, []<class T>(const T* x) { return std::tan(x[0]); },
        [](I x) {
            return sine(x[0]) / sine(x[0] + Interval{std::numbers::pi / 2, std::numbers::pi / 2});
        },
        []<class T>(const T*, T v, const T* d) { return (T(1) + v * v) * d[0]; }, "tan(%a)",
        "iDivide(iSin(%a), iSin(%a + 1.57079633))", "(1.0 + %v * %v) * %A", "", 10),
    row(
        Op::arcSine, "asin", Arity<1>(), false, false,
        []<class T>(const T* x) { return std::asin(clampUnit(x[0])); },
        [](I x) { return monotone([](double v) { return std::asin(clampUnit(v)); }, x[0], 1e-13); },
        []<class T>(const T* x, T, const T* d) {
            return std::abs(x[0]) < T(1) ? d[0] / std::sqrt(T(1) - x[0] * x[0]) : T(0);
        },
        "asin(clamp(%a, -1.0, 1.0))", "iSlack(asin(clamp(%a, -1.0, 1.0)))",
        "abs(%a) < 1.0 ? %A / sqrt(1.0 - %a * %a) : 0.0"),
    row(
        Op::arcCosine, "acos", Arity<1>(), false, false,
        []<class T>(const T* x) { return std::acos(clampUnit(x[0])); },
        [](I x) {
            return outward(std::acos(clampUnit(x[0].hi)) - 1e-13, std::acos(clampUnit(x[0].lo)) + 1e-13);
        },
        []<class T>(const T* x, T, const T* d) {
            return std::abs(x[0]) < T(1) ? -d[0] / std::sqrt(T(1) - x[0] * x[0]) : T(0);
        },
        "acos(clamp(%a, -1.0, 1.0))", "iSlack(acos(clamp(%a.yx, -1.0, 1.0)))",
        "abs(%a) < 1.0 ? -%A / sqrt(1.0 - %a * %a) : 0.0"),
    row(
        Op::arcTangent, "atan", Arity<1>(), false, false, []<class T>(const T* x) { return std::atan(x[0]); },
        [](I x) { return monotone([](double v) { return std::atan(v); }, x[0], 1e-13); },
        []<class T>(const T* x, T, const T* d) { return d[0] / (T(1) + x[0] * x[0]); }, "atan(%a)",
        "iSlack(atan(%a))", "%A / (1.0 + %a * %a)"),
    row(
        Op::logicalNot, "not", Arity<1>(), true, false, []<class T>(const T* x) { return T(1) - x[0]; },
        [](I x) {
            return Interval{1.0 - x[0].hi, 1.0 - x[0].lo};
        },
        zeroSlope, "!%a", "1.0 - %a.yx", ""),

    row(
        Op::add, "add", Arity<2>(), false, true, []<class T>(const T* x) { return x[0] + x[1]; },
        [](I x) { return x[0] + x[1]; }, []<class T>(const T*, T, const T* d) { return d[0] + d[1]; },
        "%a + %b", "%a + %b", "%A + %B"),
    row(
        Op::subtract, "subtract", Arity<2>(), false, false, []<class T>(const T* x) { return x[0] - x[1]; },
        [](I x) { return x[0] - x[1]; }, []<class T>(const T*, T, const T* d) { return d[0] - d[1]; },
        "%a - %b", "iOut(%a - %b.yx)", "%A - %B"),
    row(
        Op::multiply, "multiply", Arity<2>(), false, true, []<class T>(const T* x) { return x[0] * x[1]; },
        [](I x) { return x[0] * x[1]; },
        []<class T>(const T* x, T, const T* d) { return x[1] * d[0] + x[0] * d[1]; }, "%a * %b",
        "iMultiply(%a, %b)", "%b * %A + %a * %B"),
    row(
        Op::divide, "divide", Arity<2>(), false, false, []<class T>(const T* x) { return x[0] / x[1]; },
        [](I x) { return x[0] / x[1]; },
        []<class T>(const T* x, T v, const T* d) { return x[1] != T(0) ? (d[0] - v * d[1]) / x[1] : T(0); },
        "%a / %b", "iDivide(%a, %b)", "%b != 0.0 ? (%A - %v * %B) / %b : 0.0"),
    row(
        Op::minimum, "min", Arity<2>(), false, true, []<class T>(const T* x) { return std::min(x[0], x[1]); },
        [](I x) { return minimum(x[0], x[1]); },
        []<class T>(const T* x, T, const T* d) { return x[0] <= x[1] ? d[0] : d[1]; }, "min(%a, %b)",
        "min(%a, %b)", "%a <= %b ? %A : %B"),
    row(
        Op::maximum, "max", Arity<2>(), false, true, []<class T>(const T* x) { return std::max(x[0], x[1]); },
        [](I x) { return maximum(x[0], x[1]); },
        []<class T>(const T* x, T, const T* d) { return x[0] >= x[1] ? d[0] : d[1]; }, "max(%a, %b)",
        "max(%a, %b)", "%a >= %b ? %A : %B"),
    row(
        Op::power, "pow", Arity<2>(), false, false,
        []<class T>(const T* x) { return std::pow(std::max(T(0), x[0]), x[1]); },
        [](I x) { return power(x[0], x[1]); },
        []<class T>(const T* x, T v, const T* d) {
            return x[0] > T(0) ? v * (x[1] / x[0] * d[0] + std::log(x[0]) * d[1]) : T(0);
        },
        "fieldPower(%a, %b)", "iPower(%a, %b)", "%a > 0.0 ? %v * ((%b / %a) * %A + log(%a) * %B) : 0.0", "",
        7),
    row(
        Op::modulo, "mod", Arity<2>(), false, false,
        []<class T>(const T* x) { return x[0] - x[1] * std::floor(x[0] / x[1]); },
        [](I x) { return modulo(x[0], x[1]); },
        []<class T>(const T* x, T, const T* d) { return d[0] - std::floor(x[0] / x[1]) * d[1]; },
        "mod(%a, %b)", "iModulo(%a, %b)", "%A - floor(%a / %b) * %B"),
    row(
        Op::truncatedModulo, "fmod", Arity<2>(), false, false,
        []<class T>(const T* x) { return x[0] - x[1] * std::trunc(x[0] / x[1]); },
        [](I x) { return truncatedModulo(x[0], x[1]); },
        []<class T>(const T* x, T, const T* d) { return d[0] - std::trunc(x[0] / x[1]) * d[1]; },
        "(%a - %b * trunc(%a / %b))", "iTruncatedModulo(%a, %b)", "%A - trunc(%a / %b) * %B"),
    row(
        Op::arcTangent2, "atan2", Arity<2>(), false, false,
        []<class T>(const T* x) { return std::atan2(x[0], x[1]); },
        [](I x) { return arcTangent2(x[0], x[1]); },
        []<class T>(const T* x, T, const T* d) {
            const double squared = x[0] * x[0] + x[1] * x[1];
            return squared > T(0) ? (x[1] * d[0] - x[0] * d[1]) / squared : T(0);
        },
        "fieldArcTangent2(%a, %b)", "iArcTangent2(%a, %b)",
        "(%a != 0.0 || %b != 0.0) ? (%b * %A - %a * %B) / (%a * %a + %b * %b) : 0.0", "", 5),
    row(
        Op::less, "less", Arity<2>(), true, false, []<class T>(const T* x) { return T(x[0] < x[1]); },
        [](I x) { return truth(above(x[0].hi) < below(x[1].lo), below(x[0].lo) >= above(x[1].hi)); },
        zeroSlope, "(%a < %b)", "vec2(%a.y < %b.x, %a.x < %b.y)", ""),
    row(
        Op::lessEqual, "lessEqual", Arity<2>(), true, false,
        []<class T>(const T* x) { return T(x[0] <= x[1]); },
        [](I x) { return truth(above(x[0].hi) <= below(x[1].lo), below(x[0].lo) > above(x[1].hi)); },
        zeroSlope, "(%a <= %b)", "vec2(%a.y <= %b.x, %a.x <= %b.y)", ""),
    row(
        Op::equal, "equal", Arity<2>(), true, true, []<class T>(const T* x) { return T(x[0] == x[1]); },
        [](I x) {
            return truth(x[0].isPoint() && x[1].isPoint() && x[0].lo == x[1].lo && isBounded(x[0]),
                         x[0].hi < x[1].lo || x[1].hi < x[0].lo);
        },
        zeroSlope, "(%a == %b)", "iEqual(%a, %b)", ""),
    row(
        Op::logicalAnd, "and", Arity<2>(), true, true, []<class T>(const T* x) { return x[0] * x[1]; },
        [](I x) { return minimum(x[0], x[1]); }, zeroSlope, "(%a && %b)", "min(%a, %b)", ""),
    row(
        Op::logicalOr, "or", Arity<2>(), true, true, []<class T>(const T* x) { return std::max(x[0], x[1]); },
        [](I x) { return maximum(x[0], x[1]); }, zeroSlope, "(%a || %b)", "max(%a, %b)", ""),

    row(
        Op::select, "select", Arity<3>(), false, false,
        []<class T>(const T* x) { return x[0] != T(0) ? x[1] : x[2]; },
        [](I x) { return x[0].lo > 0.5   ? x[1]
                         : x[0].hi < 0.5 ? x[2]
                                         : hull(x[1], x[2]); },
        []<class T>(const T* x, T, const T* d) { return x[0] != T(0) ? d[1] : d[2]; }, "%a ? %b : %c",
        "iSelect(%a, %b, %c)", "%a ? %B : %C"),
    row(
        Op::smoothMinimum, "smoothMin", Arity<3>(), false, false,
        []<class T>(const T* x) { return smoothMinimum(x[0], x[1], x[2]); },
        [](I x) { return smoothMinimumInterval(x); },
        []<class T>(const T* x, T, const T* d) { return smoothMinimumSlope(x, d); },
        "fieldSmoothMin(%a, %b, %c)", "iSmoothMin(%a, %b, %c)",
        "fieldSmoothMinSlope(%a, %b, %c, %A, %B, %C)"),

    row(
        Op::gradientNoise, "perlin", Arity<4>(), false, false,
        []<class T>(const T* x) { return gradientNoise(x[0], x[1], x[2], x[3]).value; },
        [](I x) {
            return noiseInterval(x, gradientNoise<double>, kGradientNoiseSlope, -kGradientNoiseRange,
                                 kGradientNoiseRange);
        },
        []<class T>(const T* x, T, const T* d) {
            return noiseSlope(gradientNoise(x[0], x[1], x[2], x[3]), d);
        },
        "gradientNoise(vec3(%a, %b, %c), %d)",
        "iNoise(gradientNoise(iCentre(%a, %b, %c), %d.x), %a, %b, %c, 3.7, -1.1, 1.1)", kChainRule,
        "gradientNoiseGradient(vec3(%a, %b, %c), %d)", 60),
    row(
        Op::simplexNoise, "simplex", Arity<4>(), false, false,
        []<class T>(const T* x) { return simplexNoise(x[0], x[1], x[2], x[3]).value; },
        [](I x) {
            return noiseInterval(x, simplexNoise<double>, kSimplexNoiseSlope, -kSimplexNoiseRange,
                                 kSimplexNoiseRange);
        },
        []<class T>(const T* x, T, const T* d) {
            return noiseSlope(simplexNoise(x[0], x[1], x[2], x[3]), d);
        },
        "simplexNoise(vec3(%a, %b, %c), %d)",
        "iNoise(simplexNoise(iCentre(%a, %b, %c), %d.x), %a, %b, %c, 7.2, -1.1, 1.1)", kChainRule,
        "simplexNoiseGradient(vec3(%a, %b, %c), %d)", 45),
    row(
        Op::worleyNoise, "worley", Arity<4>(), false, false, WorleyNoise(),
        [](I x) { return noiseInterval(x, worleyNoise, 1.0, 0.0, kWorleyNoiseRange); }, WorleySlope(),
        "worleyNoise(vec3(%a, %b, %c), %d)",
        "iNoise(worleyNoise(iCentre(%a, %b, %c), %d.x), %a, %b, %c, 1.0, 0.0, 1.7320508)", kChainRule,
        "worleyNoiseGradient(vec3(%a, %b, %c), %d)", 110),
    row(
        Op::cellWall, "cell_wall", Arity<4>(), false, false,
        []<class T>(const T* x) { return cellWall(x[0], x[1], x[2], x[3]).value; },
        [](I x) { return noiseInterval(x, cellWall<double>, 1.0, 0.0, kCellWallRange); },
        []<class T>(const T* x, T, const T* d) { return noiseSlope(cellWall(x[0], x[1], x[2], x[3]), d); },
        "cellWallGradient(vec3(%a, %b, %c), %d).w",
        "iNoise(cellWallGradient(iCentre(%a, %b, %c), %d.x).w, %a, %b, %c, 1.0, 0.0, 0.15)", kChainRule,
        "cellWallGradient(vec3(%a, %b, %c), %d)", 260),
    row(
        Op::cellHash, "hash", Arity<4>(), false, false,
        []<class T>(const T* x) { return cellHash(x[0], x[1], x[2], x[3]); },
        [](I x) { return hashInterval(x); }, zeroSlope, "cellHash(vec3(%a, %b, %c), %d)",
        "iCellHash(%a, %b, %c, %d)", "", "", 25),

    row(
        Op::image, "image", Arity<2>(), false, false,
        []<class T>(const T* x, L layer) { return sampleImage(*layer.image, x[0], x[1]).value; },
        [](I x, L layer) { return sampleImage(*layer.image, x[0], x[1]); },
        []<class T>(const T* x, T, const T* d, L layer) {
            const ImageSample sample = sampleImage(*layer.image, x[0], x[1]);
            return sample.du * d[0] + sample.dv * d[1];
        },
        "fieldImage%i(vec2(%a, %b)).w", "fieldImageRange%i(%a, %b)", "dot(%s.xy, vec2(%A, %B))",
        "fieldImage%i(vec2(%a, %b))"),

    row(
        Op::volume, "volume", Arity<3>(), false, false,
        []<class T>(const T* x, L layer) {
            return sampleVolume(*layer.volume, {x[0], x[1], x[2]}).value;
        },
        [](I x, L layer) { return sampleVolume(*layer.volume, x); },
        []<class T>(const T* x, T, const T* d, L layer) {
            const VolumeSample sample = sampleVolume(*layer.volume, {x[0], x[1], x[2]});
            return sample.gradient[0] * d[0] + sample.gradient[1] * d[1] + sample.gradient[2] * d[2];
        },
        "fieldVolume%i(vec3(%a, %b, %c)).w", "fieldVolumeRange%i(%a, %b, %c)", kChainRule,
        "fieldVolume%i(vec3(%a, %b, %c))"),

    row(
        Op::outline, "outline", Arity<2>(), false, false,
        []<class T>(const T* x, L layer) { return sampleOutline(*layer.outline, x[0], x[1]).value; },
        [](I x, L layer) { return sampleOutline(*layer.outline, x[0], x[1]); },
        []<class T>(const T* x, T, const T* d, L layer) {
            const OutlineSample sample = sampleOutline(*layer.outline, x[0], x[1]);
            return sample.dx * d[0] + sample.dy * d[1];
        },
        "fieldOutline%i(vec2(%a, %b)).w", "fieldOutlineRange%i(%a, %b)", "dot(%s.xy, vec2(%A, %B))",
        "fieldOutline%i(vec2(%a, %b))", 60),

    row(
        Op::spline, "spline", Arity<3>(), false, false,
        []<class T>(const T* x, L layer) {
            return sampleSpline(*layer.spline, layer.channel, {x[0], x[1], x[2]}).value;
        },
        [](I x, L layer) { return sampleSpline(*layer.spline, layer.channel, x); },
        []<class T>(const T* x, T, const T* d, L layer) {
            const glm::dvec3 slope = sampleSpline(*layer.spline, layer.channel, {x[0], x[1], x[2]}).slope;
            return slope.x * d[0] + slope.y * d[1] + slope.z * d[2];
        },
        "fieldSpline%i(vec3(%a, %b, %c)).w", "fieldSplineRange%i(%a, %b, %c)", kChainRule,
        "fieldSpline%i(vec3(%a, %b, %c))", 70),
}};

constexpr bool inOrder() {
    for (size_t i = 0; i < kTable.size(); ++i)
        if (kTable[i].op != static_cast<Op>(i)) return false;
    return true;
}
static_assert(inOrder(), "rows stand in the order of enum Op");

}  // namespace

const OpInfo& opInfo(Op op) { return kTable[static_cast<size_t>(op)]; }
std::span<const OpInfo> opTable() { return kTable; }

namespace {

bool hasAvx2() {
#if defined(__x86_64__) || defined(__i386__)
    return __builtin_cpu_supports("avx2");
#else
    return false;
#endif
}

template <class T>
using AllKernels = std::array<const OpKernels<T>*, kTable.size()>;

template <class T>
AllKernels<T> kernelsHere(const OpKernels<T>* const (OpInfo::*forms)[2]) {
    AllKernels<T> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = (kTable[i].*forms)[hasAvx2()];
    return all;
}

}  // namespace

template <>
std::span<const OpKernels<double>* const> opKernels<double>() {
    static const AllKernels<double> all = kernelsHere(&OpInfo::doubles);
    return all;
}
template <>
std::span<const OpKernels<float>* const> opKernels<float>() {
    static const AllKernels<float> all = kernelsHere(&OpInfo::floats);
    return all;
}

Interval singlePrecisionInterval(const OpInfo& info, std::span<const Interval> operands, SampledLayer layer) {
    if (info.rounding == Rounding::none) return info.interval(operands.data(), layer);
    constexpr double kPlaces = 3e-7;  // five of the last places
    const auto grown = [](Interval a, double by) {
        return Interval{std::max(a.lo - by, -kHuge), std::min(a.hi + by, kHuge)};
    };
    if (info.rounding == Rounding::result) {
        const Interval range = info.interval(operands.data(), layer);
        return grown(range, kPlaces * absolute(range).hi);
    }
    Interval around[kMaxArity];
    double most = 0.0;
    for (std::size_t i = 0; i < operands.size(); ++i) {
        const double size = absolute(operands[i]).hi;
        around[i] = grown(operands[i], kPlaces * size);
        most = std::max(most, size);
    }
    const Interval range = info.interval(around, layer);
    if (info.rounding == Rounding::noise) return grown(range, 4 * kPlaces * std::max(most, 1.0));
    return info.op == Op::round ? range : grown(range, kPlaces * std::max(most, absolute(range).hi));
}

}  // namespace fw
