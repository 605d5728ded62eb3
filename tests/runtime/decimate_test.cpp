// Decimation: fewer triangles, closed and manifold, no farther from the field than was asked for.
#include "runtime/stages/decimate.h"

#include <gtest/gtest.h>

#include "graph/document/json.h"
#include "runtime/measure/field_measure.h"
#include "runtime/play/session.h"
#include "tests/support/meshes.h"

namespace fw::decimate_test {

struct Solid {
    const char* name;
    const char* shape;
    MeshMethod method;
    double error;
};

struct EachSolid : testing::TestWithParam<Solid> {};
INSTANTIATE_TEST_SUITE_P(
    Decimate, EachSolid,
    testing::Values(Solid{"SphereCoarse", R"("type": "sphere")", MeshMethod::marchingCubes, 0.02},
                    Solid{"SphereFine", R"("type": "sphere")", MeshMethod::marchingCubes, 0.003},
                    Solid{"SphereDual", R"("type": "sphere")", MeshMethod::dualContouring, 0.01},
                    Solid{"Box", R"("type": "box", "inputs": {"half_extents": [0.7, 0.5, 0.6]})",
                          MeshMethod::marchingCubes, 0.03},
                    Solid{"BoxDual", R"("type": "box", "inputs": {"half_extents": [0.7, 0.5, 0.6]})",
                          MeshMethod::dualContouring, 0.001}),
    [](const auto& row) { return row.param.name; });

Program programOf(const std::string& shape) {
    const std::string text = R"({"fieldwright": 1, "nodes": [{"id": "s", )" + shape +
                             R"(}, {"id": "m", "type": "material", "inputs": {"surface": {"from": "s"},
        "base_color": {"from": "p"}}}, {"id": "p", "type": "position"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "m"}}}]})";
    const Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

TEST_P(EachSolid, StaysWithinTheError) {
    const Solid& solid = GetParam();
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    Session session(std::move(*device));
    const Box region{{-1.1, -1.2, -1.15}, {1.2, 1.1, 1.15}};
    const MeshRequest request{region, 40, solid.method};
    Program program = programOf(solid.shape);
    session.setProgram(program);
    const Result<MesherResult> whole = session.polygonise(request);
    ASSERT_TRUE(whole) << format(whole.error());

    program.stages = {{.kind = MeshStage::Kind::decimate, .error = solid.error}};
    session.setProgram(program);
    Mesh meshes[2];
    for (Mesh& mesh : meshes) {
        const Result<MesherResult> fewer = session.polygonise(request);
        ASSERT_TRUE(fewer) << format(fewer.error());
        EXPECT_FALSE(fewer->undecimated);
        mesh = session.download(*fewer);
    }
    EXPECT_EQ(meshes[0].positions, meshes[1].positions);
    EXPECT_EQ(meshes[0].indices, meshes[1].indices);

    const Mesh& mesh = meshes[0];
    const Report report = reportOnMesh(mesh.positions, mesh.indices, measureOf(program, region));
    EXPECT_TRUE(report.closedManifold());
    EXPECT_EQ(report.eulerCharacteristic, 2);
    EXPECT_LE(*report.maxError, solid.error);
    EXPECT_LE(report.meshToSurface->max, solid.error);
    EXPECT_LE(report.surfaceToMesh->max, solid.error);
    EXPECT_LT(report.triangles, whole->triangles * 6 / 10);
    EXPECT_GE(report.triangles, 12u);
    std::printf("%s: %u triangles, %llu left, %.4g m away\n", solid.name, whole->triangles,
                static_cast<unsigned long long>(report.triangles), farthest(report));
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    for (std::size_t v = 0; v < mesh.colors.size(); ++v)
        ASSERT_LT(glm::distance(mesh.colors[v], glm::clamp(mesh.positions[v], 0.0f, 1.0f)), 1e-4f);
    for (const glm::vec3& normal : mesh.normals) EXPECT_NEAR(glm::length(normal), 1.0f, 1e-3f);
    EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
}

