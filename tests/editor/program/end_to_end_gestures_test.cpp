// What the mouse does on the canvas, in the real window: wires, their refusals, values, selections, and that
// each gesture can be taken back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "editor/canvas/fields.h"
#include "graph/document/json.h"
#include "graph/document/timeline.h"
#include "graph/language/typed_number.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_gestures_test {

constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "box", "type": "box", "at": [0, 0]},
    {"id": "ball", "type": "sphere", "at": [0, 200]},
    {"id": "cut", "type": "subtract", "at": [260, 0], "inputs": {"a": {"from": "box"}}},
    {"id": "moved", "type": "translate", "at": [520, 200], "inputs": {"surface": {"from": "cut"}}},
    {"id": "out", "type": "output", "at": [520, 0], "inputs": {"surface": {"from": "cut"}, "resolution": 16}}]})";

const Node& nodeOf(const Graph& graph, const std::string& id) {
    const Node* node = findNode(graph.nodes, id);
    if (!node) throw std::runtime_error("no node " + id);
    return *node;
}

std::string source(const Graph& graph, const std::string& node, const std::string& input) {
    const InputValue* value = nodeOf(graph, node).input(input);
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    return link ? link->node : "";
}

/// Half way along the wire into the input.
ImVec2 onWire(const Program& program, const std::string& from, const std::string& node,
              const std::string& input) {
    const ImVec2 a = program.output(from), b = program.input(node, input);
    return {0.5f * (a.x + b.x), 0.5f * (a.y + b.y)};
}

class EndToEndGestures : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
        original = program.save();
        program.frameAll();
    }
    /// One step back is where it began.
    void expectOneStep() {
        program.keys("Ctrl+Z");
        EXPECT_EQ(program.save(), original);
    }

    Program program{kDocument};
    std::string original;
};

TEST_F(EndToEndGestures, AWireThatCannotBeSaysWhyAtTheMouse) {
    const auto refuse = [&](const std::string& from, const std::string& node, const std::string& input) {
        const std::string reason = refusal(program.graph(), "", {from, ""}, {node, input});
        ASSERT_FALSE(reason.empty());
        const ImVec2 target = program.input(node, input);
        program.drag({program.output(from), target, {target.x + 1, target.y}}, 1, {}, false, false);
        const Area words = program.waitFor(reason);
        EXPECT_LT(std::abs(words.lo.x - target.x), 60);
        EXPECT_LT(std::abs(words.lo.y - target.y), 60);
        program.release();
        program.waitUntilGone(reason);
        EXPECT_EQ(program.save(), original);
        program.keys("Ctrl+Z");
        EXPECT_EQ(program.save(), original);
    };
    refuse("ball", "box", "half_extents");  // a surface is no vector
    refuse("moved", "cut", "b");            // a cycle
}

TEST_F(EndToEndGestures, Wires) {
    program.drag({program.output("ball"), program.input("cut", "b")});
    EXPECT_EQ(source(program.saved(), "cut", "b"), "ball");
    expectOneStep();

    // Taken off at its end and dropped on the empty canvas.
    program.drag({program.input("cut", "a"), program.nowhere()});
    EXPECT_EQ(source(program.saved(), "cut", "a"), "");
    expectOneStep();

    // Cut.
    const ImVec2 wire = onWire(program, "box", "cut", "a");
    program.drag({{wire.x, wire.y - 40}, {wire.x, wire.y + 40}}, 3, "ctrl");
    EXPECT_EQ(source(program.saved(), "cut", "a"), "");
    expectOneStep();

    // A reroute, where the wire was crossed.
    program.drag({{wire.x, wire.y - 40}, {wire.x, wire.y + 60}}, 3, "shift");
    const std::string reroute = source(program.saved(), "cut", "a");
    EXPECT_EQ(source(program.graph(), reroute, "value"), "box");
    const ImVec2 there = program.title(reroute);
    EXPECT_LT(std::hypot(there.x - wire.x, there.y - wire.y), 15);
    expectOneStep();

    // From somewhere on a node to somewhere on another.
    program.drag({program.title("ball"), program.title("cut")}, 3, "alt");
    EXPECT_EQ(source(program.saved(), "cut", "b"), "ball");
    expectOneStep();

    // Dropped on the canvas it offers what fits, and connects it.
    program.drag({program.output("ball"), program.nowhere()});
    program.type("twist\n");
    EXPECT_EQ(source(program.saved(), "twist", "surface"), "ball");
    expectOneStep();

    // Escape gives it up.
    program.drag({program.output("ball"), program.input("cut", "b")}, 1, {}, false, false);
    program.keys("Escape");
    program.release();
    EXPECT_EQ(program.save(), original);
}

