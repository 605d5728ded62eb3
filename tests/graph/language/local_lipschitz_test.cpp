// Local Lipschitz constants: they hold, they are close to the known ones, and where a field may jump there is
// none.
#include "graph/evaluate/local_lipschitz.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "tests/support/graph/random_graph.h"
#include "tests/support/graph/tape_field.h"

namespace fw::local_lipschitz_test {

using test::pointWithin, test::secondPoint, test::valueAt, test::TapeField;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const Box kAroundOrigin{{-1.1, -1.3, -1.2}, {1.2, 1.1, 1.3}};

TEST(LocalLipschitz, IsOneForDistances) {
    for (const char* code :
         {"return length(p) - 1.0;", "return sphere(p, 1);", "return box(p, vec3(1, 0.5, 0.25), 0.05);",
          "return torus(p, 1, 0.25);", "return cylinder(p, 0.5, 1);", "return link(p);", "return capsule(p);",
          "return box_frame(p, vec3(0.8), 0.1);", "return union(sphere(p, 1), box(p, vec3(0.7)), 0.3);",
          "return p.x < 0 ? -p.x : p.x;", "return abs(mod(p.x, 0.5) - 0.25);",
          "return repeat(sphere(p, 0.2), vec3(0.0));"}) {
        SCOPED_TRACE(code);
        EXPECT_NEAR(lipschitzOver(test::tapeField(code).tape, kAroundOrigin, 257), 1.0, 1e-6);
    }
    // A reflection is continuous, but each of its coordinates has its own hull of both sides.
    const double folded = lipschitzOver(
        test::tapeField("vec2 q = p.xy; if (q.y * sin(0.5) < q.x * cos(0.5)) q = vec2(q.y * sin(1.0) - q.x "
                        "* cos(1.0), q.y * cos(1.0) + q.x * sin(1.0)); return length(q - 0.1);")
            .tape,
        kAroundOrigin, 257);
    EXPECT_LE(folded, 1.4143);
    const Tape length = test::tapeField("return length(p) - 1.0;").tape;
    const Box far{{-1e7, -1e7, -1e7}, {1e7, 1e7, 1e7}},
        endless{{-kHuge, -kHuge, -kHuge}, {kHuge, kHuge, kHuge}}, line{{-1, 0, 0}, {1, 0, 0}}, point{};
    for (const Box& box : {far, endless, line}) EXPECT_NEAR(lipschitzOver(length, box, 1), 1.0, 1e-6);
    EXPECT_LE(lipschitzOver(length, point, 1), 1.0 + 1e-6);
}

/// Jumps, and functions that are infinitely steep, have none.
TEST(LocalLipschitz, IsUnknownWhereAFieldMayJump) {
    for (const char* code :
         {"return floor(p.x);", "return p.x < 0.25 ? p.y : p.z;", "return mod(p.x, 0.7);",
          "return sqrt(abs(p.x));", "return atan2(p.y, p.x);", "return 1.0 / p.x;", "return sign(p.x) * p.y;",
          "return asin(p.x);", "return p.x < 0.25 ? 0.0 : p.x - 0.24;",
          "return floor(p.x) < 0.5 ? p.y : p.y + 1.0;", "return p.x == 0.25 ? 1.0 : 0.0;",
          "return p.x < 0.0 || p.y < 0.0 ? min(p.x, p.y) : p.x * 2.0;",
          "return floor(p.x) < 0.5 ? 0.0 : max(p.y * (floor(p.x) - 0.5), 0.0);", "return hash(p, 1);"}) {
        SCOPED_TRACE(code);
        EXPECT_EQ(lipschitzOver(test::tapeField(code).tape, kAroundOrigin, 257), kInfinity);
    }
    // Elsewhere they are as good as others.
    const Box beyond{{0.3, 0.1, 0.1}, {0.6, 0.4, 0.3}};
    EXPECT_EQ(lipschitzOver(test::tapeField("return floor(p.x);").tape, beyond, 1), 0.0);
    EXPECT_NEAR(lipschitzOver(test::tapeField("return mod(p.x, 0.7);").tape, beyond, 1), 1.0, 1e-6);
    EXPECT_NEAR(lipschitzOver(test::tapeField("return atan2(p.y, p.x);").tape, beyond, 257),
                1 / std::hypot(0.3, 0.1), 0.1);
}

/// Deformed solids: the constant is at least as large as sampled quotients and close to the analytic bound.
TEST(LocalLipschitz, OfDeformedSolids) {
    // A twist by r radians a metre shears by a = r d at the distance d from its axis; the norm of its
    // derivative is (a + sqrt(a² + 4)) / 2.
    const auto sheared = [](double a) { return 0.5 * (a + std::sqrt(a * a + 4.0)); };
    const double radians = 1.5707963267948966;
    struct Case {
        const char* code;
        Box box;
        double analytic;
    };
    const double side = 0.71, length = 0.91;
    const Case cases[] = {
        {"return twist(box(p, vec3(0.5, 1, 0.5)), 90);",
         {{-side, -1, -side}, {side, 1, side}},
         sheared(radians * std::hypot(side, side))},
        {"return twist(cylinder(p, 0.5, 1), 90);",
         {{-0.5, -1, -0.5}, {0.5, 1, 0.5}},
         sheared(radians * std::hypot(0.5, 0.5))},
        {"return bend(box(p, vec3(1, 0.2, 0.3)), 45);",
         {{-length, -0.21, -0.31}, {length, 0.21, 0.31}},
         sheared(0.5 * radians * std::hypot(length, 0.21))},
    };
    std::mt19937 random(31);
    for (const Case& known : cases) {
        SCOPED_TRACE(known.code);
        const TapeField field = test::tapeField(known.code);
        const double constant = lipschitzOver(field.tape, known.box, 1025);
        EXPECT_LE(constant, 1.3 * known.analytic);
        double steepest = 0.0;
        for (int i = 0; i < 20'000; ++i) {
            const Point p = pointWithin(known.box, random), q = secondPoint(p, known.box, random);
            const double apart = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
            if (apart < 1e-6) continue;
            const double quotient =
                std::abs(evaluate(field.ir, field.root, {}, p) - evaluate(field.ir, field.root, {}, q)) /
                apart;
            steepest = std::max(steepest, quotient);
        }
        EXPECT_LE(steepest, constant * (1.0 + 1e-9));
        EXPECT_GE(steepest, 0.5 * constant);
    }
}

TEST(LocalLipschitz, HoldsForRandomGraphs) {
    std::mt19937 random(32);
    int bounded = 0;
    for (uint32_t seed = 1; seed <= uint32_t((std::getenv("FIELDWRIGHT_LONG") ? 1200 : 60)); ++seed) {
        const std::optional<Program> program = test::randomProgram(seed, 8);
        if (!program) continue;
        SCOPED_TRACE(seed);
        const std::vector<double> parameters = program->parameters();
        const TapeField field = test::tapeField(program->ir, program->distance(), parameters);
        const double constant = lipschitzOver(field.tape, kAroundOrigin, 65);
        EXPECT_LE(constant, lipschitzOver(field.tape, kAroundOrigin, 1) * (1.0 + 1e-9));
        if (std::isinf(constant)) continue;
        ++bounded;
        for (int i = 0; i < 200; ++i) {
            const Point p = pointWithin(kAroundOrigin, random), q = secondPoint(p, kAroundOrigin, random);
            const test::Evaluated f = valueAt(field, parameters, p), g = valueAt(field, parameters, q);
            EXPECT_LE(std::abs(f.value - g.value),
                      constant * std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) * (1.0 + 1e-12) +
                          f.rounding + g.rounding);
        }
    }
    EXPECT_GT(bounded, 10);
}

