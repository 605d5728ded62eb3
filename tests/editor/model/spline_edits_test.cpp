// What a hand does to a spline's knots: by functions, and in the picture.
#include "editor/splines/edits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "editor/splines/shown.h"
#include "editor/viewport/gizmo.h"
#include "editor/viewport/grips.h"
#include "graph/document/json.h"

namespace fw::editor::spline_edits_test {

using namespace splines;

Knots randomKnots(std::mt19937& random, std::size_t count, SplineKind kind, bool closed) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Knots knots{.kind = kind, .closed = closed};
    for (std::size_t i = 0; i < count; ++i)
        knots.numbers.insert(knots.numbers.end(),
                             {unit(random), unit(random), unit(random), 1.5 + unit(random), 0});
    return knots;
}

/// How far the places of one spline are from another, at most.
double apart(const Knots& a, const Knots& b) {
    const SplinePtr from = splineOf(a), to = splineOf(b);
    double most = 0;
    for (const SpaceArc& arc : from->arcs) {
        double least = 1e300;
        for (const SpaceArc& other : to->arcs)
            least = std::min(least, nearestOn({.middle = other.middle,
                                               .along = other.along,
                                               .towards = other.towards,
                                               .bend = other.bend,
                                               .half = other.half},
                                              arc.middle)
                                        .distance);
        most = std::max(most, least);
    }
    return most;
}

Graph documentOf(const std::string& nodes) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]}", "", nullptr);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    return graph ? *graph : Graph{};
}

TEST(SplineEdits, APointThatIsAddedLiesOnTheSpline) {
    std::mt19937 random(4);
    for (const SplineKind kind : {SplineKind::smooth, SplineKind::straight, SplineKind::bezier})
        for (const bool closed : {false, true})
            for (int run = 0; run < 10; ++run) {
                const std::size_t count = kind == SplineKind::bezier ? (closed ? 9 : 10) : 5;
                const Knots knots = randomKnots(random, count, kind, closed);
                const SplinePtr spline = splineOf(knots);
                ASSERT_TRUE(spline);
                const double along = spline->length * (0.03 + 0.094 * run);
                const auto with = inserted(knots, along);
                ASSERT_TRUE(with);
                EXPECT_EQ(with->knots.count(), count + (kind == SplineKind::bezier ? 3 : 1));
                EXPECT_FALSE(with->knots.isHandle(with->knot));
                double least = 1e300;
                for (SpaceArc arc : spline->arcs) {
                    arc.radius = arc.radiusSlope = 0;
                    least = std::min(least, nearestOn(arc, with->knots.at(with->knot)).distance);
                }
                EXPECT_LT(least, 2e-3);
                // Lines and Bézier curves stay where they were.
                if (kind != SplineKind::smooth) { EXPECT_LT(apart(with->knots, knots), 2e-4); }
                ASSERT_TRUE(splineOf(removed(with->knots, with->knot)));
                if (kind != SplineKind::bezier) { EXPECT_EQ(removed(with->knots, with->knot), knots); }
            }
}

TEST(SplineEdits, BezierPointsTakeTheirHandlesAlong) {
    std::mt19937 random(5);
    const Knots open = randomKnots(random, 7, SplineKind::bezier, false),
                closed = randomKnots(random, 9, SplineKind::bezier, true);
    const glm::dvec3 by(0.25, -0.5, 1);
    Knots now = moved(open, 3, open.at(3) + by);
    for (const std::size_t k : {2, 3, 4}) EXPECT_NEAR(glm::distance(now.at(k), open.at(k) + by), 0, 1e-12);
    for (const std::size_t k : {0, 1, 5, 6}) EXPECT_EQ(now.at(k), open.at(k));
    now = moved(closed, 0, closed.at(0) + by);
    for (const std::size_t k : {8, 0, 1}) EXPECT_NEAR(glm::distance(now.at(k), closed.at(k) + by), 0, 1e-12);
    EXPECT_EQ(now.at(2), closed.at(2));
    now = moved(open, 2, open.at(2) + by);  // a handle goes alone
    EXPECT_EQ(now.at(3), open.at(3));
    // Without a point a spline is still one, whichever it is.
    for (std::size_t k = 0; k < 9; k += 3) {
        const Knots rest = removed(closed, k);
        EXPECT_EQ(rest.count(), 6u);
        EXPECT_TRUE(splineOf(rest)) << k;
        for (std::size_t i = 0; i < 6; i += 3) EXPECT_NE(rest.at(i), closed.at(k));
    }
    for (const std::size_t k : {0, 3, 6}) {
        EXPECT_EQ(removed(open, k).count(), 4u);
        EXPECT_TRUE(splineOf(removed(open, k)));
    }
    EXPECT_EQ(removed(open, 1), open);
    const Knots least = randomKnots(random, 4, SplineKind::bezier, false);
    EXPECT_EQ(removed(least, 0), least);
}