TEST_F(EndToEndGestures, ANodeDroppedOnAWireGoesIntoIt) {
    const std::string id = program.add("twist", program.nowhere());
    const ImVec2 from = program.title(id), wire = onWire(program, "cut", "out", "surface");
    // By its title; its middle comes to lie on the wire.
    const NodeBox box = *Boxes(program.graph(), "").find(id);
    const ImVec2 middle = program.view.toScreen(box.area.centre());
    program.drag({from, {from.x + wire.x - middle.x, from.y + wire.y - middle.y}});
    EXPECT_EQ(source(program.saved(), id, "surface"), "cut");
    EXPECT_EQ(source(program.graph(), "out", "surface"), id);
}

TEST_F(EndToEndGestures, BoxAndLassoSelect) {
    const auto expectDeleted = [&](const std::set<std::string>& gone) {
        program.keys("Delete");
        for (const char* id : {"box", "ball", "cut", "moved", "out"})
            EXPECT_EQ(findNode(program.saved().nodes, id) == nullptr, gone.contains(id)) << id;
        expectOneStep();
        program.click(program.nowhere());
    };
    const Boxes boxes(program.graph(), "");
    const Area left = program.view.toScreen(boxes.find("box")->area),
               ball = program.view.toScreen(boxes.find("ball")->area);
    program.drag({{left.lo.x - 20, left.lo.y - 20}, {ball.hi.x - 30, ball.hi.y - 10}});
    expectDeleted({"box", "ball"});
    program.drag({{left.lo.x - 20, left.lo.y - 20},
                  {left.hi.x + 15, left.lo.y - 20},
                  {left.hi.x + 15, left.hi.y + 15},
                  {left.lo.x - 20, left.hi.y + 15}},
                 1, "alt", true);
    expectDeleted({"box"});
}

TEST_F(EndToEndGestures, Numbers) {
    const auto radius = [&] {
        const InputValue* value = nodeOf(program.saved(), "ball").input("radius");
        return value ? std::get<double>(value->value) : NAN;
    };
    program.set("ball", "radius", 0, "2*pi/3");
    EXPECT_NEAR(radius(), 2.0 * std::numbers::pi / 3.0, 1e-9);
    expectOneStep();

    // What is no number is refused with the reason, until Escape.
    program.click(program.field("ball", "radius"));
    program.type("2*what\n");
    program.waitFor(constantOf("2*what").error().message);
    program.keys("Escape");
    program.waitUntilGone(constantOf("2*what").error().message);
    EXPECT_EQ(program.save(), original);

    // A drag of 60 pixels counts whole, however fast it was; a tenth of it with Shift.
    const ImVec2 at = program.field("ball", "radius");
    program.drag({at, {at.x + 60, at.y}});
    const double by = radius() - 1.0;
    EXPECT_GT(by, 0.1);
    expectOneStep();
    program.drag({at, {at.x + 60, at.y}}, 1, "shift");
    EXPECT_NEAR(radius() - 1.0, 0.1 * by, 0.02 * by);
    expectOneStep();

    program.set("ball", "radius", 0, "0.7");
    program.click(program.field("ball", "radius"), 1, "ctrl");
    EXPECT_TRUE(std::isnan(radius()));
}

