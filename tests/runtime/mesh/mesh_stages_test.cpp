// Smoothing, subdivision and normals on the device: the formula, topology, distance, colours, limits; and
// that sessions, pictures and players show what they did.
#include "runtime/stages/mesh_stages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/mesher/host.h"
#include "runtime/play/player.h"
#include "runtime/play/session.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/expression_graph.h"
#include "tests/support/graph/random_graph.h"
#include "tests/support/meshes.h"

namespace fw::mesh_stages_test {

using Kind = MeshStage::Kind;

MeshStage smooth(int iterations) { return {.kind = Kind::smooth, .times = iterations}; }
MeshStage subdivide(int levels, bool project = true) {
    return {.kind = Kind::subdivide, .times = levels, .project = project};
}

/// A mesh of the host's, changed on the device in a region that holds it.
Mesh changed(const Mesh& mesh, const std::vector<MeshStage>& stages, MesherResult* told = nullptr) {
    MesherBuffers buffers;
    MeshStageBuffers stageBuffers;
    MesherResult result;
    buffers.counts = createBuffer(test::device(), sizeof(gpu::MesherCounts));
    uploadMesh(test::device(), buffers, mesh, result);
    const MeshStagePipelines pipelines = createMeshStagePipelines(test::device());
    MeshStageConfig config{
        .pipelines = &pipelines, .lo = glm::vec3(-2), .hi = glm::vec3(2), .cellSize = 0.05f};
    const Done ran = runMeshStages(test::device(), stageBuffers, buffers, result, stages, config);
    if (!ran) throw SystemError(format(ran.error()));
    if (told) *told = result;
    return downloadMesh(test::device(), buffers, result);
}

/// A torus that is uneven, and painted in a linear function of the position.
Mesh unevenTorus() {
    Mesh mesh = test::torus(37, 23);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const auto at = float(v);
        mesh.positions[v] += 0.03f * glm::vec3(std::sin(at), std::sin(2.3f * at), std::cos(1.7f * at));
    }
    for (const glm::vec3& p : mesh.positions) mesh.colors.push_back(0.5f + 0.25f * p);
    return mesh;
}

std::vector<glm::vec3> smoothedOnTheHost(const Mesh& mesh, int iterations) {
    std::vector<std::set<uint32_t>> neighbours(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            neighbours[mesh.indices[i + k]].insert(mesh.indices[i + (k + 1) % 3]);
            neighbours[mesh.indices[i + k]].insert(mesh.indices[i + (k + 2) % 3]);
        }
    std::vector<glm::dvec3> at(mesh.positions.begin(), mesh.positions.end());
    for (int i = 0; i < iterations; ++i) {
        const std::vector<glm::dvec3> from = at;
        for (std::size_t v = 0; v < at.size(); ++v) {
            glm::dvec3 sum = 4.0 * from[v];
            for (const uint32_t other : neighbours[v]) sum += from[other];
            at[v] = sum / double(4 + neighbours[v].size());
        }
    }
    return {at.begin(), at.end()};
}

struct Counts {
    uint64_t triangles, shells;
    int64_t euler;
    bool operator==(const Counts&) const = default;
};
Counts countsOf(const Report& report) {
    return {report.triangles, report.shells, report.eulerCharacteristic};
}

void expectClosedManifold(const Report& report) {
    EXPECT_EQ(report.boundaryEdges, 0u);
    EXPECT_EQ(report.nonManifoldEdges, 0u);
    EXPECT_EQ(report.nonManifoldVertices, 0u);
    EXPECT_EQ(report.flippedEdges, 0u);
}

Report reportOf(const Mesh& mesh) { return reportOnMesh(mesh.positions, mesh.indices); }

Graph graphOf(const std::string& nodes, const std::string& more = "") {
    Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]" + more + "}", "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    return std::move(*graph);
}

Program programOf(const Graph& graph) {
    Result<Program> program = compile(graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

Program sample(const std::string& name) {
    const Result<Graph> graph = readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/" + name + ".field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    return programOf(*graph);
}

const std::string kBall = R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.8}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})";

