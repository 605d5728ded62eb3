// Whole paths of light against closed forms: nothing is lost or won in a furnace, Fresnel's share, Snell's
// angle, Beer and Lambert's loss; and that a picture goes on where it was left.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <numbers>

#include "graph/document/json.h"
#include "runtime/play/session.h"
#include "runtime/render/renderer.h"
#include "tests/support/gpu.h"

namespace fw::paths_test {

constexpr int kSide = 48;

/// The text with these in place of its $, in order.
std::string filled(std::string text, std::initializer_list<std::string> values) {
    std::size_t at = 0;
    for (const std::string& value : values) {
        at = text.find('$', at);
        text.replace(at, 1, value);
        at += value.size();
    }
    return text;
}
std::string filled(const std::string& text, std::initializer_list<double> values) {
    std::string made = text;
    for (const double value : values) made = filled(made, {std::to_string(value)});
    return made;
}

/// A uniform sky of radiance 1, and nothing else.
const std::string kFurnace =
    R"("sun": false, "ground": false, "ao": false, "sky": {"zenith": [1, 1, 1], "horizon": [1, 1, 1], "ground": [1, 1, 1]})";

/// Seen from +z, 5 m away, through a narrow lens.
std::string seenFrom(glm::dvec3 eye, double fov = 2) {
    return filled(R"("camera": {"position": [$, $, $], "target": [0, 0, 0], "fov": $}, )",
                  {eye.x, eye.y, eye.z, fov});
}

/// `material` are inputs of the material node behind a comma.
std::string solid(const std::string& shape, const std::string& material) {
    return shape + R"(, {"id": "paint", "type": "material", "inputs": {"surface": {"from": "shape"}, )" +
           material + R"(}}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"}}})";
}
const std::string kBall = R"({"id": "shape", "type": "sphere"})";
const std::string kBlock = R"({"id": "shape", "type": "box", "inputs": {"half_extents": [4, 1, 4]}})";

struct Traced {
    Picture picture;
    PathSums sums;
    /// Mean radiance of the pixels within `reach` of the middle, in pixels.
    glm::dvec3 middle(int reach) const {
        glm::dvec3 sum(0);
        int count = 0;
        for (int y = kSide / 2 - reach; y < kSide / 2 + reach; ++y)
            for (int x = kSide / 2 - reach; x < kSide / 2 + reach; ++x, ++count)
                for (int k = 0; k < 3; ++k) sum[k] += at(x, y, k);
        return sum / double(count);
    }
    double at(int x, int y, int channel) const {
        return double(sums.sums[4 * std::size_t(y * kSide + x) + std::size_t(channel)]) / sums.paths;
    }
};

struct Paths : testing::Test {
    Traced trace(const std::string& nodes, const std::string& scene, int samples, int bounces = 8,
                 PathSums from = {}) {
        Traced traced{.picture = {}, .sums = std::move(from)};
        const Result<Graph> graph = parseGraph(
            R"({"fieldwright": 1, "nodes": [)" + nodes + R"(], "scene": {)" + scene + "}}", "", nullptr);
        EXPECT_TRUE(graph) << format(graph.error());
        if (!graph) return traced;
        const Result<Scene> look = readScene(graph->scene);
        EXPECT_TRUE(look) << format(look.error());
        Result<Program> program = compile(*graph);
        EXPECT_TRUE(program) << format(program.error());
        if (!look || !program) return traced;
        Result<Device> device = createDevice({.validation = true});
        EXPECT_TRUE(device);
        const auto record = device->record;
        Session session(std::move(*device));
        session.setProgram(std::move(*program));
        const Result<MesherResult> mesh = session.polygonise({{}, 16});
        EXPECT_TRUE(mesh) << format(mesh.error());
        Result<Picture> picture = session.render(*mesh, {.width = kSide,
                                                         .height = kSide,
                                                         .scene = *look,
                                                         .samples = samples,
                                                         .reference = true,
                                                         .bounces = bounces,
                                                         .sums = &traced.sums});
        EXPECT_TRUE(picture) << format(picture.error());
        if (picture) traced.picture = std::move(*picture);
        for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
        return traced;
    }
};