TEST_F(EndToEndGestures, NumbersInThePanel) {
    const Area side = {{program.view.panel.hi.x, 470}, {1276, 780}};
    const auto numberAt = [&](const std::string& name) {
        return ImVec2(1015, program.waitFor(name, side).centre().y);
    };
    const auto extents = [&] {
        const InputValue* value = nodeOf(program.saved(), "box").input("half_extents");
        return value ? std::get<std::vector<double>>(value->value) : std::vector<double>();
    };
    program.click(program.title("box"));
    const ImVec2 first = numberAt("Half extents");

    // Typed one after the other; on the node in the same way.
    program.click(first);
    program.type("0.5\t1/4\t2\n");
    EXPECT_EQ(extents(), (std::vector{0.5, 0.25, 2.0}));
    program.click(program.field("box", "half_extents", 1));
    program.type("3\t4\n");
    EXPECT_EQ(extents(), (std::vector{0.5, 3.0, 4.0}));

    // What is typed is saved with the rest.
    program.click(numberAt("Label"));
    program.type("Tower");
    EXPECT_EQ(nodeOf(program.saved(), "box").label, "Tower");

    // With a key, numbers are typed all the same, and are the key's.
    const Picture seen = program.screen();
    program.click({1242, first.y});
    program.waitForChange(seen, {{1232, first.y - 10}, {1252, first.y + 10}});
    program.moveTo(first);
    const Picture still = program.screen();
    program.click(first);
    program.waitForChange(still, {{first.x - 12, first.y - 8}, {first.x + 12, first.y + 8}});
    program.type("3*3\n");
    const Result<Timeline> timeline = readTimeline(program.saved());
    ASSERT_TRUE(timeline);
    ASSERT_EQ(timeline->tracks.size(), 1u);
    EXPECT_EQ(timeline->tracks[0].keys.at(0).value, (std::vector{9.0, 3.0, 4.0}));

    // Keys of the canvas are not heard where something else is edited.
    const std::string before = program.save();
    program.click({1100, 760});
    program.keys("X");
    program.keys("Ctrl+A");
    program.keys("Delete");
    EXPECT_EQ(program.save(), before);
}

TEST_F(EndToEndGestures, ANodeThatIsDroppedOnAWireGetsRoom) {
    const auto x = [&](const std::string& node) { return nodeOf(program.graph(), node).at->at(0); };
    const double apart = x("cut") - x("box"), on = x("out") - x("cut");
    const std::string twist =
        program.add("twist", {program.view.panel.lo.x + 60, program.view.panel.hi.y - 200});
    program.frameAll();
    program.drag({program.title(twist), onWire(program, "box", "cut", "a")}, 1, "", true);
    program.saved();
    EXPECT_EQ(source(program.graph(), "cut", "a"), twist);
    EXPECT_EQ(source(program.graph(), twist, "surface"), "box");
    EXPECT_GT(x("cut") - x("box"), apart + 100);
    EXPECT_GT(x(twist), x("box"));
    EXPECT_GT(x("cut"), x(twist));
    EXPECT_EQ(x("out") - x("cut"), on) << "what comes after moves along";
}

TEST_F(EndToEndGestures, ManyInARowAreTakenBackAndDoneAgain) {
    std::mt19937 random(20);
    const auto below = [&](std::size_t n) { return random() % n; };
    for (int i = 0; i < 14; ++i) {
        const std::vector<Node> nodes = program.graph().nodes;
        if (nodes.empty()) break;
        const std::string id = nodes[below(nodes.size())].id, other = nodes[below(nodes.size())].id;
        const Boxes boxes(program.graph(), "");
        switch (below(6)) {
            case 0: program.add("sphere", program.nowhere()); break;
            case 1:
                program.drag({program.title(id),
                              {program.title(id).x + float(below(120)) - 60,
                               program.title(id).y + float(below(80)) - 40}});
                break;
            case 2: program.drag({program.title(id), program.title(other)}, 3, "alt"); break;
            case 3:
                program.click(program.title(id));
                program.keys(
                    std::vector<std::string>{"M", "H", "Ctrl+D", "X", "Ctrl+X", "Ctrl+Shift+D"}[below(6)]);
                break;
            case 4:
                program.click(program.nowhere());
                program.keys("Ctrl+A");
                program.keys(below(2) ? "Ctrl+L" : "M");
                break;
            case 5: {
                const ImVec2 on = program.title(id);
                program.drag({{on.x - 60, on.y - 30}, {on.x + 200, on.y + 60}}, 3,
                             below(2) ? "ctrl" : "shift");
                break;
            }
        }
        program.save();
        program.frameAll();
    }
    const std::string made = program.save();
    program.keys("Ctrl+Z", 30);
    EXPECT_EQ(program.save(), original);
    program.keys("Ctrl+Y", 30);
    EXPECT_EQ(program.save(), made);
}

}  // namespace fw::editor::test::end_to_end_gestures_test