/// A session on a device of its own, under the validation layer.
struct Checked {
    FieldBy by = FieldBy::sooner;
    Session session{[] {
                        Result<Device> device = createDevice({.validation = true});
                        if (!device) throw SystemError(format(device.error()));
                        return std::move(*device);
                    }(),
                    by};
    ~Checked() { EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>()); }

    MesherResult run(Program program, std::vector<MeshStage> stages, const MeshRequest& request) {
        program.stages = std::move(stages);
        session.setProgram(std::move(program));
        Result<MesherResult> result = session.polygonise(request);
        if (!result) throw SystemError(format(result.error()));
        return std::move(*result);
    }
    Mesh mesh(Program program, std::vector<MeshStage> stages, const MeshRequest& request) {
        return session.download(run(std::move(program), std::move(stages), request));
    }
};

TEST(MeshStages, SmoothingIsTheFormula) {
    const Mesh mesh = unevenTorus();
    for (const int iterations : {1, 2, 10}) {
        const Mesh smoothed = changed(mesh, {smooth(iterations)});
        const std::vector<glm::vec3> expected = smoothedOnTheHost(mesh, iterations);
        ASSERT_EQ(smoothed.positions.size(), expected.size());
        for (std::size_t v = 0; v < expected.size(); ++v)
            ASSERT_LT(glm::distance(smoothed.positions[v], expected[v]), 1e-5f) << v;
        EXPECT_EQ(smoothed.indices, mesh.indices);
        EXPECT_EQ(smoothed.colors, mesh.colors);
    }
}

TEST(MeshStages, SmoothingSparesDrops) {
    // Twenty drops, each two cells in radius, wherever they are.
    const Graph graph = graphOf(R"({"id": "drops", "type": "expression", "code":
        "vec3 i = clamp(round(p / 0.37), vec3(-2, -0, -1), vec3(2, 1, 0));\nreturn length(p - 0.37 * i - 0.02 * sin(7 * i + vec3(1, 2, 3))) - 0.05;"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "drops"}}})");
    const Program program = programOf(graph);
    const MeshRequest request{.region = Box{{-0.9, -0.2, -0.5}, {0.9, 0.5, 0.2}}, .resolution = 72};
    Checked checked;
    const double whole = reportOf(checked.mesh(program, {}, request)).volume;
    const auto volumeOf = [&](double spare) {
        const Report report =
            reportOf(checked.mesh(program, {{.kind = Kind::smooth, .times = 25, .spare = spare}}, request));
        EXPECT_EQ(report.shells, 20u);
        expectClosedManifold(report);
        return report.volume;
    };
    std::printf("drops smoothed: %.3f of their volume is left, spared: %.4f\n", volumeOf(0.0) / whole,
                volumeOf(0.075) / whole);
    EXPECT_LT(volumeOf(0.0), 0.9 * whole);
    EXPECT_NEAR(volumeOf(0.075), whole, 0.02 * whole);
}

/// A slab with bumps of about the size of a drop, above and below.
const std::string kBumpy = R"({"id": "slab", "type": "expression", "code":
    "float bump = 0.012 * sin(63 * p.x) * sin(57 * p.z);\nreturn max(abs(p.y - bump) - 0.2, max(abs(p.x), abs(p.z)) - 0.8);"},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "slab"}}})";

TEST(MeshStages, SparingSmoothsBumpsOfAPlane) {
    const Program program = programOf(graphOf(kBumpy));
    const MeshRequest request{.region = Box{{-0.9, -0.3, -0.9}, {0.9, 0.3, 0.9}}, .resolution = 72};
    Checked checked;
    const auto bumps = [&](const std::vector<MeshStage>& stages) {
        double worst = 0.0;
        for (const glm::vec3& p : checked.mesh(program, stages, request).positions)
            if (std::max(std::abs(p.x), std::abs(p.z)) < 0.6f)
                worst = std::max(worst, std::abs(std::abs(double(p.y)) - 0.2));
        return worst;
    };
    const double rough = bumps({}), all = bumps({smooth(25)}),
                 spared = bumps({{.kind = Kind::smooth, .times = 25, .spare = 0.075}});
    std::printf("bumps of %.4f m: %.5f smoothed, %.5f with drops spared\n", rough, all, spared);
    EXPECT_GT(rough, 0.009);
    EXPECT_LT(spared, 0.1 * rough);
}

