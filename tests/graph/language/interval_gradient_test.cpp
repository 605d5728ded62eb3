// Interval differentiation: difference quotients and gradients lie within its bounds, for every operation,
// for random programs and random graphs, over boxes of all kinds.
#include "graph/evaluate/interval_gradient.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"
#include "tests/support/graph/code_text.h"
#include "tests/support/graph/random_code.h"
#include "tests/support/graph/random_graph.h"
#include "tests/support/graph/tape_field.h"

namespace fw::interval_gradient_test {

using test::TapeField, test::fraction, test::between, test::pointWithin, test::secondPoint, test::valueAt;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Box randomBox(std::mt19937& random) {
    Box box;
    const unsigned kind = random() % 8;
    const double size = kind == 0 ? 1e7 : std::pow(10.0, between(-4.0, 0.7, random));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double centre = kind == 1 ? 0.0 : between(-2.0, 2.0, random);
        box.lo[axis] = centre - size * fraction(random), box.hi[axis] = centre + size * fraction(random);
        if (kind == 2 && random() % 2 == 0) box.hi[axis] = box.lo[axis] = std::round(2.0 * centre) / 2.0;
        if (kind == 3 && random() % 2 == 0) box.lo[axis] = -kHuge;
        if (kind == 3 && random() % 2 == 0) box.hi[axis] = kHuge;
        if (kind == 4) box.lo[axis] = std::round(box.lo[axis]), box.hi[axis] = box.lo[axis] + 1.0;
    }
    return box;
}

struct Counts {
    int boxes = 0, bounded = 0, pairs = 0;
};

/// Difference quotients and gradients of points within the box.
void expectWithinBounds(const TapeField& field, std::span<const double> parameters, const Box& box, int pairs,
                        std::mt19937& random, Counts& counts) {
    static IntervalGradientMachine machine;
    const IntervalGradient bounds = machine.evaluate(field.tape, box);
    const Interval form = machine.meanValue(field.tape, box);
    const std::string where =
        ::testing::PrintToString(box.lo) + " .. " + ::testing::PrintToString(box.hi) + "\n";
    for (const Interval& slope : bounds.gradient) {
        ASSERT_TRUE(slope.lo <= slope.hi) << where;
        ASSERT_TRUE(slope.lo >= -kHuge && slope.hi <= kHuge) << where;
    }
    ASSERT_TRUE(bounds.norm >= 0.0) << where;
    ++counts.boxes, counts.bounded += bounds.norm < kInfinity;
    for (int i = 0; i < pairs; ++i) {
        const Point p = pointWithin(box, random), q = secondPoint(p, box, random);
        const test::Evaluated f = valueAt(field, parameters, p), g = valueAt(field, parameters, q);
        if (!(std::max(f.largest, g.largest) < 1e25)) continue;
        const double slack = f.rounding + g.rounding + 1e-15;
        EXPECT_TRUE(form.lo - slack <= f.value && f.value <= form.hi + slack)
            << f.value << " outside " << form.lo << " .. " << form.hi << where;
        const double difference = f.value - g.value;
        double lo = -slack, hi = slack, squared = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double along = p[axis] - q[axis];
            squared += along * along;
            if (along == 0.0) continue;
            const double a = below(bounds.gradient[axis].lo) * along,
                         b = above(bounds.gradient[axis].hi) * along;
            lo += std::min(a, b), hi += std::max(a, b);
        }
        EXPECT_TRUE(difference >= lo && difference <= hi)
            << difference << " outside " << lo << " .. " << hi << "\n"
            << where << ::testing::PrintToString(p) << ::testing::PrintToString(q);
        if (squared > 0.0) {
            EXPECT_LE(std::abs(difference), bounds.norm * std::sqrt(squared) * (1.0 + 1e-12) + slack)
                << where;
        }
        ++counts.pairs;
        ValueGradient gradient;
        evaluateGradient(field.ir, field.root, parameters, std::span(&p, 1), std::span(&gradient, 1));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double slope = gradient.gradient[axis];
            if (!std::isfinite(slope) || std::abs(slope) > 1e12) continue;
            const double rounding = 1e-9 * (1.0 + std::abs(slope)) + 1e-14 * f.largest * f.largest;
            EXPECT_GE(slope, below(bounds.gradient[axis].lo) - rounding)
                << where << ::testing::PrintToString(p);
            EXPECT_LE(slope, above(bounds.gradient[axis].hi) + rounding)
                << where << ::testing::PrintToString(p);
        }
    }
}

