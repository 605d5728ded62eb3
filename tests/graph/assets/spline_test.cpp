// Splines against the curves that they are drawn by, place by place, and their tables against every arc.
#include "graph/curves/spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "graph/check/check.h"
#include "graph/curves/spline_table.h"
#include "graph/document/json.h"

namespace fw::spline_test {

using Curve = std::function<glm::dvec3(double)>;
constexpr double kTurn = 2 * std::numbers::pi;

/// The distance to a curve that is known by its places: the least of many, and then by thirds of steps.
double bruteDistance(const Curve& curve, const glm::dvec3& p, int steps) {
    const auto far = [&](double t) { return glm::distance(curve(std::clamp(t, 0.0, 1.0)), p); };
    int nearest = 0;
    double best = 1e300;
    for (int i = 0; i <= steps; ++i)
        if (const double d = far(double(i) / steps); d < best) best = d, nearest = i;
    double lo = double(nearest - 1) / steps, hi = double(nearest + 1) / steps;
    for (int k = 0; k < 60; ++k) {
        const double a = lo + (hi - lo) / 3, b = hi - (hi - lo) / 3;
        (far(a) < far(b) ? hi : lo) = far(a) < far(b) ? b : a;
    }
    return std::min(best, far(0.5 * (lo + hi)));
}

glm::dvec3 randomPlace(std::mt19937& random, double reach) {
    std::uniform_real_distribution<double> unit(-reach, reach);
    const double x = unit(random), y = unit(random), z = unit(random);
    return {x, y, z};
}

std::vector<Knot> randomKnots(std::mt19937& random, int count, bool varied) {
    std::vector<Knot> knots;
    std::uniform_real_distribution<double> share(0.2, 1.5), angle(-2, 2);
    for (int i = 0; i < count; ++i) {
        knots.push_back({randomPlace(random, 1)});
        if (varied) knots.back().radius = share(random), knots.back().twist = angle(random);
    }
    return knots;
}

SplinePtr through(const std::vector<Knot>& knots, SplineKind kind, bool closed = false, double bend = 0) {
    const Result<SplinePtr> spline = splineThrough(knots, kind, closed, bend);
    EXPECT_TRUE(spline) << (spline ? "" : spline.error().message);
    return spline ? *spline : nullptr;
}

TEST(Spline, BallsOfOneSizeAreToTheLastBit) {
    std::mt19937 random(8);
    for (int i = 0; i < 20; ++i) {
        std::vector<Knot> knots = randomKnots(random, 6, false);
        for (Knot& knot : knots) knot.radius = 0.1 + i;
        for (const SplineKind kind : {SplineKind::smooth, SplineKind::straight}) {
            const SplinePtr spline = through(knots, kind, i % 2 == 0, 0.1);
            ASSERT_TRUE(spline);
            for (const SpaceArc& arc : spline->arcs) {
                ASSERT_EQ(arc.radius, 0.1 + i);
                ASSERT_EQ(arc.radiusSlope, 0);
            }
            EXPECT_FALSE(SplineTable(spline, 0.1).tapered);
        }
    }
}

TEST(SpaceArc, NearestPlacesAreThoseOfManyPlaces) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 a = randomPlace(random, 1), b = randomPlace(random, 1);
        glm::dvec3 direction = glm::normalize(b - a) + 0.6 * randomPlace(random, 1);
        SpaceArc arc = i % 5 == 0 ? spaceLine(a, b) : spaceArc(a, direction, b);
        ASSERT_NEAR(glm::distance(placeOn(arc, arc.half), b), 0, 1e-9);
        if (arc.bend > 0 && arc.bend * arc.half < 0.78) {
            ASSERT_NEAR(glm::distance(placeOn(arc, -arc.half), a), 0, 1e-9);
            ASSERT_NEAR(glm::distance(directionOn(arc, -arc.half), glm::normalize(direction)), 0, 1e-6);
        }
        if (i % 2 == 0) arc.radius = 0.3, arc.radiusSlope = 0.9 * unit(random);
        if (i % 10 == 2) arc.radiusSlope = 1.4;  // a ball that swallows the others
        const glm::dvec3 p = randomPlace(random, i % 3 == 0 ? 8 : 1.5);
        double wanted = 1e300;
        constexpr int kSteps = 4000;
        for (int k = 0; k <= kSteps; ++k) {
            const double s = arc.half * (2.0 * k / kSteps - 1);
            wanted = std::min(wanted, glm::distance(placeOn(arc, s), p) - arc.radius - arc.radiusSlope * s);
        }
        const SpaceFoot foot = nearestOn(arc, p);
        ASSERT_LE(foot.distance, wanted + 1e-9);
        ASSERT_NEAR(foot.distance, wanted, 2e-6) << i;
        ASSERT_NEAR(glm::distance(placeOn(arc, foot.s), p) - arc.radius - arc.radiusSlope * foot.s,
                    foot.distance, 1e-9);
    }
}