/// Counts fields whose Lipschitz constant is unknown, as declared and within their regions.
TEST(LocalLipschitz, OfProgramsWithinTheirRegions) {
    struct Numbers {
        int all = 0, unknown = 0, proven = 0, notBounded = 0, provenAround = 0;
        double milliseconds = 0.0;
    };
    const auto count = [](const Program& program, const std::string& name, Numbers& numbers) {
        ++numbers.all;
        const bool unknown = std::isinf(program.exactness.lipschitz);
        numbers.unknown += unknown;
        if (program.exactness.bound()) {
            EXPECT_EQ(lipschitzWithin(program, kAroundOrigin), program.exactness.lipschitz);
            return;
        }
        const Region region = findRegion(program);
        const bool bounded = region.extent == Extent::bounded;
        numbers.notBounded += unknown && !bounded;
        const auto start = std::chrono::steady_clock::now();
        const double within = lipschitzWithin(program, bounded ? region.box : kAroundOrigin);
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        numbers.milliseconds += time.count();
        EXPECT_LE(within, program.exactness.lipschitz);
        (bounded ? numbers.proven : numbers.provenAround) += unknown && !std::isinf(within);
        if (std::getenv("FIELDWRIGHT_LONG"))
            std::printf("%s: declared %g, proven %g (%.1f ms, %zu operations)\n", name.c_str(),
                        program.exactness.lipschitz, within, time.count(), program.ir.size());
    };
    const auto print = [](const char* name, const Numbers& numbers) {
        std::printf(
            "%s: %d, of which %d have no declared constant. %d of these have a bounded region, and %d get "
            "a constant there; %d have none, and %d get a constant around the origin. %.1f ms in all\n",
            name, numbers.all, numbers.unknown, numbers.unknown - numbers.notBounded, numbers.proven,
            numbers.notBounded, numbers.provenAround, numbers.milliseconds);
    };
    Numbers graphs, samples;
    const uint32_t seeds = std::getenv("FIELDWRIGHT_LONG") ? 300 : 40;
    for (uint32_t seed = 1; seed <= seeds; ++seed)
        if (const std::optional<Program> program = test::randomProgram(seed, 8))
            count(*program, "random graph " + std::to_string(seed), graphs);
    print("random graphs", graphs);
    EXPECT_GT(graphs.proven, 0);
    if (!std::getenv("FIELDWRIGHT_LONG")) return;
    for (const auto& entry : std::filesystem::directory_iterator(FIELDWRIGHT_SOURCE_DIR "/samples")) {
        if (!entry.path().string().ends_with(".field.json")) continue;
        const Result<Graph> graph = readGraph(entry.path().string(), nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph, {.bake = draftInPlace});
        ASSERT_TRUE(program) << format(program.error());
        count(*program, entry.path().stem().stem().string(), samples);
    }
    print("samples", samples);
}

}  // namespace fw::local_lipschitz_test
