// Intervals contain values, where this is hardest: at lattice corners, cuts and exact multiples, for huge,
// tiny and denormal numbers, and over boxes of random graphs.
#include "graph/base/interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

#include "graph/compile/compile.h"
#include "graph/evaluate/evaluate.h"
#include "graph/ir/noise.h"
#include "graph/ir/ops.h"
#include "tests/support/graph/random_graph.h"

namespace fw::interval_test {

bool isLong() { return std::getenv("FIELDWRIGHT_LONG") != nullptr; }

struct Probe {
    std::mt19937_64 random;

    double unit() { return double(random() >> 11) * 0x1p-53; }
    bool chance(double share) { return unit() < share; }

    /// A number of the kind that breaks things.
    double number() {
        constexpr double pi = std::numbers::pi;
        static const double special[] = {0.0,  -0.0, 0.5,    1.0,  2.0,   3.0,    0.1,       1.1,
                                         0.75, pi,   pi / 2, 1e-9, 1e9,   1e15,   1463.0,    1e-30,
                                         1e20, 1e29, 1e30,   1e40, 1e200, 1e-200, 4.94e-324, 2.3e-308};
        const double sign = chance(0.5) ? 1.0 : -1.0;
        double value = 0.0;
        switch (random() % 8) {
            case 0: value = special[random() % std::size(special)]; break;
            case 1: value = std::floor(40.0 * unit()); break;  // lattice corners
            case 2: value = std::floor(2000.0 * unit()) * (1.1 + 0.1 * double(random() % 3)); break;
            case 3: value = std::floor(50.0 * unit()) * pi / 2; break;
            case 4: value = std::pow(10.0, 80.0 * unit() - 40.0); break;
            case 5: value = std::pow(2.0, std::floor(70.0 * unit()) - 5.0); break;
            default: value = 4.0 * unit();
        }
        for (int steps = int(random() % 6) - 3; steps != 0 && chance(0.7); steps += steps < 0 ? 1 : -1)
            value = std::nextafter(value, steps < 0 ? -1e300 : 1e300);
        return sign * value;
    }