TEST_F(Paths, AWhiteBallInAWhiteSkyVanishes) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    for (const char* metallic : {"0", "1"})
        for (const char* roughness : {"0", "0.1", "0.3", "0.6", "1"}) {
            SCOPED_TRACE(filled("metallic $, roughness $", {std::string(metallic), roughness}));
            if (roughness == std::string("0.1") || roughness == std::string("0.6"))
                if (!std::getenv("FIELDWRIGHT_LONG")) continue;
            const Traced ball =
                trace(solid(kBall, filled(R"("base_color": [1, 1, 1], "metallic": $, "roughness": $)",
                                          {std::string(metallic), roughness})),
                      seenFrom({0, 0, 5}, 26) + kFurnace, 24, 64);
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) ASSERT_NEAR(ball.at(x, y, 1), 1.0, 0.01) << x << " " << y;
        }
}

TEST_F(Paths, ClearGlassInAWhiteSkyVanishes) {
    for (const char* more :
         {R"("ior": 1.5, "roughness": 0)", R"("ior": 1.5, "roughness": 0.4)", R"("ior": 3, "roughness": 0)",
          R"("ior": 0.5, "roughness": 0.2)", R"("ior": 1, "roughness": 0)"}) {
        SCOPED_TRACE(more);
        const Traced ball =
            trace(solid(kBall, R"("base_color": [1, 1, 1], "transmission": 1, )" + std::string(more)),
                  seenFrom({0, 0, 5}, 26) + kFurnace, 64, 64);
        EXPECT_NEAR(ball.middle(kSide / 2).g, 1.0, 0.01);
        EXPECT_NEAR(ball.middle(kSide / 6).g, 1.0, 0.01);
    }
}

/// Of facets of roughness 1 that are seen from straight above: the share of light that they reflect, and of
/// that the share that others do not mask. Their normals are as dense as the cosine.
struct Facets {
    double reflect = 0, leave = 0;
    double again = 0;  ///< that they mask, and reflect again
};
Facets facetsSeen(double alpha) {
    Facets facets;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
        const double c = (i + 0.5) / kSteps, fresnel = 0.04 + 0.96 * std::pow(1 - c, 5), down = 2 * c * c - 1;
        const double slope = alpha * alpha * (1 - down * down) / (down * down);
        facets.reflect += 2 * c * fresnel / kSteps;
        const double leaves = down > 0 ? 1 / (1 + 0.5 * (std::sqrt(1 + slope) - 1)) : 0;
        facets.leave += 2 * c * fresnel * leaves / kSteps;
        facets.again += 2 * c * fresnel * (1 - leaves) * fresnel / kSteps;
    }
    return facets;
}

TEST_F(Paths, GreyLosesByEachBounce) {
    // A ball never sees itself: one bounce, and the sky.
    const Traced ball = trace(solid(kBall, R"("base_color": [0.5, 0.2, 0], "roughness": 1)"),
                              seenFrom({0, 0, 5}) + kFurnace, 64, 1);
    // What facets reflect in the end is white, the rest is the base's.
    const glm::dvec3 seen = ball.middle(8);
    const double mirror = facetsSeen(1.0).leave + facetsSeen(1.0).again;
    EXPECT_NEAR(seen.r, mirror + (1 - mirror) * 0.5, 0.01);
    EXPECT_NEAR(seen.g, mirror + (1 - mirror) * 0.2, 0.01);
    EXPECT_NEAR(seen.b, mirror, 0.01);
}

double fresnelOf(double cosine, double ior) {
    const double sine = std::sqrt(1 - cosine * cosine) / ior;
    if (sine >= 1) return 1;
    const double bent = std::sqrt(1 - sine * sine);
    const double across = (cosine - ior * bent) / (cosine + ior * bent),
                 along = (ior * cosine - bent) / (ior * cosine + bent);
    return 0.5 * (across * across + along * along);
}