TEST(Spline, OfBezierCurvesIsAsFarAsTheCurves) {
    std::mt19937 random(5);
    for (int curves = 1; curves <= 3; ++curves) {
        const std::vector<Knot> knots = randomKnots(random, 3 * curves + 1, false);
        const Curve curve = [&](double t) {
            const auto i = std::size_t(std::min(t * curves, curves - 1e-12));
            const double w = t * curves - double(i), u = 1 - w;
            const auto at = [&](std::size_t k) { return knots[3 * i + k].place; };
            return u * u * u * at(0) + 3 * u * u * w * at(1) + 3 * u * w * w * at(2) + w * w * w * at(3);
        };
        const SplineTablePtr table = splineTable(through(knots, SplineKind::bezier), 0);
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 p = randomPlace(random, i % 4 == 0 ? 5 : 1.3);
            ASSERT_NEAR(sampleSpline(*table, SplineChannel::distance, p).value,
                        bruteDistance(curve, p, 600 * curves), 1e-5);
        }
    }
}

TEST(Spline, OfAHelixIsAsFarAsTheHelix) {
    std::mt19937 random(6);
    for (const bool right : {true, false}) {
        const Helix helix{.radius = 0.5, .topRadius = 0.2, .height = 1.1, .turns = 4.3, .right = right};
        const SplinePtr spline = *splineOfHelix(helix);
        const Curve curve = [&](double t) {
            const double r = 0.5 - 0.3 * t, a = kTurn * 4.3 * t;
            return glm::dvec3(r * std::cos(a), 1.1 * t, (right ? -1 : 1) * r * std::sin(a));
        };
        const SplineTablePtr table = splineTable(spline, 0);
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 p = randomPlace(random, i % 4 == 0 ? 5 : 0.8);
            ASSERT_NEAR(sampleSpline(*table, SplineChannel::distance, p).value, bruteDistance(curve, p, 3000),
                        1e-5);
        }
    }
}

/// A smooth spline goes through its points, and neither it nor its frame has a corner; a closed one's frame
/// comes back as it was.
TEST(Spline, SmoothOnesHaveNoCorners) {
    std::mt19937 random(7);
    for (int run = 0; run < 20; ++run) {
        const bool closed = run % 2 == 0;
        const std::vector<Knot> knots = randomKnots(random, 3 + run, true);
        const SplinePtr spline = through(knots, SplineKind::smooth, closed);
        ASSERT_TRUE(spline);
        for (const Knot& knot : knots) {
            double nearest = 1e300, share = 0;
            for (const SpaceArc& arc : spline->arcs)
                if (const double d = glm::distance(placeOn(arc, -arc.half), knot.place); d < nearest)
                    nearest = d, share = arc.radius - arc.radiusSlope * arc.half;
            const SpaceArc& last = spline->arcs.back();
            if (const double d = glm::distance(placeOn(last, last.half), knot.place); d < nearest)
                nearest = d, share = last.radius + last.radiusSlope * last.half;
            EXPECT_LT(nearest, 1e-9);
            EXPECT_NEAR(share, knot.radius, 1e-9);
        }
        const std::size_t n = spline->arcs.size();
        for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
            const SpaceArc &before = spline->arcs[i], &after = spline->arcs[(i + 1) % n];
            ASSERT_NEAR(glm::distance(placeOn(before, before.half), placeOn(after, -after.half)), 0, 1e-9);
            ASSERT_NEAR(glm::distance(directionOn(before, before.half), directionOn(after, -after.half)), 0,
                        1e-4);
            for (const int k : {0, 1})
                ASSERT_NEAR(glm::distance(frameOn(before, before.half, k), frameOn(after, -after.half, k)), 0,
                            1e-3)
                    << run << " " << i << " of " << n;
            for (const int k : {0, 1})
                ASSERT_NEAR(glm::dot(frameOn(before, before.half, k), directionOn(before, before.half)), 0,
                            1e-9);
            ASSERT_NEAR(
                glm::dot(glm::cross(frameOn(after, 0, 0), frameOn(after, 0, 1)), directionOn(after, 0)), 1,
                1e-9);
        }
    }
}

