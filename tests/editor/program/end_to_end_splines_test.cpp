// A spline shaped by hand in the real window: a point dragged, pulled out of the curve, removed, added at an
// end.
#include <gtest/gtest.h>

#include <cmath>

#include "graph/document/named_parameters.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_splines_test {

constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "curve", "type": "spline", "at": [0, 0], "inputs": {"kind": "straight", "knots": [[-1.5, 0, 0, 1, 0], [1.5, 0, 0, 1, 0]]}},
    {"id": "tube", "type": "tube", "at": [280, 0], "inputs": {"spline": {"from": "curve"}, "radius": 0.5}},
    {"id": "out", "type": "output", "at": [560, 0], "inputs": {"surface": {"from": "tube"}, "resolution": 16}}],
  "scene": {"camera": {"position": [0, 0, 14], "target": [0, 0, 0], "fov": 40}}})";

/// The middles of the leftmost and the rightmost of the points in the picture.
std::optional<std::pair<ImVec2, ImVec2>> ends(Program& program) {
    const Area part{{program.view.panel.hi.x + 20, 120}, {1260, 400}};
    const Picture seen = program.screen(part);
    std::optional<std::pair<ImVec2, ImVec2>> found;
    for (int y = 0; y < seen.height; ++y)
        for (int x = 0; x < seen.width; ++x) {
            const uint8_t* pixel = &seen.pixels[std::size_t(y * seen.width + x) * 4];
            if (pixel[0] != 0xf0 || pixel[1] != 0xf0 || pixel[2] != 0xf0) continue;
            const ImVec2 at(part.lo.x + float(x), part.lo.y + float(y));
            if (!found) found.emplace(at, at);
            if (at.x < found->first.x) found->first = at;
            if (at.x > found->second.x) found->second = at;
        }
    if (!found || found->second.x - found->first.x < 40) return std::nullopt;
    found->first.x += 4, found->second.x -= 4;
    return found;
}

TEST(EndToEnd, ASplineIsShapedInThePicture) {
    Program program(kDocument);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.frameAll();
    program.click(program.title("curve"));
    std::optional<std::pair<ImVec2, ImVec2>> seen;
    ASSERT_TRUE(eventually([&] { return (seen = ends(program)).has_value(); }));
    const auto knots = [&] { return inputNumbers(*findNode(program.saved().nodes, "curve"), "knots"); };
    // The right end upwards.
    const ImVec2 right = seen->second, middle{0.5f * (seen->first.x + right.x), right.y};
    program.drag({right, {right.x, right.y - 20}, {right.x, right.y - 40}});
    std::vector<double> now = knots();
    ASSERT_EQ(now.size(), 10u);
    EXPECT_GT(now[6], 0.2);
    EXPECT_NEAR(now[5], 1.5, 0.02);
    program.moveTo(program.nowhere());
    program.keys("Ctrl+Z");
    EXPECT_EQ(knots()[6], 0.0) << "it is one step";
    // A point out of the curve.
    program.moveTo(middle);
    program.waitFor("Drag: a new point");
    program.drag({middle, {middle.x, middle.y + 20}, {middle.x, middle.y + 40}});
    now = knots();
    ASSERT_EQ(now.size(), 15u);
    EXPECT_NEAR(now[5], 0.0, 0.05);
    EXPECT_LT(now[6], -0.2);
    EXPECT_EQ(now[8], 1.0);
    // And away again.
    program.doubleClick({middle.x, middle.y + 40});
    program.moveTo(program.nowhere());
    EXPECT_EQ(knots().size(), 10u);
    // One beyond the end.
    program.drag({right, {right.x + 20, right.y - 10}, {right.x + 40, right.y - 30}}, 1, "ctrl");
    now = knots();
    ASSERT_EQ(now.size(), 15u);
    EXPECT_GT(now[10], 1.6);
    EXPECT_GT(now[11], 0.1);
}

}  // namespace fw::editor::test::end_to_end_splines_test