TEST_F(Paths, ReflectsFresnelsShare) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // What enters is absorbed at once.
    for (const double ior : {1.33, 1.5, 3.0})
        for (const double degrees : {0.0, 45.0, 70.0}) {
            SCOPED_TRACE(filled("ior $, $ degrees", {ior, degrees}));
            const double angle = degrees * std::numbers::pi / 180;
            const Traced block = trace(
                solid(
                    kBlock,
                    filled(
                        R"("base_color": [1, 1, 1], "transmission": 1, "roughness": 0, "ior": $, "absorption": [1e9, 1e9, 1e9])",
                        {ior})),
                seenFrom(12.0 * glm::dvec3(std::sin(angle) + 1e-3, std::cos(angle), 0)) + kFurnace, 256);
            EXPECT_NEAR(block.middle(12).g, fresnelOf(std::cos(angle), ior), 0.012);
        }
}

TEST_F(Paths, LosesByTheLengthWithin) {
    const Traced block = trace(
        solid(
            kBlock,
            R"("base_color": [1, 1, 1], "transmission": 1, "roughness": 0, "ior": 1, "absorption": [0, 0.5, 2])"),
        seenFrom({0, 12, 1e-3}) + kFurnace, 4);
    const glm::dvec3 seen = block.middle(12);
    EXPECT_NEAR(seen.r, 1, 1e-3);
    EXPECT_NEAR(seen.g, std::exp(-0.5 * 2), 2e-3);
    EXPECT_NEAR(seen.b, std::exp(-2.0 * 2), 2e-3);
}

TEST_F(Paths, ASlabShiftsWhatIsBehindIt) {
    // A thin bright rod along z behind a slab that is seen at 45 degrees.
    const auto shift = [&](double ior) {
        const std::string nodes = filled(
            R"({"id": "block", "type": "box", "inputs": {"half_extents": [8, 1, 8]}},
               {"id": "clear", "type": "material", "inputs": {"surface": {"from": "block"}, "base_color": [1, 1, 1], "roughness": 0, "transmission": 1, "ior": $}},
               {"id": "rod", "type": "box", "inputs": {"half_extents": [0.05, 0.05, 6]}},
               {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "rod"}, "offset": [-2.5, -2.5, 0]}},
               {"id": "bright", "type": "material", "inputs": {"surface": {"from": "moved"}, "base_color": [0, 0, 0], "roughness": 1, "emission": [4, 4, 4]}},
               {"id": "both", "type": "union", "inputs": {"a": {"from": "clear"}, "b": {"from": "bright"}}},
               {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})",
            {ior});
        const Traced seen = trace(nodes,
                                  seenFrom({20, 20, 0}, 6) +
                                      R"("sun": false, "ground": false, "ao": false, "sky": {"strength": 0})",
                                  64, 1);
        double sum = 0, moment = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                if (seen.at(x, y, 1) > 0.3) sum += seen.at(x, y, 1), moment += y * seen.at(x, y, 1);
        EXPECT_GT(sum, 0);
        const double perPixel = 2 * std::tan(3 * std::numbers::pi / 180) / kSide *
                                (20 * std::numbers::sqrt2 + 2.5 * std::numbers::sqrt2);
        return moment / sum * perPixel;
    };
    // Across the ray, of a slab 2 m thick: t sin(a) (1 - cos(a) / sqrt(n^2 - sin(a)^2)).
    const double sine = std::sqrt(0.5);
    const double expected = 2 * sine * (1 - sine / std::sqrt(1.5 * 1.5 - 0.5));
    EXPECT_NEAR(std::abs(shift(1.5) - shift(1.0)), expected, 0.05 * expected);
}