/// Of a frame that turns as little as it can, the change has no part about the direction.
TEST(Spline, FramesTurnNoMoreThanTheyMust) {
    std::mt19937 random(8);
    const SplinePtr spline = through(randomKnots(random, 6, false), SplineKind::smooth);
    for (const SpaceArc& arc : spline->arcs) {
        const double s = 0.3 * arc.half, step = 1e-4 * arc.half;
        const glm::dvec3 change = (frameOn(arc, s + step, 0) - frameOn(arc, s - step, 0)) / (2 * step);
        EXPECT_NEAR(glm::dot(change, frameOn(arc, s, 1)), 0, 1e-6);
    }
}

TEST(Spline, StraightOnesHaveTheBendThatIsAskedFor) {
    const std::vector<Knot> knots = {{{0, 0, 0}}, {{2, 0, 0}}, {{2, 1, 0}}, {{2, 1.2, 1}}};
    const SplinePtr spline = through(knots, SplineKind::straight, false, 0.3);
    double bent = 0;
    for (const SpaceArc& arc : spline->arcs) {
        if (arc.bend == 0) continue;
        EXPECT_NEAR(1 / arc.bend, 0.3, 1e-9);
        bent += 2 * arc.half * arc.bend;
    }
    EXPECT_NEAR(bent, std::numbers::pi / 2 + std::atan2(1, 0.2), 1e-9);
    // Where there is no room the radius is what fits.
    const SplinePtr tight = through(knots, SplineKind::straight, true, 100);
    for (const SpaceArc& arc : tight->arcs)
        if (arc.bend > 0) { EXPECT_LT(1 / arc.bend, 2); }
    const SplinePtr sharp = through(knots, SplineKind::straight);
    EXPECT_EQ(sharp->arcs.size(), 3u);
    EXPECT_NEAR(sharp->length, 3 + std::hypot(0.2, 1), 1e-12);
}

/// Tables have what is the least of all arcs, and intervals that hold it.
TEST(SplineTable, SamplesAreThoseOfAllArcs) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::size_t plain = 0;
    for (int run = 0; run < 16; ++run) {
        const bool closed = run % 3 == 0;
        const SplineKind kind = run % 4 == 3 ? SplineKind::straight : SplineKind::smooth;
        const SplinePtr spline =
            through(randomKnots(random, 3 + run, run % 2 == 1), kind, closed, run % 8 == 3 ? 0.1 : 0);
        const double radius = run % 4 == 1 || run % 4 == 2 ? 0.2 : 0;
        const SplineTablePtr table = splineTable(spline, radius);
        for (const SplineTexel& texel : table->texels) plain += texel[1] >> 31 & 1;
        for (int i = 0; i < 400; ++i) {
            const double scale = i % 5 == 0 ? std::exp2(12 * unit(random)) : 1.3;
            const glm::dvec3 p = scale * randomPlace(random, 1);
            double wanted = 1e300;
            for (SpaceArc arc : spline->arcs) {
                arc.radius *= radius, arc.radiusSlope *= radius;
                wanted = std::min(wanted, nearestOn(arc, p).distance);
            }
            const SplineSample found = sampleSpline(*table, SplineChannel::distance, p);
            ASSERT_NEAR(found.value, wanted, 1e-6 * scale + 1e-9) << run << " " << i;
            ASSERT_LE(glm::length(found.slope), 1 + 1e-9);
            const double size = std::exp2(5 * unit(random) - 6) * scale;
            Interval box[3];
            for (int k = 0; k < 3; ++k) {
                const double half = size * std::abs(unit(random));
                box[k] = {p[k] - half, p[k] + half};
            }
            for (int channel = 0; channel < (radius > 0 ? 1 : kSplineChannels); ++channel) {
                const Interval range = sampleSpline(*table, SplineChannel(channel), box);
                for (int probe = 0; probe < 30; ++probe) {
                    glm::dvec3 q;
                    for (int k = 0; k < 3; ++k)
                        q[k] = 0.5 * (box[k].lo + box[k].hi) + 0.5 * (box[k].hi - box[k].lo) * unit(random);
                    const double value = sampleSpline(*table, SplineChannel(channel), q).value;
                    const double slack = 1e-6 * (1 + scale);
                    ASSERT_GE(value, range.lo - slack) << run << " " << i << " channel " << channel;
                    ASSERT_LE(value, range.hi + slack) << run << " " << i << " channel " << channel;
                }
            }
        }
    }
    EXPECT_GT(plain, 1000u);
}

