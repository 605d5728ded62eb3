// Collapses: whatever the mesh, it stays closed, manifold and uncut, and borders and creases where they are.
#include "runtime/stages/collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <random>

#include "runtime/measure/mesh_report.h"
#include "runtime/stages/decimate.h"
#include "tests/support/meshes.h"

namespace fw::collapse_test {

const bool kLong = std::getenv("FIELDWRIGHT_LONG") != nullptr;

Report reportOn(const Mesh& mesh, std::span<const uint32_t> indices) {
    MeasureOptions options;
    options.selfIntersections = true;
    return reportOnMesh(mesh.positions, indices, options);
}

/// The cube [-1,1]^3 with so many quads along an edge, cut in two.
Mesh finerCube(int cells) {
    Mesh soup;
    const auto vertex = [&](glm::vec3 place) {
        for (uint32_t v = 0; v < soup.positions.size(); ++v)
            if (soup.positions[v] == place) return v;
        soup.positions.push_back(place);
        soup.normals.push_back(glm::normalize(place));
        return uint32_t(soup.positions.size() - 1);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1})
            for (int i = 0; i < cells; ++i)
                for (int j = 0; j < cells; ++j) {
                    const auto at = [&](int x, int y) {
                        glm::vec3 place;
                        place[axis] = float(side);
                        place[(axis + 1) % 3] = -1.0f + 2.0f * float(x) / float(cells);
                        place[(axis + 2) % 3] = -1.0f + 2.0f * float(y) / float(cells);
                        return vertex(place);
                    };
                    uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
                    if (side < 0) std::swap(b, d);
                    for (const uint32_t index : {a, b, c, a, c, d}) soup.indices.push_back(index);
                }
    return soup;
}

TEST(Collapse, ACubeOfManyTrianglesBecomesOneOfTwelve) {
    const Mesh cube = finerCube(12);
    const std::vector<uint32_t> left = collapse(cube, {.distance = 1e-5});
    const Report report = reportOn(cube, left);
    EXPECT_EQ(report.triangles, 12u);
    EXPECT_NEAR(report.volume, 8.0, 1e-9);
    EXPECT_TRUE(report.closedManifold());
}

TEST(Collapse, CreasesStayThoughTheDistanceWouldAllowMore) {
    // Cells of a sixth, and a third of that to go: a bevel would cost no more than what else there is.
    const Mesh cube = finerCube(12);
    const Report report = reportOn(cube, collapse(cube, {.distance = 0.06}));
    EXPECT_NEAR(report.volume, 8.0, 1e-9);
}

TEST(Collapse, NoPartTurnsInsideOutOnTheWayToATetrahedron) {
    std::mt19937 random(3);
    for (int number = 0; number < 200; ++number) {
        Mesh box = finerCube(1 + int(random() % 5));
        const glm::vec3 size(1.0f, 0.01f + 0.1f * float(random() % 10), 0.01f + 0.1f * float(random() % 10));
        for (glm::vec3& place : box.positions) place *= size;
        for (const bool hollow : {false, true}) {
            if (hollow)
                for (std::size_t i = 0; i < box.indices.size(); i += 3)
                    std::swap(box.indices[i], box.indices[i + 1]);
            const Report report = reportOn(box, collapse(box, {.triangles = 4}));
            EXPECT_TRUE(report.closedManifold());
            EXPECT_LE(report.triangles, 6u);
            EXPECT_GT(hollow ? -report.volume : report.volume, 0.0) << number;
        }
    }
}

TEST(Collapse, RandomMeshesStayClosedManifoldAndUncut) {
    const int meshes = kLong ? 400 : 25;
    for (int number = 0; number < meshes; ++number) {
        std::mt19937 random{uint32_t(number)};
        const auto any = [&](double lo, double hi) {
            return lo + (hi - lo) * double(random()) / 4294967295.0;
        };
        const int around = 8 + int(random() % 40), across = 5 + int(random() % 30);
        Mesh mesh = test::torus(around, across, 1.0, any(0.15, 0.6));
        const double waves = any(1, 12), height = any(0.0, 0.05),
                     noise = number % 3 == 0 ? 0.0 : any(0, 0.004);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const glm::vec3 p = mesh.positions[v];
            mesh.positions[v] +=
                mesh.normals[v] * float(height * std::sin(waves * p.x) * std::sin(waves * p.z));
            for (int k = 0; k < 3; ++k) mesh.positions[v][k] += float(any(-noise, noise));
        }
        if (number % 4 == 1) mesh = test::join(mesh, test::moved(mesh, {0.0f, 0.9f, 0.3f}));
        if (number % 5 == 2) test::paint(mesh);
        const Report before = reportOn(mesh, mesh.indices);
        for (const std::size_t wanted :
             {mesh.triangleCount() / 2, mesh.triangleCount() / 10, std::size_t{4}}) {
            const Report after = reportOn(mesh, collapse(mesh, {.triangles = wanted}));
            ASSERT_TRUE(after.closedManifold()) << number;
            ASSERT_EQ(after.eulerCharacteristic, before.eulerCharacteristic) << number;
            ASSERT_EQ(after.shells, before.shells) << number;
            if (before.selfIntersections != 0) continue;
            ASSERT_EQ(after.selfIntersections, 0u) << number;
            ASSERT_LE(after.triangles, std::max<std::size_t>(wanted, 4 * 14)) << number;
        }
        const double distance = any(0.002, 0.05);
        const Report after = reportOn(mesh, collapse(mesh, {.distance = distance}));
        ASSERT_TRUE(after.closedManifold()) << number;
        ASSERT_LE(std::abs(after.volume - before.volume), 1.5 * distance * before.area) << number;
        const uint64_t most = before.selfIntersections == 0 ? 0 : after.triangles * after.triangles;
        ASSERT_LE(after.selfIntersections, most) << number;
    }
}

