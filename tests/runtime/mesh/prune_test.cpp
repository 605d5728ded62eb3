// Pruned fields: lists of members, block by block and brick by brick, leave the mesh as it is, bit for bit.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <set>

#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/mesher/mesher.h"
#include "runtime/play/mesh_program.h"
#include "runtime/play/session.h"
#include "tests/support/device_field.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/expression_graph.h"
#include "tests/support/graph/random_graph.h"

namespace fw::prune_test {

struct Meshed {
    Mesh mesh;
    MesherResult result;
};

Meshed meshOf(const Program& program, const Box& box, int cells, MeshMethod method, bool pruned,
              bool sparse = true) {
    const test::FieldResources resources(program);
    MesherConfig config{.origin = {box.lo[0], box.lo[1], box.lo[2]},
                        .cellSize = glm::vec3(float((box.hi[0] - box.lo[0]) / cells)),
                        .cells = glm::ivec3(cells),
                        .field = resources.buffers(),
                        .families = &program.families,
                        .sparse = sparse,
                        .pruned = pruned,
                        .method = method};
    MesherPipelines pipelines = createMesherPipelines(test::device(), emitField(program));
    MesherBuffers buffers;
    Result<MesherResult> result = runMesher(test::device(), pipelines, buffers, config);
    if (!result) throw SystemError(format(result.error()));
    return {downloadMesh(test::device(), buffers, *result), *result};
}

Program programOf(const std::string& code) {
    Result<Program> program = compile(test::expressionGraph(code));
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

bool sameBytes(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec3)) == 0;
}

void expectSame(const Meshed& a, const Meshed& b) {
    EXPECT_EQ(a.mesh.indices, b.mesh.indices);
    EXPECT_TRUE(sameBytes(a.mesh.positions, b.mesh.positions));
    EXPECT_TRUE(sameBytes(a.mesh.normals, b.mesh.normals));
}

/// Sampled in the bricks that intervals leave, and in all.
void expectSparseIsDense(const Program& program, const Box& box, int cells, MeshMethod method) {
    expectSame(meshOf(program, box, cells, method, true), meshOf(program, box, cells, method, true, false));
}

/// Closed, and the same bytes whether pruned or not.
void expectPruningChangesNothing(const Program& program, const Box& box, int cells, MeshMethod method) {
    const Meshed pruned = meshOf(program, box, cells, method, true),
                 all = meshOf(program, box, cells, method, false);
    expectSame(pruned, all);
    const Report report = reportOnMesh(pruned.mesh.positions, pruned.mesh.indices);
    EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges + report.flippedEdges, 0u);
}

/// The straight code has the same surface; numbers may differ in their last bits.
void expectStraightCodeAgrees(const Program& program, const Box& box, int cells) {
    const Meshed pruned = meshOf(program, box, cells, MeshMethod::marchingCubes, true);
    Program straight = program;
    straight.families = {};
    const Meshed expected = meshOf(straight, box, cells, MeshMethod::marchingCubes, false);
    EXPECT_NEAR(double(pruned.mesh.positions.size()), double(expected.mesh.positions.size()),
                2 + 1e-3 * double(expected.mesh.positions.size()));
    if (pruned.mesh.indices != expected.mesh.indices) return;  // a sample fell on the other side of zero
    const float cell = float((box.hi[0] - box.lo[0]) / cells);
    float off = 0;
    for (std::size_t i = 0; i < expected.mesh.positions.size(); ++i)
        off = std::max(off, glm::distance(pruned.mesh.positions[i], expected.mesh.positions[i]));
    EXPECT_LT(off, 0.02f * cell);
}

const Box kBox{{-1.07, -1.06, -1.05}, {1.08, 1.09, 1.1}};

constexpr int kFewForTheDriver = 100;  // members written out: of three hundred a shader takes long to build

