// Shaping by hand in the real window: several nodes at once, steps, Escape, and the picture's buttons.
#include <gtest/gtest.h>

#include <cmath>

#include "editor/shell/theme.h"
#include "graph/document/named_parameters.h"
#include "graph/document/scene.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_handles_test {

constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "a", "type": "box", "at": [0, 0], "inputs": {"half_extents": [0.5, 0.5, 0.5]}},
    {"id": "b", "type": "sphere", "at": [0, 240], "inputs": {"radius": 0.5}},
    {"id": "left", "type": "translate", "at": [240, 0], "inputs": {"surface": {"from": "a"}, "offset": [-1.03, 0, 0]}},
    {"id": "right", "type": "translate", "at": [240, 240], "inputs": {"surface": {"from": "b"}, "offset": [1, 0.25, 0]}},
    {"id": "both", "type": "union", "at": [480, 0], "inputs": {"a": {"from": "left"}, "b": {"from": "right"}}},
    {"id": "out", "type": "output", "at": [720, 0], "inputs": {"surface": {"from": "both"}, "resolution": 16}}],
  "scene": {"camera": {"position": [0, 0, 14], "target": [0, 0, 0], "fov": 40},
    "lights": [{"type": "point", "position": [0, 2.2, 0], "color": [0, 1, 0], "strength": 0.01}]}})";

Area picturePart(const Program& program) { return {{program.view.panel.hi.x + 20, 120}, {1260, 400}}; }

/// The rightmost pixel of this colour in the picture; none if there is none.
std::optional<ImVec2> rightmost(Program& program, ImU32 color) {
    const Area part = picturePart(program);
    const Picture seen = program.screen(part);
    std::optional<ImVec2> end;
    for (int y = 0; y < seen.height; ++y)
        for (int x = 0; x < seen.width; ++x) {
            const uint8_t* pixel = &seen.pixels[std::size_t(y * seen.width + x) * 4];
            if (pixel[0] != (color & 255) || pixel[1] != (color >> 8 & 255) ||
                pixel[2] != (color >> 16 & 255))
                continue;
            const ImVec2 at(part.lo.x + float(x), part.lo.y + float(y));
            if (!end || at.x > end->x) end = at;
        }
    return end;
}

ImVec2 waitForColor(Program& program, ImU32 color) {
    std::optional<ImVec2> end;
    EXPECT_TRUE(eventually([&] { return (end = rightmost(program, color)).has_value(); })) << color;
    return end.value_or(ImVec2());
}
/// The end of the red arrow to the right.
ImVec2 waitForArrow(Program& program) { return waitForColor(program, axisColor(0)); }

Triple lampOf(const Graph& graph) { return readScene(graph.scene)->lights.at(0).position; }

std::vector<double> offsetOf(const Graph& graph, const std::string& node) {
    return inputNumbers(*findNode(graph.nodes, node), "offset");
}

TEST(EndToEnd, SeveralNodesAreMovedByHandInStepsAndBack) {
    Program program(kDocument);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.frameAll();
    program.click(program.title("left"));
    program.click(program.title("right"), 1, "shift");
    ImVec2 from, last;
    EXPECT_TRUE(eventually([&] {  // until the arrow is the one of both, where it stays
        last = std::exchange(from, waitForArrow(program));
        program.save();
        return from.x == last.x && from.y == last.y;
    }));
    const ImVec2 tip(from.x - 4, from.y);
    program.moveTo(tip);
    program.waitFor("Move 2 Nodes", picturePart(program));
    program.drag({tip, {tip.x + 20, tip.y}, {tip.x + 50, tip.y}});
    const std::vector<double> left = offsetOf(program.saved(), "left"),
                              right = offsetOf(program.graph(), "right");
    const double by = left[0] + 1.03;
    EXPECT_GT(by, 0.2);
    EXPECT_NEAR(right[0] - 1.0, by, 1e-6) << "both go as far";
    EXPECT_EQ(left[1], 0.0);
    EXPECT_EQ(right[1], 0.25);

    program.moveTo(program.nowhere());
    program.keys("Ctrl+Z");
    EXPECT_EQ(offsetOf(program.saved(), "left"), (std::vector<double>{-1.03, 0, 0})) << "it is one step";
    EXPECT_EQ(offsetOf(program.graph(), "right"), (std::vector<double>{1, 0.25, 0}));

    // Escape takes back what is under the hand.
    const ImVec2 again = waitForArrow(program);
    const ImVec2 held(again.x - 4, again.y);
    program.drag({held, {held.x + 20, held.y}, {held.x + 50, held.y}}, 1, {}, false, false);
    program.keys("Escape");
    program.release();
    program.moveTo(program.nowhere());
    EXPECT_EQ(offsetOf(program.saved(), "left"), (std::vector<double>{-1.03, 0, 0}));

    // The magnet: both go by a multiple of 0.1 m.
    const ImVec2 third = waitForArrow(program);
    program.moveTo({third.x - 4, third.y});
    program.waitFor("Move 2 Nodes", picturePart(program));
    program.keys("Shift+Tab");
    program.waitFor("Snap: drags in the picture", Area{{0, 770}, {1280, 800}});
    program.drag({{third.x - 4, third.y}, {third.x + 20, third.y}, {third.x + 43, third.y}});
    const double step = offsetOf(program.saved(), "left")[0] + 1.03;
    EXPECT_GT(step, 0.2);
    EXPECT_NEAR(std::remainder(step, 0.1), 0.0, 1e-6) << step;

    program.clickOn("Options", Area{{820, 300}, {1280, 460}});
    program.waitFor("Centres and ends");
    program.waitFor("Each its own");
    program.clickOn("Lamps and camera");
    program.keys("Escape");
    program.waitUntilGone("Centres and ends");

    // The lamp, by its colour: a click chooses it, and it is moved as a node is.
    const ImVec2 lamp = waitForColor(program, IM_COL32(0, 255, 0, 255));
    program.moveTo({lamp.x - 2, lamp.y});
    program.waitFor("Lamp 1", picturePart(program));
    program.click({lamp.x - 2, lamp.y});
    program.waitFor("Move Lamp 1", picturePart(program));
    program.drag({{lamp.x - 2, lamp.y}, {lamp.x + 20, lamp.y}, {lamp.x + 40, lamp.y}});
    const Triple there = lampOf(program.saved());
    EXPECT_GT(there[0], 0.5);
    EXPECT_NEAR(there[1], 2.2, 0.06) << "it goes in steps still";
    program.moveTo(program.nowhere());
    program.keys("Ctrl+Z");
    EXPECT_EQ(lampOf(program.saved()), (Triple{0, 2.2, 0}));
}

}  // namespace fw::editor::test::end_to_end_handles_test
