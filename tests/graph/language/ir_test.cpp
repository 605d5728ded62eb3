// The op table's four meanings agree with each other, and the graph's folding and substitution keep values.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "graph/evaluate/evaluate.h"
#include "graph/ir/ir.h"

namespace fw::ir_test {

/// Distances to a ball.
FieldVolumePtr ballVolume() {
    static const FieldVolumePtr volume = [] {
        const VolumeGrid grid{{-1.0, -1.0, -1.0}, 0.2, {11, 11, 11}};
        std::vector<float> distances;
        std::vector<glm::vec3> gradients;
        for (int z = 0; z < 11; ++z)
            for (int y = 0; y < 11; ++y)
                for (int x = 0; x < 11; ++x) {
                    const glm::vec3 p(grid.place({x, y, z}));
                    const float length = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
                    distances.push_back(length - 0.7f);
                    gradients.push_back(length > 0.0f ? p / length : glm::vec3(0.0f));
                }
        return std::make_shared<const FieldVolume>(grid, distances, gradients);
    }();
    return volume;
}

/// An Ir that applies `op` to x, y, z and a constant, as far as its arity goes; booleans where they are
/// wanted.
struct Applied {
    Ir ir;
    IrId root;
    explicit Applied(Op op, double fourth = 3.0) {
        const IrId isPositive = ir.add(Op::less, ir.constant(0.0), ir.position(0));
        const IrId isLarge = ir.add(Op::less, ir.constant(0.5), ir.position(1));
        const int arity = opInfo(op).arity;
        if (op == Op::image)
            root = ir.sample(ir.addImage(plainImage()), 1, ir.position(0), ir.position(1));
        else if (op == Op::volume)
            root = ir.sample(ir.addVolume(ballVolume()), tricubicChannel,
                             {ir.position(0), ir.position(1), ir.position(2)});
        else if (op == Op::outline)
            root = ir.sample(ir.addOutline(outlineThrough(std::array{-0.5, -0.4, 0.6, -0.3, 0.1, 0.7})),
                             ir.position(0), ir.position(1));
        else if (op == Op::spline)
            root = ir.sample(
                ir.addSpline(splineTable(*splineOfHelix({.radius = 0.6, .topRadius = 0.4, .turns = 1.2}), 0)),
                SplineChannel::distance, {ir.position(0), ir.position(1), ir.position(2)});
        else if (op == Op::select)
            root = ir.add(op, isPositive, ir.position(1), ir.position(2));
        else if (op == Op::logicalNot)
            root = ir.add(op, isPositive);
        else if (op == Op::logicalAnd || op == Op::logicalOr)
            root = ir.add(op, isPositive, isLarge);
        else {
            const std::array<IrId, 4> operands{ir.position(0), ir.position(1), ir.position(2),
                                               ir.constant(fourth)};
            root = ir.add(op, std::span<const IrId>(operands.data(), arity));
        }
    }
};

class EachOp : public testing::TestWithParam<int> {
  protected:
    Op op() const { return static_cast<Op>(GetParam()); }
};

TEST_P(EachOp, IntervalContainsTheValues) {
    const Applied applied(op());
    std::mt19937 random(GetParam());
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 20'000; ++i) {
        Box box;
        Point point;
        const double size = std::pow(10.0, 2.0 * unit(random) - 2.0);
        for (int axis = 0; axis < 3; ++axis) {
            const double a = 4.0 * unit(random) - 2.0;
            box.lo[axis] = a, box.hi[axis] = a + size * unit(random);
            const double t = unit(random);
            point[axis] = t < 0.05   ? box.lo[axis]
                          : t > 0.95 ? box.hi[axis]
                                     : box.lo[axis] + unit(random) * (box.hi[axis] - box.lo[axis]);
        }
        const double value = evaluate(applied.ir, applied.root, {}, point);
        const Interval range = evaluateInterval(applied.ir, applied.root, {}, box);
        if (std::isfinite(value)) {
            ASSERT_TRUE(range.contains(value))
                << opInfo(op()).name << ' ' << range.lo << " <= " << value << " <= " << range.hi;
        }
        ASSERT_FALSE(std::isnan(range.lo) || std::isnan(range.hi)) << opInfo(op()).name;
    }
}

TEST_P(EachOp, IntervalOfAPointIsTight) {
    const Applied applied(op());
    const Point point{0.7, 0.3, 0.45};
    const double value = evaluate(applied.ir, applied.root, {}, point);
    const Interval range = evaluateInterval(applied.ir, applied.root, {}, {point, point});
    EXPECT_NEAR(range.lo, value, 1e-7) << opInfo(op()).name;
    EXPECT_NEAR(range.hi, value, 1e-7) << opInfo(op()).name;
}