int rounds(int few) { return std::getenv("FIELDWRIGHT_LONG") ? 20 * few : few; }

/// A small field that needs the operation, with some operands replaced by numbers.
TapeField fieldOf(const OpInfo& info, unsigned numbers, std::mt19937& random) {
    Ir ir;
    std::vector<IrId> operands;
    for (int i = 0; i < info.arity; ++i) {
        const bool truth = (info.op == Op::select && i == 0) || info.op == Op::logicalAnd ||
                           info.op == Op::logicalOr || info.op == Op::logicalNot;
        if (numbers >> i & 1) {
            operands.push_back(truth ? ir.constant(double(random() & 1))
                                     : ir.constant(std::round(4.0 * fraction(random)) / 2.0 - 0.75));
            continue;
        }
        IrId operand = ir.add(Op::multiply, ir.position(i % 3), ir.constant(0.5 + fraction(random)));
        operand = ir.add(random() % 2 ? Op::add : Op::subtract, operand, ir.position((i + 1) % 3));
        if (random() % 3 == 0) operand = ir.add(Op::multiply, operand, ir.position(int(random() % 3)));
        if (random() % 3 == 0) operand = ir.add(Op::sine, operand);
        if (truth) operand = ir.add(Op::less, operand, ir.constant(0.25 * fraction(random)));
        operands.push_back(operand);
    }
    const IrId root = ir.add(info.op, operands);
    return test::tapeField(std::move(ir), root);
}

TEST(IntervalGradient, OfEveryOperation) {
    std::mt19937 random(7);
    for (const OpInfo& info : opTable()) {
        if (info.arity == 0 || samplesLayer(info.op)) continue;
        Counts counts;
        for (unsigned numbers = 0; numbers < (1u << info.arity); ++numbers)
            for (int i = 0; i < rounds(40); ++i) {
                SCOPED_TRACE(std::string(info.name) + ", numbers " + std::to_string(numbers));
                const TapeField field = fieldOf(info, numbers, random);
                expectWithinBounds(field, {}, randomBox(random), 6, random, counts);
                if (HasFailure()) return;
            }
        EXPECT_GT(counts.bounded, 0) << info.name;
    }
}

TEST(IntervalGradient, OfRandomPrograms) {
    std::mt19937 random(11);
    Counts counts;
    for (int n = 0; n < rounds(400); ++n) {
        const test::CodeText code = test::randomCode(random, true);
        language::Lowering state;
        state.time = state.ir.constant(0.25);
        const auto inputs = test::inputValues(state, code.inputs);
        const auto value = language::lowerText(state, code.text, inputs);
        if (!value || componentCount(value->type) == 0 || state.ir.size() > 3000) continue;
        SCOPED_TRACE(code.text);
        std::array<IrId, 1> root{value->ids[0]};
        Ir ir = state.ir.compact(root);
        if (ir[root[0]].positions == 0) continue;
        const TapeField field = test::tapeField(std::move(ir), root[0]);
        for (int i = 0; i < 8; ++i) expectWithinBounds(field, {}, randomBox(random), 4, random, counts);
        if (HasFailure()) return;
    }
    EXPECT_GT(counts.bounded, counts.boxes / 8);
    EXPECT_GT(counts.pairs, counts.boxes);
}

TEST(IntervalGradient, OfRandomGraphs) {
    std::mt19937 random(12);
    Counts counts;
    for (uint32_t seed = 1; seed <= uint32_t(rounds(150)); ++seed) {
        std::optional<Program> program = test::randomProgram(seed, 8);
        if (!program) continue;
        SCOPED_TRACE(seed);
        const std::vector<double> parameters = program->parameters();
        const TapeField field = test::tapeField(program->ir, program->distance(), parameters);
        for (int i = 0; i < 10; ++i)
            expectWithinBounds(field, parameters, randomBox(random), 3, random, counts);
        if (HasFailure()) return;
    }
    EXPECT_GT(counts.bounded, counts.boxes / 4);
}

/// Boxes of all sizes about what is sampled.
Box boxAround(double reach, std::mt19937& random) {
    Box box;
    const double size = std::pow(10.0, between(-4.0, 0.5, random));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = between(-reach, reach, random);
        box.hi[axis] = box.lo[axis] + size * fraction(random);
    }
    return box;
}

