// Units in the real window: what is typed with one, how numbers are shown, and what clicks on the solid
// measure.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_units_test {

constexpr const char* kDocument = R"({"fieldwright": 1, "unit": "mm", "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 50}},
    {"id": "turned", "type": "rotate", "at": [240, 0],
     "inputs": {"surface": {"from": "ball"}, "angles": [0, 0, 0]}},
    {"id": "out", "type": "output", "at": [520, 0], "inputs": {"surface": {"from": "turned"}, "resolution": 16}}],
  "scene": {"camera": {"position": [0, 0, 300], "target": [0, 0, 0], "fov": 40}}})";

double radiusOf(const Graph& graph) {
    const InputValue* value = findNode(graph.nodes, "ball")->input("radius");
    return value ? std::get<double>(value->value) : NAN;
}

TEST(EndToEndUnits, NumbersAreTypedWithUnitsAndRefusedByName) {
    Program program(kDocument);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    const std::string original = program.save();
    program.frameAll();
    const auto typed = [&](const char* text) {
        program.set("ball", "radius", 0, text);
        return radiusOf(program.saved());
    };
    program.waitFor("50 mm");
    EXPECT_EQ(typed("3mm"), 3.0);
    EXPECT_EQ(typed("1/4in"), 6.35);
    program.waitFor("6.35 mm");
    EXPECT_EQ(typed("2 cm + 1 1/2in"), 58.1);
    EXPECT_EQ(typed("1'6\""), 457.2);
    program.set("turned", "angles", 1, "1/8turn");
    EXPECT_EQ(
        std::get<std::vector<double>>(findNode(program.saved().nodes, "turned")->input("angles")->value)[1],
        45.0);
    program.keys("Ctrl+Z", 5);
    EXPECT_EQ(program.save(), original) << "each was a step";

    // What is refused says why, stays to be mended, and changes nothing.
    const auto refused = [&](const char* node, const char* input, const char* text, const char* words) {
        program.click(program.field(node, input));
        program.type(std::string(text) + "\n");
        program.waitFor(words);
        program.keys("Escape");
        program.waitUntilGone(words);
        EXPECT_EQ(program.save(), original) << text;
    };
    refused("ball", "radius", "3mmm", "'mmm' is no unit");
    refused("ball", "radius", "1/0in", "division by zero");
    refused("turned", "angles", "3mm", "this is an angle");
    refused("ball", "radius", "90deg", "this is a length");
    refused("out", "resolution", "3mm", "this is a plain number");

    // In the panel in the same way.
    program.click(program.title("ball"));
    const Area side = {{program.view.panel.hi.x, 470}, {1276, 780}};
    program.click({1015, program.waitFor("Radius", side).centre().y});
    program.type("2in\n");
    EXPECT_EQ(radiusOf(program.saved()), 50.8);
    program.waitFor("50.8 mm", side);
}

TEST(EndToEndUnits, ClicksOnTheSolidMeasureInTheDocumentsUnit) {
    Program program(kDocument);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.save();
    program.frameAll();
    program.keys("Alt+P");
    program.waitFor("Point at the solid in the picture, or type a place.");
    const Area part{{program.view.panel.hi.x + 20, 120}, {1260, 400}};
    const ImVec2 middle = part.centre();
    int rested = 0;
    const auto toPicture = [&] {
        program.moveTo({middle.x + float(++rested % 2 * 5), middle.y});
        program.save();  // keys count over the picture once the mouse is seen there
    };
    const Area side{{program.view.panel.hi.x, 470}, {1276, 790}};
    const auto copied = [&](const std::string& begins) {
        program.clipboard("nothing yet");
        const Area tool = program.waitFor("Wall", side);  // the last of its row
        program.clickOn("Copy", Area{{tool.hi.x, tool.lo.y - 10}, {1280, tool.hi.y + 10}});
        eventually([&] { return program.clipboard().starts_with(begins); });
        return program.clipboard();
    };

    // The ball's own radius where it is clicked, and that of a circle through three of its points.
    program.clickOn("Radius", side);
    program.waitFor("Radius: click the solid");
    program.click(middle);
    program.waitFor("Radius: two more are a circle");
    program.waitFor("Radius 50 mm", side);
    EXPECT_EQ(copied("Radius 50 mm"), "Radius 50 mm");
    program.click({middle.x + 40, middle.y});
    program.waitFor("Radius: click the circle's last point");
    program.click({middle.x, middle.y + 40});
    program.waitFor("Radius: click the solid");
    double radius = 0;
    const std::string circle = copied("Radius");
    ASSERT_EQ(std::sscanf(circle.c_str(), "Radius %lf mm", &radius), 1) << circle;
    EXPECT_LT(radius, 50.0) << "a circle on a ball, off its middle";
    EXPECT_GT(radius, 1.0);

    // The corner is the second of three points.
    program.clickOn("Angle", side);
    program.waitFor("Angle: click a point of one side");
    program.click({middle.x + 50, middle.y});
    program.waitFor("Angle: click the corner");
    program.click(middle);
    program.waitFor("Angle: click its other side");
    program.click({middle.x, middle.y + 50});
    double angle = 0;
    const std::string words = copied("Angle");
    ASSERT_EQ(std::sscanf(words.c_str(), "Angle %lf", &angle), 1) << words;
    EXPECT_NEAR(angle, 90.0, 12.0) << "the ball falls off behind the corner";
    EXPECT_NE(angle, 90.0);

    // Escape clears what was measured, then puts the tool down.
    toPicture();
    program.keys("Escape");
    program.waitFor("Angle: click a point of one side");
    toPicture();
    program.keys("Escape");
    program.waitUntilGone("Angle: click a point of one side");
}

}  // namespace fw::editor::test::end_to_end_units_test
