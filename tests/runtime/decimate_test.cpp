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

TEST(Decimate, LeavesAMeshThatIsFartherAwayThanThat) {
    Mesh mesh = test::torus(30, 20);
    const Mesh before = mesh;
    MeasureOptions far;
    far.error = [](std::span<const glm::dvec3>, std::span<double> errors) {
        for (double& error : errors) error = 0.5;
    };
    EXPECT_FALSE(decimate(mesh, 0.4, far));
    EXPECT_EQ(mesh.positions, before.positions);
    EXPECT_EQ(mesh.indices, before.indices);
    EXPECT_TRUE(decimate(mesh, 0.6, far));
    EXPECT_LT(mesh.triangleCount(), before.triangleCount());
    EXPECT_TRUE(reportOnMesh(mesh.positions, mesh.indices).closedManifold());
}

TEST(Decimate, ASolidStaysASolidWhateverTheError) {
    for (const double error : {0.5, 2.0, 10.0, 1000.0}) {
        Mesh mesh = test::torus(30, 20);
        ASSERT_TRUE(decimate(mesh, error, {})) << error;
        const Report report = reportOnMesh(mesh.positions, mesh.indices);
        EXPECT_TRUE(report.closedManifold());
        EXPECT_GE(report.triangles, 4u);
        EXPECT_GT(report.volume, 0.0);
    }
}

TEST(Decimate, AnEmptyMeshStaysEmpty) {
    Mesh mesh;
    EXPECT_FALSE(decimate(mesh, 1.0, {}));
}

}  // namespace fw::decimate_test
