// The split picture in the real window: each view shows what is moved where it has to, has handles, and is
// looked about in for itself.
#include <gtest/gtest.h>

#include <cmath>

#include "editor/shell/theme.h"
#include "graph/document/named_parameters.h"
#include "graph/document/scene.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_split_test {

/// A magenta ball that is moved between two grey ones, which keep the solid's bounds.
constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 0.5}},
    {"id": "paint", "type": "material", "at": [220, 0], "inputs": {"surface": {"from": "ball"}, "base_color": [1, 0, 1]}},
    {"id": "place", "type": "translate", "at": [440, 0], "inputs": {"surface": {"from": "paint"}, "offset": [0, 0, 0]}},
    {"id": "dot", "type": "sphere", "at": [0, 260], "inputs": {"radius": 0.3}},
    {"id": "low", "type": "translate", "at": [220, 260], "inputs": {"surface": {"from": "dot"}, "offset": [-2, -2, -2]}},
    {"id": "high", "type": "translate", "at": [220, 420], "inputs": {"surface": {"from": "dot"}, "offset": [2, 2, 2]}},
    {"id": "dots", "type": "union", "at": [440, 260], "inputs": {"a": {"from": "low"}, "b": {"from": "high"}}},
    {"id": "all", "type": "union", "at": [660, 0], "inputs": {"a": {"from": "place"}, "b": {"from": "dots"}}},
    {"id": "out", "type": "output", "at": [880, 0], "inputs": {"surface": {"from": "all"}, "resolution": 40}}],
  "scene": {"camera": {"position": [3, 3, 12], "target": [0, 0, 0], "fov": 40}}})";

struct Views {
    Area first, front, right, top;
};

/// Where they are, by the words at their lower right corners.
Views viewsOf(Program& program) {
    const ImVec2 front = program.waitFor("Front · orthographic").hi,
                 right = program.waitFor("Right · orthographic").hi,
                 top = program.waitFor("Top · orthographic").hi;
    const ImVec2 size(right.x - front.x - 4, front.y - top.y - 4), pad(8, 6);
    const auto ending = [&](ImVec2 at) {
        const ImVec2 hi(at.x + pad.x, at.y + pad.y);
        return Area{{hi.x - size.x, hi.y - size.y}, hi};
    };
    return {ending({right.x, top.y}), ending(front), ending(right), ending(top)};
}

/// The middle of what has a colour in a view; none if it is nowhere.
std::optional<ImVec2> middleOf(Program& program, const Area& view,
                               const std::function<bool(const uint8_t*)>& is) {
    const Picture seen = program.screen(view);
    double x = 0, y = 0, count = 0;
    for (int row = 0; row < seen.height; ++row)
        for (int column = 0; column < seen.width; ++column)
            if (is(&seen.pixels[std::size_t(row * seen.width + column) * 4])) x += column, y += row, ++count;
    if (count < 4) return std::nullopt;
    return ImVec2(view.lo.x + float(x / count), view.lo.y + float(y / count));
}
bool isMagenta(const uint8_t* p) { return p[0] > 130 && p[2] > 130 && p[1] < 90; }

std::optional<ImVec2> ballIn(Program& program, const Area& view) {
    return middleOf(program, view, isMagenta);
}

/// Waits until the ball has gone so in the view: -1, 0 or 1 to the right and upwards.
void expectMoved(Program& program, const Area& view, ImVec2 from, int right, int up, const char* name) {
    const auto way = [](float by) { return std::abs(by) < 4.0f ? 0 : by > 0.0f ? 1 : -1; };
    std::optional<ImVec2> now;
    EXPECT_TRUE(eventually([&] {
        now = ballIn(program, view);
        return now && way(now->x - from.x) == right && way(from.y - now->y) == up;
    })) << name
        << (now ? ": " + std::to_string(now->x - from.x) + ", " + std::to_string(from.y - now->y) : ": none");
}

/// Presses the keys with the mouse over a view, once it is known to be there.
void lookIn(Program& program, const Area& view, const std::string& keys, const std::string& words) {
    program.moveTo({view.lo.x + 12, view.lo.y + 12});
    EXPECT_TRUE(eventually([&] {
        program.keys(keys);
        return program.sees(words, view);
    })) << words;
}

std::vector<double> placeOf(const Graph& graph) {
    return inputNumbers(*findNode(graph.nodes, "place"), "offset");
}

