// The mesher with the field evaluated on the host: as sound as the kernels' mesh, and the same up to
// rounding.
#include "runtime/mesher/host.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <set>

#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/mesher/mesher.h"
#include "runtime/play/mesh_program.h"
#include "runtime/play/session.h"
#include "tests/support/device_field.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/random_graph.h"

namespace fw::mesher_host_test {

struct Meshed {
    MesherResult result;
    Mesh mesh;
};

MesherConfig gridOf(const Box& box, int cells) {
    const glm::dvec3 lo(box.lo[0], box.lo[1], box.lo[2]), hi(box.hi[0], box.hi[1], box.hi[2]);
    const double size = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z}) / cells;
    return {.origin = glm::vec3(lo),
            .cellSize = glm::vec3(float(size)),
            .cells = glm::max(glm::ivec3((hi - lo) / size), glm::ivec3(1))};
}

Meshed run(MesherPipelines pipelines, MesherConfig config, MesherHost* host) {
    MesherBuffers buffers;
    config.host = host;
    Result<MesherResult> result = runMesher(test::device(), pipelines, buffers, config);
    if (!result) throw SystemError(format(result.error()));
    return {*result, downloadMesh(test::device(), buffers, *result)};
}

Program programOf(const std::string& path) {
    const Result<Graph> graph = readGraph(path, nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    // Some samples have particles, which have been under way for a while.
    Result<Program> program = compileAtTime(*graph, 0.2, {}, [] { return &test::device(); });
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

/// Share of the vertices whose normal is not the reference's slope: some lie where slopes jump.
double shareOfWrongNormals(const Program& program, const Mesh& mesh) {
    std::vector<Point> points;
    for (const glm::vec3& p : mesh.positions) points.push_back({p.x, p.y, p.z});
    std::vector<ValueGradient> slopes(points.size());
    evaluateGradient(program.ir, program.distance(), program.parameters(), points, slopes);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
        const Point& g = slopes[i].gradient;
        wrong +=
            glm::distance(glm::normalize(glm::dvec3(g[0], g[1], g[2])), glm::dvec3(mesh.normals[i])) > 0.05;
    }
    return double(wrong) / double(slopes.size());
}

TEST(MesherHost, EverySampleHasTheMeshOfTheKernels) {
    int samples = 0, number = 0;
    std::set<std::filesystem::path> all;  // by name: every sixth without FIELDWRIGHT_LONG
    for (const auto& entry : std::filesystem::directory_iterator(FIELDWRIGHT_SOURCE_DIR "/samples"))
        if (entry.path().string().ends_with(".field.json")) all.insert(entry.path());
    for (const std::filesystem::path& path : all) {
        if (number++ % 6 != 0 && !std::getenv("FIELDWRIGHT_LONG")) continue;
        SCOPED_TRACE(path.filename().string());
        const Program program = programOf(path);
        const Result<Box> box = meshRegion(program, {std::nullopt, 40});
        ASSERT_TRUE(box);
        MesherConfig config = gridOf(*box, 40);
        const test::FieldResources resources(program);
        config.field = resources.buffers();
        config.families = &program.families;
        const Meshed kernels =
            run(createMesherPipelines(test::device(), emitField(program)), config, nullptr);
        MesherHost host(program.ir, program.distance(), program.parameters());
        const Meshed ours = run({}, config, &host);

        const Report report = reportOnMesh(ours.mesh.positions, ours.mesh.indices);
        EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges + report.nonManifoldVertices, 0u);
        EXPECT_EQ(report.flippedEdges + report.degenerateTriangles, 0u);
        const Report expected = reportOnMesh(kernels.mesh.positions, kernels.mesh.indices);
        EXPECT_NEAR(report.volume, expected.volume, 2e-3 * expected.volume);
        EXPECT_NEAR(report.area, expected.area, 1e-2 * expected.area);
        // Where a face lies on the grid, single and double precision may take different sides.
        EXPECT_NEAR(double(ours.mesh.positions.size()), double(kernels.mesh.positions.size()),
                    0.1 * double(kernels.mesh.positions.size()));
        EXPECT_LT(shareOfWrongNormals(program, kernels.mesh), 0.02);
        EXPECT_LT(shareOfWrongNormals(program, ours.mesh), 0.02);
        ++samples;
    }
    EXPECT_GE(samples, 6);
}