TEST(SplineEdits, EndsGoOn) {
    std::mt19937 random(6);
    const Knots knots = randomKnots(random, 3, SplineKind::smooth, false);
    const auto behind = extended(knots, true), before = extended(knots, false);
    ASSERT_TRUE(behind && before);
    EXPECT_EQ(behind->knot, 3u);
    EXPECT_NEAR(glm::distance(behind->knots.at(3), 2.0 * knots.at(2) - knots.at(1)), 0, 1e-12);
    EXPECT_EQ(before->knot, 0u);
    EXPECT_NEAR(glm::distance(before->knots.at(0), 2.0 * knots.at(0) - knots.at(1)), 0, 1e-12);
    EXPECT_FALSE(extended(randomKnots(random, 4, SplineKind::smooth, true), true));
    const auto curve = extended(randomKnots(random, 4, SplineKind::bezier, false), false);
    ASSERT_TRUE(curve);
    EXPECT_EQ(curve->knots.count(), 7u);
    EXPECT_TRUE(splineOf(curve->knots));
    EXPECT_EQ(removed(randomKnots(random, 2, SplineKind::smooth, false), 0).count(), 2u);
}

/// The points can be held where they are seen: behind what moves the tube, and along the sweep that they
/// bend.
TEST(SplineEdits, PointsAreHeldWhereTheyAreSeen) {
    const Graph graph = documentOf(R"(
        {"id": "curve", "type": "spline", "inputs": {"knots": [[0, 0, 0, 1, 0], [1, 0, 0, 1, 0], [1, 1, 0, 1, 0]]}},
        {"id": "flat", "type": "circle", "inputs": {"radius": 0.1}},
        {"id": "bent", "type": "sweep", "inputs": {"surface": {"from": "flat"}, "spline": {"from": "curve"}}},
        {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "bent"}, "offset": [0, 2, 0]}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "moved"}}})");
    const Grips grips = gripsOf(graph, "", "curve", "", 0.0, Tool::move);
    ASSERT_EQ(grips.handles.size(), 3u);
    ASSERT_TRUE(grips.spline);
    EXPECT_EQ(grips.why, "");
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(grips.handles[i].knot, int(i));
        EXPECT_NEAR(glm::distance(grips.handles[i].origin, grips.spline->knots.at(i) + glm::dvec3(0, 2, 0)),
                    0, 1e-12);
    }
    // Under the mouse is the curve, at as many metres as it has gone there.
    Camera camera;
    camera.position = {0.5f, 2.5f, 5};
    camera.target = {0.5f, 2.5f, 0};
    const Lens lens(camera, {{0, 0}, {400, 400}});
    const SpaceArc& arc = grips.spline->spline->arcs[3];
    const auto pixel = lens.project(placeOn(arc, 0) + glm::dvec3(0, 2, 0));
    ASSERT_TRUE(pixel);
    const auto along = alongAt(*grips.spline, lens, *pixel, 5);
    ASSERT_TRUE(along);
    EXPECT_NEAR(*along, arc.begin + arc.half, 0.03);
    EXPECT_FALSE(alongAt(*grips.spline, lens, {5, 5}, 5));
}

}  // namespace fw::editor::spline_edits_test
