// Tapes: every evaluator on them does what the op table's rows say, registers hold what is alive, and a
// shortened tape has the same bits within its box.
#include "graph/evaluate/tape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "tests/support/graph/random_graph.h"

namespace fw::tape_test {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

double fraction(std::mt19937& random) { return double(random() >> 8) / double(1 << 24); }

/// The value by the rows' scalar meanings alone, one operation after the other.
double reference(const Ir& ir, IrId root, std::span<const double> parameters, const Point& p) {
    std::vector<double> values(root + 1);
    for (IrId id = 0; id <= root; ++id) {
        const IrNode& node = ir[id];
        double operands[kMaxArity] = {};
        for (int i = 0; i < opInfo(node.op).arity; ++i) operands[i] = values[node.operands[std::size_t(i)]];
        values[id] = id < 3                       ? p[id]
                     : node.op == Op::parameter   ? parameters[std::size_t(node.number)]
                     : opInfo(node.op).arity == 0 ? node.number
                                                  : opInfo(node.op).value(operands, ir.layer(node));
    }
    return values[root];
}

/// As many points within the box as a batch holds, put where the machine reads them.
template <class T>
std::vector<Point> scatter(TapeMachine<T>& machine, const Box& box, std::size_t count, std::mt19937& random) {
    std::vector<Point> points(count);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = std::lerp(box.lo[axis], box.hi[axis], fraction(random));
            points[i][axis] = i == 0   ? box.lo[axis]
                              : i == 1 ? box.hi[axis]
                                       : std::clamp(double(T(at)), box.lo[axis], box.hi[axis]);
            machine.position(int(axis))[i] = T(points[i][axis]);
        }
    return points;
}

/// A small field that needs the operation, with some operands replaced by numbers.
IrId fieldOf(Ir& ir, const OpInfo& info, unsigned numbers, std::mt19937& random) {
    std::vector<IrId> operands;
    for (int i = 0; i < info.arity; ++i) {
        const bool truth = info.op == Op::select && i == 0, both = info.boolean && info.op != Op::less &&
                                                                   info.op != Op::lessEqual &&
                                                                   info.op != Op::equal;
        if (numbers >> i & 1) {
            operands.push_back(truth || both ? ir.constant(double(random() & 1))
                                             : ir.constant(std::round(4.0 * fraction(random)) / 2.0 - 0.75));
            continue;
        }
        IrId operand = ir.add(Op::multiply, ir.position(i % 3), ir.constant(0.5 + fraction(random)));
        operand = ir.add(Op::add, operand, ir.position((i + 1) % 3));
        if (truth || both) operand = ir.add(Op::less, operand, ir.constant(0.25 * fraction(random)));
        operands.push_back(operand);
    }
    return ir.add(info.op, operands);
}

