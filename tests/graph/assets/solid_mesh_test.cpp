// Meshes made ready to bound a solid: what is found, what is turned, which normals decide.
#include "graph/assets/solid_mesh.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/support/graph/triangle_meshes.h"

namespace fw::solid_mesh_test {

using namespace test;

void turn(TriangleMesh& mesh, std::size_t triangle) {
    std::swap(mesh.indices[3 * triangle], mesh.indices[3 * triangle + 1]);
}
void turnAll(TriangleMesh& mesh) {
    for (std::size_t t = 0; 3 * t < mesh.indices.size(); ++t) turn(mesh, t);
}

TEST(SolidMesh, ACubeIsFoundClosedAndOriented) {
    for (const TriangleMesh& mesh : {cubeFile(), unsharedFile(cubeFile())}) {
        const SolidMesh solid = solidMesh(mesh);
        EXPECT_EQ(solid.positions.size(), 8u);
        EXPECT_EQ(solid.source.size(), 12u);
        EXPECT_TRUE(solid.found.oriented());
        EXPECT_EQ(solid.found.parts, 1u);
        EXPECT_EQ(solid.found.text(), "");
        EXPECT_NEAR(solid.volume, 8.0, 1e-12);
    }
}

TEST(SolidMesh, AFewTurnedFacesAreTurnedBack) {
    TriangleMesh mesh = cubeFile();
    for (const std::size_t t : {2u, 5u, 7u}) turn(mesh, t);
    const SolidMesh solid = solidMesh(mesh);
    EXPECT_TRUE(solid.found.oriented());
    EXPECT_EQ(solid.found.turned, 3u);
    EXPECT_EQ(solid.found.text(), "3 faces turned the other way");
    EXPECT_NEAR(solid.volume, 8.0, 1e-12);
}

TEST(SolidMesh, AMeshInsideOutIsTurned) {
    TriangleMesh mesh = cubeFile();
    turnAll(mesh);
    const SolidMesh solid = solidMesh(mesh);
    EXPECT_TRUE(solid.found.insideOut);
    EXPECT_NEAR(solid.volume, 8.0, 1e-12);
    EXPECT_EQ(solid.indices.size(), 36u);
}

TEST(SolidMesh, ACavityStaysOneAndATurnedNeighbourDoesNot) {
    TriangleMesh cavity = movedFile(cubeFile(), {0.0f, 0.0f, 0.0f}, 0.5f);
    turnAll(cavity);
    EXPECT_NEAR(solidMesh(joinedFile(cubeFile(), cavity)).volume, 8.0 - 1.0, 1e-12);
    // All of it inside out: still a cavity.
    TriangleMesh both = joinedFile(cubeFile(), cavity);
    turnAll(both);
    EXPECT_NEAR(solidMesh(both).volume, 8.0 - 1.0, 1e-12);
    // Beside it: a solid that was turned the wrong way.
    TriangleMesh beside = movedFile(cubeFile(), {4.0f, 0.0f, 0.0f}, 0.5f);
    turnAll(beside);
    const SolidMesh solid = solidMesh(joinedFile(cubeFile(), beside));
    EXPECT_NEAR(solid.volume, 8.0 + 1.0, 1e-12);
    EXPECT_EQ(solid.found.turned, 12u);
    EXPECT_EQ(solid.found.parts, 2u);
}

TEST(SolidMesh, HolesCrowdedEdgesAndCopiesAreCounted) {
    TriangleMesh open = cubeFile();
    open.indices.resize(33);
    EXPECT_EQ(solidMesh(open).found.openEdges, 3u);
    EXPECT_FALSE(solidMesh(open).found.closed());
    EXPECT_EQ(solidMesh(open).found.text(), "3 open edges");

    TriangleMesh twice = cubeFile();
    twice.indices.insert(twice.indices.end(), {twice.indices[1], twice.indices[2], twice.indices[0]});
    twice.indices.insert(twice.indices.end(), {3, 3, 4});
    const SolidMesh solid = solidMesh(twice);
    EXPECT_EQ(solid.found.copies, 1u);
    EXPECT_EQ(solid.found.collapsed, 1u);
    EXPECT_TRUE(solid.found.oriented());

    // Two cubes with an edge in common.
    const SolidMesh touching =
        solidMesh(joinedFile(cubeFile(), movedFile(cubeFile(), {2.0f, 2.0f, 0.0f}, 1.0f)));
    EXPECT_EQ(touching.found.crowded, 4u);
    EXPECT_FALSE(touching.found.closed());
}

TEST(SolidMesh, AMoebiusStripCannotAgree) {
    TriangleMesh strip;
    constexpr int around = 24;
    for (int i = 0; i < around; ++i) {
        const double a = 2.0 * std::numbers::pi * i / around, half = 0.5 * a;
        for (const double side : {-0.3, 0.3}) {
            const double r = 1.0 + side * std::cos(half);
            strip.positions.emplace_back(r * std::cos(a), side * std::sin(half), r * std::sin(a));
        }
    }
    for (uint32_t i = 0; i < around; ++i) {
        const bool last = i + 1 == around;
        const uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        strip.indices.insert(strip.indices.end(), {a, b, c, c, b, d});
    }
    EXPECT_EQ(solidMesh(strip).found.oneSided, 1u);
    EXPECT_FALSE(solidMesh(strip).found.oriented());
}

TEST(SolidMesh, NormalsOfACubesFeatures) {
    const SolidMesh solid = solidMesh(cubeFile());
    const std::vector<FeatureNormals> normals = featureNormals(solid);
    ASSERT_EQ(normals.size(), 12u);
    for (std::size_t t = 0; t < 12; ++t) {
        const FeatureNormals& of = normals[t];
        for (std::size_t k = 0; k < 3; ++k) {
            // A corner's normal goes through the corner, however its sides are cut into triangles.
            const glm::vec3 corner = solid.positions[solid.indices[3 * t + k]];
            EXPECT_NEAR(glm::dot(of[4 + k], glm::normalize(corner)), 1.0f, 1e-6f);
            const glm::vec3 next = solid.positions[solid.indices[3 * t + (k + 1) % 3]];
            const float edge = glm::length(next - corner);
            // A side's is between its faces', or that of both where it is a diagonal.
            const float wanted = edge > 2.5f ? 1.0f : float(std::sqrt(0.5));
            EXPECT_NEAR(glm::dot(of[1 + k], of[0]), wanted, 1e-6f);
        }
        EXPECT_NEAR(glm::length(of[0]), 1.0f, 1e-6f);
    }
}

}  // namespace fw::solid_mesh_test