TEST_P(EachOp, GradientIsTheCentralDifference) {
    const Applied applied(op());
    std::mt19937 random(GetParam());
    std::uniform_real_distribution<double> unit(-2.0, 2.0);
    int failures = 0;
    const double h = 1e-6;
    for (int i = 0; i < 5'000; ++i) {
        const Point p{unit(random), unit(random), unit(random)};
        ValueGradient result;
        evaluateGradient(applied.ir, applied.root, {}, std::span(&p, 1), std::span(&result, 1));
        ASSERT_EQ(std::isnan(result.gradient[0]), false);
        for (int axis = 0; axis < 3; ++axis) {
            Point a = p, b = p;
            a[axis] -= h, b[axis] += h;
            const double difference =
                (evaluate(applied.ir, applied.root, {}, b) - evaluate(applied.ir, applied.root, {}, a)) /
                (2.0 * h);
            if (std::abs(difference - result.gradient[axis]) > 1e-4 * (1.0 + std::abs(difference)))
                ++failures;
        }
    }
    EXPECT_LE(failures, 15) << opInfo(op()).name;  // a few points straddle a kink, a jump or a pole
}

INSTANTIATE_TEST_SUITE_P(Table, EachOp,
                         testing::Range(static_cast<int>(Op::negate), static_cast<int>(Op::count)),
                         [](const auto& row) {
                             return std::string(opInfo(static_cast<Op>(row.param)).name);
                         });

TEST(Ir, SharesAndFolds) {
    Ir ir;
    const IrId x = ir.position(0), y = ir.position(1);
    EXPECT_EQ(ir.add(Op::add, x, y), ir.add(Op::add, y, x));
    EXPECT_EQ(ir.add(Op::add, x, ir.constant(0.0)), x);
    EXPECT_EQ(ir.add(Op::multiply, x, ir.constant(1.0)), x);
    EXPECT_TRUE(ir.isConstant(ir.add(Op::subtract, x, x), 0.0));
    EXPECT_TRUE(ir.isConstant(ir.add(Op::power, ir.constant(2.0), ir.constant(3.0)), 8.0));
    EXPECT_EQ(ir.add(Op::negate, ir.add(Op::negate, x)), x);
    EXPECT_EQ(ir.add(Op::minimum, ir.add(Op::maximum, x, y), x), x);
    EXPECT_EQ(ir.add(Op::select, ir.constant(1.0), x, y), x);
    EXPECT_EQ(ir[ir.add(Op::multiply, x, x)].op, Op::square);
    EXPECT_EQ(ir[ir.add(Op::add, x, y)].positions, dependsOnX | dependsOnY);
}

/// A random expression over x, y, z and a parameter.
IrId randomExpression(Ir& ir, std::mt19937& random, int operations) {
    std::vector<IrId> numbers{ir.position(0),   ir.position(1),     ir.position(2),   ir.parameter(0),
                              ir.constant(0.5), ir.constant(-1.25), ir.constant(0.0), ir.constant(1.0)};
    const Op ops[] = {Op::negate,  Op::absolute,      Op::floor,   Op::squareRoot,      Op::square,
                      Op::sine,    Op::cosine,        Op::add,     Op::subtract,        Op::multiply,
                      Op::minimum, Op::maximum,       Op::modulo,  Op::truncatedModulo, Op::arcTangent2,
                      Op::select,  Op::gradientNoise, Op::cellHash};
    const auto pick = [&] { return numbers[random() % numbers.size()]; };
    for (int i = 0; i < operations; ++i) {
        const Op op = ops[random() % std::size(ops)];
        std::array<IrId, 4> operands{pick(), pick(), pick(), ir.constant(double(random() % 5))};
        if (op == Op::select) operands[0] = ir.add(Op::less, pick(), pick());
        if (op == Op::modulo || op == Op::truncatedModulo) operands[1] = ir.constant(0.75);
        numbers.push_back(ir.add(op, std::span<const IrId>(operands.data(), opInfo(op).arity)));
    }
    return numbers.back();
}

TEST(Ir, SumsWithConstantsAreOneSum) {
    Ir ir;
    const IrId x = ir.position(0), one = ir.constant(1.0), three = ir.constant(3.0);
    const IrId more = ir.add(Op::add, x, ir.constant(2.0)), less = ir.add(Op::subtract, x, ir.constant(2.0));
    EXPECT_EQ(ir.add(Op::subtract, ir.add(Op::add, x, three), one), more);
    EXPECT_EQ(ir.add(Op::add, one, ir.add(Op::add, one, x)), more);
    EXPECT_EQ(ir.add(Op::subtract, ir.add(Op::subtract, x, one), one), less);
    EXPECT_EQ(ir.add(Op::add, ir.add(Op::subtract, x, three), one), less);
    EXPECT_EQ(ir.add(Op::add, ir.add(Op::subtract, x, three), three), x);
    IrId chain = x;
    for (int i = 0; i < 1000; ++i) chain = ir.add(Op::subtract, chain, one);
    EXPECT_EQ(chain, ir.add(Op::subtract, x, ir.constant(1000.0)));
    const IrId reversed = ir.add(Op::subtract, one, x);  // 1 - x keeps its sign
    EXPECT_DOUBLE_EQ(evaluate(ir, ir.add(Op::add, reversed, one), {}, Point{5, 0, 0}), -3.0);
}

