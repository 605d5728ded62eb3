// Nodes that come wired: behind what is selected, before it, in its wires, and where nothing fits.
#include "editor/document/joining.h"

#include <gtest/gtest.h>

#include "editor/canvas/boxes.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::joining_test {

using test::graphOf;

const std::string kBox = R"({"id": "box", "type": "box", "at": [0, 0]},)";
const std::string kOut =
    R"({"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "box"}}})";

std::string sourceOf(const Graph& graph, const std::string& node, const std::string& input) {
    const InputValue* value = graph.node(node) ? graph.node(node)->input(input) : nullptr;
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    return link ? link->node : "";
}

void expectApart(const Graph& graph) {
    const Boxes boxes(graph, "");
    for (const NodeBox& a : boxes.nodes)
        for (const NodeBox& b : boxes.nodes)
            EXPECT_TRUE(&a == &b || !a.area.overlaps(b.area)) << a.node->id << " covers " << b.node->id;
}

TEST(Joining, WhatTakesASurfaceGoesBehindTheOneThatGivesIt) {
    const Graph graph = graphOf(kBox + kOut);
    const Edited made = addJoined(graph, "", "twist", "box");
    ASSERT_EQ(made.nodes, NodeIds{"twist"});
    EXPECT_EQ(sourceOf(made.graph, "twist", "surface"), "box");
    EXPECT_EQ(sourceOf(made.graph, "out", "surface"), "twist");
    EXPECT_EQ(test::errorsOf(made.graph), "");
    expectApart(made.graph);
    EXPECT_GT((*made.graph.node("twist")->at)[0], 180);
    EXPECT_GT((*made.graph.node("out")->at)[0], (*made.graph.node("twist")->at)[0]);
}

TEST(Joining, EveryWireThatLeadsOnLeadsFromItThen) {
    const Graph graph = graphOf(kBox + R"({"id": "a", "type": "union", "at": [300, 0], "inputs": {
        "a": {"from": "box"}, "b": {"from": "box", "output": "surface"}}},
        {"id": "o", "type": "output", "at": [600, 0], "inputs": {"surface": {"from": "a"}}})");
    const Graph made = addJoined(graph, "", "twist", "box").graph;
    EXPECT_EQ(sourceOf(made, "a", "a"), "twist");
    EXPECT_EQ(sourceOf(made, "a", "b"), "twist");
    EXPECT_EQ(sourceOf(made, "twist", "surface"), "box");
    expectApart(made);
}

TEST(Joining, AShapeFeedsWhatIsFree) {
    const Graph graph = graphOf(kBox + R"({"id": "cut", "type": "subtract", "at": [240, 0], "inputs": {
        "a": {"from": "box"}}},
        {"id": "out", "type": "output", "at": [480, 0], "inputs": {"surface": {"from": "cut"}}})");
    const Graph made = addJoined(graph, "", "cylinder", "cut").graph;
    EXPECT_EQ(sourceOf(made, "cut", "a"), "box");
    EXPECT_EQ(sourceOf(made, "cut", "b"), "cylinder");
    EXPECT_EQ(sourceOf(made, "out", "surface"), "cut");
    EXPECT_EQ(made.node("cylinder")->input("radius"), nullptr) << "a surface is no radius";
    expectApart(made);
}

TEST(Joining, BeforeAnOutputItGoesIntoTheWireOrTakesItsPlace) {
    const Graph graph = graphOf(kBox + kOut);
    const Graph scaled = addJoined(graph, "", "scale", "out").graph;
    EXPECT_EQ(sourceOf(scaled, "out", "surface"), "scale");
    EXPECT_EQ(sourceOf(scaled, "scale", "surface"), "box");
    expectApart(scaled);
    const Graph other = addJoined(graph, "", "sphere", "out").graph;
    EXPECT_EQ(sourceOf(other, "out", "surface"), "sphere");
    ASSERT_NE(other.node("box"), nullptr);
    expectApart(other);
    EXPECT_EQ(joinedByItself(graph, ""), "out");
    EXPECT_EQ(joinedByItself(Graph{}, ""), "");
}