TEST(Decimate, WhereAMeshIsFartherAwayAlreadyItGetsNoFarther) {
    // A torus of flat quads whose surface is said to be farther away on one side.
    Mesh mesh = test::torus(60, 40);
    const std::size_t before = mesh.triangleCount();
    MeasureOptions measure;
    measure.error = [](std::span<const glm::dvec3> points, std::span<double> errors) {
        for (std::size_t i = 0; i < points.size(); ++i)
            errors[i] =
                points[i].x > 0.5
                    ? 0.2
                    : std::abs(std::hypot(std::hypot(points[i].x, points[i].z) - 1.0, points[i].y) - 0.25);
    };
    ASSERT_TRUE(decimate(mesh, {.error = 0.02}, measure));
    EXPECT_LT(mesh.triangleCount(), before / 3);
    const Report report = reportOnMesh(mesh.positions, mesh.indices, measure);
    EXPECT_TRUE(report.closedManifold());
    EXPECT_LE(*report.maxError, 0.2);
    std::vector<glm::dvec3> places;
    for (const uint32_t index : mesh.indices) places.emplace_back(mesh.positions[index]);
    std::vector<double> errors(places.size());
    measure.error(places, errors);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].x <= 0.5) ASSERT_LE(errors[i], 0.02);
}

TEST(Decimate, ASolidStaysASolidWhateverTheError) {
    for (const double error : {0.5, 2.0, 10.0, 1000.0}) {
        Mesh mesh = test::torus(30, 20);
        ASSERT_TRUE(decimate(mesh, {.error = error}, {})) << error;
        const Report report = reportOnMesh(mesh.positions, mesh.indices);
        EXPECT_TRUE(report.closedManifold());
        EXPECT_GE(report.triangles, 4u);
        EXPECT_EQ(report.eulerCharacteristic, 0) << "a torus stays one";
        EXPECT_GT(report.volume, 0.0);
    }
}

TEST(Decimate, AnEmptyMeshStaysEmpty) {
    Mesh mesh;
    EXPECT_FALSE(decimate(mesh, {.error = 1.0}, {}));
    EXPECT_FALSE(decimate(mesh, {.triangles = 10}, {}));
    EXPECT_TRUE(mesh.indices.empty());
}

TEST(Decimate, WithoutAWishNothingGoes) {
    Mesh mesh = test::torus(30, 20);
    EXPECT_FALSE(decimate(mesh, {}, {}));
    EXPECT_EQ(mesh.triangleCount(), 1200u);
}

TEST(Decimate, EndsAtTheNumberUnlessTheErrorEndsItBefore) {
    const Mesh torus = test::torus(60, 40);
    for (const std::size_t wanted : {4799u, 4000u, 1001u, 200u, 60u}) {
        Mesh mesh = torus;
        ASSERT_TRUE(decimate(mesh, {.triangles = wanted}, {})) << wanted;
        EXPECT_LE(mesh.triangleCount(), wanted);
        EXPECT_GE(mesh.triangleCount() + 1, wanted) << "two triangles go at a time";
        EXPECT_EQ(reportOnMesh(mesh.positions, mesh.indices).eulerCharacteristic, 0);
    }
    Mesh mesh = torus;
    EXPECT_FALSE(decimate(mesh, {.triangles = 4800}, {})) << "as many as there are";
    EXPECT_FALSE(decimate(mesh, {.triangles = 100'000}, {}));
    ASSERT_TRUE(decimate(mesh, {.triangles = 4}, {})) << "as few as a torus can have";
    EXPECT_GE(mesh.triangleCount(), 14u);
    EXPECT_TRUE(reportOnMesh(mesh.positions, mesh.indices).closedManifold());

    Mesh within = torus, both = torus;
    ASSERT_TRUE(decimate(within, {.error = 0.01}, {}));
    ASSERT_TRUE(decimate(both, {.error = 0.01, .triangles = 4}, {}));
    EXPECT_GT(within.triangleCount(), 100u);
    EXPECT_GT(both.triangleCount(), 100u);
    ASSERT_TRUE(decimate(both = torus, {.error = 0.5, .triangles = 1000}, {}));
    EXPECT_EQ(both.triangleCount(), 1000u);
}

}  // namespace fw::decimate_test
