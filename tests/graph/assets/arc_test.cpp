// Arcs: their formulas against circles with a centre, and curves that became arcs against the curves.
#include "graph/outlines/arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "graph/outlines/path.h"

namespace fw::arc_test {

using glm::dvec2;

TEST(Arc, IsAPartOfItsCircle) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const dvec2 centre{unit(random), unit(random)};
        const double radius = std::exp2(4 * unit(random)), from = 4 * unit(random), turn = 3.1 * unit(random);
        const auto at = [&](double w) { return centre + radius * dvec2(std::cos(w), std::sin(w)); };
        const Arc arc = arcBetween(at(from), at(from + turn), (turn < 0 ? -1 : 1) / radius);
        EXPECT_NEAR(turnOf(arc), turn, 1e-6 * std::exp2(4));
        EXPECT_NEAR(lengthOf(arc), std::abs(turn) * radius, 1e-6 * radius);
        for (const double share : {0.0, 0.3, 0.5, 1.0})
            EXPECT_LT(glm::distance(placeOn(arc, share), at(from + share * turn)), 1e-6 * radius);
        const dvec2 p{3 * unit(random), 3 * unit(random)};
        const double out = glm::distance(p, centre) - radius;
        EXPECT_NEAR(sideOf(arc, p), turn > 0 ? -out : out, 1e-9 * (1 + radius));
        // The nearest of many places.
        double nearest = 1e300;
        for (int k = 0; k <= 2000; ++k)
            nearest = std::min(nearest, glm::distance(p, at(from + turn * k / 2000)));
        EXPECT_NEAR(distanceTo(arc, p), nearest, 1e-3 * radius);
        EXPECT_LE(distanceTo(arc, p), nearest + 1e-6 * radius);
        const Arc back = reversed(arc);
        EXPECT_NEAR(sideOf(back, p), -sideOf(arc, p), 1e-9 * (1 + radius));
        EXPECT_LT(glm::distance(normalAtEnd(back), -arc.normal), 1e-9);
    }
}

TEST(Arc, NearlyStraightLosesNoDigits) {
    for (const double bend : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
        const Arc arc = arcBetween({0, 0}, {1, 0}, bend);
        EXPECT_NEAR(sideOf(arc, {0.5, 0.25}), 0.25 + 0.125 * bend, 1e-6 * bend + 1e-15);
        EXPECT_NEAR(distanceTo(arc, {0.5, -0.5}), 0.5 - 0.125 * bend, 1e-6 * bend + 1e-15);
    }
}

TEST(Arc, PlainPartsGoOneWay) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        const dvec2 a{unit(random), unit(random)}, b{unit(random), unit(random)};
        const Arc arc = arcBetween(a, b, 2 * unit(random) / glm::distance(a, b));
        std::vector<Arc> parts;
        addPlain(arc, parts);
        ASSERT_FALSE(parts.empty());
        EXPECT_EQ(parts.front().a, a);
        EXPECT_EQ(parts.back().b, b);
        double length = 0, area = 0;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (k > 0) { EXPECT_EQ(parts[k].a, parts[k - 1].b); }
            length += lengthOf(parts[k]);
            area += twiceAreaBeside(parts[k]);
            const dvec2 lo = glm::min(parts[k].a, parts[k].b) - 1e-9,
                        hi = glm::max(parts[k].a, parts[k].b) + 1e-9;
            for (const double share : {0.2, 0.5, 0.8}) {
                const dvec2 p = placeOn(parts[k], share);
                EXPECT_TRUE(p.x >= lo.x && p.y >= lo.y && p.x <= hi.x && p.y <= hi.y);
            }
        }
        EXPECT_NEAR(length, lengthOf(arc), 1e-9);
        EXPECT_NEAR(area, twiceAreaBeside(arc), 1e-9);
    }
}

double areaOf(const std::vector<Contour>& contours) {
    double twice = 0;
    for (const Contour& contour : contours)
        for (const Arc& arc : contour.arcs) twice += twiceAreaBeside(arc);
    return 0.5 * twice;
}

/// How far a pen's arcs are from a curve at most, looked at from the curve's places.
template <class Curve>
double farthest(const std::vector<Contour>& contours, const Curve& curve) {
    double most = 0;
    for (int i = 0; i <= 4000; ++i) {
        double nearest = 1e300;
        for (const Contour& contour : contours)
            for (const Arc& arc : contour.arcs)
                nearest = std::min(nearest, distanceTo(arc, curve(i / 4000.0)));
        most = std::max(most, nearest);
    }
    return most;
}

TEST(Pen, CurvesAreAsNearAsAskedAndSmooth) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 60; ++i) {
        std::array<dvec2, 4> p;
        for (dvec2& q : p) q = {unit(random), unit(random)};
        if (i % 7 == 0) p[1] = p[0];                         // no slope at the beginning
        if (i % 11 == 0) p[2] = p[3] = 0.5 * (p[0] + p[1]);  // a line that turns back
        for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
            Pen pen(tolerance);
            pen.moveTo(p[0]);
            pen.curveTo(p[1], p[2], p[3]);
            const std::size_t count = pen.arcs();
            const std::vector<Contour> contours = pen.taken();
            EXPECT_LT(farthest(contours,
                               [&](double t) {
                                   const double s = 1 - t;
                                   return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] +
                                          t * t * t * p[3];
                               }),
                      1.5 * tolerance)
                << i;
            EXPECT_LT(count, 40 * std::pow(1e-3 / tolerance, 1 / 3.0) + 40);
            if (i % 7 == 0 || i % 11 == 0) continue;
            const std::vector<Arc>& arcs = contours.front().arcs;
            for (std::size_t k = 1; k < arcs.size(); ++k) {
                // Where a line stands for less than the tolerance there may be a bend.
                if (std::min(lengthOf(arcs[k - 1]), lengthOf(arcs[k])) < 30 * tolerance) continue;
                EXPECT_NEAR(cross(tangentAtEnd(arcs[k - 1]), tangentAtStart(arcs[k])), 0, 1e-4)
                    << i << " " << k;
            }
        }
    }
}

TEST(Pen, CirclesAndEllipsesHaveTheirAreas) {
    constexpr double pi = std::numbers::pi;
    Pen pen(1e-6);
    pen.moveTo({3, 1});
    pen.ellipse({1, 1}, {2, 0}, {0, 2}, 0, 2 * pi);
    pen.close();
    EXPECT_LE(pen.arcs(), 8u) << "a circle is arcs already";
    EXPECT_NEAR(areaOf(pen.taken()), 4 * pi, 1e-12);
    pen.moveTo({2, 0});
    pen.ellipse({0, 0}, {2, 0}, {0, 0.5}, 0, 2 * pi);
    pen.close();
    EXPECT_NEAR(areaOf(pen.taken()), pi, 1e-5);
    // Stretched, a circle is that ellipse.
    pen.moveTo({1, 0});
    pen.ellipse({0, 0}, {1, 0}, {0, 1}, 0, 2 * pi);
    pen.close();
    const std::vector<Contour> circle = pen.taken();
    EXPECT_NEAR(areaOf(moved(circle, {{2, 0}, {0, 0.5}, {7, 7}}, 1e-6)), pi, 1e-5);
    EXPECT_NEAR(areaOf(moved(circle, {{0, 3}, {-3, 0}, {1, 2}}, 1e-6)), 9 * pi, 1e-9);
    EXPECT_NEAR(areaOf(moved(circle, {{0, 3}, {3, 0}, {1, 2}}, 1e-6)), -9 * pi, 1e-9) << "mirrored";
}

}  // namespace fw::arc_test
