// Understanding a graph in the real window: what the probe reads, what is measured in the picture, the plot
// along a line and its table, and wires that tell how far their distance can be trusted.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "editor/shell/theme.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_probe_test {

using fw::test::readText;

/// The output is on one height with the union: the wire between them is straight.
constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 0.5}},
    {"id": "box", "type": "box", "at": [0, 160], "inputs": {"half_extents": [0.1, 0.1, 0.1]}},
    {"id": "both", "type": "union", "at": [220, 0], "inputs": {"a": {"from": "ball"}, "b": {"from": "box"}}},
    {"id": "out", "type": "output", "at": [520, 0], "inputs": {"surface": {"from": "both"}, "resolution": 16}}],
  "scene": {"camera": {"position": [0, 0, 3], "target": [0, 0, 0], "fov": 40}}})";

Area picturePart(const Program& program) { return {{program.view.panel.hi.x + 20, 120}, {1260, 400}}; }

/// Of the pixels along the wire from the union to the output, how many are not the canvas's. The arrowhead in
/// the middle does not count.
double drawnPart(Program& program) {
    const ImVec2 from = program.output("both"), to = program.input("out", "surface");
    const float middle = 0.5f * (from.x + to.x);
    const ImU32 canvas = themeColor(ThemeColor::canvas), grid = themeColor(ThemeColor::grid);
    const auto isBare = [&](const uint8_t* pixel) {
        for (ImU32 color : {canvas, grid}) {
            int off = 0;
            for (int i = 0; i < 3; ++i) off += std::abs(int(pixel[i]) - int(color >> (8 * i) & 0xff));
            if (off < 24) return true;
        }
        return false;
    };
    int drawn = 0, all = 0;
    for (const Area& part : {Area{{from.x + 8, from.y}, {middle - 10, from.y + 1}},
                             Area{{middle + 10, from.y}, {to.x - 8, from.y + 1}}}) {
        const Picture seen = program.screen(part);
        for (int x = 0; x < seen.width; ++x) drawn += !isBare(seen.pixels.data() + 4 * x), ++all;
    }
    return double(drawn) / std::max(all, 1);
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
    program.waitFor("Cancel");
    program.keys("Ctrl+A");
    program.type("line.csv\n");
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(program.path("line.csv")); }));
    program.waitUntilGone("Cancel");
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
    const auto toPicture = [&](float aside) {
        program.moveTo({middle.x + aside, middle.y});
        program.save();  // keys count over the picture once the mouse is seen there
    };
    toPicture(0);
    program.keys("Shift+T");
    program.waitFor("Wall: click the solid");
    program.click(middle);
    program.waitFor("1 m", picturePart(program));
    const auto copyAbove = [&](const Area& words) {
        program.clickOn("Copy", Area{{program.view.panel.hi.x, words.lo.y - 40}, {1280, words.lo.y}});
    };
    copyAbove(program.waitFor("Wall 1 m"));
    EXPECT_TRUE(eventually([&] { return program.clipboard() == "Wall 1 m"; })) << program.clipboard();
    toPicture(0);
    program.keys("Escape");
    program.waitUntilGone("Wall 1 m");

    // Two points of the ball: their distance and its parts, in numbers.
    toPicture(5);  // after a key the mouse counts when it moves
    program.keys("Shift+M");
    program.waitFor("Length: click two points");
    program.click({middle.x - 40, middle.y});
    program.waitFor("Length: click its end");
    program.click({middle.x + 40, middle.y});
    copyAbove(program.waitFor("dx"));
    EXPECT_TRUE(eventually([&] { return program.clipboard().starts_with("Length "); }))
        << program.clipboard();
    double length = 0, dx = 0, dy = 0, dz = 0;
    ASSERT_EQ(std::sscanf(program.clipboard().c_str(), "Length %lf m dx %lf m dy %lf m dz %lf", &length, &dx,
                          &dy, &dz),
              4)
        << program.clipboard();
    EXPECT_NEAR(length, std::hypot(dx, dy, dz), 1e-5);
    EXPECT_GT(dx, 0.1);
    EXPECT_LT(length, 1.0) << "a chord of a ball of 1 m";
    toPicture(0);
    program.keys("Escape");
    program.waitUntilGone("dx");
    toPicture(5);
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
    program.save();  // the list of commands is gone
    double drawn = 0.0;
    EXPECT_TRUE(eventually([&] {
        drawn = drawnPart(program);
        return drawn > 0.3 && drawn < 0.85;
    })) << drawn;
    const ImVec2 from = program.output("both"), to = program.input("out", "surface");
    program.moveTo({0.5f * (from.x + to.x), 0.5f * (from.y + to.y)});
    // Each key makes a frame, of which one comes when the mouse has rested for long enough.
    EXPECT_TRUE(eventually([&] {
        program.save();
        return program.sees("Plain: exact. Dashes: a bound. Dots: may be steeper than a distance.");
    }));
}

}  // namespace fw::editor::test::end_to_end_probe_test