TEST(Collapse, ASurfaceNearAnotherIsNotPushedThroughIt) {
    // Two sheets a fiftieth apart: bumpy tori, one in the other, whose facets would cut each other.
    Mesh outer = test::torus(80, 40, 1.0, 0.3), inner = test::torus(80, 40, 1.0, 0.285);
    for (std::size_t i = 0; i < inner.indices.size(); i += 3)
        std::swap(inner.indices[i], inner.indices[i + 1]);
    const Mesh both = test::join(outer, inner);
    ASSERT_EQ(reportOn(both, both.indices).selfIntersections, 0u);
    for (const std::size_t wanted : {2000u, 600u, 100u}) {
        const Report report = reportOn(both, collapse(both, {.triangles = wanted}));
        EXPECT_EQ(report.selfIntersections, 0u);
        EXPECT_EQ(report.shells, 2u);
        EXPECT_TRUE(report.closedManifold());
    }
}

/// A torus, finely cut, with one colour or label on each side of a plane that is not along its quads.
bool isLeft(const glm::vec3& p) { return p.x + 0.4f * p.z > 0.13f; }

/// The farthest from the plane that a point of the triangles has less than two thirds of its side's colour.
double widthOfBorder(const Mesh& mesh, std::span<const uint32_t> indices) {
    double most = 0.0;
    for (std::size_t i = 0; i < indices.size(); i += 3)
        for (int u = 0; u <= 16; ++u)
            for (int v = 0; u + v <= 16; ++v) {
                const float weights[] = {float(u) / 16, float(v) / 16, float(16 - u - v) / 16};
                glm::vec3 place(0.0f), color(0.0f);
                for (std::size_t k = 0; k < 3; ++k) {
                    place += weights[k] * mesh.positions[indices[i + k]];
                    color += weights[k] * mesh.colors[indices[i + k]];
                }
                const bool left = isLeft(place);
                if ((left ? color.r : color.b) > 0.67f) continue;
                most = std::max(most, std::abs(place.x + 0.4 * place.z - 0.13) / std::hypot(1.0, 0.4));
            }
    return most;
}

TEST(Collapse, ABorderBetweenColoursStaysWhereItIs) {
    Mesh mesh = test::torus(200, 80);
    for (const glm::vec3& p : mesh.positions)
        mesh.colors.push_back(isLeft(p) ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1));
    const double cell = 2.0 * 3.1416 * 1.25 / 200;
    ASSERT_LT(widthOfBorder(mesh, mesh.indices), cell);
    const std::vector<uint32_t> within = collapse(mesh, {.distance = 0.02});
    EXPECT_LT(within.size(), mesh.indices.size() / 20);
    EXPECT_LE(widthOfBorder(mesh, within), 0.02 + cell);

    const std::vector<uint32_t> few = collapse(mesh, {.triangles = 1000});
    EXPECT_LE(few.size(), 3000u);
    EXPECT_LE(widthOfBorder(mesh, few), 1.5 * cell);

    // The same without colours: what the border costs, and that it would be lost.
    Mesh plain = mesh;
    plain.colors.clear();
    EXPECT_GT(widthOfBorder(mesh, collapse(plain, {.triangles = 1000})), 2.0 * cell);
}