/// Near a spline intervals of small boxes are a few times as wide as these.
TEST(SplineTable, IntervalsAreNarrow) {
    std::mt19937 random(12);
    int narrow = 0, all = 0;
    const SplinePtr spline = through(randomKnots(random, 6, false), SplineKind::smooth);
    const SplineTablePtr table = splineTable(spline, 0);
    for (const SpaceArc& arc : spline->arcs)
        for (int i = 0; i < 5; ++i) {
            const glm::dvec3 p = arc.middle + randomPlace(random, 0.1);
            constexpr double kHalf = 1e-4;
            const Interval box[3] = {
                {p.x - kHalf, p.x + kHalf}, {p.y - kHalf, p.y + kHalf}, {p.z - kHalf, p.z + kHalf}};
            for (int channel = 0; channel < 4; ++channel) {
                const Interval range = sampleSpline(*table, SplineChannel(channel), box);
                narrow += range.hi - range.lo < 20 * kHalf;
                ++all;
            }
        }
    EXPECT_GT(narrow, 0.6 * all);
}

/// Slopes are the differences of values, but where values jump.
TEST(SplineTable, SlopesAreThoseOfTheValues) {
    std::mt19937 random(10);
    int wrong = 0, all = 0;
    for (int run = 0; run < 6; ++run) {
        const SplinePtr spline =
            through(randomKnots(random, 4 + run, true), SplineKind::smooth, run % 2 == 0);
        for (const double radius : {0.0, 0.1}) {
            const SplineTablePtr table = splineTable(spline, radius);
            for (int channel = 0; channel < (radius > 0 ? 1 : kSplineChannels); ++channel)
                for (int i = 0; i < 300; ++i) {
                    const glm::dvec3 p = randomPlace(random, 1.2);
                    const SplineSample at = sampleSpline(*table, SplineChannel(channel), p);
                    for (int axis = 0; axis < 3; ++axis) {
                        glm::dvec3 step(0);
                        step[axis] = 1e-5;
                        const double rise = (sampleSpline(*table, SplineChannel(channel), p + step).value -
                                             sampleSpline(*table, SplineChannel(channel), p - step).value) /
                                            2e-5;
                        wrong += std::abs(rise - at.slope[axis]) > 1e-2 * (1 + std::abs(rise));
                        ++all;
                    }
                }
        }
    }
    EXPECT_LT(wrong, all / 100);
}

TEST(SplineTable, PositionsThatAreNaNGiveNaN) {
    std::mt19937 random(1);
    const SplineTablePtr table = splineTable(through(randomKnots(random, 7, true), SplineKind::smooth), 0);
    for (int channel = 0; channel < kSplineChannels; ++channel) {
        const SplineSample sample = sampleSpline(*table, SplineChannel(channel), glm::dvec3(NAN, 0, 0));
        if (SplineChannel(channel) == SplineChannel::distance) { EXPECT_TRUE(std::isnan(sample.value)); }
    }
}

