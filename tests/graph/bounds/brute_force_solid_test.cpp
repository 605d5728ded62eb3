// The brute-force oracle, judged by solids whose volume, bounds and distance are known, and the reference
// field, judged by tapes.
#include "tests/support/graph/brute_force_solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "graph/assets/mesh_field.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "tests/support/graph/random_scene.h"
#include "tests/support/graph/triangle_meshes.h"

namespace fw::brute_force_solid_test {

using test::BruteForceSolid;
using test::NearestSurface;
using test::PointField;

constexpr double kPi = std::numbers::pi;

double boxDistance(const Point& p, const Point& centre, const Point& half) {
    double outside = 0.0, inside = -INFINITY;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double beyond = std::abs(p[axis] - centre[axis]) - half[axis];
        outside += std::pow(std::max(beyond, 0.0), 2.0);
        inside = std::max(inside, beyond);
    }
    return inside < 0.0 ? inside : std::sqrt(outside);
}

double torusDistance(const Point& p) { return std::hypot(std::hypot(p[0], p[2]) - 1.0, p[1]) - 0.3; }

double shellDistance(const Point& p) { return std::abs(std::hypot(p[0] - 0.2, p[1], p[2]) - 0.9) - 0.1; }

struct KnownSolid {
    const char* name;
    double (*distance)(const Point&);  ///< exact
    double volume;
    Box bounds;
    std::size_t bodies;
};

const KnownSolid kKnownSolids[] = {
    {"sphere",
     [](const Point& p) { return std::hypot(p[0] - 0.1, p[1] + 0.2, p[2]) - 0.8; },
     4.0 / 3.0 * kPi * 0.512,
     {{-0.7, -1.0, -0.8}, {0.9, 0.6, 0.8}},
     1},
    {"box",
     [](const Point& p) {
         return boxDistance(p, {0.1, 0, 0}, {0.7, 0.4, 0.9});
     },
     8 * 0.7 * 0.4 * 0.9,
     {{-0.6, -0.4, -0.9}, {0.8, 0.4, 0.9}},
     1},
    {"two boxes",
     [](const Point& p) {
         return std::min(boxDistance(p, {-0.7, 0, 0}, {0.4, 0.4, 0.4}),
                         boxDistance(p, {0.7, 0.5, 0.2}, {0.5, 0.3, 0.6}));
     },
     8 * (0.064 + 0.09),
     {{-1.1, -0.4, -0.4}, {1.2, 0.8, 0.8}},
     2},
    {"torus", torusDistance, 2 * kPi* kPi * 0.09, {{-1.3, -0.3, -1.3}, {1.3, 0.3, 1.3}}, 1},
    {"shell", shellDistance, 4.0 / 3.0 * kPi*(1.0 - 0.512), {{-0.8, -1, -1}, {1.2, 1, 1}}, 1},
};

Point randomPoint(test::SceneRandom& random, double size) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

TEST(BruteForceSolid, MeasuresKnownSolids) {
    for (const KnownSolid& known : kKnownSolids) {
        SCOPED_TRACE(known.name);
        const BruteForceSolid solid = sampleByBruteForce(
            test::pointField(known.distance), test::gridOver(Box{{-1.5, -1.4, -1.5}, {1.5, 1.4, 1.5}}, 60));
        EXPECT_FALSE(solid.touchesGrid);
        EXPECT_EQ(solid.bodies.size(), known.bodies);
        EXPECT_TRUE(solid.isBodyCountCertain());
        EXPECT_NEAR(solid.volume, known.volume, solid.volumeError + 1e-12);
        EXPECT_LT(solid.volumeError, 0.003 * known.volume);
        ASSERT_TRUE(solid.bounds);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_GE(solid.bounds->lo[axis], known.bounds.lo[axis] - 1e-12);
            EXPECT_LE(solid.bounds->lo[axis], known.bounds.lo[axis] + solid.boundsError);
            EXPECT_LE(solid.bounds->hi[axis], known.bounds.hi[axis] + 1e-12);
            EXPECT_GE(solid.bounds->hi[axis], known.bounds.hi[axis] - solid.boundsError);
        }
    }
}

TEST(BruteForceSolid, FindsTheDistanceToTheSurface) {
    for (const KnownSolid& known : kKnownSolids) {
        SCOPED_TRACE(known.name);
        const PointField field = test::pointField(known.distance);
        const BruteForceSolid solid = sampleByBruteForce(field, test::gridOver(cubeAround(1.5), 40));
        test::SceneRandom random(3);
        for (int i = 0; i < 60; ++i) {
            const Point point = randomPoint(random, 2.0);
            const NearestSurface nearest = nearestSurface(field, solid, point);
            const double distance = std::abs(known.distance(point));
            EXPECT_GE(nearest.distance + nearest.rounding, distance);
            EXPECT_LE(nearest.distance - nearest.error, distance);
            // The search around the best sign change is far better than the bound.
            EXPECT_NEAR(nearest.distance, distance, 0.05 * solid.grid.step);
            EXPECT_NEAR(known.distance(nearest.at), 0.0, 1e-9);
        }
    }
}