TEST(MeshStages, NoVertexGetsFartherThanItMay) {
    const Mesh mesh = unevenTorus();
    for (const double within : {0.001, 0.01}) {
        const Mesh kept = changed(mesh, {{.kind = Kind::smooth, .times = 25, .within = within}});
        double worst = 0.0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            worst = std::max(worst, double(glm::distance(kept.positions[v], mesh.positions[v])));
        EXPECT_LE(worst, 1.001 * within);
        EXPECT_GT(worst, 0.99 * within) << "it would go farther";
    }
    // Where it would not, it does as without.
    const Mesh free = changed(mesh, {smooth(5)}),
               far = changed(mesh, {{.kind = Kind::smooth, .times = 5, .within = 10.0}});
    EXPECT_EQ(free.positions, far.positions);
}

TEST(MeshStages, NoIterationsAndNoLevelsChangeNothing) {
    const Mesh mesh = unevenTorus();
    const Mesh same = changed(mesh, {smooth(0), subdivide(0)});
    EXPECT_EQ(same.positions, mesh.positions);
    EXPECT_EQ(same.indices, mesh.indices);
    for (std::size_t v = 0; v < mesh.normals.size(); ++v)
        ASSERT_LT(glm::distance(same.normals[v], mesh.normals[v]), 1e-3f);
}

TEST(MeshStages, SubdivisionPutsAVertexOnEachEdgeAndCarriesColours) {
    const Mesh mesh = unevenTorus();
    MesherResult result;
    const Mesh split = changed(mesh, {subdivide(1, false)}, &result);
    ASSERT_EQ(split.indices.size(), 4 * mesh.indices.size());
    ASSERT_EQ(split.positions.size(), mesh.positions.size() + mesh.indices.size() / 2);
    EXPECT_EQ(result.vertices, split.positions.size());
    EXPECT_EQ(countsOf(reportOf(split)), (Counts{4 * mesh.triangleCount(), 1, 0}));
    EXPECT_NEAR(reportOf(split).area, reportOf(mesh).area, 1e-4);
    EXPECT_NEAR(reportOf(split).volume, reportOf(mesh).volume, 1e-5);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) EXPECT_EQ(split.positions[v], mesh.positions[v]);
    for (std::size_t v = 0; v < split.positions.size(); ++v)
        ASSERT_LT(glm::distance(split.colors[v], 0.5f + 0.25f * split.positions[v]), 1e-5f) << v;
}

TEST(MeshStages, EachRunGivesTheSameBytes) {
    const Mesh mesh = unevenTorus();
    const std::vector<MeshStage> stages = {subdivide(2, false), smooth(3), subdivide(1, false), smooth(1)};
    const Mesh first = changed(mesh, stages);
    EXPECT_EQ(first.triangleCount(), 64 * mesh.triangleCount());
    for (int i = 0; i < 3; ++i) {
        const Mesh again = changed(mesh, stages);
        EXPECT_EQ(again.positions, first.positions);
        EXPECT_EQ(again.normals, first.normals);
        EXPECT_EQ(again.colors, first.colors);
        EXPECT_EQ(again.indices, first.indices);
    }
}

TEST(MeshStages, LongWorkGoesInPartsToTheSameBytes) {
    const Mesh mesh = unevenTorus();
    const std::atomic<uint64_t>& submissions = test::device().record->submissions;
    const uint64_t begin = submissions;
    const Mesh stepwise = changed(mesh, {subdivide(3, false), smooth(3), smooth(3), smooth(3), smooth(3)});
    const uint64_t between = submissions;
    const Mesh atOnce = changed(mesh, {subdivide(3, false), smooth(12)});
    EXPECT_GT(submissions - between, between - begin);
    EXPECT_EQ(atOnce.positions, stepwise.positions);
    EXPECT_EQ(atOnce.normals, stepwise.normals);
}

