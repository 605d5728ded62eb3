// Understanding a graph in the real window: what the probe reads, what is measured in the picture, the plot
// along a line and its table, and wires that tell how far their distance can be trusted.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "editor/shell/theme.h"
#include "tests/editor/program.h"

namespace fw::editor::test::end_to_end_probe_test {

using fw::test::readText;

/// The output is on one height with the union: the wire between them is straight.
constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 0.5}},
    {"id": "box", "type": "box", "at": [0, 160], "inputs": {"half_extents": [0.1, 0.1, 0.1]}},
    {"id": "both", "type": "union", "at": [260, 0], "inputs": {"a": {"from": "ball"}, "b": {"from": "box"}}},
    {"id": "out", "type": "output", "at": [560, 0], "inputs": {"surface": {"from": "both"}, "resolution": 16}}],
  "scene": {"camera": {"position": [0, 0, 3], "target": [0, 0, 0], "fov": 40}}})";

Area picturePart(const Program& program) { return {{program.view.panel.hi.x + 20, 120}, {1260, 400}}; }

/// Of the pixels along the wire from the union to the output, how many are not the canvas's.
double drawnPart(Program& program) {
    const ImVec2 from = program.output("both"), to = program.input("out", "surface");
    // The first quarter: behind it is the arrowhead.
    const Area part{{from.x + 8, from.y - 1}, {from.x + 0.25f * (to.x - from.x), from.y + 1}};
    const Picture seen = program.screen(part);
    const ImU32 canvas = themeColor(ThemeColor::canvas), grid = themeColor(ThemeColor::grid);
    const auto near = [](const uint8_t* pixel, ImU32 color) {
        int off = 0;
        for (int i = 0; i < 3; ++i) off += std::abs(int(pixel[i]) - int(color >> (8 * i) & 0xff));
        return off < 24;
    };
    int drawn = 0;
    for (int x = 0; x < seen.width; ++x) {
        const uint8_t* pixel = seen.pixels.data() + 4 * x;
        drawn += !near(pixel, canvas) && !near(pixel, grid);
    }
    return double(drawn) / std::max(seen.width, 1);
}

TEST(EndToEndProbe, ReadsMeasuresAndPlots) {
    Program program(kDocument);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.save();
    program.frameAll();
    const auto boxOf = [&](const char* node) {
        return program.view.toScreen(Boxes(program.graph(), "").find(node)->area);
    };

    // A place that is typed: what is known of it stands on the nodes and in the list.
    program.keys("Alt+P");
    program.waitFor("Point at the solid in the picture, or type a place.");
    const Area pinned = program.waitFor("Pinned");
    program.click({pinned.lo.x + 30, pinned.centre().y - 23});
    program.keys("Ctrl+A");
    program.type("2\n");
    program.waitFor("1.5 m", boxOf("ball"));
    program.waitFor("1.9 m", boxOf("box"));
    program.waitFor("1.5 m", boxOf("both"));
    program.waitFor("A: Sphere");

    // Along x through that place: the ball's own thickness, and a table in a file.
    program.click(program.title("ball"));
    program.clickOn("Along x");
    program.waitFor("1 m thick, from");
    program.clickOn("Save as CSV …");
    program.keys("Ctrl+A");
    program.type("line.csv\n");
    EXPECT_TRUE(
        eventually([&] { return readText(program.path("line.csv")).starts_with("metres,x,y,z,value"); }));
    double metres = 0, x = 0, y = 0, z = 0, value = 0, gradient = 0;
    const std::string table = readText(program.path("line.csv"));
    const std::size_t line = table.find('\n') + 1;
    ASSERT_EQ(
        std::sscanf(table.c_str() + line, "%lf,%lf,%lf,%lf,%lf,%lf", &metres, &x, &y, &z, &value, &gradient),
        6);
    EXPECT_NEAR(value, std::abs(x) - 0.5, 1e-6);
    EXPECT_NEAR(gradient, 1.0, 1e-6);

    // A click in the picture's middle is on the ball's front; it is a metre thick.
    const ImVec2 middle = picturePart(program).centre();
    program.moveTo(middle);
    program.keys("Shift+T");
    program.waitFor("Wall: click the solid");
    program.click(middle);
    program.waitFor("1 m", picturePart(program));
    program.waitFor("Wall 1 m");
    program.clickOn("Copy", Area{{program.view.panel.hi.x, 400}, {1280, 800}});
    program.moveTo(middle);
    program.keys("Escape");
    program.waitUntilGone("Wall 1 m");

    // Two points of the ball, at the same height.
    program.keys("Shift+M");
    program.waitFor("Length: click two points");
    program.click({middle.x - 40, middle.y});
    program.waitFor("Length: click its end");
    program.click({middle.x + 40, middle.y});
    program.waitFor("dy 0 m");
    program.moveTo(middle);
    program.keys("Escape");
    program.waitUntilGone("dy 0 m");
    program.keys("Escape");
    program.waitUntilGone("Length: click two points");

    // Muted, the ball gives no value.
    program.click(program.title("ball"));
    program.keys("M");
    program.waitUntilGone("1.5 m");
    program.keys("Ctrl+Z");
    program.waitFor("1.5 m", boxOf("ball"));
    program.keys("Alt+P");
    program.waitUntilGone("1.5 m");

    // A union is a bound within: its wire is broken.
    program.moveTo(program.nowhere());
    program.click(program.title("box"));
    program.moveTo(program.nowhere());
    EXPECT_GT(drawnPart(program), 0.95);
    program.keys("F3");
    program.type("exactness on\n");
    EXPECT_TRUE(eventually([&] { return drawnPart(program) < 0.85; })) << drawnPart(program);
    EXPECT_GT(drawnPart(program), 0.3);
    const ImVec2 from = program.output("both"), to = program.input("out", "surface");
    program.moveTo({0.5f * (from.x + to.x), 0.5f * (from.y + to.y)});
    program.waitFor("Plain: exact. Dashes: a bound. Dots: may be steeper than a distance.");
}

}  // namespace fw::editor::test::end_to_end_probe_test
