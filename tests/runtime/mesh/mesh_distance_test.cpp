// Distances between mesh and surface, and triangles that cut each other, against what is known of simple
// solids.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "graph/assets/triangle_tree.h"
#include "graph/document/json.h"
#include "runtime/measure/field_measure.h"
#include "tests/support/meshes.h"

namespace fw::mesh_distance_test {

Program programOf(const std::string& code) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "code", "type": "expression", "code": ")" +
                                               code + R"("},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "code"}}}]})",
                                           "a.field.json", nullptr);
    EXPECT_TRUE(graph);
    Result<Program> program = compile(*graph);
    EXPECT_TRUE(program) << (program ? "" : format(program.error()));
    return std::move(*program);
}

Box cube(double half) { return {{-half, -half, -half}, {half, half, half}}; }

uint64_t cuts(const Mesh& mesh) {
    return reportOnMesh(mesh.positions, mesh.indices, {.selfIntersections = true}).selfIntersections.value();
}

TEST(TriangleTree, TheDistanceIsTheLeastOfAllTriangles) {
    const Mesh mesh = test::torus(24, 12);
    const TriangleTree tree(mesh.positions, mesh.indices);
    std::vector<TriangleTree> each;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
        each.emplace_back(mesh.positions, std::span(mesh.indices).subspan(t, 3));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-2.0, 2.0);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 point(any(random), any(random), any(random));
        double least = std::numeric_limits<double>::infinity();
        for (const TriangleTree& one : each) least = std::min(least, one.distance(point));
        EXPECT_EQ(tree.distance(point), least);
    }
}

TEST(TriangleTree, DistancesToACubeAreExact) {
    const Mesh mesh = test::cube();  // of half extent 1
    const TriangleTree tree(mesh.positions, mesh.indices);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-3.0, 3.0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 p(any(random), any(random), any(random)), q = glm::abs(p) - 1.0;
        const double wanted =
            glm::length(glm::max(q, glm::dvec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
        EXPECT_NEAR(tree.distance(p), std::abs(wanted), 1e-12);
    }
    EXPECT_EQ(TriangleTree({}, {}).distance({}), std::numeric_limits<double>::infinity());
}

TEST(SelfIntersections, AreTheCutsOfTrianglesAndNotTheirTouches) {
    EXPECT_EQ(cuts(test::cube()), 0u);
    EXPECT_EQ(cuts(test::torus(100, 50)), 0u);
    // Beside it, on it, at one corner, and within it: nothing is cut.
    for (const glm::vec3 by : {glm::vec3(3, 0, 0), glm::vec3(2, 0, 0), glm::vec3(2, 2, 2), glm::vec3(0)})
        EXPECT_EQ(cuts(test::join(test::cube(), test::moved(test::cube(), by))), 0u);
    // Halfway into it along all axes: each of three faces cuts three of the other, along one segment a pair.
    EXPECT_GT(cuts(test::join(test::cube(), test::moved(test::cube(), glm::vec3(0.9f, 0.8f, 0.7f)))), 6u);
    // One triangle through another, which is counted once; sharing a corner with it; sharing two.
    const auto pair = [](std::vector<glm::vec3> positions, std::vector<uint32_t> indices) {
        Mesh mesh;
        mesh.positions = std::move(positions), mesh.indices = std::move(indices);
        return cuts(mesh);
    };
    const std::vector<glm::vec3> floor = {{-1, 0, -1}, {1, 0, -1}, {0, 0, 2}};
    const auto with = [&](std::vector<glm::vec3> more) {
        more.insert(more.begin(), floor.begin(), floor.end());
        return more;
    };
    EXPECT_EQ(pair(with({{0, -1, 0}, {0, 1, 0}, {5, 1, 0}}), {0, 1, 2, 3, 4, 5}), 1u);
    EXPECT_EQ(pair(with({{0.1f, -1, 0.5f}, {0, 1, 0.5f}}), {0, 1, 2, 0, 3, 4}), 1u);
    EXPECT_EQ(pair(with({{0, 1, 0}}), {0, 1, 2, 0, 1, 3}), 0u);
    EXPECT_EQ(pair(with({{3, 1, 0}, {3, -1, 0}, {4, 0, 0}}), {0, 1, 2, 3, 4, 5}), 0u);
}

TEST(SurfacePoints, LieOnTheSurfaceAndSpreadEvenly) {
    const Program ball = programOf("return length(p) - 1;");
    const std::vector<SurfacePoint> points = surfacePoints(ball, cube(1.3), 6000);
    // Each of n lines, spread over the three faces of the region, meets the ball twice in its disc.
    EXPECT_NEAR(double(points.size()), 6000 * 2 * std::numbers::pi / (2.6 * 2.6), 300);
    double weights = 0.0, height = 0.0, upper = 0.0;
    for (const SurfacePoint& point : points) {
        EXPECT_NEAR(glm::length(point.position), 1.0, 1e-7);
        weights += point.weight;
        height += point.weight * std::abs(point.position.y);
        upper += point.position.y > 0 ? point.weight : 0.0;
    }
    EXPECT_NEAR(height / weights, 0.5, 0.02);  // Archimedes
    EXPECT_NEAR(upper / weights, 0.5, 0.02);
}

TEST(SurfacePoints, AreFoundWhereIntervalsSayNothing) {
    const Program ball = programOf(
        "float one = cos(p.x) * cos(p.x) + sin(p.x) * sin(p.x); return length(p) - 1 + 300 * (one - 1);");
    const std::vector<SurfacePoint> points = surfacePoints(ball, cube(1.3), 6000);
    EXPECT_NEAR(double(points.size()), 6000 * 2 * std::numbers::pi / (2.6 * 2.6), 300);
    for (const SurfacePoint& point : points) EXPECT_NEAR(glm::length(point.position), 1.0, 1e-7);
}

TEST(SurfacePoints, AreFewerOfAFieldThatTakesLong) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const Program slow = programOf(
        "float s = 0; for (int i = 1; i < 1000; ++i) s += sin(p.x * float(i) + p.y); "
        "return length(p) - 1 + 1e-9 * s;");
    const std::vector<SurfacePoint> points = surfacePoints(slow, cube(1.3), 12000, Points::affordable);
    EXPECT_GT(points.size(), 30u);
    EXPECT_LT(points.size(), 3000u);
    // But not where something relies on them.
    EXPECT_NEAR(double(surfacePoints(slow, cube(1.3), 300).size()), 300 * 2 * std::numbers::pi / (2.6 * 2.6),
                60);
    EXPECT_LT(measureOf(slow, cube(1.3), Points::affordable).samples,
              measureOf(programOf("return length(p) - 1;"), cube(1.3), Points::affordable).samples);
    for (const SurfacePoint& point : points) EXPECT_NEAR(glm::length(point.position), 1.0, 1e-5);
}