TEST(MeshStages, ABoxKeepsItsTopologyWhateverIsDone) {
    const Mesh mesh = changed(
        [] {
            Mesh cube = test::cube();
            cube.normals.assign(cube.positions.size(), glm::vec3(0, 1, 0));
            return cube;
        }(),
        {subdivide(3, false), smooth(50)});
    const Report report = reportOf(mesh);
    EXPECT_TRUE(report.closedManifold());
    EXPECT_EQ(countsOf(report), (Counts{12 * 64, 1, 2}));
    EXPECT_LT(report.volume, 7.0) << "smoothing rounds it";
    EXPECT_GT(report.volume, 1.0);
}

TEST(MeshStages, SmallPartsShrinkAndDoNotCollapse) {
    // Some are a few cells long, and were to become lines.
    Checked checked;
    const MeshRequest request{Box{{-0.992, -0.864, -1.344}, {0.369, 0.722, 0.409}}, 4};
    const Program program = programOf(test::expressionGraph("return hash(p * 2, 3) - 0.5;"));
    const Counts before = countsOf(reportOf(checked.mesh(program, {}, request)));
    for (const int iterations : {30, 100, 1000}) {
        const Report report = reportOf(checked.mesh(program, {smooth(iterations)}, request));
        expectClosedManifold(report);
        EXPECT_EQ(countsOf(report), before);
        EXPECT_EQ(report.degenerateTriangles, 0u);
    }
}

TEST(MeshStages, RandomGraphsKeepTheirTopology) {
    MesherPipelines pipelines;
    MesherBuffers buffers;
    MeshStageBuffers stageBuffers;
    const MeshStagePipelines stagePipelines = createMeshStagePipelines(test::device());
    const MeshStageConfig stageConfig{
        .pipelines = &stagePipelines, .lo = glm::vec3(-2.1f), .hi = glm::vec3(2.1f)};
    int meshed = 0;
    for (uint32_t seed = 1; meshed < 100; ++seed) {
        ASSERT_LT(seed, 2000u);
        std::optional<Program> program = test::randomProgram(seed, 30);
        if (!program || !program->ir.images().empty()) continue;
        MesherHost host(program->ir, program->distance(), program->parameters());
        SCOPED_TRACE("seed " + std::to_string(seed));
        const MesherConfig config{.origin = glm::vec3(-2.03f, -1.98f, -2.01f),
                                  .cellSize = glm::vec3(4.0f / 20),
                                  .cells = glm::ivec3(20),
                                  .method = MeshMethod(seed % 2),
                                  .host = &host};
        Result<MesherResult> result = runMesher(test::device(), pipelines, buffers, config);
        ASSERT_TRUE(result) << format(result.error());
        if (result->triangles == 0) continue;
        ++meshed;
        const Mesh before = downloadMesh(test::device(), buffers, *result);
        const Report of = reportOf(before);
        for (const auto& [stage, times] :
             {std::pair{smooth(1), 1}, {subdivide(1, false), 4}, {smooth(3), 4}}) {
            const std::vector<MeshStage> stages = {stage};
            const Done ran =
                runMeshStages(test::device(), stageBuffers, buffers, *result, stages, stageConfig);
            ASSERT_TRUE(ran) << format(ran.error());
            const Report report = reportOf(downloadMesh(test::device(), buffers, *result));
            expectClosedManifold(report);
            EXPECT_EQ(countsOf(report),
                      (Counts{uint64_t(times) * of.triangles, of.shells, of.eulerCharacteristic}));
        }
        ASSERT_FALSE(HasFailure());
    }
}

