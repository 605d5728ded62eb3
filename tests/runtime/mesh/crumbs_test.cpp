// Small parts that hang together with nothing: which go, and what is in them.
#include "runtime/mesh/crumbs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/play/session.h"
#include "tests/support/meshes.h"

namespace fw::crumbs_test {

Mesh sized(Mesh mesh, float size, glm::vec3 at) {
    for (glm::vec3& p : mesh.positions) p = size * p + at;
    return mesh;
}
/// The same, turned inside out: a void.
Mesh hollow(Mesh mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
    return mesh;
}

Report measured(const Mesh& mesh) { return reportOnMesh(mesh.positions, mesh.indices); }

TEST(Crumbs, GoWithTheVoidsInThemAndOthersStay) {
    // A large cube with a void, in which floats a small one that is hollow; and one beside that is not so
    // small.
    Mesh mesh = test::cube();                                                  // volume 8
    mesh = test::join(mesh, hollow(sized(test::cube(), 0.8f, {})));            // 4.096
    mesh = test::join(mesh, sized(test::cube(), 0.3f, {0.1f, 0, 0}));          // 0.216
    mesh = test::join(mesh, hollow(sized(test::cube(), 0.1f, {0.1f, 0, 0})));  // 0.008
    mesh = test::join(mesh, sized(test::cube(), 0.5f, {3, 0, 0}));             // 1
    mesh = test::join(mesh, hollow(sized(test::cube(), 0.2f, {3, 0, 0})));     // 0.064
    test::paint(mesh);
    EXPECT_EQ(measured(mesh).bodies(), 3u);

    Mesh untouched = mesh;
    EXPECT_FALSE(leaveOutCrumbs(untouched, 0.02));
    EXPECT_EQ(untouched.indices, mesh.indices);

    Mesh some = mesh;
    EXPECT_TRUE(leaveOutCrumbs(some, 0.05));
    Report report = measured(some);
    EXPECT_EQ(report.bodies(), 2u);
    EXPECT_EQ(report.cavities, 2u);
    EXPECT_NEAR(report.volume, 8 - 4.096 + 1 - 0.064, 1e-5);
    EXPECT_EQ(some.colors.size(), some.positions.size());
    for (std::size_t v = 0; v < some.positions.size(); ++v) {
        const auto found = std::ranges::find(mesh.positions, some.positions[v]);
        ASSERT_NE(found, mesh.positions.end());
    }

    Mesh one = mesh;
    EXPECT_TRUE(leaveOutCrumbs(one, 1.0));
    report = measured(one);
    EXPECT_EQ(report.bodies(), 1u);
    EXPECT_EQ(report.cavities, 1u);
    EXPECT_NEAR(report.volume, 8 - 4.096, 1e-5);

    Mesh unshared = test::unshared(mesh);
    EXPECT_TRUE(leaveOutCrumbs(unshared, 1.0));
    EXPECT_EQ(unshared.triangleCount(), one.triangleCount());
    Mesh nothing;
    EXPECT_FALSE(leaveOutCrumbs(nothing, 1.0));
}

TEST(Crumbs, OfATrimmedLatticeAreLeftOut) {
    const auto meshed = [](const std::string& kind, bool dropped) {
        const Result<Graph> graph = parseGraph(
            R"({"fieldwright": 1, "nodes": [
            {"id": "l", "type": "lattice", "inputs": {"kind": ")" +
                kind + R"(", "cell": 0.4, "thickness": 0.07}},
            {"id": "s", "type": "sphere", "inputs": {"radius": 0.75}},
            {"id": "i", "type": "intersect", "inputs": {"a": {"from": "s"}, "b": {"from": "l"}}},
            {"id": "m", "type": "polygonize", "inputs": {"surface": {"from": "i"}, "resolution": 96}},
            {"id": "d", "type": "drop_crumbs", "inputs": {"mesh": {"from": "m"}}},
            {"id": "out", "type": "output", "inputs": {"mesh": {"from": ")" +
                (dropped ? "d" : "m") + R"("}}}]})",
            "trimmed.field.json", nullptr);
        EXPECT_TRUE(graph) << format(graph.error());
        Result<Program> program = compile(*graph);
        EXPECT_TRUE(program) << format(program.error());
        Result<Device> device = createDevice({.validation = true});
        if (!device) throw SystemError(format(device.error()));
        Session session(std::move(*device));
        session.setProgram(std::move(*program));
        const Result<MesherResult> result = session.polygonise({std::nullopt, 96});
        if (!result) throw SystemError(format(result.error()));
        EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
        return measured(session.download(*result));
    };
    for (const char* kind : {"diamond", "octet"}) {
        SCOPED_TRACE(kind);
        const Report with = meshed(kind, false), without = meshed(kind, true);
        EXPECT_GT(with.bodies(), 1u);
        EXPECT_EQ(without.bodies(), 1u);
        EXPECT_TRUE(without.closedManifold());
        EXPECT_GT(without.volume, 0.9 * with.volume);
    }
}

}  // namespace fw::crumbs_test