TEST(EndToEndSplit, EachViewShowsAndMovesTheDocumentFromItsSide) {
    Program program(kDocument);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.frameAll();
    const Area whole = {{program.view.panel.hi.x + 20, 100}, {1276, 440}};
    lookIn(program, whole, "1", "Front · perspective");
    program.keys("Z", 3);
    program.waitFor("Colours");  // each in one colour, whatever the light
    program.keys("0");
    program.waitFor("Scene camera");
    program.keys("Ctrl+Alt+Q");
    const Views views = viewsOf(program);
    std::optional<ImVec2> front, right, top;
    EXPECT_TRUE(eventually([&] {
        front = ballIn(program, views.front), right = ballIn(program, views.right);
        top = ballIn(program, views.top);
        return front && right && top && ballIn(program, views.first);
    }));
    ASSERT_TRUE(front && right && top);
    EXPECT_NEAR(front->x, views.front.centre().x, 4);
    EXPECT_NEAR(right->y, views.right.centre().y, 4);

    // Along +x it goes right in the front and the top view, and towards the eye in the right one.
    program.set("place", "offset", 0, "1");
    expectMoved(program, views.front, *front, 1, 0, "front, +x");
    expectMoved(program, views.top, *top, 1, 0, "top, +x");
    expectMoved(program, views.right, *right, 0, 0, "right, +x");
    // Along +y up in front and right, along +z left in the right view and down in the top view.
    program.set("place", "offset", 0, "0");
    program.set("place", "offset", 1, "1");
    expectMoved(program, views.front, *front, 0, 1, "front, +y");
    expectMoved(program, views.right, *right, 0, 1, "right, +y");
    expectMoved(program, views.top, *top, 0, 0, "top, +y");
    program.set("place", "offset", 1, "0");
    program.set("place", "offset", 2, "1");
    expectMoved(program, views.right, *right, -1, 0, "right, +z");
    expectMoved(program, views.top, *top, 0, -1, "top, +z");
    expectMoved(program, views.front, *front, 0, 0, "front, +z");
    program.set("place", "offset", 2, "0");
    expectMoved(program, views.right, *right, 0, 0, "right, back");

    // A click selects in the view that it is made in; handles are dragged there.
    program.moveTo(program.nowhere());
    program.click(program.title("place"));
    const auto isBlue = [](const uint8_t* p) {
        return std::abs(p[2] - int(axisColor(2) >> 16 & 255)) < 3 &&
               std::abs(p[0] - int(axisColor(2) & 255)) < 3;
    };
    std::optional<ImVec2> arrow;
    EXPECT_TRUE(eventually([&] { return (arrow = middleOf(program, views.right, isBlue)).has_value(); }));
    ASSERT_TRUE(arrow);
    EXPECT_LT(arrow->x, right->x - 10) << "z points to the left";
    const ImVec2 hold(arrow->x - 8, right->y);
    program.moveTo(hold);
    program.waitFor("Move Translate");
    program.drag({hold, {hold.x - 10, hold.y}, {hold.x - 30, hold.y}});
    const std::vector<double> dragged = placeOf(program.saved());
    EXPECT_GT(dragged[2], 0.2);
    EXPECT_NEAR(dragged[0], 0.0, 1e-9);
    EXPECT_NEAR(dragged[1], 0.0, 1e-9);
    expectMoved(program, views.top, *top, 0, -1, "top, after the drag");
    program.moveTo(program.nowhere());
    program.keys("Ctrl+Z");
    EXPECT_EQ(placeOf(program.saved())[2], 0.0) << "it is one step";

    // Each is looked about in by itself.
    lookIn(program, views.top, "3", "Right · orthographic");
    program.waitFor("Front · orthographic", views.front);
    program.keys("Ctrl+B");
    program.waitFor("kept as view 1");
    const ImVec2 away(views.front.lo.x + 20, views.front.lo.y + 20);
    program.drag({away, {away.x + 15, away.y + 10}, {away.x + 30, away.y + 20}});
    program.waitFor("User · orthographic", views.front);
    program.waitFor("Right · orthographic", views.right);
    lookIn(program, views.front, "B", "Right · orthographic");
    program.clickOn("Reset views");
    program.waitFor("Front · orthographic", views.front);
    program.waitFor("Top · orthographic", views.top);

    // A click selects what is seen in the view that it is made in.
    program.click(program.nowhere());
    program.click({right->x + 3, right->y + 2});
    program.waitFor("ball", Area{{990, 540}, {1280, 580}});  // its id in the inspector

    program.keys("Ctrl+Alt+Q");
    program.waitUntilGone("Front · orthographic");
    program.waitFor("Scene camera", Area{{program.view.panel.hi.x, 400}, {1280, 470}});
    EXPECT_EQ(readScene(program.saved().scene)->camera->position, (Triple{3, 3, 12}));
}

}  // namespace fw::editor::test::end_to_end_split_test