    /// Operands, and an interval around each, cut to the finite range as results of operations are.
    void operands(const OpInfo& info, double* values, Interval* ranges) {
        for (int i = 0; i < kMaxArity; ++i) {
            const bool truth = (i == 0 && info.op == Op::select) || info.op == Op::logicalNot ||
                               info.op == Op::logicalAnd || info.op == Op::logicalOr;
            const auto one = [&] { return truth ? double(random() % 2) : number(); };
            double a = one(), b = chance(0.3) ? a : one();
            if (!truth && chance(0.5)) b = a + std::pow(10.0, 6.0 * unit() - 5.0);
            if (b < a) std::swap(a, b);
            const double t = unit();
            double inside = t < 0.25  ? a
                            : t < 0.5 ? b
                            : t < 0.6 ? std::floor(b)
                            : t < 0.7 ? 0.0
                                      : std::lerp(a, b, unit());
            if (truth) inside = chance(0.5) ? a : b;
            values[i] = std::clamp(inside, a, b);
            ranges[i] = {std::clamp(a, -kHuge, kHuge), std::clamp(b, -kHuge, kHuge)};
        }
    }
};

class EveryOp : public testing::TestWithParam<int> {};

TEST_P(EveryOp, IntervalContainsTheValueOfHardOperands) {
    const OpInfo& info = opInfo(static_cast<Op>(GetParam()));
    if (samplesLayer(info.op)) return;  // image_test, volume_test, outline_test
    Probe probe{std::mt19937_64(uint64_t(GetParam()))};
    const int probes = isLong() ? 1'000'000 : 20'000;
    double values[kMaxArity];
    Interval ranges[kMaxArity];
    for (int n = 0; n < probes; ++n) {
        probe.operands(info, values, ranges);
        const double value = info.value(values, {});
        const Interval range = info.interval(ranges, {});
        ASSERT_FALSE(std::isnan(range.lo) || std::isnan(range.hi)) << info.name;
        ASSERT_LE(range.lo, range.hi) << info.name;
        ASSERT_TRUE(-kHuge <= range.lo && range.hi <= kHuge) << info.name;
        const double cut = std::clamp(value, -kHuge, kHuge);
        const bool holds = std::isnan(value) ? range.lo == -kHuge && range.hi == kHuge : range.contains(cut);
        if (holds) continue;
        std::string text;
        for (int i = 0; i < info.arity; ++i) {
            char part[160];
            std::snprintf(part, sizeof part, " %.17g in [%.17g, %.17g]", values[i], ranges[i].lo,
                          ranges[i].hi);
            text += part;
        }
        char what[120];
        std::snprintf(what, sizeof what, "%.17g is not in [%.17g, %.17g]", value, range.lo, range.hi);
        FAIL() << info.name << text << ": " << what;
    }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryOp,
                         testing::Range(static_cast<int>(Op::negate), static_cast<int>(Op::count)),
                         [](const auto& row) {
                             return std::string(opInfo(static_cast<Op>(row.param)).name);
                         });

TEST(Interval, OfARemainder) {
    const double left = 1463.0 - 1.1 * std::floor(1463.0 / 1.1);
    ASSERT_LT(left, 0.0);  // the quotient is rounded to the next whole number
    EXPECT_LE(modulo({1400.0, 1500.0}, {1.1, 1.1}).lo, left);
    EXPECT_LE(modulo({1463.0, 1463.0}, {1.1, 1.1}).lo, left);
    EXPECT_EQ(modulo({1.0, 2.0}, {0.0, 0.0}).hi, kHuge);
    EXPECT_EQ(modulo({1.0, 2.0}, {0.0, 0.0}).lo, -kHuge);
    EXPECT_EQ(truncatedModulo({1.0, 2.0}, {-1.0, 1.0}).lo, -kHuge);
    EXPECT_NEAR(modulo({0.25, 0.5}, {-2.0, -2.0}).lo, -1.75,
                1e-12);  // one quotient, as for a positive divisor
}

TEST(Noise, WorleyIsTheDistanceToTheNearestPoint) {
    // Against all points of the 343 cells around.
    std::mt19937_64 random(5);
    const int places = isLong() ? 200'000 : 4'000;
    int farther = 0;
    for (int n = 0; n < places; ++n) {
        const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
        double p[3], seed = 3.0;
        for (double& c : p) c = 1000.0 * unit() - 500.0;
        if (n % 4 == 0) {  // where the 27 cells around have none within a metre, and one beyond is nearer
            const double lo[3] = {-14.01, -20.03, 18.03};
            for (int axis = 0; axis < 3; ++axis) p[axis] = lo[axis] + 0.01 * unit();
            seed = 0.0;
        }
        double nearest = 1e9;
        for (int k = -3; k <= 3; ++k)
            for (int j = -3; j <= 3; ++j)
                for (int i = -3; i <= 3; ++i) {
                    const double o[3] = {std::floor(p[0]) + i, std::floor(p[1]) + j, std::floor(p[2]) + k};
                    const std::array<double, 3> point = worleyPoint(o[0], o[1], o[2], seed);
                    nearest =
                        std::min(nearest, std::hypot(p[0] - point[0], p[1] - point[1], p[2] - point[2]));
                }
        const NoiseSample sample = worleyNoise(p[0], p[1], p[2], seed);
        ASSERT_NEAR(sample.value, nearest, 1e-12) << p[0] << ' ' << p[1] << ' ' << p[2];
        ASSERT_LE(sample.value, kWorleyNoiseRange);
        farther += nearest > 1.0;
    }
    EXPECT_GT(farther, 0);
}

TEST(Noise, CellWallIsTheDistanceToTheNearestWall) {
    // Against the planes half way to all points of the 343 cells around.
    std::mt19937_64 random(6);
    const int places = isLong() ? 100'000 : 2'000;
    int beyond = 0;
    for (int n = 0; n < places; ++n) {
        const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
        std::array<double, 3> p;
        for (double& c : p) c = 1000.0 * unit() - 500.0;
        std::vector<std::array<double, 3>> points;
        for (int k = -3; k <= 3; ++k)
            for (int j = -3; j <= 3; ++j)
                for (int i = -3; i <= 3; ++i) {
                    const double o[3] = {std::floor(p[0]) + i, std::floor(p[1]) + j, std::floor(p[2]) + k};
                    std::array<double, 3> point = worleyPoint(o[0], o[1], o[2], 5.0);
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        point[axis] = o[axis] + 0.1 + 0.8 * (point[axis] - o[axis]) - p[axis];
                    points.push_back(point);
                }
        const auto size = [](const std::array<double, 3>& a) { return std::hypot(a[0], a[1], a[2]); };
        const auto nearest = *std::ranges::min_element(points, {}, size);
        double wall = kCellWallRange;
        for (const auto& point : points) {
            const double apart =
                std::hypot(point[0] - nearest[0], point[1] - nearest[1], point[2] - nearest[2]);
            const double far = size(point), near = size(nearest);
            if (apart > 0.0) wall = std::min(wall, (far * far - near * near) / (2.0 * apart));
        }
        const NoiseSample sample = cellWall(p[0], p[1], p[2], 5.0);
        ASSERT_NEAR(sample.value, wall, 1e-9) << p[0] << ' ' << p[1] << ' ' << p[2];
        beyond += size(nearest) > 0.9;
    }
    EXPECT_GT(beyond, 0);
}

TEST(Noise, WorleyHasItsIntervalWhereThePointIsTwoCellsOff) {
    const OpInfo& worley = opInfo(Op::worleyNoise);
    const Interval box[4] = {{-14.02, -13.99}, {-20.04, -20.02}, {18.02, 18.04}, {0.0, 0.0}};
    const double place[4] = {-13.991, -20.03, 18.03, 0.0};
    const Interval range = worley.interval(box, {});
    EXPECT_NEAR(worley.value(place, {}), 1.07 - 0.0539, 1e-4);
    EXPECT_TRUE(range.contains(worley.value(place, {}))) << range.lo << ' ' << range.hi;
}

TEST(Interval, OfRandomGraphsContainsTheirSamples) {
    const uint32_t wanted = isLong() ? 500 : 40;
    uint32_t graphs = 0;
    std::mt19937_64 random(9);
    const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
    for (uint32_t seed = 1; graphs < wanted; ++seed) {
        ASSERT_LT(seed, 4 * wanted + 100);
        const std::optional<Program> program = test::randomProgram(seed, 40);
        if (!program) continue;
        ++graphs;
        const std::vector<double> parameters = program->parameters();
        for (int n = 0; n < (isLong() ? 200 : 24); ++n) {
            Box box;
            const double size = std::pow(10.0, 5.0 * unit() - 4.0), reach = n % 6 == 0 ? 200.0 : 2.5;
            for (int axis = 0; axis < 3; ++axis) {
                box.lo[axis] = reach * (2.0 * unit() - 1.0);
                if (n % 3 == 0) box.lo[axis] = std::round(2.0 * box.lo[axis]) / 2.0;
                box.hi[axis] = box.lo[axis] + size;
            }
            std::vector<Point> points(32);
            for (std::size_t i = 0; i < points.size(); ++i)
                for (int axis = 0; axis < 3; ++axis)
                    points[i][axis] = i < 8 ? (i >> axis & 1 ? box.hi : box.lo)[axis]
                                            : std::lerp(box.lo[axis], box.hi[axis], unit());
            std::vector<double> values(points.size());
            evaluate(program->ir, program->distance(), parameters, points, values);
            const Interval range = evaluateInterval(program->ir, program->distance(), parameters, box);
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (!std::isfinite(values[i])) continue;
                ASSERT_TRUE(range.contains(std::clamp(values[i], -kHuge, kHuge)))
                    << "seed " << seed << ": " << values[i] << " is not in [" << range.lo << ", " << range.hi
                    << "] at " << points[i][0] << ' ' << points[i][1] << ' ' << points[i][2];
            }
        }
    }
}

}  // namespace fw::interval_test