/// Across and up are the distance's two parts, and along is how far the nearest place lies.
TEST(SplineTable, CoordinatesLeadBackToThePlace) {
    std::mt19937 random(11);
    const SplinePtr spline = through(randomKnots(random, 7, true), SplineKind::smooth);
    const SplineTablePtr table = splineTable(spline, 0);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 p = randomPlace(random, 1.5);
        const double across = sampleSpline(*table, SplineChannel::across, p).value,
                     up = sampleSpline(*table, SplineChannel::up, p).value,
                     along = sampleSpline(*table, SplineChannel::along, p).value;
        const double at = std::clamp(along, 0.0, spline->length);
        const SpaceArc* own = &spline->arcs.back();
        for (const SpaceArc& arc : spline->arcs)
            if (at >= arc.begin && at <= arc.begin + 2 * arc.half) own = &arc;
        const double s = at - own->begin - own->half;
        const glm::dvec3 back = placeOn(*own, s) + across * frameOn(*own, s, 0) + up * frameOn(*own, s, 1) +
                                (along - at) * directionOn(*own, s);
        ASSERT_NEAR(glm::distance(back, p), 0, 2e-4) << i;
    }
}

TEST(Spline, WhatIsNoSplineIsToldOrNothing) {
    const Result<SplinePtr> odd = splineThrough(std::vector<Knot>(5), SplineKind::bezier, false);
    ASSERT_FALSE(odd);
    EXPECT_NE(odd.error().message.find("4, 7, 10"), std::string::npos);
    EXPECT_FALSE(splineThrough(std::vector<Knot>(kMostKnots + 1), SplineKind::smooth, false));
    EXPECT_EQ(through({}, SplineKind::smooth), nullptr);
    EXPECT_EQ(through({{{1, 2, 3}}}, SplineKind::smooth), nullptr);
    EXPECT_EQ(through(std::vector<Knot>(6), SplineKind::smooth, true), nullptr);
    EXPECT_EQ(through(std::vector<Knot>(4), SplineKind::bezier), nullptr);
    // Points upon each other, lines back upon themselves, handles of no length: sound all the same.
    const std::vector<Knot> folded = {{{0, 0, 0}}, {{0, 0, 0}}, {{1, 0, 0}}, {{0, 0, 0}}, {{1, 0, 0}}};
    for (const SplineKind kind : {SplineKind::smooth, SplineKind::straight})
        for (const bool closed : {false, true})
            for (const double bend : {0.0, 0.2}) {
                const SplinePtr spline = through(folded, kind, closed, bend);
                ASSERT_TRUE(spline);
                const SplineTablePtr table = splineTable(spline, 0);
                for (int channel = 0; channel < kSplineChannels; ++channel)
                    EXPECT_TRUE(
                        std::isfinite(sampleSpline(*table, SplineChannel(channel), {0.3, 0.2, 0.1}).value));
            }
    const SplinePtr still = through({{{0, 0, 0}}, {{0, 0, 0}}, {{1, 1, 0}}, {{1, 1, 0}}}, SplineKind::bezier);
    ASSERT_TRUE(still);
    EXPECT_NEAR(still->length, std::sqrt(2.0), 1e-6);
}

/// A knot may be written with its place alone; what is no knot is told by its place in the file.
TEST(Knots, AreReadWithTheirPlacesAlone) {
    const auto read = [](const std::string& knots) {
        return parseGraph(R"({"fieldwright": 1, "nodes": [
            {"id": "curve", "type": "spline", "inputs": {"knots": )" +
                              knots + "}}]}",
                          "a.field.json", nullptr);
    };
    const Result<Graph> graph = read("[[0, 1, 2], [3, 4, 5, 0.5, 90]]");
    ASSERT_TRUE(graph) << format(graph.error());
    const InputValue& value = *graph->nodes[0].input("knots");
    EXPECT_EQ(value.entry, 5);
    EXPECT_EQ(std::get<std::vector<double>>(value.value),
              (std::vector<double>{0, 1, 2, 1, 0, 3, 4, 5, 0.5, 90}));
    for (const char* bad : {"[[0, 1, 2], [3, 4]]", "[[0, 1, 2], [3, 4, 5, 6]]", "[[0, 1, 2, 3, 4], 5]"})
        EXPECT_FALSE(read(bad)) << bad;
    const Result<Graph> thin = read("[[0, 1, 2], [3, 4, 5, -1, 0]]");
    ASSERT_TRUE(thin);
    const std::vector<Error> findings = check(*thin);
    EXPECT_TRUE(std::ranges::any_of(findings, [](const Error& finding) {
        return finding.message.find("the radius of knot 2 is -1") != std::string::npos;
    }));
}

}  // namespace fw::spline_test