TEST(Prune, ThreeHundredScatteredBoxes) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const auto boxes = [](int count) {
        return programOf(
            "d = 1000.0; for (int i = 0; i < " + std::to_string(count) +
            "; i++) { c = vec3(hash(vec3(i, 1, 0), 1), hash(vec3(i, 2, 0), 1), hash(vec3(i, 3, 0), "
            "1)) * 2 - 1; d = min(d, box(p - c, vec3(0.05, 0.04, 0.06), 0.01).distance); } return d;");
    };
    const Program program = boxes(300);
    ASSERT_EQ(program.families.all.size(), 1u);
    for (int cells : {20, 100})  // one block; several, not a multiple of a brick
        for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring}) {
            SCOPED_TRACE(std::to_string(cells) + " cells, method " + std::to_string(int(method)));
            expectPruningChangesNothing(program, kBox, cells, method);
        }
    expectStraightCodeAgrees(boxes(kFewForTheDriver), kBox, 100);
}

TEST(Prune, BlocksAreListedOnLongGrids) {
    const Program program = programOf(
        "d = 1000.0; for (int i = 0; i < 40; i++) { c = vec3(hash(vec3(i, 1, 0), 1), hash(vec3(i, 2, 0), 1), "
        "hash(vec3(i, 3, 0), 1)) * 2 - 1; d = min(d, sphere(p - c, 0.02 + 0.0007 * i).distance + 0.001 * "
        "sin(i) * p.x); "
        "} return d;");
    ASSERT_FALSE(program.families.empty());
    expectPruningChangesNothing(program, kBox, 530, MeshMethod::marchingCubes);
}

TEST(Prune, ThreeHundredBallsBlendedIntoTheGround) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const std::string ball =
        "c = vec3(hash(vec3(i, 1, 0), 1), 0.5 * hash(vec3(i, 2, 0), 1), hash(vec3(i, 3, 0), 1)) * 2 - 1; ";
    for (const char* first : {"d = p.y + 0.8; ", "d = length(p) - 0.3; ", "d = 0.02 * p.x + 1000.0; "}) {
        SCOPED_TRACE(first);
        if (first[4] == 'l' && !std::getenv("FIELDWRIGHT_LONG")) continue;
        const auto balls = [&](int count) {
            return programOf(first + ("for (int i = 0; i < " + std::to_string(count)) + "; i++) { " + ball +
                             "d = smooth_min(d, length(p - c) - 0.07, 0.05); } return d;");
        };
        const Program program = balls(300);
        ASSERT_EQ(program.families.all.size(), 1u);
        ASSERT_TRUE(program.families.groups.begin()->second.chain());
        for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring})
            expectPruningChangesNothing(program, kBox, 60, method);
        if (first[4] == 'p') expectStraightCodeAgrees(balls(kFewForTheDriver), kBox, 60);
    }
}

/// Shapes of several kinds, unions and holes, sharp and blended, under a turn, a shell or a displacement.
std::string randomCode(uint32_t seed) {
    std::mt19937 random(seed);
    const auto number = [&](double lo, double hi) {
        return std::to_string(lo + (hi - lo) * double(random() >> 8) / double(1 << 24));
    };
    const auto one = [&](std::initializer_list<const char*> of) {
        return std::string(of.begin()[random() % of.size()]);
    };
    std::string code = one({"", "p = vec3(0.8 * p.x + 0.6 * p.z, p.y, 0.8 * p.z - 0.6 * p.x); ",
                            "p.xz = p.zx * 1.1; ", "p = abs(p) - 0.2; "});
    code += "d = " + one({"1000.0", "torus(p, 0.7, 0.1).distance", "box(p, vec3(0.5)).distance"}) + ";";
    for (int group = 0; group < 1 + int(random() % 3); ++group) {
        const std::string k = std::to_string(random() % 97);
        const std::string shape =
            one({"box(p - c, vec3(0.05, 0.03, 0.08) * (0.5 + c.x * c.x), 0.01).distance",
                 "sphere(p - c, 0.06 + 0.03 * c.y).distance * 0.9 + 0.01 * p.x * c.z",
                 "torus(p - c, 0.08 + 0.02 * c.z, 0.03).distance",
                 "box_max(p - c, vec3(0.06, 0.04 + 0.01 * c.x, 0.05)).distance",
                 "max(sphere(p - c, 0.1).distance, p.y * c.x - 0.05)"});
        const std::string put =
            one({"d = min(d, e);", "d = max(d, -e);", "d = max(-e, d);", "d = smooth_min(d, e, 0.06);",
                 "d = smooth_min(e, d, 0.02 + 0.03 * c.x * c.x);", "d = smooth_max(d, -e, 0.05);"});
        code += "for (int i = 0; i < " + std::to_string(16 + random() % 40) +
                "; i++) { c = vec3(hash(vec3(i, 1, " + k + "), 1), hash(vec3(i, 2, " + k +
                "), 1), hash(vec3(i, 3, " + k + "), 1)) * 2 - 1; e = " + shape + "; " + put + "} ";
    }
    code += one({"", "", "d = abs(d) - 0.015; ", "d = d + 0.01 * sin(p.x * 9); ", "d = max(d, p.y - "});
    if (code.ends_with("p.y - ")) code += number(-0.3, 0.6) + "); ";
    return code + "return d;";
}