TEST(MeshStages, SamplesKeepTheirTopologyOnTheField) {
    Checked checked;
    for (const char* name : {"csg_part", "gyroid_sphere", "figure", "tower", "landscape", "mushroom"})
        for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring}) {
            SCOPED_TRACE(name + std::string(method == MeshMethod::marchingCubes ? "" : ", dual contouring"));
            const MeshRequest request{std::nullopt, 37, method};
            const Report of = reportOf(checked.mesh(sample(name), {}, request));
            for (const auto& stages : {std::vector{subdivide(1)}, {subdivide(1), smooth(2)}, {smooth(2)}}) {
                const Mesh mesh = checked.mesh(sample(name), stages, request);
                const Report report = reportOf(mesh);
                expectClosedManifold(report);
                const uint64_t times = stages[0].kind == Kind::subdivide ? 4 : 1;
                EXPECT_EQ(countsOf(report),
                          (Counts{times * of.triangles, of.shells, of.eulerCharacteristic}));
                for (const glm::vec3& normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1.0f, 1e-3f);
            }
        }
}

/// The farthest that vertices and centroids are from the ball of radius 0.8.
double farFromBall(const Mesh& mesh) {
    double most = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::dvec3 sum(0);
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec3 p = mesh.positions[mesh.indices[i + k]];
            most = std::max(most, std::abs(glm::length(p) - 0.8));
            sum += p;
        }
        most = std::max(most, std::abs(glm::length(sum / 3.0) - 0.8));
    }
    return most;
}

TEST(MeshStages, EachProjectedLevelBringsASphereFourTimesAsNear) {
    Checked checked;
    const MeshRequest request{.region = Box{{-1, -1, -1}, {1, 1, 1}}, .resolution = 16};
    const Program ball = programOf(graphOf(kBall));
    double before = farFromBall(checked.mesh(ball, {}, request));
    for (int level = 1; level <= 3; ++level) {
        const Mesh mesh = checked.mesh(ball, {subdivide(level)}, request);
        const double now = farFromBall(mesh);
        EXPECT_GT(before / now, 2.7) << level;
        EXPECT_LT(before / now, 5.5) << level;
        EXPECT_TRUE(reportOf(mesh).closedManifold());
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            ASSERT_GT(glm::dot(mesh.normals[v], glm::normalize(mesh.positions[v])), 0.9999f)
                << "the field's own";
        before = now;
    }
    EXPECT_GT(farFromBall(checked.mesh(ball, {subdivide(1, false)}, request)), 4 * before)
        << "in the middle of their edges";
}

TEST(MeshStages, TheHostProjectsAsTheKernelDoes) {
    Checked kernels, tapes{FieldBy::tapes};
    // A ball that leaves its region, closed at five of its sides.
    const MeshRequest request{.region = Box{{-0.31, -0.9, -0.57}, {0.42, 0.123, 0.7}}, .resolution = 31};
    const Program ball = programOf(graphOf(kBall));
    const Mesh expected = kernels.mesh(ball, {subdivide(2)}, request);
    const Mesh ours = tapes.mesh(ball, {subdivide(2)}, request);
    ASSERT_TRUE(tapes.session.byTapes());
    ASSERT_EQ(ours.indices, expected.indices);
    for (std::size_t v = 0; v < ours.positions.size(); ++v) {
        const glm::vec3 p = ours.positions[v], n = ours.normals[v], theirs = expected.normals[v];
        ASSERT_LT(glm::distance(p, expected.positions[v]), 1e-4f);
        ASSERT_GT(glm::dot(n, theirs), 0.999f)
            << v << " at " << p.x << ' ' << p.y << ' ' << p.z << ": " << n.x << ' ' << n.y << ' ' << n.z
            << " and " << theirs.x << ' ' << theirs.y << ' ' << theirs.z;
    }
}