TEST(Joining, WhatDoesNotFitIsAddedAlone) {
    const Graph graph = graphOf(kBox + kOut);
    const Edited made = addJoined(graph, "", "mesh_file", "box");
    ASSERT_EQ(made.nodes.size(), 1u);
    EXPECT_EQ(made.graph.nodes.size(), 3u);
    EXPECT_EQ(sourceOf(made.graph, "out", "surface"), "box");
    expectApart(made.graph);
    EXPECT_EQ(addJoined(graph, "", "sphere", "gone").graph.nodes.size(), 3u);
    // A second output cannot be.
    EXPECT_EQ(addJoined(graph, "", "output", "box").graph, graph);
}

TEST(Joining, WhatStandsBetweenComesAlong) {
    // A fluid gives particles, and the output shows a surface.
    const Graph graph = graphOf(kBox + kOut);
    for (const char* to : {"box", "out"}) {
        const Edited made = addJoined(graph, "", "sph_fluid", to);
        EXPECT_EQ(made.nodes, NodeIds{"sph_fluid"});
        EXPECT_EQ(made.graph.nodes.size(), 4u);
        EXPECT_EQ(sourceOf(made.graph, "sph_fluid", "source"), "box");
        EXPECT_EQ(sourceOf(made.graph, "particles_to_field", "particles"), "sph_fluid");
        EXPECT_EQ(sourceOf(made.graph, "out", "surface"), "particles_to_field");
        EXPECT_EQ(test::errorsOf(made.graph), "");
        expectApart(made.graph);
    }
    // What begins by itself takes the place of what was shown.
    const Edited spray = addJoined(graph, "", "emitter", "out");
    EXPECT_EQ(sourceOf(spray.graph, "particles_to_field", "particles"), "emitter");
    EXPECT_EQ(sourceOf(spray.graph, "out", "surface"), "particles_to_field");
    EXPECT_EQ(spray.graph.nodes.size(), 4u);
    expectApart(spray.graph);
    // Behind a fluid there is nothing to stand between, and an output takes a mesh as it is.
    const Graph fluid = addJoined(graph, "", "sph_fluid", "box").graph;
    EXPECT_EQ(addJoined(fluid, "", "foam", "sph_fluid").graph.nodes.size(), 5u);
    EXPECT_EQ(addJoined(graph, "", "mesh_file", "out").graph.nodes.size(), 3u);
    EXPECT_EQ(addJoined(graph, "", "polygonize", "box").graph.nodes.size(), 3u);
}

// The other Shift the second time: of one key pressed twice within a millisecond, as only a program can, GLFW
// takes the second for an echo of the first.
TEST(Joining, ShiftEnterInTheMenuIsOneStep) {
    test::DrivenEditor editor(graphOf(kBox + kOut), 900, 600);
    NEEDS_EDITOR(editor);
    const Graph before = editor->document.graph();
    editor.click(editor.title("box"));
    editor.send("key --delay 0 shift+a type --delay 0 --args 1 twist key Shift_R+Return");
    EXPECT_EQ(sourceOf(editor->document.graph(), "out", "surface"), "twist");
    EXPECT_EQ(editor->canvas.active, "twist");
    EXPECT_EQ(editor->document.undoName(), "Add Twist");
    editor.keys("ctrl+z");
    EXPECT_EQ(editor->document.graph(), before);
    EXPECT_EQ(editor->document.step(), 0u);
    // Nothing selected: the output.
    editor.keys("Escape");
    editor->canvas.select({});
    editor.send("key --delay 0 shift+a type --delay 0 --args 1 scale key Shift_R+Return");
    EXPECT_EQ(sourceOf(editor->document.graph(), "scale", "surface"), "box");
    // And its first value is typed at once.
    editor.send("key Return type --delay 0 --args 1 3 key Return");
    EXPECT_EQ(std::get<double>(editor->document.graph().node("scale")->input("factor")->value), 3.0);
}

}  // namespace fw::editor::joining_test
