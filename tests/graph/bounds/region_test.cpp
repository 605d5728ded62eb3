// The region search: contains the solid, close to its bounds, and honest about solids without any.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <stop_token>

#include "graph/bounds/region.h"
#include "graph/evaluate/tape.h"
#include "tests/support/graph/code_field.h"

namespace fw::region_test {

Region regionOf(const std::string& code, double lipschitz = std::numeric_limits<double>::infinity()) {
    const test::CodeField field = test::fieldOfCode(code);
    return findRegion(field.ir, field.distance, {}, lipschitz);
}

void expectBounds(const std::string& code, Point lo, Point hi, double slack) {
    SCOPED_TRACE(code);
    const Region region = regionOf(code);
    ASSERT_EQ(region.extent, Extent::bounded);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(region.box.lo[axis], lo[axis] + 1e-6);
        EXPECT_GE(region.box.lo[axis], lo[axis] - slack);
        EXPECT_GE(region.box.hi[axis], hi[axis] - 1e-6);
        EXPECT_LE(region.box.hi[axis], hi[axis] + slack);
    }
}

TEST(Region, OfSolidsAlongTheAxes) {
    expectBounds("return box(p, vec3(1, 2, 3));", {-1, -2, -3}, {1, 2, 3}, 0.01);
    expectBounds("return sphere(p - vec3(5, 0, 0), 0.001);", {4.999, -0.001, -0.001}, {5.001, 0.001, 0.001},
                 0.01);
    expectBounds("return sphere(p - vec3(100, -200, 3), 50);", {50, -250, -47}, {150, -150, 53}, 1.0);
    expectBounds("return max(sphere(p, 1), p.y);", {-1, -1, -1}, {1, 0, 1}, 0.05);
}

TEST(Region, OfSolidsWhoseHalfSpacesProveLittle) {
    expectBounds("return octahedron(p, 0.8);", {-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8}, 0.1);
    const double r = std::sqrt(0.5);
    expectBounds(
        "q = vec3(p.x + p.z, p.y * sqrt(2.0), p.z - p.x) * sqrt(0.5); return box(q, vec3(1, 0.5, 0.01));",
        {-r * 1.01, -0.5, -r * 1.01}, {r * 1.01, 0.5, r * 1.01}, 0.3);
    expectBounds("return twist(box(p, vec3(0.5, 1, 0.5)), 90);", {-0.5, -1, -0.5}, {0.5, 1, 0.5}, 1.1);
    expectBounds("return capped_cone(p, 0.5, 0.6, 0.25);", {-0.6, -0.5, -0.6}, {0.6, 0.5, 0.6}, 0.1);
}

TEST(Region, OfSolidsThatOnlyCutsOfCutsBound) {
    const std::string turn =
        "c = cos(0.7); s = sin(0.7); vec3 q = vec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z); "
        "q = vec3(q.x, c * q.y - s * q.z, s * q.y + c * q.z); ";
    const std::string bent = "vec3 b = vec3(q.x, q.y + 0.3 * q.x * q.x, q.z); ";
    const std::string heart =
        "a = h.x * h.x + 2.25 * h.z * h.z + h.y * h.y - 1; float f = a * a * a - h.x * h.x * h.y * h.y * h.y "
        "- 0.1125 * h.z * h.z * h.y * h.y * h.y; ";
    const std::string quartic = "k = dot(q, q) + 0.3; float f = k * k - 1.2 * (q.x * q.x + q.z * q.z); ";
    const Point lo{-1.6, -1.6, -1.6}, hi{1.6, 1.6, 1.6};
    for (const std::string& code : {
             turn + bent + "return max(abs(b.x + b.y) - b.z, b.z + abs(b.x - b.y)) - 0.4;",
             turn + bent + "vec3 h = b; " + heart + "return f;",
             turn + "vec3 h = q; " + heart + "return mix(f, twist(box(p, vec3(0.3)), 60), 0.9);",
             turn + quartic + "g = twist(box(p, vec3(0.3)), 60); return min(min(f, g), (f + g - 0.2) * 0.7);",
         }) {
        SCOPED_TRACE(code);
        const Region region = regionOf(code);
        EXPECT_EQ(region.extent, Extent::bounded);
        EXPECT_LE(longestSide(joined(region.box, {lo, hi})), 20.0);
    }
}