/// Before black and nothing else: where a thin bright rod along `axis` at this place is seen through a clear
/// solid, in metres from the middle of the picture at the target, 1 m of the picture being `fov` degrees
/// wide.
double rodSeen(Paths& test, const std::string& clear, double ior, glm::dvec3 rod, char axis, glm::dvec3 eye,
               double fov) {
    const glm::dvec3 half = axis == 'x' ? glm::dvec3(6, 0.04, 0.04) : glm::dvec3(0.04, 6, 0.04);
    const std::string nodes =
        clear +
        filled(
            R"(, {"id": "clear", "type": "material", "inputs": {"surface": {"from": "shape"}, "base_color": [1, 1, 1], "roughness": 0, "transmission": 1, "ior": $}},
               {"id": "rod", "type": "box", "inputs": {"half_extents": [$, $, $]}},
               {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "rod"}, "offset": [$, $, $]}},
               {"id": "bright", "type": "material", "inputs": {"surface": {"from": "moved"}, "base_color": [0, 0, 0], "roughness": 1, "emission": [4, 4, 4]}},
               {"id": "both", "type": "union", "inputs": {"a": {"from": "clear"}, "b": {"from": "bright"}}},
               {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})",
            {ior, half.x, half.y, half.z, rod.x, rod.y, rod.z});
    const Traced seen = test.trace(
        nodes, seenFrom(eye, fov) + R"("sun": false, "ground": false, "ao": false, "sky": {"strength": 0})",
        64, 1);
    double sum = 0, moment = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            // Its image alone, in the middle of the lens.
            const int along = axis == 'x' ? x : y, across = axis == 'x' ? kSide - 1 - y : x;
            if (std::abs(along - kSide / 2) > 3 || seen.at(x, y, 1) < 0.3) continue;
            sum += seen.at(x, y, 1), moment += (across + 0.5 - kSide / 2) * seen.at(x, y, 1);
        }
    EXPECT_GT(sum, 0);
    return moment / sum * 2 * std::tan(fov * std::numbers::pi / 360) / kSide * glm::length(eye);
}

TEST_F(Paths, ABallIsALens) {
    // A ray that passes the middle at b is turned by 2 (asin(b) - asin(b / n)): behind the ball's focus, at
    // n / (2 (n - 1)), images are upside down.
    constexpr double kIor = 1.5, kAway = 20, kBehind = 4, kHigh = 0.4;
    const auto landing = [](double b) {
        // From the eye upwards by `slope`, out of the ball `back` above the axis, `down` towards it.
        const double slope = std::asin(b / kAway), in = std::asin(b), within = std::asin(b / kIor);
        const double back = 2 * within - in + slope, down = 2 * (in - within) - slope;
        return std::sin(back) - (kBehind - std::cos(back)) * std::tan(down);
    };
    double low = 0.01, high = 0.7;
    for (int i = 0; i < 60; ++i) (landing(0.5 * (low + high)) > -kHigh ? low : high) = 0.5 * (low + high);
    const double expected = std::tan(std::asin(low / kAway)) * kAway;
    const double seen = rodSeen(*this, kBall, kIor, {0, -kHigh, -kBehind}, 'x', {0, 0, kAway}, 6);
    EXPECT_NEAR(seen, expected, 0.03) << "upside down, above the middle";
}

TEST_F(Paths, APrismTurnsWhatIsBehindIt) {
    // Straight through its front, out of a back that leans by 25 degrees: turned by asin(n sin a) - a.
    constexpr double kAngle = 25 * std::numbers::pi / 180, kAway = 60, kBehind = 4;
    const std::string wedge =
        R"({"id": "block", "type": "box", "inputs": {"half_extents": [1, 1, 1]}},
           {"id": "back", "type": "plane", "inputs": {"normal": )" +
        filled("[$, 0, $]", {-std::sin(kAngle), -std::cos(kAngle)}) +
        R"(, "offset": 0}},
           {"id": "shape", "type": "intersect", "inputs": {"a": {"from": "block"}, "b": {"from": "back"}}})";
    const double turn = std::asin(1.5 * std::sin(kAngle)) - kAngle;
    // The back passes the origin: a ray at x leaves it at z = -x tan(a), and lands kBehind behind the origin.
    const double x0 = 0.15, z0 = -x0 * std::tan(kAngle), landing = x0 + (kBehind + z0) * std::tan(turn);
    const double seen = rodSeen(*this, wedge, 1.5, {landing, 0, -kBehind}, 'y', {0, 0, kAway}, 1.8);
    EXPECT_NEAR(seen, x0, 0.06);
}

