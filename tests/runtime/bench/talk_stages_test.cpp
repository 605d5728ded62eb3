// The baseline, the mesher and the talk's stages make one and the same closed mesh; the benchmark's own parts
// work.
#include "tests/bench/talk_stages.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "runtime/mesher/mesher.h"
#include "tests/bench/baseline.h"
#include "tests/bench/bench.h"
#include "tests/bench/table.h"
#include "tests/bench/tuned.h"
#include "tests/bench/verify.h"
#include "tests/support/gpu.h"

namespace fw::bench::talk_stages_test {

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

TEST(Tuned, HasTheBaselinesMeshWithItsVerticesInAnotherOrder) {
    for (int cells : {33, kCells}) {  // of an odd number one thread has a layer more
        Baseline baseline(cells);
        Tuned tuned(cells);
        for (Field field : kFields) {
            baseline.run(field);
            tuned.run(field);
            EXPECT_EQ(faultOf(tuned.indices(), tuned.positions().size()), "") << fieldName(field);
            EXPECT_EQ(tuned.positions().size(), baseline.positions().size()) << fieldName(field);
            EXPECT_EQ(tuned.indices().size(), baseline.indices().size()) << fieldName(field);
            const auto area = [](std::span<const glm::vec3> p, std::span<const uint32_t> t) {
                double sum = 0;
                for (std::size_t i = 0; i < t.size(); i += 3)
                    sum += glm::length(
                        glm::cross(glm::dvec3(p[t[i + 1]] - p[t[i]]), glm::dvec3(p[t[i + 2]] - p[t[i]])));
                return sum / 2;
            };
            const double expected = area(baseline.positions(), baseline.indices());
            EXPECT_NEAR(area(tuned.positions(), tuned.indices()), expected, 1e-5 * expected)
                << fieldName(field);
        }
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

TEST(Baseline, HasTheMeshersTriangles) {
    Baseline baseline(kCells);
    for (Field field : kFields) {
        SCOPED_TRACE(fieldName(field));
        const Result<Graph> graph = readGraph(benchGraph(field), nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph);
        ASSERT_TRUE(program) << format(program.error());
        const float half = regionHalf(field);
        const GridEdges grid{.origin = glm::vec3(-half), .spacing = 2 * half / kCells};
        MesherBuffers buffers;
        MesherPipelines pipelines = createMesherPipelines(device(), emitField(*program));
        MesherConfig config;
        config.origin = grid.origin;
        config.cellSize = glm::vec3(grid.spacing);
        config.cells = glm::ivec3(kCells);
        const Result<MesherResult> result = runMesher(device(), pipelines, buffers, config);
        ASSERT_TRUE(result) << format(result.error());
        const Mesh mesh = downloadMesh(device(), buffers, *result);
        baseline.run(field);
        EXPECT_EQ(mesh.positions.size(), baseline.positions().size());
        EXPECT_EQ(faultOf(mesh.indices, mesh.positions.size()), "");
        EXPECT_EQ(trianglesByEdge(mesh.positions, mesh.indices, grid),
                  trianglesByEdge(baseline.positions(), baseline.indices(), grid));
    }
}

TEST(TalkStages, EveryWayDrawsTheBaselinesTriangles) {
    if (!device().has.geometryShader) GTEST_SKIP() << "the device has no geometry shaders";
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
    if (!device().has.geometryShader) GTEST_SKIP() << "the device has no geometry shaders";
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

TEST(Bench, FiguresReadWell) {
    EXPECT_EQ(number(0), "0");
    EXPECT_EQ(number(0.01234), "0.0123");
    EXPECT_EQ(number(1.6), "1.60");
    EXPECT_EQ(number(-12.34), "-12.3");
    EXPECT_EQ(number(123456), "123456");
    EXPECT_EQ(count(0), "0");
    EXPECT_EQ(count(999), "999");
    EXPECT_EQ(count(1234567), "1 234 567");
    int calls = 0;
    const Figure figure = measure(3, [&] { return double(10 - ++calls); });
    EXPECT_EQ(calls, 5) << "two to warm up, three that count";
    EXPECT_EQ(figure.least(), 5);
    EXPECT_EQ(figure.median(), 6);
    EXPECT_EQ(figure.greatest(), 7);
}

TEST(Bench, PrintsTablesForTerminalAndPage) {
    const Table table{
        .title = "T", .header = {"a", "µs"}, .rows = {{"row", "1"}, {"r", "22"}}, .notes = {"Note."}};
    testing::internal::CaptureStdout();
    print(table, false);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "T\na    µs\nrow   1\nr    22\n  Note.\n\n");
    testing::internal::CaptureStdout();
    print(table, true);
    EXPECT_EQ(testing::internal::GetCapturedStdout(),
              "### T\n\n| a | µs |\n| --- | ---: |\n| row | 1 |\n| r | 22 |\n\n* Note.\n\n");
}

TEST(Bench, RunsByName) {
    const std::vector<std::string> unknown = {"peaks", "nonsense"}, known = {"peaks"};
    testing::internal::CaptureStderr();
    EXPECT_EQ(runBench(unknown), 2);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("'nonsense'"), std::string::npos);
    testing::internal::CaptureStdout();
    BenchOptions once;
    once.repeats = 1;
    EXPECT_EQ(runBench(known, once), 0);
    EXPECT_NE(testing::internal::GetCapturedStdout().find("an empty dispatch"), std::string::npos);
}

}  // namespace fw::bench::talk_stages_test