TEST(Tape, EveryOperationMeansTheSameInEveryEvaluator) {
    std::mt19937 random(5);
    for (const OpInfo& info : opTable()) {
        if (info.arity == 0 || samplesLayer(info.op)) continue;
        for (unsigned numbers = 0; numbers < (1u << info.arity); ++numbers) {
            SCOPED_TRACE(std::string(info.name) + ", numbers " + std::to_string(numbers));
            Ir ir;
            const IrId root = fieldOf(ir, info, numbers, random);
            const Tape tape = makeTape(ir, root, {});
            TapeMachine<double> machine;
            TapeMachine<float> single;
            const Box box{{-1.5, -0.5, 0.125}, {0.5, 1.75, 2.25}};
            constexpr std::size_t kCount = TapeMachine<double>::kGradientPoints - 1;
            const std::vector<Point> points = scatter(single, box, kCount, random);
            scatter(machine, box, 0, random);
            const auto place = [&] {
                for (std::size_t i = 0; i < points.size(); ++i)
                    for (int axis = 0; axis < 3; ++axis)
                        machine.position(axis)[i] = points[i][std::size_t(axis)];
            };
            place();
            const double* values = machine.value(tape, kCount);
            const std::vector<double> found(values, values + kCount);
            const float* narrow = single.value(tape, kCount);
            const Interval range = machine.interval(tape, box), wide = single.interval(tape, box);
            for (std::size_t i = 0; i < kCount; ++i) {
                EXPECT_TRUE(same(found[i], reference(ir, root, {}, points[i])));
                if (!std::isfinite(found[i]) || std::abs(found[i]) >= kHuge) continue;
                EXPECT_TRUE(range.contains(found[i])) << found[i];
                EXPECT_TRUE(wide.contains(double(narrow[i]))) << narrow[i];
                // What jumps may take the other side; what is steep loses places.
                const bool jumps = info.op == Op::floor || info.op == Op::ceil || info.op == Op::round ||
                                   info.op == Op::truncate || info.op == Op::modulo ||
                                   info.op == Op::truncatedModulo || info.op == Op::tangent;
                if (!jumps) { EXPECT_NEAR(double(narrow[i]), found[i], 2e-5 * (1.0 + std::abs(found[i]))); }
            }
            place();
            const auto gradients = machine.gradient(tape, kCount);
            std::vector<Point> slopes(kCount);
            for (std::size_t i = 0; i < kCount; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis) slopes[i][axis] = gradients.gradients[axis][i];
            int smooth = 0;
            for (std::size_t i = 0; i < kCount; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    EXPECT_TRUE(same(gradients.values[i], found[i]));
                    Point less = points[i], more = points[i];
                    const double h = 1e-6;
                    less[axis] -= h, more[axis] += h;
                    const double left = (found[i] - reference(ir, root, {}, less)) / h,
                                 right = (reference(ir, root, {}, more) - found[i]) / h;
                    if (!(std::abs(left - right) < 1e-2 * (1.0 + std::abs(left)))) continue;  // a corner
                    ++smooth;
                    EXPECT_NEAR(slopes[i][axis], 0.5 * (left + right), 2e-2 * (1.0 + std::abs(left)));
                }
            EXPECT_GT(smooth, int(kCount));
        }
    }
}

/// Over boxes so small that rounding is all that their intervals can be wide.
TEST(Tape, SinglePrecisionIsWithinItsIntervalsOfNoises) {
    std::mt19937 random(9);
    for (const Op op : {Op::gradientNoise, Op::simplexNoise, Op::worleyNoise, Op::cellWall}) {
        Ir ir;
        const IrId root = ir.add(op, std::array{ir.position(0), ir.position(1), ir.position(2),
                                                ir.constant(double(random() % 9))});
        const Tape tape = makeTape(ir, root, {});
        TapeMachine<float> machine;
        for (int n = 0; n < 3000; ++n) {
            Box box;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double size = std::pow(10.0, 6.0 * fraction(random) - 2.0);
                const double at = n % 3 ? size * (2.0 * fraction(random) - 1.0) : std::round(size);
                box.lo[axis] = float(at), box.hi[axis] = float(at + 1e-6 * size);
            }
            constexpr std::size_t kCount = 24;
            scatter(machine, box, kCount, random);
            for (std::size_t i = 0; i < kCount; ++i)
                for (int axis = 0; axis < 3; ++axis)
                    machine.position(axis)[i] =
                        std::clamp(machine.position(axis)[i], float(box.lo[std::size_t(axis)]),
                                   float(box.hi[std::size_t(axis)]));
            const float* values = machine.value(tape, kCount);
            const std::vector<float> found(values, values + kCount);
            const Interval range = machine.interval(tape, box);
            for (const float value : found)
                ASSERT_TRUE(range.contains(double(value)))
                    << opInfo(op).name << ": " << value << " is not in [" << range.lo << ", " << range.hi
                    << "] about " << box.lo[0] << ", " << box.lo[1] << ", " << box.lo[2];
        }
    }
}