TEST(MeshStages, NormalsFromConnectivityAreTheSpheres) {
    Checked checked;
    const MeshRequest request{.region = Box{{-1, -1, -1}, {1, 1, 1}}, .resolution = 32};
    for (const auto& stages : {std::vector{smooth(1)}, {subdivide(1, false)}, {subdivide(1), smooth(4)}}) {
        const Mesh mesh = checked.mesh(programOf(graphOf(kBall)), stages, request);
        double worst = 0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            ASSERT_NEAR(glm::length(mesh.normals[v]), 1.0f, 1e-4f);
            const glm::dvec3 n(mesh.normals[v]), outwards = glm::normalize(glm::dvec3(mesh.positions[v]));
            worst = std::max(worst, std::acos(std::clamp(glm::dot(glm::normalize(n), outwards), -1.0, 1.0)));
        }
        // In the middle of an edge, the two faces beside it are all there is.
        EXPECT_LT(worst * 180 / 3.14159265, stages[0].kind == Kind::subdivide && !stages[0].project ? 8 : 4);
    }
}

TEST(MeshStages, ACappedSolidStaysWithinItsRegion) {
    Checked checked;
    const Box region{{-0.31, -0.9, -0.57}, {0.42, 0.123, 0.9}};
    const MeshRequest request{.region = region, .resolution = 31};
    const Report of = reportOf(checked.mesh(programOf(graphOf(kBall)), {}, request));
    const Report report = reportOf(checked.mesh(programOf(graphOf(kBall)), {subdivide(2)}, request));
    expectClosedManifold(report);
    EXPECT_EQ(countsOf(report), (Counts{16 * of.triangles, of.shells, of.eulerCharacteristic}));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(report.boundsMin[axis], std::max(region.lo[axis], -0.8) - 1e-5);
        EXPECT_LE(report.boundsMax[axis], std::min(region.hi[axis], 0.8) + 1e-5);
    }
}

TEST(MeshStages, WhereSidesOfTheRegionMeetNormalsAreTheirs) {
    // Within a ball nothing but the region's sides is left, and no vertex takes the ball's normal.
    const Box region{{-0.31, -0.3, -0.2}, {0.22, 0.123, 0.37}};
    for (const FieldBy by : {FieldBy::kernels, FieldBy::tapes}) {
        Checked checked{by};
        const Mesh mesh =
            checked.mesh(programOf(graphOf(kBall)), {subdivide(2)}, {.region = region, .resolution = 17});
        EXPECT_GT(mesh.positions.size(), 1000u);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const glm::dvec3 p(mesh.positions[v]);
            glm::dvec3 sides(0);
            for (int axis = 0; axis < 3; ++axis)
                sides[axis] = (region.hi[std::size_t(axis)] - p[axis] < 1e-5) -
                              (p[axis] - region.lo[std::size_t(axis)] < 1e-5);
            ASSERT_NE(glm::length(sides), 0.0) << v << " lies on no side";
            ASSERT_GT(glm::dot(glm::dvec3(mesh.normals[v]), glm::normalize(sides)), 0.55) << v;
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_TRUE(sides[axis] != 0 || std::abs(mesh.normals[v][axis]) < 1e-4f)
                    << v << " at " << p.x << ' ' << p.y << ' ' << p.z << ": " << mesh.normals[v].x << ' '
                    << mesh.normals[v].y << ' ' << mesh.normals[v].z;
        }
    }
}

TEST(MeshStages, SmoothedCreasesAreShadedAsTheyAre) {
    Checked checked;
    const Program box =
        programOf(graphOf(R"({"id": "box", "type": "box", "inputs": {"half_extents": [0.7, 0.7, 0.7]}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "box"}}})"));
    const MeshRequest request{std::nullopt, 20, MeshMethod::dualContouring};
    const Mesh sharp = checked.mesh(box, {}, request), split = checked.mesh(box, {subdivide(1)}, request);
    const MesherResult smoothed = checked.run(box, {smooth(3)}, request);
    EXPECT_GT(sharp.positions.size(), reportOf(sharp).vertices) << "vertices on creases are doubled";
    EXPECT_GT(split.positions.size(), reportOf(split).vertices);
    EXPECT_EQ(checked.session.download(smoothed).positions.size(), smoothed.vertices);
}

TEST(MeshStages, TooManyLevelsAreRefused) {
    Checked checked;
    Program program = programOf(graphOf(kBall));
    program.stages = {subdivide(6)};
    checked.session.setProgram(std::move(program));
    const Result<MesherResult> result = checked.session.polygonise({std::nullopt, 64});
    ASSERT_FALSE(result);
    const std::string& message = result.error().message;
    EXPECT_NE(message.find("of subdivide needs"), std::string::npos) << message;
    EXPECT_NE(message.find("fewer levels"), std::string::npos) << message;
}