TEST(Prune, RandomGraphsWithFamilies) {
    const uint32_t most = std::getenv("FIELDWRIGHT_LONG") ? 150 : 4;
    int pruned = 0;
    for (uint32_t seed = 1; seed <= most; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Program program = programOf(randomCode(seed));
        if (program.families.empty()) continue;
        expectPruningChangesNothing(program, kBox, 40 + int(seed % 40), MeshMethod(seed % 2));
        if (seed % 6 == 0) expectStraightCodeAgrees(program, kBox, 50);
        ++pruned;
        if (::testing::Test::HasFailure()) break;
    }
    EXPECT_GE(pruned, int(most) / 3);
}

/// Value, rows, interval and gradient of the loops over all members are those of the operations one by one.
TEST(Prune, LoopsGiveTheValuesOfTheReference) {
    for (uint32_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Program program = programOf(randomCode(seed));
        std::vector<std::array<float, 3>> points;
        std::vector<Point> same;
        std::mt19937 random(seed);
        for (int i = 0; i < 500; ++i) {
            std::array<float, 3> point;
            for (float& x : point) x = -1.2f + 2.4f * float(random() >> 8) / float(1 << 24);
            points.push_back(point);
            same.push_back({point[0], point[1], point[2]});
        }
        const std::vector<test::FieldSample> found = test::evaluateOnDevice(program, points, 0.05f);
        std::vector<double> values(points.size());
        evaluate(program.ir, program.distance(), {}, same, values);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(found[i].value, values[i], 2e-5);
            EXPECT_NEAR(found[i].rowValue, values[i], 2e-5);
            EXPECT_NEAR(found[i].gradient[3], values[i], 2e-5);
            EXPECT_LE(found[i].interval[0], values[i] + 1e-5);
            EXPECT_GE(found[i].interval[1], values[i] - 1e-5);
        }
    }
}

std::string scattered(const std::string& shape, const std::string& settings) {
    return R"({"fieldwright": 1, "nodes": [)" + shape +
           R"(, {"id": "many", "type": "scatter", "inputs": {"surface": )" + R"({"from": "shape"}, )" +
           settings + R"(}}, {"id": "out", "type": "output", "inputs": {"surface": )" +
           R"({"from": "many"}}}]})";
}

