// Flat outlines drawn by hand: the edits, and the window in which they are made by mouse and keys.
#include <gtest/gtest.h>

#include <cmath>

#include "editor/outline/edits.h"
#include "tests/support/editor/program.h"

namespace fw::editor::outline_test {

using outline::Points;
using outline::Selection;
using test::Program;

const Points kSquare{{0, 0, 1, 0, 1, 1, 0, 1}, {}};

TEST(Outline2D, PointsAndSidesAreFoundWithinReach) {
    EXPECT_EQ(outline::pointAt(kSquare, {0.95, 0.1}, 0.2), 1u);
    EXPECT_FALSE(outline::pointAt(kSquare, {0.5, 0.5}, 0.2));
    const auto side = outline::sideAt(kSquare, {-0.1, 0.3}, 0.2);
    ASSERT_TRUE(side);
    EXPECT_EQ(side->after, 3u) << "the one that closes it";
    EXPECT_EQ(side->place[0], 0.0);
    EXPECT_NEAR(side->place[1], 0.3, 1e-12);
    EXPECT_FALSE(outline::sideAt(kSquare, {-0.3, 0.3}, 0.2));
    EXPECT_EQ(outline::within(kSquare, {2, 0.5}, {0.5, -1}), (Selection{1}));
}

TEST(Outline2D, PointsAreMovedToTheGrid) {
    Points points = kSquare;
    points.selected = {1, 2};
    EXPECT_EQ(outline::moved(points, {0.23, 0.0}, 0.1).numbers,
              (std::vector<double>{0, 0, 1.2, 0, 1.2, 1, 0, 1}));
    EXPECT_EQ(outline::moved(points, {0.25, -0.5}, 0.0).numbers,
              (std::vector<double>{0, 0, 1.25, -0.5, 1.25, 0.5, 0, 1}));
}

TEST(Outline2D, PointsComeAndGo) {
    const Points more = outline::inserted(kSquare, 3, {0, 0.5});
    EXPECT_EQ(more.count(), 5u);
    EXPECT_EQ(more.selected, (Selection{4}));
    Points again = more;
    EXPECT_EQ(outline::removed(again).numbers, kSquare.numbers);
    again = kSquare, again.selected = {0, 1};
    EXPECT_EQ(outline::removed(again), again) << "two points are no outline";
    again.selected = {0, 1, 2, 3};
    const Points divided = outline::divided(again);
    EXPECT_EQ(divided.count(), 8u);
    EXPECT_EQ(divided.selected.size(), 8u);
    EXPECT_EQ(divided.at(7), (Position{0.0, 0.5}));
    EXPECT_EQ(outline::twiceArea(divided), 2.0);
}

TEST(Outline2D, MirrorsKeepTheSenseOfRotation) {
    EXPECT_EQ(outline::twiceArea(kSquare), 2.0);
    for (const int axis : {0, 1}) {
        const Points flipped = outline::flipped(kSquare, axis);
        EXPECT_EQ(outline::twiceArea(flipped), 2.0);
        EXPECT_EQ(outline::flipped(flipped, axis).numbers, kSquare.numbers);
    }
    EXPECT_EQ(outline::mirrored(kSquare, 0).numbers,
              (std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1, -1, 1, -1, 0}));
    // Cut where it crosses the axis: a square half a metre to the left gets as wide as its right part twice.
    const Points left{{-1.5, 0, 0.5, 0, 0.5, 1, -1.5, 1}, {}};
    const Points alike = outline::mirrored(left, 0);
    EXPECT_EQ(outline::twiceArea(alike), 2.0);
    EXPECT_FALSE(outline::crossesItself(alike));
    const Points away{{-2, 0, -1, 0, -1, 1}, {}};
    EXPECT_EQ(outline::mirrored(away, 0), away);
    EXPECT_EQ(outline::mirrored(alike, 0).numbers.size(), alike.numbers.size());
}

TEST(Outline2D, CrossingsAreSeen) {
    EXPECT_FALSE(outline::crossesItself(kSquare));
    EXPECT_TRUE(outline::crossesItself({{0, 0, 1, 1, 1, 0, 0, 1}, {}}));
    EXPECT_FALSE(outline::crossesItself({{0, 0, 1, 0, 0, 1}, {}}));
}

class OutlineWindow : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
        program.frameAll();
        program.click(program.title("shape"));
        program.clickOn("Draw …");
        const Area tools = program.waitFor("Mirror");
        program.waitFor("4 points, 0 selected");
        // The sheet has the middle of the outline in its middle, and is between the tools and the last line.
        const Area last = program.waitFor("4 points, 0 selected");
        const float top = tools.hi.y, bottom = last.lo.y;
        middle = {640.0f, 0.5f * (top + bottom)};
    }
    /// A drag of a corner tells how many pixels a metre has: by what the document says of it.
    Points points() {
        const InputValue* value = program.saved().node("shape")->input("points");
        return {value ? std::get<std::vector<double>>(value->value) : std::vector<double>{}, {}};
    }

    Program program{R"({"fieldwright": 1, "nodes": [
        {"id": "shape", "type": "polygon", "at": [0, 0], "inputs": {"points": [[-1, -1], [1, -1], [1, 1], [-1, 1]]}},
        {"id": "out", "type": "output", "at": [300, 0], "inputs": {"surface": {"from": "shape"}, "resolution": 16}}]})"};
    ImVec2 middle{};
};

TEST_F(OutlineWindow, PointsAreDrawnByMouseAndKeys) {
    // All of the outline is seen: 80 % of the sheet's height, so a metre is 0.4 of it. Found by selecting
    // all.
    program.click(middle);
    program.keys("Ctrl+A");
    program.waitFor("4 points, 4 selected");
    program.keys("Right", 2);
    EXPECT_EQ(points().numbers, (std::vector<double>{-0.8, -1, 1.2, -1, 1.2, 1, -0.8, 1}));
    program.keys("Left", 2);
    // A double click in the middle: a new point, for it is near to no side the nearest.
    program.doubleClick(middle);
    program.waitFor("Point");
    EXPECT_EQ(points().count(), 5u);
    program.keys("Delete");
    program.waitFor("4 points, 0 selected");
    EXPECT_EQ(points().count(), 4u);
    program.keys("Ctrl+Z");
    EXPECT_EQ(points().count(), 5u);
    program.keys("Ctrl+Z");
    // A rectangle over everything selects all; Escape closes the window, and Delete is the canvas' again.
    program.drag({{middle.x - 300, middle.y - 200}, middle, {middle.x + 300, middle.y + 200}});
    program.waitFor("4 points, 4 selected");
    program.clickOn("Divide");
    program.waitFor("8 points, 8 selected");
    EXPECT_EQ(points().count(), 8u);
    program.click(middle);
    program.keys("Escape");
    program.waitUntilGone("8 selected");
    EXPECT_EQ(program.saved().nodes.size(), 2u);
}

}  // namespace fw::editor::outline_test
