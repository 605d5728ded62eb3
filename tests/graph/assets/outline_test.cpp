// Outlines against the distance to each edge in turn, with sides told by counting along a ray.
#include "graph/outlines/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace fw::outline_test {

struct Reference {
    double distance;
    bool inside;
};

Reference simple(const std::vector<double>& corners, double x, double y) {
    Reference result{1e300, false};
    for (std::size_t i = 0, n = corners.size() / 2; i < n; ++i) {
        const double ax = corners[2 * i], ay = corners[2 * i + 1];
        const double bx = corners[2 * ((i + 1) % n)], by = corners[2 * ((i + 1) % n) + 1];
        const double dx = bx - ax, dy = by - ay, size = dx * dx + dy * dy;
        const double t = size > 0 ? std::clamp(((x - ax) * dx + (y - ay) * dy) / size, 0.0, 1.0) : 0.0;
        result.distance = std::min(result.distance, std::hypot(x - ax - t * dx, y - ay - t * dy));
        if ((ay <= y) != (by <= y) && x < ax + (y - ay) / (by - ay) * dx) result.inside = !result.inside;
    }
    return result;
}

void expectDistances(const std::vector<double>& corners, std::mt19937& random, int probes, double reach) {
    const OutlinePtr made = outlineThrough(corners);
    const Outline& outline = *made;
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < probes; ++i) {
        const double scale = i % 4 == 0 ? std::exp2(20 * unit(random)) : reach;
        const double x = scale * unit(random), y = scale * unit(random);
        const Reference wanted = simple(corners, x, y);
        const OutlineSample found = sampleOutline(outline, x, y);
        const double far = 1 + std::abs(x) + std::abs(y),
                     slack = (far < 1000 * reach ? 1e-12 : 1e-7) * (far + wanted.distance);
        ASSERT_NEAR(std::abs(found.value), wanted.distance, slack) << x << " " << y;
        if (wanted.distance > slack) {
            ASSERT_EQ(found.value < 0, wanted.inside) << x << " " << y;
            ASSERT_NEAR(std::hypot(found.dx, found.dy), 1, 1e-9);
        }
        ASSERT_GE(found.value, outline.least - slack);
    }
}

std::vector<double> ring(int corners) {
    std::vector<double> result;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners, radius = 1 + 0.1 * std::sin(9 * angle);
        result.insert(result.end(), {radius * std::cos(angle), radius * std::sin(angle)});
    }
    return result;
}

TEST(Outline, IsTheDistanceToTheNearestEdge) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const int corners : {3, 5, 100, 1000, 3000}) expectDistances(ring(corners), random, 4000, 1.5);
    for (int n = 1; n <= 60; ++n) {  // most of them cross themselves
        std::vector<double> corners;
        for (int i = 0; i < 2 * n; ++i) corners.push_back(unit(random));
        SCOPED_TRACE(n);
        expectDistances(corners, random, 500, 1.5);
    }
}

TEST(Outline, CornersMayCoincideOrLieOnALine) {
    std::mt19937 random(8);
    expectDistances({0.5, 0.25}, random, 500, 1);
    expectDistances({0, 0, 1, 0}, random, 500, 1);
    expectDistances({0, 0, 0.5, 0, 1, 0, 1, 1, 1, 1, 0, 1}, random, 2000, 1.5);
    expectDistances({0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1, 0, 1}, random, 2000, 1.5);  // twice around
    expectDistances({1e-9, 0, 0, 1e-9, -1e-9, 0}, random, 500, 1e-9);
    expectDistances({1e6, 1e6, 1e6 + 1, 1e6, 1e6, 1e6 + 1}, random, 500, 2e6);
}

TEST(Outline, PlacesOnTheGridOfTheCornersKnowTheirSide) {
    std::vector<double> stairs{0, 0};
    for (int i = 0; i < 32; ++i)
        stairs.insert(stairs.end(), {double(i + 1), double(i), double(i + 1), double(i + 1)});
    stairs.insert(stairs.end(), {0, 32});
    const OutlinePtr made = outlineThrough(stairs);
    const Outline& outline = *made;
    for (int y = -64; y < 96; ++y)
        for (int x = -64; x < 96; ++x) {
            const Reference wanted = simple(stairs, 0.5 * x, 0.5 * y);
            const double found = sampleOutline(outline, 0.5 * x, 0.5 * y).value;
            ASSERT_NEAR(std::abs(found), wanted.distance, 1e-12);
            if (wanted.distance > 0) { ASSERT_EQ(found < 0, wanted.inside) << x << " " << y; }
        }
}