TEST(MeshStages, AnEmptyMeshPasses) {
    Checked checked;
    const MesherResult result = checked.run(programOf(graphOf(kBall)), {smooth(2), subdivide(1)},
                                            {.region = Box{{2, 2, 2}, {3, 3, 3}}, .resolution = 16});
    EXPECT_EQ(result.triangles, 0u);
}

TEST(MeshStages, PicturesShowTheMeshAndItsColours) {
    Checked checked;
    const Graph graph = graphOf(R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.8}},
        {"id": "red", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": [0.8, 0.02, 0.02]}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "red"}}})");
    const MeshRequest request{.region = Box{{-1, -1, -1}, {1, 1, 1}}, .resolution = 8};
    RenderOptions options{.width = 96, .height = 96, .samples = 1};
    options.scene.ground.reset();
    options.scene.camera = Camera{};
    options.scene.camera->position = {0, 0, 4};
    const auto redPixels = [&](const std::vector<MeshStage>& stages) {
        const MesherResult mesh = checked.run(programOf(graph), stages, request);
        const Result<Picture> picture = checked.session.render(mesh, options);
        if (!picture) throw SystemError(format(picture.error()));
        int red = 0;
        for (std::size_t i = 0; i < picture->pixels.size(); i += 4)
            red += picture->pixels[i] > 2 * picture->pixels[i + 1] && picture->pixels[i] > 40;
        return red;
    };
    const int smaller = redPixels({smooth(10)}), whole = redPixels({});
    EXPECT_GT(smaller, 100);
    EXPECT_LT(smaller, whole * 9 / 10) << "smoothing shrinks so coarse a ball";
    EXPECT_EQ(redPixels({smooth(10)}), smaller);
}

TEST(MeshStages, PlayersRunThemOnEachFrame) {
    const Graph graph = graphOf(
        R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
           {"id": "poly", "type": "polygonize", "inputs": {"surface": {"from": "ball"}, "resolution": 16}},
           {"id": "split", "type": "subdivide", "inputs": {"mesh": {"from": "poly"}}},
           {"id": "even", "type": "smooth", "inputs": {"mesh": {"from": "split"}, "iterations": 2}},
           {"id": "out", "type": "output", "inputs": {"mesh": {"from": "even"}}})",
        R"(, "parameters": [{"name": "evenness", "node": "even", "input": "iterations"}],
           "timeline": {"length": 2, "tracks": [{"node": "ball", "input": "radius",
               "keys": [{"time": 0, "value": 0.5}, {"time": 2, "value": 0.8}]}]})");
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    Result<Player> player = Player::create(graph, std::move(*device));
    ASSERT_TRUE(player) << format(player.error());
    double size[2];
    for (int i = 0; i < 2; ++i) {
        player->seek(1.9 * i);
        const Result<Mesh> mesh = player->mesh();
        ASSERT_TRUE(mesh) << format(mesh.error());
        const Report report = reportOf(*mesh);
        EXPECT_TRUE(report.closedManifold());
        EXPECT_EQ(report.triangles % 4, 0u);
        EXPECT_EQ(report.eulerCharacteristic, 2);
        size[i] = report.volume;
    }
    EXPECT_GT(size[1], 3 * size[0]);
    const double evener = 40;
    ASSERT_TRUE(player->set("evenness", std::span(&evener, 1)));
    const Result<Mesh> mesh = player->mesh();
    ASSERT_TRUE(mesh) << format(mesh.error());
    EXPECT_LT(reportOf(*mesh).volume, 0.97 * size[1]);
    ASSERT_TRUE(player->frame({.width = 64, .height = 48, .samples = 1}));
    EXPECT_EQ(player->device().validationMessages(), std::vector<std::string>());
}

}  // namespace fw::mesh_stages_test
