// Jobs that make a shape: a mug, a sign, a gear, a city.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/editor/editor_tasks.h"

namespace fw::editor::test::editor_tasks_shapes_test {

using namespace editor_tasks;

void expectMug(Person& person) {
    const Solid mug(person.graph());
    EXPECT_TRUE(mug.at(0.38, 0, 0)) << "the wall";
    EXPECT_FALSE(mug.at(0, 0.2, 0)) << "it is hollow";
    EXPECT_FALSE(mug.at(0, 0.49, 0)) << "it is open";
    EXPECT_TRUE(mug.at(0, -0.48, 0)) << "it has a bottom";
    EXPECT_TRUE(mug.at(0.7, 0, 0)) << "the handle";
    EXPECT_FALSE(mug.at(0.55, 0, 0)) << "a hand goes through the handle";
    EXPECT_FALSE(mug.at(0.3, 0, 0)) << "the handle does not reach in";
    EXPECT_FALSE(mug.at(0.45, 0, 0.25)) << "the handle stands upright";
}

TEST(EditorTasks, AMug) {
    count(
        "A mug", kNew,
        [](Person& person) {
            person.remove("box");
            person.addWired({"cyl"});
            person.valuesThen("0.4\t0.5", {"sub", "cyl"});
            person.valuesThen("0.35\t0.5", {"trans"});
            person.values("0\t0.05");
            person.look();
            person.click(person.title("cylinder"));
            person.addWired({"uni", "tor"});
            person.valuesThen("0.25\t0.05", {"rot"});
            person.valuesThen("90", {"trans"});
            person.values("0.45");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            person.makeRoom();
            person.remove("box");
            person.addAt("cyl", person.spot(-1.6f, -2.2f));
            person.formerValues("0.4\t0.5");
            person.save();
            person.lead("cylinder", "uni", person.spot(-0.6f, -2.2f));
            person.lead("union", "sub", person.spot(0.4f, -2.2f));
            person.wire("subtract", "output", "surface");
            person.addAt("tor", person.spot(-1.6f, -1.0f));
            person.formerValues("0.25\t0.05");
            person.save();
            person.lead("torus", "rot", person.spot(-0.6f, -1.0f));
            person.formerValues("90");
            person.save();
            person.lead("rotate", "trans", person.spot(0.3f, -1.1f));
            person.formerValues("0.45");
            person.save();
            person.wire("translate", "union", "b");
            person.addAt("cyl", person.spot(-1.6f, 0.2f));
            person.formerValues("0.35\t0.5");
            person.save();
            person.lead("cylinder_2", "trans", person.spot(-0.6f, 0.4f));
            person.formerValues("0\t0.05");
            person.save();
            person.wire("translate_2", "subtract", "b");
            person.keys("Ctrl+S");
        },
        expectMug);
}

TEST(EditorTasks, ASign) {
    count(
        "A sign", kNew,
        [](Person& person) {
            person.remove("box");
            person.addWired({"polygon"});
            person.clickOn("Draw …");
            const Area tools = person.waitFor("Mirror"), last = person.waitFor("5 points, 0 selected");
            // All of the outline is seen, in 80 % of the sheet's height: its tip, and seven tenths below.
            const float high = last.lo.y - tools.hi.y, middle = 0.5f * (last.lo.y + tools.hi.y);
            const float metre = 0.8f * high / 1.1f;
            const ImVec2 tip(640.0f, middle - 0.55f * metre);
            person.drag({tip, {tip.x, tip.y + 0.4f * metre}, {tip.x, tip.y + 0.7f * metre}});
            person.keys("Escape");
            person.waitUntilGone("Mirror");
            person.addWired({"ext"});
            person.values("0.05");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            person.makeRoom();
            person.remove("box");
            person.addAt("polygon", person.spot(-1, -1));
            person.clickOn("5 points", Area{{person.view.panel.hi.x, 400}, {1280, 800}});
            person.clickOn("0.6", Area{{person.view.panel.hi.x, 400}, {1280, 800}});
            person.type("-0.1\n");
            person.save();
            person.lead("polygon", "ext", person.spot(0, -0.5f));
            person.formerValues("0.05");
            person.save();
            person.wire("extrude", "output", "surface");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            const InputValue* points = onlyOf(person.graph(), "polygon")->input("points");
            ASSERT_NE(points, nullptr) << "it is as it came";
            EXPECT_EQ(std::get<std::vector<double>>(points->value),
                      (std::vector<double>{-0.5, -0.5, 0.5, -0.5, 0.5, 0.2, 0, -0.1, -0.5, 0.2}));
            const Solid sign(person.graph());
            EXPECT_TRUE(sign.at(0.4, 0, 0.04));
            EXPECT_FALSE(sign.at(0, 0, 0)) << "the notch";
            EXPECT_FALSE(sign.at(0.4, 0, 0.06)) << "it is thin";
        });
}

TEST(EditorTasks, AGear) {
    count(
        "A gear", kNew,
        [](Person& person) {
            person.click(person.title("box"));
            person.type("0.1");
            person.keys("Ctrl+Enter");
            person.addWired({"trans"});
            person.valuesThen("0.5", {"polar"});
            person.valuesThen("12", {"uni", "cyl"});
            person.values("0.5\t0.1");
            person.look();
            person.click(person.title("union"));
            person.addWired({"sub", "inf"});
            person.values("0.1");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            person.makeRoom();
            person.click(person.title("box"));
            person.formerValues("0.1\t0.1\t0.1");
            person.save();
            person.lead("box", "trans", person.spot(-1.4f, 1));
            person.formerValues("0.5");
            person.save();
            person.lead("translate", "polar", person.spot(-0.4f, 1.2f));
            person.formerValues("12");
            person.save();
            person.lead("polar_repeat", "uni", person.spot(0.5f, 1.4f));
            person.lead("union", "sub", person.spot(1.5f, 1.4f));
            person.wire("subtract", "output", "surface");
            person.addAt("cyl", person.spot(-1.4f, -1.6f));
            person.formerValues("0.5\t0.1");
            person.save();
            person.wire("cylinder", "union", "b");
            person.addAt("inf", person.spot(0, -1.6f));
            person.formerValues("0.1");
            person.save();
            person.wire("infinite_cylinder", "subtract", "b");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            const Solid gear(person.graph());
            const auto around = [&](double radius, double degrees) {
                const double angle = degrees * 3.14159265358979 / 180.0;
                return gear.at(radius * std::cos(angle), 0.0, radius * std::sin(angle));
            };
            for (int tooth = 0; tooth < 12; ++tooth) {
                EXPECT_TRUE(around(0.58, 30.0 * tooth)) << tooth;
                EXPECT_FALSE(around(0.58, 30.0 * tooth + 15.0)) << tooth;
            }
            EXPECT_TRUE(around(0.3, 7));
            EXPECT_FALSE(gear.at(0, 0, 0)) << "the hole";
            EXPECT_FALSE(gear.at(0.3, 0.12, 0)) << "it is flat";
        });
}

TEST(EditorTasks, ACity) {
    count(
        "A city", kNew,
        [](Person& person) {
            person.click(person.title("box"));
            person.valuesThen("0.3\t1\t0.3", {"scat"});
            person.valuesThen("1\t0\t1", {"inter", "box"});
            person.values("4\t2\t4");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            person.makeRoom();
            person.click(person.title("box"));
            person.formerValues("0.3\t1\t0.3");
            person.save();
            person.lead("box", "scat", person.spot(-1, 1));
            person.formerValues("1\t0\t1");
            person.save();
            person.lead("scatter", "inter", person.spot(0.4f, 1.4f));
            person.wire("intersect", "output", "surface");
            person.addAt("box", person.spot(-1, -1.6f));
            person.formerValues("4\t2\t4");
            person.save();
            person.wire("box_2", "intersect", "b");
            person.keys("Ctrl+S");
        },
        [](Person& person) {
            const Solid city(person.graph());
            int built = 0, all = 0;
            for (double x = -3.9; x < 4.0; x += 0.1)
                for (double z = -3.9; z < 4.0; z += 0.1) ++all, built += city.at(x, 0.1, z) ? 1 : 0;
            EXPECT_GT(built, all / 20);
            EXPECT_LT(built, all / 2);
            for (double x = 4.1; x < 8.0; x += 0.1) EXPECT_FALSE(city.at(x, 0.1, 0.0));
        });
}

}  // namespace fw::editor::test::editor_tasks_shapes_test
