// Doubling vertices on creases: who is doubled, what normals they get, and that the surface stays the same.
#include "runtime/mesh/creases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/measure/mesh_report.h"
#include "tests/support/meshes.h"

namespace fw::creases_test {

Mesh withSmoothNormals(Mesh mesh) {
    mesh.normals.clear();
    for (const glm::vec3& p : mesh.positions) mesh.normals.push_back(glm::normalize(p));
    return mesh;
}

TEST(Creases, ACornerOfACubeGetsThreeNormals) {
    Mesh mesh = withSmoothNormals(test::cube());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.colors.push_back(glm::vec3(float(v)));
    splitCreases(mesh);
    ASSERT_EQ(mesh.positions.size(), 24u);
    ASSERT_EQ(mesh.normals.size(), 24u);
    ASSERT_EQ(mesh.colors.size(), 24u);
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                        c = mesh.positions[mesh.indices[t + 2]];
        const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
        for (int k = 0; k < 3; ++k)
            EXPECT_LT(glm::distance(mesh.normals[mesh.indices[t + k]], normal), 1e-6f);
    }
    for (std::size_t v = 8; v < 24; ++v) {
        const auto original = std::size_t(mesh.colors[v].x);
        EXPECT_EQ(mesh.positions[v], mesh.positions[original]);
    }
    const Report report = reportOnMesh(mesh.positions, mesh.indices);
    EXPECT_TRUE(report.closedManifold());
    EXPECT_EQ(report.vertices, 8u);
}

TEST(Creases, ASmoothSurfaceKeepsItsVerticesAndNormals) {
    Mesh mesh = test::torus(64, 32);
    const Mesh before = mesh;
    splitCreases(mesh);
    EXPECT_EQ(mesh.positions, before.positions);
    EXPECT_EQ(mesh.normals, before.normals);
    EXPECT_EQ(mesh.indices, before.indices);
}

TEST(Creases, ATriangleWithoutAreaSplitsNothing) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.indices = {0, 1, 2, 0, 3, 1};
    splitCreases(mesh);
    EXPECT_EQ(mesh.positions.size(), 4u);
    for (const glm::vec3& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
    Mesh nothing;
    splitCreases(nothing);
    EXPECT_TRUE(nothing.positions.empty());
}

}  // namespace fw::creases_test