TEST(Ir, MultiplesAreOneMultiple) {
    Ir ir;
    const IrId x = ir.position(0), y = ir.position(1);
    const auto number = [&](double value) { return ir.constant(value); };
    const auto times = [&](IrId of, double factor) { return ir.add(Op::multiply, of, number(factor)); };
    EXPECT_EQ(times(times(x, 2.0), 3.0), times(x, 6.0));
    EXPECT_EQ(times(times(x, 2.0), 0.5), x);
    EXPECT_EQ(ir.add(Op::negate, times(x, 2.0)), times(x, -2.0));
    EXPECT_EQ(times(ir.add(Op::negate, x), 2.0), times(x, -2.0));
    EXPECT_EQ(ir.add(Op::multiply, ir.add(Op::negate, x), ir.add(Op::negate, y)), ir.add(Op::multiply, x, y));
    EXPECT_EQ(ir.add(Op::add, times(x, 2.0), times(x, 3.0)), times(x, 5.0));
    EXPECT_EQ(ir.add(Op::add, x, x), times(x, 2.0));
    EXPECT_EQ(ir.add(Op::subtract, times(x, 2.0), x), x);
    EXPECT_TRUE(ir.isConstant(ir.add(Op::add, times(x, 2.0), times(x, -2.0)), 0.0));
    EXPECT_EQ(ir.add(Op::divide, times(x, 3.0), number(3.0)), x);
    // A float would not hold the product.
    EXPECT_NE(times(times(x, 1e20), 1e20), times(x, 1e40));
    EXPECT_FALSE(ir.isConstant(times(times(x, 1e-200), 1e-200)));
}

TEST(Ir, ADifferenceFromAConstantTakesInConstants) {
    Ir ir;
    const IrId x = ir.position(0), five = ir.constant(5.0), two = ir.constant(2.0);
    const IrId plus = ir.add(Op::add, x, two), minus = ir.add(Op::subtract, x, two),
               from = ir.add(Op::subtract, two, x);
    EXPECT_EQ(ir.add(Op::subtract, five, plus), ir.add(Op::subtract, ir.constant(3.0), x));
    EXPECT_EQ(ir.add(Op::subtract, five, minus), ir.add(Op::subtract, ir.constant(7.0), x));
    EXPECT_EQ(ir.add(Op::subtract, five, from), ir.add(Op::add, x, ir.constant(3.0)));
}

TEST(Ir, SubstitutionIsEvaluationElsewhere) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-2.0, 2.0);
    for (int i = 0; i < 200; ++i) {
        Ir ir;
        const IrId field = randomExpression(ir, random, 30);
        std::array<IrId, 3> moved{};
        for (IrId& axis : moved) axis = randomExpression(ir, random, 5);
        const IrId there = ir.substitute(field, moved);
        const std::vector<double> parameters{0.7};
        for (int k = 0; k < 20; ++k) {
            const Point p{unit(random), unit(random), unit(random)};
            Point q;
            for (int axis = 0; axis < 3; ++axis) q[axis] = evaluate(ir, moved[axis], parameters, p);
            const double expected = evaluate(ir, field, parameters, q),
                         found = evaluate(ir, there, parameters, p);
            if (std::isfinite(expected) && std::abs(expected) < 1e6) {
                ASSERT_NEAR(found, expected, 1e-6 * (1.0 + std::abs(expected)));
            }
        }
    }
}

TEST(Ir, CompactingKeepsValuesAndGivesAStableHash) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-2.0, 2.0);
    for (int i = 0; i < 100; ++i) {
        Ir ir;
        IrId root = randomExpression(ir, random, 60);
        std::array<IrId, 1> roots{root};
        const Ir small = ir.compact(roots);
        EXPECT_LE(small.size(), ir.size() + 3);
        std::array<IrId, 1> again = roots;
        const Ir same = small.compact(again);
        EXPECT_EQ(same.hash(again), small.hash(roots));
        const std::vector<double> parameters{0.7};
        const Point p{unit(random), unit(random), unit(random)};
        const double expected = evaluate(ir, root, parameters, p);
        if (std::isfinite(expected)) { EXPECT_EQ(evaluate(small, roots[0], parameters, p), expected); }
    }
}

TEST(Interval, SineOverManyPeriods) {
    for (double a = -20.0; a < 20.0; a += 0.173)
        for (double width : {0.01, 0.5, 1.5, 3.0, 5.0, 7.0}) {
            const Interval range = sine({a, a + width});
            double least = 1.0, most = -1.0;
            for (int i = 0; i <= 2000; ++i) {
                const double value = std::sin(a + width * i / 2000.0);
                least = std::min(least, value), most = std::max(most, value);
            }
            EXPECT_LE(range.lo, least);
            EXPECT_GE(range.hi, most);
            EXPECT_NEAR(range.lo, least, 1e-5);
            EXPECT_NEAR(range.hi, most, 1e-5);
        }
}

}  // namespace fw::ir_test