Program programOfText(const std::string& text) {
    const Result<Graph> graph = parseGraph(text, "scatter", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

const Box kTenCells{{-5.03, -5.03, -5.03}, {5.03, 5.03, 5.03}};

TEST(Scatter, CopiesAreWholeWhereverTheyStand) {
    const std::string ball = R"({"id": "shape", "type": "sphere", "inputs": {"radius": 0.23}})";
    // One layer of cells of 2 m: 25 balls lie within, none at the sides, since the region ends in the middle
    // of cells.
    const Program program =
        programOfText(scattered(ball, R"("period": [2.012, 0, 2.012], "jitter": 0.4, "size_variation": 0)"));
    const Meshed many = meshOf(program, kTenCells, 200, MeshMethod::marchingCubes, true);
    const Report report = reportOnMesh(many.mesh.positions, many.mesh.indices);
    EXPECT_EQ(report.shells, 25u);
    const double whole = 4.0 / 3.0 * 3.14159265 * 0.23 * 0.23 * 0.23;
    EXPECT_NEAR(report.volume, 25 * whole, 0.03 * 25 * whole);
    EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges, 0u);
    EXPECT_FALSE(many.result.capped);
}

TEST(Scatter, ChanceLeavesCopiesOutAndSeedsDiffer) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    const std::string ball = R"({"id": "shape", "type": "sphere", "inputs": {"radius": 0.3}})";
    const auto parts = [&](const std::string& settings) {
        const Meshed many = meshOf(
            programOfText(scattered(ball, R"("period": [1.006, 1.006, 1.006], "jitter": 0.2, )" + settings)),
            kTenCells, 80, MeshMethod::marchingCubes, true);
        return std::pair(reportOnMesh(many.mesh.positions, many.mesh.indices).shells, many.mesh.positions);
    };
    const auto [all, positions] = parts(R"("chance": 1)");
    const auto [half, some] = parts(R"("chance": 0.5)");
    const auto [other, others] = parts(R"("chance": 0.5, "seed": 7)");
    EXPECT_NEAR(double(half), 0.5 * double(all), 0.08 * double(all));
    EXPECT_NEAR(double(other), 0.5 * double(all), 0.08 * double(all));
    EXPECT_NE(some.size(), others.size());
    EXPECT_EQ(parts(R"("chance": 0)").first, 0u);
}

TEST(Scatter, IsPrunedWithoutAChange) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const std::string box =
        R"({"id": "shape", "type": "box", "inputs": {"half_extents": [0.3, 0.2, 0.4], "rounding": 0.05}})";
    for (const char* settings :
         {R"("period": [1.2, 1.3, 1.4])", R"("period": [1.2, 0, 1.4], "chance": 0.6)"}) {
        const Program program = programOfText(scattered(box, settings));
        ASSERT_FALSE(program.families.empty());
        for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring})
            expectPruningChangesNothing(program, kTenCells, 110, method);
    }
}

/// Every twelfth without FIELDWRIGHT_LONG.
TEST(Prune, EverySample) {
    std::set<std::filesystem::path> samples;
    for (const auto& entry : std::filesystem::directory_iterator(FIELDWRIGHT_SOURCE_DIR "/samples"))
        if (entry.path().string().ends_with(".field.json")) samples.insert(entry.path());
    int number = 0;
    for (const std::filesystem::path& sample : samples) {
        if (number++ % 12 != 0 && !std::getenv("FIELDWRIGHT_LONG")) continue;
        SCOPED_TRACE(sample.filename().string());
        const Result<Graph> graph = readGraph(sample, nullptr);
        ASSERT_TRUE(graph);
        const Result<Program> program = compileAtTime(*graph, 0.2, {}, [] { return &test::device(); });
        ASSERT_TRUE(program) << format(program.error());
        const Result<Box> box = meshRegion(*program, {std::nullopt, 48});
        ASSERT_TRUE(box);
        for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring}) {
            if (!program->families.empty()) expectPruningChangesNothing(*program, *box, 48, method);
            expectSparseIsDense(*program, *box, 48, method);
        }
    }
}

TEST(Prune, RandomGraphsSparseAndDense) {
    const uint32_t most = std::getenv("FIELDWRIGHT_LONG") ? 150 : 5;
    uint32_t meshed = 0, sparser = 0;
    for (uint32_t seed = 1; meshed < most; ++seed) {
        ASSERT_LT(seed, 20 * most);
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::optional<Program> program = test::randomProgram(seed, 30);
        if (!program || !program->ir.images().empty()) continue;
        const Box box{{-2.03, -1.98, -2.01}, {1.97, 2.02, 1.99}};
        const MeshMethod method = MeshMethod(seed % 2);
        const Meshed sparse = meshOf(*program, box, 40, method, true),
                     dense = meshOf(*program, box, 40, method, true, false);
        if (dense.result.triangles == 0) continue;
        expectSame(sparse, dense);
        ++meshed, sparser += sparse.result.bricks < dense.result.bricks;
        if (::testing::Test::HasFailure()) break;
    }
    EXPECT_GT(sparser, most / 2);
}

}  // namespace fw::prune_test