/// Samples of the solid within the cube around a centre are in the region, which is at most three times as
/// long.
void expectCloseRegion(const std::string& code, Point centre, double halfSize) {
    SCOPED_TRACE(code);
    const test::CodeField field = test::fieldOfCode(code);
    const Region region = findRegion(field.ir, field.distance, {});
    ASSERT_EQ(region.extent, Extent::bounded);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-halfSize, halfSize);
    std::vector<Point> points(20'000);
    for (Point& point : points)
        for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = centre[axis] + unit(random);
    std::vector<double> values(points.size());
    TapeMachine<double> machine;
    machine.evaluate(makeTape(field.ir, field.distance, {}), points, values);
    std::optional<Box> inside;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (values[i] < 0.0) joinInto(inside, Box{points[i], points[i]});
    ASSERT_TRUE(inside);
    EXPECT_EQ(joined(*inside, region.box), region.box);
    EXPECT_LT(longestSide(region.box), 3.0 * longestSide(*inside));
}

TEST(Region, OfPolarRepeatsOfPolynomialsAroundObliqueAxes) {
    const std::string axes =
        "vec3 w = vec3(-0.404894, 0.750227, 0.522704); vec3 u = vec3(0.914364, 0.332212, 0.231462); "
        "vec3 v = vec3(0, 0.571659, -0.820491); ";
    const std::string fold =
        "a = mod(atan2(dot(p, v), dot(p, u)), 1.0472); r = sqrt(dot(p, u) * dot(p, u) + dot(p, v) * dot(p, "
        "v)); vec3 q = w * dot(p, w) + u * (r * cos(a)) + v * (r * sin(a)); ";
    const std::string taper = "s = max(0.01, 1 - 0.04 * q.y); q = vec3(q.x / s, q.y, q.z / s); ";
    const std::string polynomial =
        "return 0.9 * q.x * q.x + 0.7 * q.y * q.y + 0.4 * q.z * q.z * q.z * q.z - 0.3 + 0.1 * q.x * q.z;";
    expectCloseRegion(axes + fold + polynomial, {0, 0, 0}, 2.0);
    expectCloseRegion(axes + fold + taper + polynomial, {0, 0, 0}, 2.0);
}

TEST(Region, OfSolidsNearTheFarthestCoordinates) {
    const std::string polynomial =
        "return (q.x * q.x + q.y * q.y) * (q.x * q.x + q.z * q.z) + q.x * q.x * q.z + q.y * q.y + q.z * q.z "
        "- 1;";
    for (const std::string place : {"20000, 0, 0", "-27000, 31000, 9000", "100, -50000, 40000"}) {
        const Region region = regionOf("vec3 q = p - vec3(" + place + "); " + polynomial);
        EXPECT_EQ(region.extent, Extent::bounded) << place;
        EXPECT_LT(longestSide(region.box), 8.0) << place;
    }
}

TEST(Region, OfProductsThatReachFar) {
    // No interval rule bounds a product: only the search from outside does.
    for (const double place : {1e3, 6e4, 1e5, 2e6, 3e7}) {
        const std::string x = std::to_string(place);
        const Region region =
            regionOf("vec3 q = p - vec3(" + x + ", 0, 0); return (dot(p, p) - 1) * (dot(q, q) - 4);");
        ASSERT_EQ(region.extent, Extent::bounded) << place;
        EXPECT_LE(region.box.lo[0], -1.0) << place;
        EXPECT_GE(region.box.hi[0], place + 2.0) << place;
    }
}

TEST(Region, OfSolidsBehindValuesThatAreNoNumber) {
    // max(d, NaN) is d, and a comparison with NaN is false: the ball at (100, 0, 0) or (-100, 0, 0) stays.
    const std::string right = "d = length(p - vec3(100, 0, 0)) - 1; ",
                      left = "d = length(p + vec3(100, 0, 0)) - 1; ", ball = " return min(length(p) - 1, d);";
    for (const std::string& code : {
             right + "e = pow(p.x, 200.5); d = max(d, e / e);",
             right + "e = exp(-p.x * p.x); q = 1 / (e * e); d = max(d, 1 + q * e * e);",
             right + "e = exp(p.x * p.x); f = exp(p.x * p.x + p.y * p.y); d = max(d, 1 + abs(e - f));",
             right + "e = exp(p.x * 20); d = max(d, 2 + perlin(vec3(e, 1, 1)));",
             right + "e = exp(p.x * 20); if (1 + abs(cos(e)) > 0.5) d = 5;",
             left + "d = max(d, 2 + cos(1 / max(p.x, 0.0)));",
             left + "d = max(d, 2 + sin(inversesqrt(p.x)));",
             left + "d = max(d, 2 + sin(1 / floor(abs(p.x) / 1000.0)));",
         }) {
        SCOPED_TRACE(code);
        const Region region = regionOf(code + ball);
        ASSERT_EQ(region.extent, Extent::bounded);
        const bool isRight = code.starts_with(right);
        EXPECT_TRUE(isRight ? region.box.hi[0] >= 101.0 : region.box.lo[0] <= -101.0);
    }
}

