// Tapes: the full one has the evaluators' values, a shortened one the same bits within its box.
#include "graph/evaluate/tape.h"

#include <gtest/gtest.h>

#include <random>

#include "graph/compile/compile.h"
#include "tests/support/graph/random_graph.h"

namespace fw {
namespace {

/// As many points within the box as a batch holds, put where the machine reads them.
std::vector<Point> scatter(TapeMachine& machine, const Box& box, std::mt19937& random) {
    std::vector<Point> points(TapeMachine::kBatch);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const double t = double(random() >> 8) / double(1 << 24);
            points[i][axis] = i == 0   ? box.lo[axis]
                              : i == 1 ? box.hi[axis]
                                       : std::lerp(box.lo[axis], box.hi[axis], t);
            machine.position(axis)[i] = points[i][axis];
        }
    return points;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

TEST(Tape, ShortenedTapesKeepEveryValueOfRandomGraphs) {
    std::size_t shorter = 0, tapes = 0;
    for (uint32_t seed = 1; seed <= 150; ++seed) {
        const Result<Program> program = compile(test::randomGraph(seed, 40));
        if (!program) continue;
        const std::vector<double> parameters = program->parameters();
        TapeMachine machine(program->ir, parameters);
        const Tape whole = makeTape(program->ir, program->distance());
        std::mt19937 random(seed);
        for (double size : {2.0, 0.5, 0.1, 0.02}) {
            Box box;
            for (int axis = 0; axis < 3; ++axis) {
                box.lo[axis] = -2.0 + 4.0 * double(random() >> 8) / double(1 << 24);
                box.hi[axis] = box.lo[axis] + size;
            }
            const Interval range = machine.interval(whole, box);
            const Tape own = machine.shortened(whole);
            const std::vector<Point> points = scatter(machine, box, random);
            std::vector<double> expected(points.size());
            evaluate(program->ir, program->distance(), parameters, points, expected);
            const double* full = machine.value(whole, points.size());
            const std::vector<double> values(full, full + points.size());
            const double* brief = machine.value(own, points.size());
            for (std::size_t i = 0; i < points.size(); ++i) {
                EXPECT_TRUE(same(values[i], expected[i])) << "seed " << seed;
                EXPECT_TRUE(same(brief[i], values[i])) << "seed " << seed << ", box of " << size;
                const bool finite = std::isfinite(values[i]) && std::abs(values[i]) < kHuge;
                EXPECT_TRUE(!finite || range.contains(values[i])) << "seed " << seed;
            }
            ++tapes;
            shorter += own.steps.size() < whole.steps.size();
        }
    }
    EXPECT_GT(tapes, 300u);
    EXPECT_GT(shorter, tapes / 4) << "nothing is dropped";
}

TEST(Tape, SlopesAreTheGradients) {
    for (uint32_t seed = 1; seed <= 40; ++seed) {
        const Result<Program> program = compile(test::randomGraph(seed, 30));
        if (!program) continue;
        const std::vector<double> parameters = program->parameters();
        TapeMachine machine(program->ir, parameters);
        std::mt19937 random(seed);
        const Tape tape = makeTape(program->ir, program->distance());
        const std::vector<Point> points = scatter(machine, {{-1, -1, -1}, {1, 1, 1}}, random);
        std::vector<ValueGradient> expected(points.size());
        evaluateGradient(program->ir, program->distance(), parameters, points, expected);
        machine.value(tape, points.size());
        for (int axis = 0; axis < 3; ++axis) {
            for (int other = 0; other < 3; ++other)
                std::fill_n(machine.direction(other), points.size(), other == axis ? 1.0 : 0.0);
            const double* slope = machine.slope(tape, points.size());
            for (std::size_t i = 0; i < points.size(); ++i)
                if (const double wanted = expected[i].gradient[axis]; std::isfinite(wanted)) {
                    EXPECT_NEAR(slope[i], wanted, 1e-9 * std::abs(wanted)) << "seed " << seed;
                }
        }
    }
}

TEST(Tape, OnlyMovedAxesAreComputedAnew) {
    Ir ir;
    const IrId xy = ir.add(Op::multiply, ir.position(0), ir.position(1));
    const IrId live = ir.add(Op::square, ir.parameter(0));
    const IrId root = ir.add(Op::add, ir.add(Op::add, xy, ir.position(2)), live);
    TapeMachine machine(ir, std::array{3.0});
    const Tape tape = makeTape(ir, root);
    *machine.position(0) = 2, *machine.position(1) = 5, *machine.position(2) = 1;
    EXPECT_EQ(*machine.value(tape, 1), 20.0);
    *machine.position(2) = 7;
    EXPECT_EQ(*machine.value(tape, 1, dependsOnZ), 26.0);
}

TEST(Tape, AUnionOfFarShapesShrinksToTheNearOne) {
    Ir ir;
    IrId all = 0;
    for (int i = 0; i < 50; ++i) {
        const IrId ball = ir.add(Op::absolute, ir.add(Op::subtract, ir.position(0), ir.constant(i * 10.0)));
        all = i == 0 ? ball : ir.add(Op::minimum, all, ball);
    }
    TapeMachine machine(ir, {});
    const Tape whole = makeTape(ir, all);
    machine.interval(whole, {{99, 0, 0}, {101, 1, 1}});
    EXPECT_EQ(machine.shortened(whole).steps.size(), 2u);
    EXPECT_GT(whole.steps.size(), 140u);
}

}  // namespace
}  // namespace fw