TEST(Tape, ShortenedTapesKeepEveryValueOfRandomGraphs) {
    std::size_t shorter = 0, fewer = 0, tapes = 0;
    const auto probe = [&]<class T>(TapeMachine<T>& machine, const Program& program, uint32_t seed) {
        const std::vector<double> parameters = program.parameters();
        const Tape whole = makeTape(program.ir, program.distance(), parameters);
        std::mt19937 random(seed);
        Tape own = whole;
        for (double size : {2.0, 0.5, 0.1, 0.02}) {
            Box box;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.lo[axis] = double(T(-2.0 + 4.0 * fraction(random)));
                box.hi[axis] = double(T(box.lo[axis] + size));
            }
            const Interval range = machine.interval(whole, box);
            own = machine.shortened(whole);
            EXPECT_EQ(machine.shortens() || own.steps.size() == whole.steps.size(), true);
            const std::size_t count = TapeMachine<T>::kPoints;
            const std::vector<Point> points = scatter(machine, box, count, random);
            const auto place = [&] {
                for (std::size_t i = 0; i < count; ++i)
                    for (int axis = 0; axis < 3; ++axis)
                        machine.position(axis)[i] = T(points[i][std::size_t(axis)]);
            };
            const T* full = machine.value(whole, count);
            const std::vector<T> values(full, full + count);
            place();
            const T* brief = machine.value(own, count);
            for (std::size_t i = 0; i < count; ++i) {
                if (i < 4 && sizeof(T) == sizeof(double)) {
                    EXPECT_TRUE(same(double(values[i]),
                                     reference(program.ir, program.distance(), parameters, points[i])));
                }
                ASSERT_TRUE(same(double(brief[i]), double(values[i])))
                    << "seed " << seed << ", box of " << size;
                const bool finite = std::isfinite(values[i]) && std::abs(double(values[i])) < kHuge;
                ASSERT_TRUE(!finite || range.contains(double(values[i])))
                    << "seed " << seed << ", box of " << size << ": " << values[i];
            }
            // Whose sign alone counts is shorter still.
            machine.interval(whole, box);
            const Tape signs = machine.shortenedForSigns(whole);
            EXPECT_LE(signs.steps.size(), own.steps.size());
            place();
            const T* sided = machine.value(signs, count);
            for (std::size_t i = 0; i < count; ++i)
                ASSERT_TRUE(std::isnan(values[i]) ||
                            ((sided[i] < 0) == (values[i] < 0) && (sided[i] > 0) == (values[i] > 0)))
                    << "seed " << seed << ", box of " << size << ": " << values[i] << ", " << sided[i];
            fewer += signs.steps.size() < own.steps.size();
            // A part of the box makes a shorter tape of the shortened one.
            Box part = box;
            part.hi[0] = double(T(0.5 * (box.lo[0] + box.hi[0])));
            machine.interval(own, part);
            const Tape least = machine.shortened(own);
            const std::vector<Point> within = scatter(machine, part, count, random);
            const T* again = machine.value(least, count);
            const std::vector<T> last(again, again + count);
            for (std::size_t i = 0; i < count; ++i)
                for (int axis = 0; axis < 3; ++axis)
                    machine.position(axis)[i] = T(within[i][std::size_t(axis)]);
            full = machine.value(whole, count);
            for (std::size_t i = 0; i < count; ++i)
                ASSERT_TRUE(same(double(last[i]), double(full[i]))) << "seed " << seed;
            ++tapes;
            shorter += own.steps.size() < whole.steps.size();
            EXPECT_LE(own.steps.size(), whole.steps.size());
        }
    };
    TapeMachine<double> machine;
    TapeMachine<float> single;
    for (uint32_t seed = 1; seed <= 150; ++seed) {
        const Result<Program> program = compile(test::randomGraph(seed, 40));
        if (!program) continue;
        probe(machine, *program, seed);
        probe(single, *program, seed);
    }
    EXPECT_GT(tapes, 600u);
    EXPECT_GT(shorter, tapes / 4) << "nothing is dropped";
    EXPECT_GT(fewer, tapes / 50) << "signs drop nothing more";
}

/// So many operations on values made before, the positions among them, any of which may be old.
IrId randomField(Ir& ir, int operations, std::size_t alive, std::mt19937& random) {
    std::vector<IrId> values = {0, 1, 2};
    IrId last = 0;
    const auto any = [&] {
        const std::size_t from = values.size() > alive ? values.size() - alive : 0;
        return values[from + random() % (values.size() - from)];
    };
    for (int i = 0; i < operations; ++i) {
        constexpr Op kOps[] = {Op::add, Op::subtract, Op::minimum, Op::maximum, Op::smoothMinimum};
        const Op op = kOps[random() % 5];
        const IrId a = any(), b = random() % 4 ? any() : ir.constant(fraction(random));
        last = op == Op::smoothMinimum ? ir.add(op, a, b, ir.constant(0.1 + fraction(random)))
                                       : ir.add(op, a, b);
        if (ir[last].positions == 0) continue;
        // What is added up stays small.
        values.push_back(last = ir.add(Op::multiply, last, ir.constant(0.5)));
    }
    IrId sum = values[3];
    for (std::size_t i = 4; i < values.size(); i += 7) sum = ir.add(Op::add, sum, values[i]);
    return sum;
}

