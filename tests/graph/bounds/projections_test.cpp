// Property test of projectOperands(): operands that give a result in the interval are never cut off.
#include "graph/bounds/projections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "graph/ir/ir.h"

namespace fw::projections_test {

bool isBoolean(Op op, int operand) {
    return (op == Op::select && operand == 0) || op == Op::logicalNot || op == Op::logicalAnd ||
           op == Op::logicalOr;
}

/// Random numbers, intervals and points in them.
struct Source {
    std::mt19937_64 random;

    double unit() { return double(random() >> 11) * 0x1p-53; }
    double number() {
        const double sign = random() % 2 ? 1.0 : -1.0;
        switch (random() % 6) {
            case 0: return 0.0;
            case 1: return sign * double(random() % 5);
            case 2: return sign * 0.5 * double(random() % 7);
            case 3: return sign * std::pow(10.0, 12.0 * unit() - 6.0);
            default: return sign * 3.0 * unit();
        }
    }
    Interval interval(bool boolean) {
        if (boolean) {
            const double a = double(random() % 2), b = double(random() % 2);
            return {std::min(a, b), std::max(a, b)};
        }
        const double a = number();
        switch (random() % 6) {
            case 0: return {a, a};
            case 1: return {a, a + std::pow(10.0, 5.0 * unit() - 6.0)};
            case 2: return {a, kHuge};
            case 3: return {-kHuge, a};
            case 4: return random() % 4 ? Interval{-std::abs(a), std::abs(number())} : kEverything;
            default: break;
        }
        const double b = number();
        return {std::min(a, b), std::max(a, b)};
    }
    double within(Interval range, bool boolean) {
        if (boolean) return random() % 2 ? range.lo : range.hi;
        const double t = unit();
        if (t < 0.15 && range.lo > -kHuge) return range.lo;
        if (t < 0.3 && range.hi < kHuge) return range.hi;
        const double value = range.lo > -kHuge  ? range.lo + std::abs(number())
                             : range.hi < kHuge ? range.hi - std::abs(number())
                                                : number();
        if (isBounded(range) && !(t < 0.5 && range.contains(value)))
            return std::lerp(range.lo, range.hi, unit());
        return std::clamp(value, range.lo, range.hi);
    }
};

/// How often operands are cut off although the interval may contain their exact result. `least` is the
/// smallest width by which the result interval contains the value; below it, rounding decides.
void expectKeepsOperands(const OpInfo& info, const SampledLayer& layer, int rounds) {
    Source source{std::mt19937_64(uint64_t(info.op) + 77)};
    int tried = 0, failed = 0;
    for (int round = 0; round < rounds; ++round) {
        Interval before[kMaxArity], after[kMaxArity];
        for (int i = 0; i < info.arity; ++i) before[i] = source.interval(isBoolean(info.op, i));
        constexpr int kSamples = 12;
        double values[kSamples][kMaxArity] = {}, results[kSamples];
        for (int n = 0; n < kSamples; ++n) {
            for (int i = 0; i < info.arity; ++i)
                values[n][i] = source.within(before[i], isBoolean(info.op, i));
            results[n] = info.value(values[n], layer);
        }
        Interval result = source.interval(info.boolean);
        const double some = results[source.random() % kSamples];
        if (std::isfinite(some) && source.random() % 4) {
            // An interval next to a value that occurs.
            const double slack = 1e-9 * (1.0 + std::abs(some));
            const Interval around[] = {{some - slack, some + slack},
                                       {-kHuge, some + slack},
                                       {some - slack, kHuge},
                                       {some - slack, some + slack + source.unit()}};
            result = around[source.random() % 4];
        }
        result = {std::max(result.lo, -kHuge), std::min(result.hi, kHuge)};
        if (result.lo > result.hi) continue;
        std::copy(before, before + kMaxArity, after);
        const bool possible = projectOperands(info.op, result, after, layer);
        for (int n = 0; n < kSamples; ++n) {
            // Exact values differ from rounded ones by less than this.
            double largest = std::abs(results[n]);
            for (int i = 0; i < info.arity; ++i) largest = std::max(largest, std::abs(values[n][i]));
            const double slack = info.boolean ? 0.0 : 1e-14 * largest;
            if (!(results[n] >= below(result.lo) + slack && results[n] <= above(result.hi) - slack)) continue;
            ++tried;
            bool holds = possible;
            for (int i = 0; i < info.arity; ++i) holds = holds && after[i].contains(values[n][i]);
            if (holds || ++failed > 3) continue;
            std::string text;
            for (int i = 0; i < info.arity; ++i) {
                char part[200];
                std::snprintf(part, sizeof part, "\n  operand %.17g of [%.17g, %.17g] -> [%.17g, %.17g]",
                              values[n][i], before[i].lo, before[i].hi, after[i].lo, after[i].hi);
                text += part;
            }
            char wanted[120];
            std::snprintf(wanted, sizeof wanted, "%.17g in [%.17g, %.17g]", results[n], result.lo, result.hi);
            ADD_FAILURE() << info.name << " = " << wanted << (possible ? "" : ", but none is possible")
                          << text;
        }
    }
    EXPECT_EQ(failed, 0) << "of " << tried;
    EXPECT_GT(tried, rounds / 20) << info.name << ": hardly any sample meets its result interval";
}

int rounds() { return std::getenv("FIELDWRIGHT_LONG") ? 300'000 : 6'000; }

class ProjectEveryOp : public testing::TestWithParam<int> {};

TEST_P(ProjectEveryOp, KeepsOperandsThatGiveTheResult) {
    const OpInfo& info = opInfo(static_cast<Op>(GetParam()));
    if (samplesLayer(info.op)) GTEST_SKIP() << "tested with layers";
    expectKeepsOperands(info, {}, rounds());
}

INSTANTIATE_TEST_SUITE_P(Table, ProjectEveryOp,
                         testing::Range(static_cast<int>(Op::negate), static_cast<int>(Op::count)),
                         [](const auto& row) {
                             return std::string(opInfo(static_cast<Op>(row.param)).name);
                         });

/// Distances to a ball.
FieldVolumePtr sampledBall() {
    const VolumeGrid grid{{-1.0, -1.0, -1.0}, 0.4, {6, 6, 6}};
    std::vector<float> distances;
    std::vector<glm::vec3> gradients;
    for (int z = 0; z < 6; ++z)
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 6; ++x) {
                const glm::vec3 p(grid.place({x, y, z}));
                const float length = glm::length(p);
                distances.push_back(length - 0.7f);
                gradients.push_back(p / length);
            }
    return std::make_shared<const FieldVolume>(grid, distances, gradients);
}

