// The baseline and the talk's stages draw one and the same closed mesh.
#include "tests/bench/talk_stages.h"

#include <gtest/gtest.h>

#include <random>

#include "graph/compile.h"
#include "graph/json.h"
#include "tests/bench/baseline.h"
#include "tests/bench/verify.h"
#include "tests/support/gpu.h"

namespace fw::bench {
namespace {

using fw::test::device;

constexpr int kCells = 64;

TEST(Baseline, MeshesAreClosedAndTheSameOnEveryRun) {
    Baseline baseline(kCells);
    for (Field field : kFields) {
        baseline.run(field);
        EXPECT_EQ(faultOf(baseline.indices(), baseline.positions().size()), "") << fieldName(field);
        const std::vector<glm::vec3> positions(baseline.positions().begin(), baseline.positions().end());
        const std::vector<uint32_t> indices(baseline.indices().begin(), baseline.indices().end());
        baseline.run(field);
        EXPECT_TRUE(std::equal(positions.begin(), positions.end(), baseline.positions().begin(),
                               baseline.positions().end()));
        EXPECT_TRUE(
            std::equal(indices.begin(), indices.end(), baseline.indices().begin(), baseline.indices().end()));
    }
}

TEST(BenchFields, GraphsSayTheSameAsTheCode) {
    std::mt19937 random(7);
    for (Field field : kFields) {
        SCOPED_TRACE(fieldName(field));
        std::vector<Error> warnings;
        const Result<Graph> graph = readGraph(benchGraph(field), &warnings);
        ASSERT_TRUE(graph) << format(graph.error());
        EXPECT_TRUE(warnings.empty());
        const Result<Program> program = compile(*graph);
        ASSERT_TRUE(program) << format(program.error());
        std::uniform_real_distribution<float> anywhere(-regionHalf(field), regionHalf(field));
        for (int i = 0; i < 20'000; i++) {
            const float x = anywhere(random), y = anywhere(random), z = anywhere(random);
            const double value = evaluate(program->ir, program->distance(), program->parameters(), {x, y, z});
            ASSERT_NEAR(value, fieldAt(field, {x, y, z}), 2e-6) << x << " " << y << " " << z;
        }
    }
}

TEST(Verify, FindsFaults) {
    const std::vector<uint32_t> tetrahedron = {0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
    EXPECT_EQ(faultOf(tetrahedron, 4), "");
    EXPECT_NE(faultOf(tetrahedron, 5), "") << "an unused vertex";
    EXPECT_NE(faultOf(tetrahedron, 3), "") << "an index too high";
    std::vector<uint32_t> open(tetrahedron.begin(), tetrahedron.end() - 3);
    EXPECT_NE(faultOf(open, 4), "") << "a triangle is missing";
    std::vector<uint32_t> flipped = tetrahedron;
    std::swap(flipped[0], flipped[1]);
    EXPECT_NE(faultOf(flipped, 4), "") << "a triangle is flipped";
    std::vector<uint32_t> twice = tetrahedron;
    twice.insert(twice.end(), tetrahedron.begin(), tetrahedron.end());
    EXPECT_NE(faultOf(twice, 4), "") << "four triangles share an edge";
}

TEST(TalkStages, EveryWayDrawsTheBaselinesTriangles) {
    if (!device().geometryShader) GTEST_SKIP() << "the device has no geometry shaders";
    Baseline baseline(kCells);
    baseline.run(Field::tower);
    const GridEdges grid{.origin = glm::vec3(-2.5f), .spacing = 5.0f / kCells};
    const auto expected = trianglesByEdge(baseline.positions(), baseline.indices(), grid);
    ASSERT_GT(expected.size(), 10'000u);

    const TalkStages stages = createTalkStages(device(), {.cells = kCells, .half = 2.5f, .imageSize = 256});
    for (TalkWay way : kTalkWays) {
        SCOPED_TRACE(int(way));
        const Mesh mesh = captureMesh(stages, way);
        EXPECT_EQ(trianglesByEdge(mesh.positions, mesh.indices, grid), expected);
        if (way != TalkWay::indexed) continue;
        EXPECT_EQ(mesh.positions.size(), baseline.positions().size());
        EXPECT_EQ(faultOf(mesh.indices, mesh.positions.size()), "");
    }
}

TEST(TalkStages, EveryWayLeavesTheSameDepths) {
    if (!device().geometryShader) GTEST_SKIP() << "the device has no geometry shaders";
    const TalkStages stages = createTalkStages(device(), {.cells = kCells, .half = 2.5f, .imageSize = 256});
    std::vector<float> first;
    for (TalkWay way : kTalkWays) {
        Commands commands(device());
        recordGeneration(commands, stages, way);
        recordPass(commands, stages, way);
        submit(commands);
        const std::vector<float> depth = readDepth(stages);
        if (first.empty()) first = depth;
        const auto covered = std::count_if(depth.begin(), depth.end(), [](float d) { return d > 0; });
        EXPECT_GT(covered, 256 * 256 / 20);
        EXPECT_LT(covered, 256 * 256 / 2);
        int differing = 0;
        for (std::size_t i = 0; i < depth.size(); i++) differing += std::abs(depth[i] - first[i]) > 1e-5f;
        EXPECT_EQ(differing, 0) << "way " << int(way);
    }
}

}  // namespace
}  // namespace fw::bench