TEST(SurfacePoints, FindWhatIsThinnerThanAnyCell) {
    // A sheet of a tenth of a millimetre in a region of two metres: lines across it meet both sides.
    const Program sheet = programOf("return max(abs(p.y) - 0.00005, max(abs(p.x), abs(p.z)) - 0.5);");
    std::size_t above = 0, below = 0;
    for (const SurfacePoint& point : surfacePoints(sheet, cube(1.0), 3000)) {
        if (std::abs(point.position.y - 0.00005) < 1e-7) ++above;
        if (std::abs(point.position.y + 0.00005) < 1e-7) ++below;
    }
    EXPECT_NEAR(double(above), 250, 60);
    EXPECT_NEAR(double(below), 250, 60);
}

TEST(MeshDistances, BothWaysOfACubeAndItsBall) {
    // From a cube of half extent 1 to the ball in it, and back: its corners and the middles of its faces.
    const Program ball = programOf("return length(p) - 1;");
    const Mesh mesh = test::cube();
    const Report report = reportOnMesh(mesh.positions, mesh.indices, measureOf(ball, cube(1.5)));
    ASSERT_TRUE(report.meshToSurface && report.surfaceToMesh);
    EXPECT_NEAR(report.meshToSurface->max, std::sqrt(3.0) - 1.0, 0.02);
    EXPECT_LE(report.meshToSurface->max, std::sqrt(3.0) - 1.0 + 1e-9);
    EXPECT_NEAR(report.surfaceToMesh->max, 1.0 - 1.0 / std::sqrt(3.0), 0.01);
    EXPECT_LE(report.surfaceToMesh->max, 1.0 - 1.0 / std::sqrt(3.0) + 1e-7);
    // The mean of sqrt(1 + u^2 + v^2) - 1 over the unit square, and of 1 - max(|x|, |y|, |z|) over the ball.
    EXPECT_NEAR(report.meshToSurface->mean, 0.2808, 0.005);
    EXPECT_NEAR(report.surfaceToMesh->mean, 0.1665, 0.005);
}

TEST(MeshDistances, APartThatTheMeshLacksIsFar) {
    const Program pair = programOf("return min(length(p) - 1, length(p - vec3(4, 0, 0)) - 0.25);");
    const Mesh mesh = test::cube();
    const Report report =
        reportOnMesh(mesh.positions, mesh.indices, measureOf(pair, {{-1.5, -1.5, -1.5}, {4.5, 1.5, 1.5}}));
    EXPECT_NEAR(report.surfaceToMesh->max, 3.25, 0.02);
    EXPECT_LT(report.meshToSurface->max, 0.74);
}

TEST(MeshDistances, WhereTheRegionClosesTheSolidTheMeshIsRight) {
    const Program everything = programOf("return p.y - 5;");
    const Mesh mesh = test::cube();
    const Report report = reportOnMesh(mesh.positions, mesh.indices, measureOf(everything, cube(1.0)));
    EXPECT_NEAR(report.meshToSurface->max, 0.0, 1e-9);
    EXPECT_FALSE(report.surfaceToMesh);  // there is no surface in the region
}

TEST(MeshReport, AnglesAreThoseOfTheTriangles) {
    const Report cube = reportOnMesh(test::cube().positions, test::cube().indices);
    EXPECT_NEAR(cube.smallestAngle, 45.0, 1e-9);
    EXPECT_NEAR(cube.largestAngle, 90.0, 1e-9);
    const Report sliver = reportOnMesh(std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0.5f, 0.001f, 0}},
                                       std::vector<uint32_t>{0, 1, 2});
    EXPECT_NEAR(sliver.largestAngle, 180.0 - 2.0 * std::atan(0.002) * 180.0 / std::numbers::pi, 1e-6);
}

}  // namespace fw::mesh_distance_test