TEST(BruteForceSolid, TellsWhatItCannotBeSureOf) {
    // Two boxes that touch along an edge are two by faces and one by corners.
    const auto touching = [](const Point& p) {
        return std::min(boxDistance(p, {-0.5, -0.5, 0}, {0.5, 0.5, 0.5}),
                        boxDistance(p, {0.5, 0.5, 0}, {0.5, 0.5, 0.5}));
    };
    const BruteForceSolid edge =
        sampleByBruteForce(test::pointField(touching), test::gridOver(cubeAround(1.5), 30));
    EXPECT_EQ(edge.bodies.size(), 2u);
    EXPECT_EQ(edge.bodiesByCorners, 1u);
    EXPECT_FALSE(edge.isBodyCountCertain());
    // A solid that the grid cuts off.
    const BruteForceSolid cut =
        sampleByBruteForce(test::pointField(torusDistance), test::gridOver(cubeAround(1.0), 30));
    EXPECT_TRUE(cut.touchesGrid);
    // Nothing at all.
    const BruteForceSolid nothing = sampleByBruteForce(test::pointField([](const Point&) { return NAN; }),
                                                       test::gridOver(cubeAround(1.0), 8));
    EXPECT_FALSE(nothing.bounds);
    EXPECT_EQ(nothing.volume, 0.0);
    EXPECT_TRUE(std::isinf(nearestSurface(test::pointField(torusDistance), nothing, {}).distance));
}

TEST(BruteForceSolid, NoticesASolidThatIsALittleDifferent) {
    const auto sphereOf = [](double radius) {
        return sampleByBruteForce(
            test::pointField([radius](const Point& p) { return std::hypot(p[0], p[1], p[2]) - radius; }),
            test::gridOver(cubeAround(1.2), 48));
    };
    const BruteForceSolid one = sphereOf(1.0), other = sphereOf(1.002);
    EXPECT_GT(other.volume - one.volume, one.volumeError);
    EXPECT_GT(other.bounds->hi[0] - one.bounds->hi[0], 0.0);
}

TEST(BruteForceSolid, AgreesWithTheVolumeOfAMesh) {
    const TriangleMesh mesh = test::torusFile(96, 48);
    const Result<FieldVolumePtr> baked = bakeOnHost({.mesh = test::shared(mesh), .resolution = 96});
    ASSERT_TRUE(baked) << format(baked.error());
    Ir ir;
    const IrId distance =
        ir.sample(ir.addVolume(*baked), tricubicChannel, {ir.position(0), ir.position(1), ir.position(2)});
    const BruteForceSolid solid =
        sampleByBruteForce(test::ReferenceField(ir, distance, {}), test::gridOver(cubeAround(1.5), 48));
    const SolidMesh closed = solidMesh(mesh);
    EXPECT_EQ(solid.bodies.size(), closed.found.parts);
    // Values between the samples of the baked grid add to the error of the oracle.
    EXPECT_NEAR(solid.volume, closed.volume, solid.volumeError + 0.003 * closed.volume);
}

TEST(ReferenceField, AgreesWithTapes) {
    for (uint32_t seed = 1; seed <= 16; ++seed) {
        const test::RandomScene scene = test::randomScene(seed);
        const Result<Graph> graph = parseGraph(scene.json, "", nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        const Result<Program> program = compile(*graph);
        if (!program) continue;
        const test::ReferenceField reference(*program);
        test::SceneRandom random(seed);
        std::vector<Point> points;
        for (const test::SceneAnchor& anchor : scene.anchors)
            for (int i = 0; i < 50; ++i) {
                Point point = randomPoint(random, 1.5 * anchor.radius);
                for (std::size_t axis = 0; axis < 3; ++axis) point[axis] += anchor.centre[axis];
                points.push_back(point);
            }
        std::vector<double> expected(points.size()), values(points.size());
        reference(points, expected);
        evaluate(program->ir, program->distance(), program->parameters(), points, values);
        for (std::size_t i = 0; i < points.size(); ++i)
            ASSERT_NEAR(values[i], expected[i], 1e-9 * std::max(1.0, std::abs(expected[i])))
                << "scene " << seed << " at " << test::sceneVector(points[i]) << "\n"
                << scene.json;
        EXPECT_EQ(reference(points[0]), expected[0]);
    }
}

}  // namespace fw::brute_force_solid_test
