// Orthographic views, grids and round lengths, and views that are kept, without a window.
#include "editor/viewport/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "editor/viewport/ground.h"
#include "editor/viewport/kept_views.h"

namespace fw::editor::projection_test {

const Area kPlace{{0, 0}, {600, 400}};

Orbit somewhere() {
    Orbit orbit;
    orbit.target = {1.0, -2.0, 0.5};
    orbit.azimuth = 0.7, orbit.elevation = 0.4, orbit.distance = 6.0, orbit.fov = 40.0;
    return orbit;
}

glm::dvec3 vec(const Vector& v) { return {v[0], v[1], v[2]}; }

/// How far apart, in pixels, points are seen that lie `metres` above and below, so far before the target.
double seenHeight(const Orbit& orbit, double metres, double before) {
    const Lens lens(orbit.camera(), kPlace);
    const Axes axes = axesOf(orbit);
    const glm::dvec3 at = vec(orbit.target) + before * vec(axes.back), up = metres * vec(axes.up);
    return double(lens.project(at - up)->y - lens.project(at + up)->y);
}

TEST(Projection, WhatLiesAtTheTargetKeepsItsSize) {
    const Orbit orbit = somewhere(), parallel = throughLensOf(orbit, kParallelFov);
    EXPECT_NEAR(seenHeight(parallel, 1.0, 0.0), seenHeight(orbit, 1.0, 0.0), 0.01);
    EXPECT_TRUE(isParallel(parallel));
    EXPECT_FALSE(isParallel(orbit));
    EXPECT_NEAR(throughLensOf(parallel, orbit.fov).distance, orbit.distance, 1e-9);
}

TEST(Projection, IsAsNearToParallelAsItsHeaderSays) {
    const Orbit orbit = throughLensOf(somewhere(), kParallelFov);
    const double height = 2.0 * orbit.distance * std::tan(orbit.fov * 3.14159265358979 / 360.0);
    const double grown = seenHeight(orbit, 1.0, 0.5 * height) / seenHeight(orbit, 1.0, 0.0) - 1.0;
    EXPECT_GT(grown, 0.0);
    EXPECT_LT(grown, 0.009);
    EXPECT_GT(seenHeight(somewhere(), 1.0, 0.5 * height) / seenHeight(somewhere(), 1.0, 0.0), 1.3);
}

TEST(Projection, WordsSayFromWhereItLooks) {
    Orbit orbit = somewhere();
    EXPECT_EQ(wordsOf(orbit, false), "User · perspective");
    constexpr std::pair<Side, const char*> kWords[] = {{Side::front, "Front"}, {Side::back, "Back"},
                                                       {Side::left, "Left"},   {Side::right, "Right"},
                                                       {Side::top, "Top"},     {Side::bottom, "Bottom"}};
    for (const auto& [side, name] : kWords) {
        lookFrom(orbit, side);
        EXPECT_EQ(sideOf(orbit), side);
        EXPECT_EQ(wordsOf(orbit, true), std::string(name) + " · orthographic");
    }
    lookFrom(orbit, Side::top);
    turn(orbit, 0.01, 0.0);
    EXPECT_EQ(sideOf(orbit), std::nullopt);
}

TEST(Projection, RoundLengthsAreOneTwoOrFive) {
    EXPECT_DOUBLE_EQ(roundUp125(0.13), 0.2);
    EXPECT_DOUBLE_EQ(roundUp125(0.2), 0.2);
    EXPECT_DOUBLE_EQ(roundUp125(51.0), 100.0);
    EXPECT_DOUBLE_EQ(roundDown125(0.19), 0.1);
    EXPECT_DOUBLE_EQ(roundDown125(9.9), 5.0);
    EXPECT_DOUBLE_EQ(roundDown125(1000.0), 1000.0);
    EXPECT_EQ(lengthWords(0.5, *lengthUnit("m")), "50 cm");
    EXPECT_EQ(lengthWords(2000.0, *lengthUnit("m")), "2 km");
    EXPECT_EQ(lengthWords(0.001, *lengthUnit("m")), "1 mm");
    EXPECT_EQ(lengthWords(1.0, *lengthUnit("m")), "1 m");
    EXPECT_EQ(lengthWords(50.0, *lengthUnit("mm")), "5 cm") << "as a part in millimetres is";
    EXPECT_EQ(lengthWords(0.5, *lengthUnit("in")), "0.5 in");
}

TEST(Ground, LinesLieOnThePlaneThatIsLookedAt) {
    for (const std::optional<Side> side : {std::optional<Side>(), std::optional(Side::top),
                                           std::optional(Side::front), std::optional(Side::right)}) {
        Orbit orbit = somewhere();
        if (side) lookFrom(orbit, *side), orbit = throughLensOf(orbit, kParallelFov);
        const Lens lens(orbit.camera(), kPlace);
        const Grid grid = gridOf(lens, vec(orbit.target), side);
        EXPECT_DOUBLE_EQ(grid.spacing, roundUp125(grid.spacing));
        const int across = side == Side::front ? 2 : side == Side::right ? 0 : 1;
        std::set<int> axes;
        for (const GridLine& line : grid.lines) {
            EXPECT_EQ(line.from[across], 0.0);
            EXPECT_EQ(line.to[across], 0.0);
            for (int i = 0; i < 3; ++i) {
                if (i == line.along) continue;
                const double place = line.from[i];
                EXPECT_EQ(line.to[i], place);
                EXPECT_NEAR(place / grid.spacing, std::round(place / grid.spacing), 1e-9);
                EXPECT_EQ(line.axis, i == across ? line.axis : place == 0.0);
            }
            if (line.axis) axes.insert(line.along);
        }
        EXPECT_EQ(axes.size(), 2u);
        EXPECT_FALSE(axes.contains(across));
    }
}

TEST(KeptViews, AreReadAsTheyWereWritten) {
    const std::vector<KeptView> views = {{somewhere(), true}, {Orbit{}, false}};
    Json json = jsonOf(views);
    json.push_back("no view");
    json.push_back({{"target", {1, 2}}, {"distance", 1}});
    json.push_back(json[0]);
    json.back()["distance"] = -1.0;
    const std::vector<KeptView> read = keptViewsIn(json);
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].orbit.camera(), somewhere().camera());
    EXPECT_EQ(read[0].orbit.azimuth, somewhere().azimuth);
    EXPECT_TRUE(read[0].orthographic);
    EXPECT_FALSE(read[1].orthographic);
}

}  // namespace fw::editor::projection_test