void expectSampled(Ir ir, IrId root, double leastBounded, std::mt19937& random) {
    const TapeField field = test::tapeField(std::move(ir), root);
    Counts counts;
    for (int i = 0; i < rounds(400); ++i)
        expectWithinBounds(field, {}, boxAround(2.0, random), 6, random, counts);
    EXPECT_GE(counts.bounded, leastBounded * counts.boxes);
}

TEST(IntervalGradient, OfImages) {
    std::mt19937 random(21);
    std::vector<uint32_t> texels(5 * 4);
    for (uint32_t& texel : texels) texel = random() & 0xFFFFFF;
    const auto image = std::make_shared<const FieldImage>(5, 4, texels);
    for (int channel = 0; channel < kImageLayers; ++channel) {
        SCOPED_TRACE(channel);
        Ir ir;
        const IrId u = ir.add(Op::multiply, ir.position(0), ir.constant(0.7));
        const IrId root = ir.sample(ir.addImage(image), channel, u, ir.add(Op::add, ir.position(2), u));
        expectSampled(std::move(ir), root, 1.0, random);
    }
}

TEST(IntervalGradient, OfOutlines) {
    std::mt19937 random(22);
    const std::vector<double> corners{-1, -1, 1, -0.5, 0.2, 0.1, 0, 1};
    Ir ir;
    const IrId root = ir.sample(ir.addOutline(outlineThrough(corners)), ir.position(0),
                                ir.add(Op::subtract, ir.position(1), ir.position(2)));
    expectSampled(std::move(ir), root, 1.0, random);
}

TEST(IntervalGradient, OfVolumes) {
    std::mt19937 random(23);
    const VolumeGrid grid{
        .origin = glm::dvec3(-0.75), .cell = 0.15, .size = glm::ivec3(11), .inset = glm::dvec3(0.1)};
    std::vector<float> distances(grid.samples());
    std::vector<glm::vec3> gradients(grid.samples());
    std::vector<uint32_t> colors(grid.samples());
    for (int z = 0; z < 11; ++z)
        for (int y = 0; y < 11; ++y)
            for (int x = 0; x < 11; ++x) {
                const glm::dvec3 p = grid.place({x, y, z});
                const double length = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
                const std::size_t i = grid.index(x, y, z);
                distances[i] = float(length - 0.6);
                gradients[i] = length > 0.0 ? glm::vec3(p / length) : glm::vec3(0.0f);
                colors[i] = random() & 0xFFFFFF;
            }
    const auto volume = std::make_shared<const FieldVolume>(grid, distances, gradients, colors);
    for (int channel = 0; channel < kVolumeLayers; ++channel) {
        SCOPED_TRACE(channel);
        Ir ir;
        const IrId root = ir.sample(ir.addVolume(volume), VolumeChannel(channel),
                                    {ir.position(2), ir.position(0), ir.position(1)});
        expectSampled(std::move(ir), root, 1.0, random);
    }
}

TEST(IntervalGradient, OfSplines) {
    std::mt19937 random(24);
    for (int n = 0; n < 6; ++n) {
        std::vector<Knot> knots(5);
        for (Knot& knot : knots) {
            for (int axis = 0; axis < 3; ++axis) knot.place[axis] = between(-1.0, 1.0, random);
            if (n % 2) knot.radius = between(0.3, 1.5, random), knot.twist = between(-1.0, 1.0, random);
        }
        const Result<SplinePtr> spline =
            splineThrough(knots, n < 4 ? SplineKind::smooth : SplineKind::straight, n % 3 == 0);
        ASSERT_TRUE(spline);
        for (const double radius : {0.0, 0.1})
            for (int channel = 0; channel < kSplineChannels; ++channel) {
                const bool isDistance = SplineChannel(channel) == SplineChannel::distance;
                if (radius > 0.0 && !isDistance) continue;
                SCOPED_TRACE(std::to_string(n) + ", channel " + std::to_string(channel));
                Ir ir;
                const IrId root =
                    ir.sample(ir.addSpline(splineTable(*spline, radius)), SplineChannel(channel),
                              {ir.position(0), ir.position(1), ir.position(2)});
                expectSampled(std::move(ir), root, isDistance ? 1.0 : 0.0, random);
            }
    }
}