TEST(Tape, RegistersOfLargeRandomFieldsHoldEveryValue) {
    std::mt19937 random(11);
    TapeMachine<double> machine;
    for (const std::size_t alive : {3, 30, 3000, 100'000}) {
        SCOPED_TRACE(alive);
        Ir ir;
        const IrId root = randomField(ir, 4000, alive, random);
        const Tape tape = makeTape(ir, root, {});
        std::vector<bool> written(tape.registers);
        written[0] = written[1] = written[2] = true;
        for (const TapeStep& step : tape.steps) {
            for (int i = 0; i < opInfo(step.op).arity; ++i) {
                if (step.numbers >> i & 1) continue;
                ASSERT_TRUE(written[step.operands[std::size_t(i)]]);
                ASSERT_NE(step.operands[std::size_t(i)], step.result);
            }
            ASSERT_GE(step.result, 3u);
            written[step.result] = true;
        }
        constexpr std::size_t kCount = TapeMachine<double>::kPoints;
        const std::vector<Point> points = scatter(machine, {{-1, -1, -1}, {1, 1, 1}}, kCount, random);
        const double* values = machine.value(tape, kCount);
        for (std::size_t i = 0; i < kCount; i += 19)
            EXPECT_TRUE(same(values[i], reference(ir, root, {}, points[i])));
    }
}

TEST(Tape, AChainTakesFewRegistersHoweverLong) {
    Ir ir;
    IrId all = ir.position(0);
    for (int i = 0; i < 5000; ++i) {
        const IrId ball =
            ir.add(Op::absolute, ir.add(Op::subtract, ir.position(i % 3), ir.constant(i * 0.01)));
        all = ir.add(Op::minimum, all, ball);
    }
    const Tape tape = makeTape(ir, all, {});
    EXPECT_GT(tape.steps.size(), 14'000u);
    EXPECT_LE(tape.registers, 16 + tape.steps.size() / 6);
    TapeMachine<float> machine;
    machine.interval(tape, {{-1, -1, -1}, {1, 1, 1}});
    machine.shortened(tape);
    EXPECT_LE(machine.bytes() + tape.steps.size() * sizeof(TapeStep), 100 * tape.steps.size());
}

TEST(Tape, SeveralRootsAreValuesOfOneTape) {
    Ir ir;
    const IrId sum = ir.add(Op::add, ir.position(0), ir.position(1)),
               live = ir.add(Op::square, ir.parameter(1)), far = ir.add(Op::maximum, sum, ir.position(2));
    const std::vector<IrId> roots = {far, 1, live, sum, far, ir.constant(7.0)};
    const Tape tape = makeTape(ir, roots, std::array{0.0, 3.0});
    TapeMachine<double> machine;
    *machine.position(0) = 1, *machine.position(1) = 2, *machine.position(2) = 5;
    EXPECT_EQ(*machine.value(tape, 1), 5.0);
    const double expected[] = {5, 2, 9, 3, 5, 7};
    for (std::size_t i = 0; i < roots.size(); ++i) EXPECT_EQ(*machine.root(tape, i), expected[i]) << i;
    machine.interval(tape, {{0, 0, 0}, {1, 1, 0.5}});
    EXPECT_EQ(machine.shortened(tape).roots.size(), roots.size());
}

TEST(Tape, SlopesAreTheGradients) {
    TapeMachine<double> machine;
    constexpr std::size_t kCount = TapeMachine<double>::kGradientPoints;
    for (uint32_t seed = 1; seed <= 40; ++seed) {
        const Result<Program> program = compile(test::randomGraph(seed, 30));
        if (!program) continue;
        std::mt19937 random(seed);
        const Tape tape = makeTape(program->ir, program->distance(), program->parameters());
        const std::vector<Point> points = scatter(machine, {{-1, -1, -1}, {1, 1, 1}}, kCount, random);
        const auto expected = machine.gradient(tape, kCount);
        std::array<std::vector<double>, 3> wanted;
        for (std::size_t axis = 0; axis < 3; ++axis)
            wanted[axis].assign(expected.gradients[axis], expected.gradients[axis] + kCount);
        for (std::size_t along = 0; along < 3; ++along) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (std::size_t i = 0; i < kCount; ++i) {
                    machine.position(int(axis))[i] = points[i][axis];
                    machine.direction(int(axis))[i] = axis == along ? 1.0 : 0.0;
                }
            const double* slope = machine.slope(tape, kCount).slopes;
            for (std::size_t i = 0; i < kCount; ++i)
                if (std::isfinite(wanted[along][i])) {
                    EXPECT_NEAR(slope[i], wanted[along][i], 1e-9 * std::abs(wanted[along][i]))
                        << "seed " << seed;
                }
        }
    }
}

TEST(Tape, WhatZDoesNotMoveIsNotComputedAnew) {
    TapeMachine<float> machine;
    std::size_t still = 0;
    for (uint32_t seed = 1; seed <= 60; ++seed) {
        const Result<Program> program = compile(test::randomGraph(seed, 30));
        if (!program) continue;
        std::mt19937 random(seed);
        const Tape tape = makeTape(program->ir, program->distance(), program->parameters());
        still += tape.still;
        constexpr std::size_t kCount = 81;
        scatter(machine, {{-1, -1, -1}, {1, 1, 1}}, kCount, random);
        machine.value(tape, kCount);
        for (const float z : {-0.5f, 0.25f, 0.75f}) {
            std::fill_n(machine.position(2), kCount, z);
            const float* once = machine.value(tape, kCount, true);
            const std::vector<float> moved(once, once + kCount);
            const float* whole = machine.value(tape, kCount);
            for (std::size_t i = 0; i < kCount; ++i)
                ASSERT_TRUE(same(double(moved[i]), double(whole[i]))) << "seed " << seed;
        }
    }
    EXPECT_GT(still, 100u);
}

TEST(Tape, AUnionOfFarShapesShrinksToTheNearOne) {
    Ir ir;
    IrId all = 0;
    for (int i = 0; i < 50; ++i) {
        const IrId ball = ir.add(Op::absolute, ir.add(Op::subtract, ir.position(0), ir.constant(i * 10.0)));
        all = i == 0 ? ball : ir.add(Op::minimum, all, ball);
    }
    TapeMachine<double> machine;
    const Tape whole = makeTape(ir, all, {});
    machine.interval(whole, {{99, 0, 0}, {101, 1, 1}});
    const Tape own = machine.shortened(whole);
    EXPECT_EQ(own.steps.size(), 2u);
    EXPECT_EQ(own.registers, 5u);
    EXPECT_GT(whole.steps.size(), 140u);
}

TEST(Tape, KeepsWhatItSamples) {
    std::weak_ptr<const SplineTable> table;
    Tape tape;
    {
        const Result<Graph> graph = parseGraph(
            R"({"fieldwright": 1, "nodes": [{"id": "s", "type": "spline"},
                {"id": "t", "type": "tube", "inputs": {"spline": {"from": "s"}, "radius": 0.1}},
                {"id": "out", "type": "output", "inputs": {"surface": {"from": "t"}}}]})",
            "", nullptr);
        ASSERT_TRUE(graph) << graph.error().message;
        const Result<Program> program = compile(*graph);
        ASSERT_TRUE(program) << program.error().message;
        ASSERT_EQ(program->ir.splines().size(), 1u);
        table = program->ir.splines()[0];
        tape = makeTape(program->ir, program->distance(), program->parameters());
    }
    EXPECT_FALSE(table.expired());
    tape = {};
    EXPECT_TRUE(table.expired());
}

TEST(Tape, OnlyWhatTheRootNeedsIsInIt) {
    Ir ir;
    IrId other = ir.position(0);
    for (int i = 0; i < 1000; ++i) other = ir.add(Op::sine, ir.add(Op::add, other, ir.position(1)));
    const IrId root = ir.add(Op::add, ir.position(2), ir.add(Op::square, ir.parameter(0)));
    const Tape tape = makeTape(ir, root, std::array{3.0});
    EXPECT_EQ(tape.steps.size(), 1u);
    TapeMachine<double> machine;
    *machine.position(2) = 1;
    EXPECT_EQ(*machine.value(tape, 1), 10.0);
}

}  // namespace fw::tape_test