TEST(MesherHost, ASphereIsTheSameVertexForVertex) {
    Ir ir;
    IrId squares = ir.constant(0);
    for (int axis = 0; axis < 3; ++axis)
        squares = ir.add(Op::add, squares, ir.add(Op::square, ir.position(axis)));
    const IrId root = ir.add(Op::subtract, ir.add(Op::squareRoot, squares), ir.parameter(0));
    MesherHost host(ir, root, {0.77});
    // Two blocks along each axis, and a part of the last one.
    const MesherConfig config{
        .origin = glm::vec3(-1), .cellSize = glm::vec3(2.0f / 70), .cells = glm::ivec3(70)};
    const Meshed ours = run({}, config, &host);
    EXPECT_EQ(reportOnMesh(ours.mesh.positions, ours.mesh.indices).eulerCharacteristic, 2);
    for (std::size_t i = 0; i < ours.mesh.positions.size(); ++i) {
        ASSERT_NEAR(glm::length(ours.mesh.positions[i]), 0.77f, 1e-5f);
        ASSERT_GT(glm::dot(glm::normalize(ours.mesh.positions[i]), ours.mesh.normals[i]), 0.9999f);
    }
}

TEST(MesherHost, ASolidThatFillsTheRegionIsCapped) {
    Ir ir;
    MesherHost host(ir, ir.constant(-1), {});
    const MesherConfig config{.origin = glm::vec3(0), .cellSize = glm::vec3(0.1f), .cells = {10, 5, 3}};
    const Meshed ours = run({}, config, &host);
    EXPECT_TRUE(ours.result.capped);
    const Report report = reportOnMesh(ours.mesh.positions, ours.mesh.indices);
    EXPECT_EQ(report.boundaryEdges + report.nonManifoldVertices + report.degenerateTriangles, 0u);
    EXPECT_NEAR(report.volume, 0.15, 1e-3);
}

TEST(MesherHost, AnEmptyFieldGivesAnEmptyMesh) {
    Ir ir;
    MesherHost host(ir, ir.constant(1), {});
    EXPECT_EQ(run({}, {.cells = glm::ivec3(20)}, &host).mesh.indices.size(), 0u);
}

TEST(MesherHost, BuffersGrowUntilTheSurfaceFits) {
    const Program program = programOf(FIELDWRIGHT_SOURCE_DIR "/samples/gyroid_sphere.field.json");
    const Result<Box> box = meshRegion(program, {std::nullopt, 96});
    ASSERT_TRUE(box);
    MesherHost host(program.ir, program.distance(), program.parameters());
    const Meshed ours = run({}, gridOf(*box, 96), &host);
    EXPECT_EQ(reportOnMesh(ours.mesh.positions, ours.mesh.indices).boundaryEdges, 0u);
    EXPECT_GT(ours.mesh.positions.size(), 10000u);
}

TEST(MesherHost, RandomGraphsAreClosedAndManifoldByBothMethods) {
    const int wanted = std::getenv("FIELDWRIGHT_LONG") ? 10'000 : 150;
    const int cells = 20;
    MesherPipelines pipelines;  // all that is needed is the same for every field
    MesherBuffers buffers;
    int meshed = 0, empty = 0;
    uint64_t pinches = 0, cuts = 0, triangles = 0, flat = 0;
    for (uint32_t seed = 1; meshed < wanted; ++seed) {
        ASSERT_LT(seed, 20u * uint32_t(wanted));
        std::optional<Program> program = test::randomProgram(seed, 30);
        if (!program || !program->ir.images().empty()) continue;
        MesherHost host(program->ir, program->distance(), program->parameters());
        bool any = false;
        for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring}) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", method " + std::to_string(int(method)));
            const MesherConfig config{.origin = glm::vec3(-2.03f, -1.98f, -2.01f),
                                      .cellSize = glm::vec3(4.0f / cells),
                                      .cells = glm::ivec3(cells),
                                      .method = method,
                                      .host = &host};
            const Result<MesherResult> result = runMesher(test::device(), pipelines, buffers, config);
            ASSERT_TRUE(result) << format(result.error());
            any = any || result->triangles > 0;
            if (result->triangles == 0) continue;
            const Mesh mesh = downloadMesh(test::device(), buffers, *result);
            const bool dual = method == MeshMethod::dualContouring;
            const Report report = reportOnMesh(mesh.positions, mesh.indices, {.selfIntersections = dual});
            ASSERT_EQ(report.boundaryEdges + report.nonManifoldEdges + report.nonManifoldVertices, 0u);
            ASSERT_EQ(report.flippedEdges, 0u);
            flat += report.degenerateTriangles;
            if (!dual) continue;
            pinches += result->pinches;
            cuts += *report.selfIntersections;
            triangles += report.triangles;
        }
        ++(any ? meshed : empty);
    }
    EXPECT_LE(flat, triangles / 10'000);  // points that a field with jumps puts in one line
    const auto number = [](uint64_t of) { return static_cast<unsigned long long>(of); };
    std::printf("%d graphs meshed, %d empty there, %llu triangles without area\n", meshed, empty,
                number(flat));
    std::printf("dual contouring: %llu triangles, %llu cuts, %llu pinches\n", number(triangles), number(cuts),
                number(pinches));
}

}  // namespace fw::mesher_host_test