/// The bodies of all nodes and the expressions of all samples.
TEST(IntervalGradient, OfKnownCodes) {
    std::mt19937 random(13);
    Counts counts;
    for (const test::CodeText& code : test::knownCodes()) {
        language::Lowering state;
        state.time = state.ir.constant(0.25);
        const auto inputs = test::inputValues(state, code.inputs);
        const auto value = language::lowerText(state, code.text, inputs);
        if (!value || componentCount(value->type) == 0) continue;
        SCOPED_TRACE(code.text);
        std::array<IrId, 1> root{value->ids[0]};
        Ir ir = state.ir.compact(root);
        const TapeField field = test::tapeField(std::move(ir), root[0]);
        for (int i = 0; i < rounds(30); ++i)
            expectWithinBounds(field, {}, randomBox(random), 4, random, counts);
        if (HasFailure()) return;
    }
    EXPECT_GT(counts.bounded, counts.boxes / 2);
}

/// The mean value form is tighter than the plain interval where boxes are small.
TEST(IntervalGradient, MeanValueFormIsTight) {
    const TapeField field = test::tapeField("return twist(box(p, vec3(0.5, 1, 0.5)), 90);");
    IntervalGradientMachine machine;
    TapeMachine<double> plain;
    std::mt19937 random(33);
    double widths = 0.0, plainWidths = 0.0;
    for (int i = 0; i < 200; ++i) {
        Box box;
        for (std::size_t axis = 0; axis < 3; ++axis)
            box.lo[axis] = between(-1.0, 1.0, random), box.hi[axis] = box.lo[axis] + 0.02;
        const Interval form = machine.meanValue(field.tape, box), range = plain.interval(field.tape, box);
        EXPECT_GE(form.lo, range.lo);
        EXPECT_LE(form.hi, range.hi);
        widths += form.hi - form.lo, plainWidths += range.hi - range.lo;
    }
    EXPECT_LT(widths, 0.8 * plainWidths);
}

/// Measures; nothing is expected of the times.
TEST(IntervalGradient, Speed) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a measurement: with FIELDWRIGHT_LONG";
    std::vector<std::pair<std::string, TapeField>> fields;
    for (const char* code :
         {"return box(p, vec3(1, 0.5, 0.25), 0.05);", "return twist(box(p, vec3(0.5, 1, 0.5)), 90);"})
        fields.emplace_back(code, test::tapeField(code));
    for (const std::string name :
         {"csg_part", "tower", "threaded_jar", "watering_can", "breaker", "figure"}) {
        const Result<Graph> graph =
            readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json", nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph, {.bake = draftInPlace});
        ASSERT_TRUE(program) << format(program.error());
        fields.emplace_back(name, test::tapeField(program->ir, program->distance(), program->parameters()));
    }
    TapeMachine<double> plain;
    IntervalGradientMachine machine;
    for (const auto& [name, field] : fields)
        for (const double size : {1.0, 0.1}) {
            std::mt19937 random(4);
            std::vector<Box> boxes(500);
            for (Box& box : boxes)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    box.lo[axis] = between(-1.5, 1.5, random), box.hi[axis] = box.lo[axis] + size;
            const auto nanoseconds = [&](auto evaluate) {
                double best = kInfinity, sum = 0.0;
                for (int repetition = 0; repetition < 5; ++repetition) {
                    const auto start = std::chrono::steady_clock::now();
                    for (const Box& box : boxes) sum += evaluate(box);
                    const std::chrono::duration<double, std::nano> time =
                        std::chrono::steady_clock::now() - start;
                    best = std::min(best, time.count());
                }
                EXPECT_FALSE(std::isnan(sum));
                return best / double(boxes.size()) / double(field.tape.steps.size());
            };
            const double interval =
                nanoseconds([&](const Box& box) { return plain.interval(field.tape, box).lo; });
            const double gradient =
                nanoseconds([&](const Box& box) { return machine.evaluate(field.tape, box).value.lo; });
            const double form =
                nanoseconds([&](const Box& box) { return machine.meanValue(field.tape, box).lo; });
            std::printf(
                "%-50s %5zu steps, boxes of %g m: interval %.1f ns a step, gradient %.1f (%.1f times), mean "
                "value "
                "form %.1f\n",
                name.c_str(), field.tape.steps.size(), size, interval, gradient, gradient / interval, form);
        }
}

}  // namespace fw::interval_gradient_test