TEST_F(Paths, AWhiteRoomGathersWhatItSends) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    // All that its walls send out comes back to them: with each bounce as much again (an integrating sphere).
    for (const int bounces : {1, 4}) {
        const Traced room = trace(
            R"({"id": "ball", "type": "sphere"}, {"id": "shape", "type": "shell", "inputs": {"surface": {"from": "ball"}, "thickness": 0.1}}, )" +
                solid("", R"("base_color": [1, 1, 1], "roughness": 1, "emission": [0.25, 0.25, 0.25])")
                    .substr(2),
            R"("camera": {"position": [0, 0, 0.01], "target": [0, 0, 0], "fov": 60}, )" + kFurnace, 64,
            bounces);
        EXPECT_NEAR(room.middle(kSide / 2).g, 0.25 * (1 + bounces), 0.01 * (1 + bounces));
    }
}

/// How much of what a small part of the floor sees is a wall that stands on it: the wall's height, how far
/// its two edges are to the sides, and how far it is away (Howell, "A Catalog of Radiation Heat Transfer
/// Configuration Factors", B-4).
double shareOfWall(double high, double left, double right, double away) {
    const auto half = [&](double wide) {
        const double slanted = std::hypot(away, high);
        return (std::atan(wide / away) - away / slanted * std::atan(wide / slanted)) / (2 * std::numbers::pi);
    };
    return half(left) + half(right);
}

/// A wall of 1 m by 1 m that sends out the red of the Cornell box, and a white floor before it, seen from
/// above.
const std::string kRedWall =
    R"({"id": "upright", "type": "box", "inputs": {"half_extents": [0.05, 0.5, 0.5]}},
       {"id": "wall", "type": "translate", "inputs": {"surface": {"from": "upright"}, "offset": [-0.05, 0.5, 0]}},
       {"id": "glow", "type": "material", "inputs": {"surface": {"from": "wall"}, "base_color": [0, 0, 0], "roughness": 1,
            "emission": [0.63, 0.065, 0.05]}},
       {"id": "plate", "type": "box", "inputs": {"half_extents": [0.5, 0.05, 0.5]}},
       {"id": "floor", "type": "translate", "inputs": {"surface": {"from": "plate"}, "offset": [0.5, -0.05, 0]}},
       {"id": "white", "type": "material", "inputs": {"surface": {"from": "floor"}, "base_color": [1, 1, 1], "roughness": 1}},
       {"id": "room", "type": "union", "inputs": {"a": {"from": "glow"}, "b": {"from": "white"}}},
       {"id": "out", "type": "output", "inputs": {"surface": {"from": "room"}}})";

TEST_F(Paths, AWallBleedsByWhatTheFloorSeesOfIt) {
    double all = 0;
    for (int x = 0; x < 100; ++x)
        for (int z = 0; z < 100; ++z)
            all += 1e-4 * shareOfWall(1, 0.01 * (z + 0.5), 1 - 0.01 * (z + 0.5), 0.01 * (x + 0.5));
    EXPECT_NEAR(all, 0.20004, 2e-4);  // as published of two squares with an edge in common
    constexpr double kFov = 18.0;
    const Traced seen =
        trace(kRedWall,
              filled(R"("camera": {"position": [0.5, 3, 0.3], "target": [0.5, 0, 0], "fov": $}, )", {kFov}) +
                  R"("sun": false, "ground": false, "ao": false, "sky": {"strength": 0})",
              1024, 1);
    const double across =
        2 * std::hypot(3, 0.3) * std::tan(kFov / 360 * std::numbers::pi) / kSide;  // a pixel
    for (const int column : {3, 8, 16, 26, 36, 43}) {
        glm::dvec3 sum(0);
        double wanted = 0;
        for (int x = column - 2; x < column + 2; ++x)
            for (int y = kSide / 2 - 8; y < kSide / 2 + 8; ++y) {
                const double z = across * (y + 0.5 - kSide / 2), away = 0.5 + across * (x + 0.5 - kSide / 2);
                wanted += shareOfWall(1, 0.5 - z, 0.5 + z, away);
                for (int k = 0; k < 3; ++k) sum[k] += seen.at(x, y, k);
            }
        EXPECT_NEAR(sum.r / (0.63 * wanted), 1.0, 0.03) << column;
        EXPECT_NEAR(sum.g / sum.r, 0.065 / 0.63, 1e-3) << column;
        EXPECT_NEAR(sum.b / sum.r, 0.05 / 0.63, 1e-3) << column;
    }
}