TEST(Outline, IntervalsContainEveryValueAndAreTight) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(-1, 1);
    const OutlinePtr made = outlineThrough(ring(200));
    const Outline& outline = *made;
    for (int i = 0; i < 20'000; ++i) {
        const double size = std::exp2(8 * unit(random) - 4), x = 2 * unit(random), y = 2 * unit(random);
        const Interval u{x - size * std::abs(unit(random)), x + size},
            v{y - size, y + size * std::abs(unit(random))};
        const Interval range = sampleOutline(outline, u, v);
        for (int k = 0; k < 8; ++k) {
            const double s = 0.5 + 0.5 * unit(random), t = 0.5 + 0.5 * unit(random);
            const double value =
                sampleOutline(outline, u.lo + s * (u.hi - u.lo), v.lo + t * (v.hi - v.lo)).value;
            ASSERT_LE(range.lo, value);
            ASSERT_GE(range.hi, value);
        }
        ASSERT_LE(range.hi - range.lo, std::hypot(u.hi - u.lo, v.hi - v.lo) + 1e-9);
    }
    EXPECT_GE(sampleOutline(outline, {-1e30, 1e30}, {-1e30, 1e30}).hi, 1e30);
}

TEST(Outline, NoNumbersAndInfinitiesAreNoCrash) {
    const OutlinePtr made = outlineThrough(ring(50));
    const Outline& outline = *made;
    for (const double x : std::initializer_list<double>{std::nan(""), INFINITY, -INFINITY, 1e308, 0.0})
        for (const double y : std::initializer_list<double>{std::nan(""), INFINITY, -INFINITY, 1e308, 0.0})
            sampleOutline(outline, x, y);
}

TEST(Outline, ThatIsKnownIsNotMadeAgain) {
    const std::vector<double> corners = ring(20), others = ring(21);
    const OutlinePtr first = outlineThrough(corners);
    EXPECT_EQ(outlineThrough(corners), first);
    EXPECT_NE(outlineThrough(others), first);
}

/// Arcs of every bend, through corners that go round once.
std::vector<Arc> bentRing(std::mt19937& random, int corners) {
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<glm::dvec2> places;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners, radius = 1 + 0.2 * unit(random);
        places.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    std::vector<Arc> arcs;
    for (int i = 0; i < corners; ++i) {
        const glm::dvec2 a = places[std::size_t(i)], b = places[std::size_t((i + 1) % corners)];
        addPlain(arcBetween(
                     a, b, i % 5 == 0 ? 0 : unit(random) * std::exp2(6 * unit(random)) / glm::distance(a, b)),
                 arcs);
    }
    return arcs;
}

TEST(Outline, OfArcsIsTheDistanceToTheNearest) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const int corners : {3, 8, 60, 400}) {
        SCOPED_TRACE(corners);
        const std::vector<Arc> arcs = bentRing(random, corners);
        const Outline outline(arcs);
        // Sides against a polygon of many places on each arc, where the two agree what is near.
        std::vector<double> fine;
        for (const Arc& arc : arcs)
            for (int i = 0; i < 64; ++i) {
                const glm::dvec2 p = placeOn(arc, i / 64.0);
                fine.insert(fine.end(), {p.x, p.y});
            }
        for (int i = 0; i < 3000; ++i) {
            const double reach = i % 4 == 0 ? std::exp2(20 * unit(random)) : 1.6;
            const glm::dvec2 p{reach * unit(random), reach * unit(random)};
            double nearest = 1e300;
            for (const Arc& arc : arcs) nearest = std::min(nearest, distanceTo(arc, p));
            const OutlineSample found = sampleOutline(outline, p.x, p.y);
            const double far = 1 + std::abs(p.x) + std::abs(p.y), slack = (far < 1000 ? 1e-12 : 1e-7) * far;
            ASSERT_NEAR(std::abs(found.value), nearest, slack) << p.x << " " << p.y;
            if (nearest < 1e-3 || far > 1000) continue;
            ASSERT_NEAR(std::hypot(found.dx, found.dy), 1, 1e-9);
            ASSERT_EQ(found.value < 0, simple(fine, p.x, p.y).inside) << p.x << " " << p.y;
        }
    }
}

}  // namespace fw::outline_test