// Where borders need more triangles than are wanted, they are given up before the shape is.
TEST(Collapse, FewerTrianglesThanItsBordersNeedKeepTheShape) {
    Mesh mesh = test::torus(200, 80);
    const double whole = reportOn(mesh, mesh.indices).volume;
    for (const glm::vec3& p : mesh.positions)  // dots all over it
        mesh.colors.push_back(std::sin(20.0f * p.x) * std::sin(20.0f * p.y) * std::sin(20.0f * p.z) > 0.2f
                                  ? glm::vec3(1)
                                  : glm::vec3(1, 0, 0));
    for (const std::size_t wanted : {2000u, 600u}) {
        const Report report = reportOn(mesh, collapse(mesh, {.triangles = wanted}));
        EXPECT_LE(report.triangles, wanted);
        EXPECT_GT(report.volume, 0.93 * whole) << wanted;
        EXPECT_LT(report.volume, 1.02 * whole) << wanted;
        EXPECT_EQ(report.selfIntersections, 0u);
        EXPECT_TRUE(report.closedManifold());
    }
}

TEST(Collapse, ABorderBetweenMaterialsStaysWhereItIs) {
    Mesh mesh = test::torus(200, 80);
    std::vector<uint32_t> labels;
    for (const glm::vec3& p : mesh.positions) labels.push_back(isLeft(p));
    Mesh painted = mesh;  // by the labels, to measure it
    for (const uint32_t label : labels) painted.colors.emplace_back(float(label), 0.0f, 1.0f - float(label));
    const double cell = 2.0 * 3.1416 * 1.25 / 200;
    EXPECT_LE(widthOfBorder(painted, collapse(mesh, {.triangles = 1000, .labels = labels})), 2.0 * cell);
    EXPECT_LE(widthOfBorder(painted, collapse(mesh, {.distance = 0.02, .labels = labels})),
              0.02 + 1.5 * cell);
}

TEST(Collapse, WhatIsNoSolidKeepsItsBordersAndItsKnots) {
    Mesh open = test::torus(40, 30);
    open.indices.resize(open.indices.size() - 3 * 200);
    const Report before = reportOn(open, open.indices);
    ASSERT_GT(before.boundaryEdges, 0u);
    const Report after = reportOn(open, collapse(open, {.triangles = 300}));
    EXPECT_EQ(after.boundaryEdges, before.boundaryEdges);
    EXPECT_EQ(after.nonManifoldEdges, 0u);
    EXPECT_EQ(after.nonManifoldVertices, before.nonManifoldVertices);
    EXPECT_EQ(after.eulerCharacteristic, before.eulerCharacteristic);
    EXPECT_LE(after.triangles, 400u);

    // Two that share a vertex, and a fin at an edge.
    Mesh knot = test::join(test::torus(30, 20), test::moved(test::torus(30, 20), {2.6f, 0.0f, 0.0f}));
    const std::size_t half = knot.positions.size() / 2;
    for (uint32_t& index : knot.indices)
        if (index == half) index = 0;
    knot.positions.push_back({0, 3, 0});
    knot.normals.push_back({0, 1, 0});
    for (const uint32_t index : {knot.indices[300], knot.indices[301], uint32_t(knot.positions.size() - 1)})
        knot.indices.push_back(index);
    const Report knotted = reportOn(knot, knot.indices),
                 fewer = reportOn(knot, collapse(knot, {.triangles = 500}));
    EXPECT_EQ(fewer.nonManifoldEdges, knotted.nonManifoldEdges);
    EXPECT_EQ(fewer.nonManifoldVertices, knotted.nonManifoldVertices);
    EXPECT_EQ(fewer.boundaryEdges, knotted.boundaryEdges);
    EXPECT_LE(fewer.triangles, 500u);
}

TEST(Collapse, PlacesThatAreNoNumbersStay) {
    Mesh mesh = test::torus(40, 30);
    mesh.positions[77].y = NAN;
    mesh.positions[500] = glm::vec3(INFINITY);
    const std::vector<uint32_t> left = collapse(mesh, {.triangles = 400});
    EXPECT_LE(left.size() / 3, 400u);
    EXPECT_NE(std::ranges::find(left, 77u), left.end());
    EXPECT_NE(std::ranges::find(left, 500u), left.end());
    for (glm::vec3& place : mesh.positions) place = glm::vec3(NAN);
    EXPECT_EQ(collapse(mesh, {.triangles = 4}), mesh.indices);
}

TEST(Collapse, TrianglesThatAreNoneAndOnePointAreNoTrouble) {
    Mesh point;
    point.positions.assign(8, glm::vec3(1.0f));
    point.normals.assign(8, glm::vec3(0, 1, 0));
    point.indices = test::cube().indices;
    EXPECT_EQ(collapse(point, {.triangles = 4}).size(), point.indices.size());
    Mesh twice = test::cube();
    for (const uint32_t index : {0u, 0u, 1u}) twice.indices.push_back(index);
    EXPECT_TRUE(reportOn(twice, collapse(twice, {.triangles = 4})).closedManifold());
    EXPECT_TRUE(collapse(Mesh(), {.triangles = 4}).empty());
    const Mesh least = test::tetrahedron();
    EXPECT_EQ(collapse(least, {.triangles = 1}).size(), least.indices.size());
}

}  // namespace fw::collapse_test