TEST(Region, OfReciprocals) {
    for (const char* code :
         {"return length(p) - 3 + 0.1 / abs(p.x);", "return 1 / (p.x * p.x) + length(p) - 5;",
          "return 1 / length(p.xz) + length(p) - 5;", "return length(p) - 5 - 1 / -abs(p.y);"}) {
        const Region region = regionOf(code);
        ASSERT_EQ(region.extent, Extent::bounded) << code;
        EXPECT_LT(longestSide(region.box), 10.1) << code;
        EXPECT_GT(longestSide(region.box), 5.0) << code;
    }
}

TEST(Region, OfDifferencesOfBothSigns) {
    expectCloseRegion(
        "a = 2 * p.z; u = p.x * cos(a) + p.y * sin(a); v = p.y * cos(a) - p.x * sin(a); d = u * v - p.z; e = "
        "p.z - u * v; return d * d * d * d + (u + v) * (u + v) + 0.1 * e + p.z * p.z + u * u - 1;",
        {0, 0, 0}, 2.0);
}

TEST(Region, IsUnprovenOnceAStopIsRequested) {
    const auto stop = std::make_unique<std::stop_source>();  // on the stack GCC 12 warns of it at -Og
    stop->request_stop();
    const test::CodeField field = test::fieldOfCode("return twist(box(p, vec3(0.3, 1, 0.1)), 1440);");
    EXPECT_EQ(findRegion(field.ir, field.distance, {}, 1.0, stop->get_token()).extent, Extent::unproven);
}

TEST(Region, OfManySolidsThatAreTurned) {
    // Half-spaces prove nothing, and the intervals of turned coordinates little.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::string code = "float d = 1e9; vec3 q;";
    const auto number = [](double value) { return "(" + std::to_string(value) + ")"; };
    for (int i = 0; i < 200; ++i) {
        const double angle = 3.0 * unit(random), c = std::cos(angle), s = std::sin(angle);
        code += "q = p - vec3(" + number(4 * unit(random)) + ", " + number(4 * unit(random)) + ", " +
                number(4 * unit(random)) + "); q = vec3(" + number(c) + " * q.x - " + number(s) +
                " * q.z, q.y, " + number(s) + " * q.x + " + number(c) +
                " * q.z); d = min(d, box(q, vec3(0.2, 0.3, 0.1)));";
    }
    for (const double lipschitz : {1.0, std::numeric_limits<double>::infinity()}) {
        const Region region = regionOf(code + "return d;", lipschitz);
        ASSERT_EQ(region.extent, Extent::bounded) << lipschitz;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GT(region.box.lo[axis], -6.0);
            EXPECT_LT(region.box.hi[axis], 6.0);
        }
    }
}

TEST(Region, OfADrill) {
    const Region region = regionOf("return twist(box(p, vec3(0.3, 1, 0.1)), 1440);");
    ASSERT_EQ(region.extent, Extent::bounded);
    EXPECT_LT(longestSide(region.box), 4.0);
}

TEST(Region, OfSolidsWithoutBounds) {
    EXPECT_EQ(regionOf("return p.y;").extent, Extent::unbounded);
    EXPECT_EQ(regionOf("return repeat(sphere(p, 1), vec3(20, 0, 0));").extent, Extent::unbounded);
    EXPECT_EQ(regionOf("return repeat(sphere(p, 1), vec3(3));").extent, Extent::unbounded);
    EXPECT_EQ(regionOf("return -sphere(p, 1);").extent, Extent::unbounded);
    EXPECT_EQ(regionOf("return gyroid(p, 1, 0.1);").extent, Extent::unbounded);
    EXPECT_EQ(regionOf("return -1;").extent, Extent::unbounded);
}

TEST(Region, OfNothing) {
    EXPECT_EQ(regionOf("return 1;").extent, Extent::empty);
    EXPECT_EQ(regionOf("return length(p) + 0.1;").extent, Extent::empty);
    EXPECT_EQ(regionOf("return max(sphere(p, 1), sphere(p - vec3(3, 0, 0), 1));").extent, Extent::empty);
}

TEST(Region, PaddingKeepsTheCellsPromised) {
    const Box box = padded({{0, 0, 0}, {1, 2, 4}}, 100, 1.5);
    const double cell = (box.hi[2] - box.lo[2]) / 100;
    EXPECT_NEAR(box.lo[0], -1.5 * cell, 1e-12);
    EXPECT_NEAR(box.hi[1], 2 + 1.5 * cell, 1e-12);
}

}  // namespace fw::region_test