/// A post on a plate, which is wider than all that is put beside it.
const std::string kStand =
    R"({"id": "post", "type": "box", "inputs": {"half_extents": [0.2, 2, 0.2]}},
       {"id": "plate", "type": "box", "inputs": {"half_extents": [2.2, 0.1, 2.2]}},
       {"id": "low", "type": "translate", "inputs": {"surface": {"from": "plate"}, "offset": [0, -2, 0]}},
       {"id": "stand", "type": "union", "inputs": {"a": {"from": "post"}, "b": {"from": "low"}}})";

TEST_F(Paths, WhatBendsNothingIsNotSeen) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const std::string scene = seenFrom({0, 2, 5}, 40) + R"("sky": {}, "ground": false, "sun": {"size": 40})";
    const auto with = [&](const std::string& material) {
        return trace(
            kStand +
                R"(, {"id": "ball", "type": "sphere"}, {"id": "shape", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 0, 1]}},
            {"id": "paint", "type": "material", "inputs": {"surface": {"from": "shape"}, )" +
                material + R"(}},
            {"id": "both", "type": "union", "inputs": {"a": {"from": "paint"}, "b": {"from": "stand"}}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})",
            scene, 128);
    };
    const Traced there = with(R"("base_color": [1, 1, 1], "transmission": 1, "roughness": 0, "ior": 1)"),
                 painted = with(R"("base_color": [1, 1, 1], "roughness": 0)");
    const Traced without =
        trace(kStand + R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": "stand"}}})",
              scene, 128);
    // Lamps behind it are found by other paths, so that each pixel has noise of its own, but not all of them.
    for (const int reach : {4, 12, kSide / 2})
        EXPECT_NEAR(there.middle(reach).g, without.middle(reach).g, 0.02);
    EXPECT_GT(std::abs(painted.middle(4).g - without.middle(4).g), 0.05);
}

TEST_F(Paths, TheSunIsFoundByEitherWay) {
    // What a white floor sends back of the sun: irradiance over pi, whether the sun is a point or a disc.
    for (const char* size : {"0", "4", "30"}) {
        SCOPED_TRACE(size);
        const Traced floor = trace(
            solid(kBlock, R"("base_color": [0.5, 0.5, 0.5], "roughness": 1, "metallic": 0)"),
            seenFrom({0, 12, 1e-3}) +
                filled(
                    R"("ground": false, "ao": false, "sky": {"strength": 0}, "sun": {"elevation": 90, "strength": 3, "color": [1, 1, 1], "size": $})",
                    {std::string(size)}),
            256, 1);
        // Chalk, with what facets mask, and the gloss of those that are level: D F G / 4, D = 1 / pi.
        const Facets facets = facetsSeen(1.0);
        EXPECT_NEAR(floor.middle(12).g * std::numbers::pi / 3,
                    (1 - facets.leave - facets.again) * 0.5 + facets.again + 0.01, 0.01);
    }
}

TEST_F(Paths, GoesOnWhereItWasLeft) {
    const std::string nodes = solid(kBall,
                                    R"("base_color": [1, 0.9, 0.8], "roughness": 0.1, "transmission": 0.5)"),
                      scene = seenFrom({0, 1, 5}, 30) + R"("sky": {})";
    const Traced whole = trace(nodes, scene, 21), part = trace(nodes, scene, 5),
                 rest = trace(nodes, scene, 21, 8, part.sums);
    EXPECT_EQ(whole.sums.sums, rest.sums.sums);
    EXPECT_EQ(whole.picture.pixels, rest.picture.pixels);
    EXPECT_NE(whole.picture.pixels, part.picture.pixels);
}

}  // namespace fw::paths_test