TEST(ProjectLayers, VolumesKeepTheirPlaces) {
    Ir ir;
    const uint32_t ball = ir.addVolume(sampledBall());
    for (const VolumeChannel channel : {tricubicChannel, trilinearChannel}) {
        const IrId root = ir.sample(ball, channel, {ir.position(0), ir.position(1), ir.position(2)});
        expectKeepsOperands(opInfo(Op::volume), ir.layer(ir[root]), rounds() / 10);
    }
}

TEST(ProjectLayers, OutlinesAndSplinesKeepTheirPlaces) {
    Ir ir;
    const IrId outline = ir.sample(ir.addOutline(outlineThrough(std::array{-0.5, -0.4, 0.6, -0.3, 0.1, 0.7})),
                                   ir.position(0), ir.position(1));
    expectKeepsOperands(opInfo(Op::outline), ir.layer(ir[outline]), rounds() / 10);
    const uint32_t spline =
        ir.addSpline(splineTable(*splineOfHelix({.radius = 0.6, .topRadius = 0.4, .turns = 1.2}), 0));
    const IrId distance =
        ir.sample(spline, SplineChannel::distance, {ir.position(0), ir.position(1), ir.position(2)});
    expectKeepsOperands(opInfo(Op::spline), ir.layer(ir[distance]), rounds() / 20);
}

}  // namespace fw::projections_test
