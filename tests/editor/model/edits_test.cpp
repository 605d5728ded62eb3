// What edits do to a graph, and that none makes it unsound.
#include "editor/document/edits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "editor/document/wiring.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/editor/random_edits.h"

namespace fw::editor::edits_test {

using editor::test::graphOf;
using editor::test::structuralErrors;

constexpr const char* kTower = R"(
  {"id": "tower", "type": "box", "at": [0, 0], "inputs": {"half_extents": [1, 2, 1]}},
  {"id": "hole", "type": "sphere", "at": [0, 160], "inputs": {"radius": 0.5}},
  {"id": "moved", "type": "translate", "at": [240, 160], "inputs": {"surface": {"from": "hole"}}},
  {"id": "cut", "type": "subtract", "at": [480, 0], "inputs": {"a": {"from": "tower"}, "b": {"from": "moved"}}},
  {"id": "out", "type": "output", "at": [720, 0], "inputs": {"surface": {"from": "cut"}}})";

constexpr const char* kReferences = R"(,
  "parameters": [{"name": "size", "node": "hole", "input": "radius", "min": 0.1, "max": 0.9}],
  "timeline": {"tracks": [
    {"node": "moved", "input": "offset.y", "keys": [{"time": 0, "value": 0}, {"time": 1, "value": 1}]},
    {"parameter": "size", "keys": [{"time": 0, "value": 0.2}, {"time": 1, "value": 0.4}]},
    {"scene": "camera.fov", "keys": [{"time": 0, "value": 30}]}]})";

std::string source(const Graph& graph, const std::string& node, const std::string& input,
                   std::string_view scope = "") {
    const Node* found = findNode(nodesOf(graph, scope), node);
    const InputValue* value = found ? found->input(input) : nullptr;
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    return link ? link->node + (link->output.empty() ? "" : "." + link->output) : "";
}

TEST(FreshId, IsFitAndFree) {
    const Graph graph = graphOf(R"({"id": "box", "type": "box"}, {"id": "box_2", "type": "box"})");
    EXPECT_EQ(freshId(graph.nodes, "cone"), "cone");
    EXPECT_EQ(freshId(graph.nodes, "box"), "box_3");
    EXPECT_EQ(freshId(graph.nodes, "box_2"), "box_3");
    EXPECT_EQ(freshId(graph.nodes, "Window row!"), "window_row");
    EXPECT_EQ(freshId(graph.nodes, "3 ways"), "n3_ways");
    EXPECT_EQ(freshId(graph.nodes, "über"), "ber");
    EXPECT_EQ(freshId(graph.nodes, ""), "node");
    EXPECT_EQ(freshId(graph.nodes, "__"), "node");
    for (const char* base : {"box", "", "42", "_a", "A B", "out_", "x__9"})
        EXPECT_TRUE(isId(freshId(graph.nodes, base))) << base;
}

TEST(AddNode, MakesEveryTypeSound) {
    const Graph graph = graphOf(kTower);
    for (const NodeType& type : nodeTypes()) {
        const Edited edited = addNode(graph, "", type.id, {10, 20});
        EXPECT_TRUE(structuralErrors(edited.graph).empty()) << type.id;
        const bool may = type.id != "output" && type.id != "group" && !type.id.starts_with("group_");
        ASSERT_EQ(edited.nodes.size(), may ? 1u : 0u) << type.id;
        if (!may) continue;
        const Node* node = edited.graph.node(edited.nodes[0]);
        ASSERT_TRUE(node);
        EXPECT_EQ(node->type, type.id);
        EXPECT_EQ(node->at, (Position{10, 20}));
    }
    EXPECT_EQ(addNode(graph, "", "no_such_type", {}).graph, graph);
    EXPECT_TRUE(check(addNode(graph, "", "expression", {}).graph).empty());
    EXPECT_EQ(addNode(Graph{}, "", "output", {}).nodes, NodeIds{"output"});
}

TEST(AddNode, GivesParametersNamesOfTheirOwn) {
    Graph graph = addNode(graphOf(kTower), "", "parameter", {}).graph;
    graph = addNode(graph, "", "parameter", {}).graph;
    EXPECT_EQ(graph.nodes.back().input("name")->value, InputValue{std::string("parameter 2")}.value);
}

TEST(Refusal, SaysWhy) {
    const Graph graph = graphOf(
        std::string(kTower) +
        R"(, {"id": "place", "type": "position"}, {"id": "code", "type": "expression", "code": "return 1;"},
        {"id": "mesh", "type": "polygonize", "inputs": {"surface": {"from": "cut"}}}, {"id": "bend", "type": "reroute"})");
    const auto why = [&](const Plug& from, const Plug& to) { return refusal(graph, "", from, to); };
    EXPECT_EQ(why({"hole", ""}, {"cut", "a"}), "");
    EXPECT_EQ(why({"cut", ""}, {"moved", "surface"}), "a cycle: cut -> moved -> cut");
    EXPECT_EQ(why({"cut", ""}, {"cut", "a"}), "a cycle: cut -> cut");
    EXPECT_EQ(why({"cut", ""}, {"hole", "radius"}), "a cycle: cut -> hole -> moved -> cut");
    EXPECT_EQ(why({"place", ""}, {"cut", "a"}), "vec3 is no surface");
    EXPECT_EQ(why({"hole", ""}, {"cut", "radius"}), "") << "a surface gives its distance";
    EXPECT_EQ(why({"hole", ""}, {"cut", "profile"}), "an input of type string takes no wire");
    EXPECT_EQ(why({"code", ""}, {"cut", "profile"}), "an input of type string takes no wire");
    EXPECT_EQ(why({"code", ""}, {"out", "mesh"}), "an expression gives no mesh");
    EXPECT_EQ(why({"mesh", ""}, {"out", "mesh"}), "");
    EXPECT_EQ(why({"mesh", ""}, {"code", "m"}), "code takes no mesh");
    EXPECT_EQ(why({"hole", ""}, {"code", "m"}), "");
    EXPECT_EQ(why({"hole", ""}, {"code", "a b"}), "'a b' is no name in code");
    EXPECT_EQ(why({"out", ""}, {"code", "m"}), "node 'out' has no output");
    EXPECT_EQ(why({"hole", "x"}, {"code", "m"}), "node 'hole' has no output 'x'");
    EXPECT_EQ(why({"hole", ""}, {"cut", "c"}), "node 'cut' has no input 'c'");
    EXPECT_EQ(why({"gone", ""}, {"cut", "a"}), "there is no node 'gone'");
    EXPECT_EQ(why({"hole", ""}, {"gone", "a"}), "there is no node 'gone'");
}

TEST(Refusal, LooksBeyondReroutes) {
    const Graph graph = graphOf(
        R"({"id": "place", "type": "position"}, {"id": "ball", "type": "sphere"},
           {"id": "first", "type": "reroute"}, {"id": "second", "type": "reroute", "inputs": {"value": {"from": "first"}}},
           {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "second"}}})");
    EXPECT_EQ(refusal(graph, "", {"ball", ""}, {"first", "value"}), "");
    EXPECT_EQ(refusal(graph, "", {"place", ""}, {"first", "value"}),
              "vec3 is no surface, which the reroute leads to");
    const Graph wired = connect(graph, "", {"ball", ""}, {"first", "value"});
    EXPECT_EQ(setInput(wired, "", {"first", "value"}, InputValue{std::vector<double>{1, 2, 3}}), wired);
}

TEST(Connect, ReplacesWhatFedTheInput) {
    const Graph graph = graphOf(kTower);
    const Graph wired = connect(graph, "", {"hole", "surface"}, {"cut", "a"});
    EXPECT_EQ(source(wired, "cut", "a"), "hole") << "the name of an only output is left out";
    EXPECT_EQ(disconnect(wired, "", {"cut", "a"}).node("cut")->input("a"), nullptr);
    EXPECT_EQ(disconnect(graph, "", {"tower", "half_extents"}), graph) << "a value is no wire";
}

TEST(Disconnect, LeavesAnExpressionItsNames) {
    const Graph graph = graphOf(
        R"({"id": "place", "type": "position"}, {"id": "wave", "type": "noise"}, {"id": "e", "type": "expression",
            "code": "return length(q) - n;", "inputs": {"q": {"from": "place"}, "n": {"from": "wave", "output": "value"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "e"}}})");
    Graph cut = disconnect(graph, "", {"e", "q"});
    cut = disconnect(cut, "", {"e", "n"});
    EXPECT_EQ(cut.node("e")->input("q")->value, (InputValue{std::vector<double>{0, 0, 0}}.value));
    EXPECT_EQ(cut.node("e")->input("n")->value, InputValue{0.0}.value);
    EXPECT_FALSE(hasErrors(check(cut)));
    EXPECT_FALSE(hasErrors(check(removeNodes(graph, "", NodeIds{"place"}, false))));
}

TEST(Fitting, PrefersFreeInputsOfTheSameType) {
    const Graph graph = graphOf(std::string(kTower) + R"(, {"id": "v", "type": "value"},
        {"id": "c", "type": "color"}, {"id": "ball", "type": "sphere"}, {"id": "noise", "type": "noise"},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "hole"}}},
        {"id": "code", "type": "expression", "code": "return a;", "inputs": {"a": {"from": "v"}}})");
    EXPECT_EQ(fittingInput(graph, "", {"v", ""}, "ball"), (Plug{"ball", "radius"})) << "p would only convert";
    EXPECT_EQ(fittingInput(graph, "", {"c", ""}, "ball"), (Plug{"ball", "p"}));
    EXPECT_EQ(fittingInput(graph, "", {"ball", ""}, "both"), (Plug{"both", "b"})) << "a is linked";
    EXPECT_EQ(fittingInput(graph, "", {"ball", ""}, "out"), (Plug{"out", "surface"}))
        << "though it is linked";
    EXPECT_EQ(fittingInput(graph, "", {"v", ""}, "code"), (Plug{"code", "a2"})) << "a new input of the code";
    EXPECT_EQ(fittingInput(graph, "", {"cut", ""}, "hole"), std::nullopt) << "a cycle";
    EXPECT_EQ(fittingOutput(graph, "", "noise", {"ball", "p"}), (Plug{"noise", "vector"}));
    EXPECT_EQ(fittingOutput(graph, "", "noise", {"ball", "radius"}), (Plug{"noise", "value"}));
    EXPECT_EQ(fittingOutput(graph, "", "out", {"ball", "radius"}), std::nullopt);
}

TEST(Fitting, OffersTheTypesThatFit) {
    const Graph graph = graphOf(std::string(kTower) + R"(, {"id": "c", "type": "color"},
        {"id": "code", "type": "expression", "code": "return p;"})");
    const auto offers = [&](const Plug& plug, bool isOutput, std::string_view type) {
        return std::ranges::any_of(typesThatFit(graph, "", plug, isOutput),
                                   [&](const NodeType* each) { return each->id == type; });
    };
    EXPECT_TRUE(offers({"hole", ""}, true, "union"));
    EXPECT_TRUE(offers({"hole", ""}, true, "expression"));
    EXPECT_TRUE(offers({"hole", ""}, true, "reroute"));
    EXPECT_FALSE(offers({"hole", ""}, true, "output")) << "there is one";
    EXPECT_FALSE(offers({"hole", ""}, true, "time"));
    EXPECT_FALSE(offers({"c", ""}, true, "union")) << "a colour is neither surface nor number";
    EXPECT_TRUE(offers({"c", ""}, true, "material"));
    EXPECT_TRUE(offers({"code", ""}, true, "vector_math"));
    EXPECT_FALSE(offers({"cut", "profile"}, false, "value"));
    EXPECT_TRUE(offers({"cut", "radius"}, false, "value"));
    EXPECT_TRUE(offers({"cut", "a"}, false, "box"));
    EXPECT_FALSE(offers({"cut", "a"}, false, "position"));
    EXPECT_TRUE(offers({"out", "mesh"}, false, "polygonize"));
    EXPECT_FALSE(offers({"out", "mesh"}, false, "expression"));
    for (const bool isOutput : {true, false}) {
        const Plug plug = isOutput ? Plug{"hole", ""} : Plug{"cut", "b"};
        for (const NodeType* type : typesThatFit(graph, "", plug, isOutput)) {
            const Edited added = addNode(graph, "", type->id, {});
            ASSERT_EQ(added.nodes.size(), 1u) << type->id;
            EXPECT_TRUE(isOutput ? fittingInput(added.graph, "", plug, added.nodes[0])
                                 : fittingOutput(added.graph, "", added.nodes[0], plug))
                << type->id;
        }
    }
}

TEST(InsertOnWire, LeadsTheWireThroughTheNode) {
    const Graph graph = graphOf(kTower);
    const Edited twisted = insertOnWire(graph, "", {"cut", "a"}, "twist", {100, 0});
    ASSERT_EQ(twisted.nodes, NodeIds{"twist"});
    EXPECT_EQ(source(twisted.graph, "cut", "a"), "twist");
    EXPECT_EQ(source(twisted.graph, "twist", "surface"), "tower");
    EXPECT_EQ(insertOnWire(graph, "", {"cut", "a"}, "color", {}).graph, graph);
    EXPECT_EQ(insertOnWire(graph, "", {"cut", "radius"}, "twist", {}).graph, graph) << "no wire there";
    const Edited bend = addReroute(graph, "", {"cut", "b"}, {300, 300});
    EXPECT_EQ(source(bend.graph, "cut", "b"), "reroute");
    EXPECT_EQ(source(bend.graph, "reroute", "value"), "moved");
}

TEST(DropOnWire, RefusesWhatWouldCloseACycle) {
    const Graph graph = graphOf(kTower);
    EXPECT_EQ(dropOnWire(graph, "", {"moved", "surface"}, "cut"), graph);
    EXPECT_EQ(dropOnWire(graph, "", {"cut", "b"}, "moved"), graph) << "an end of the wire";
    const Graph dropped = dropOnWire(addNode(graph, "", "twist", {}).graph, "", {"out", "surface"}, "twist");
    EXPECT_EQ(source(dropped, "out", "surface"), "twist");
    EXPECT_EQ(source(dropped, "twist", "surface"), "cut");
}

TEST(RemoveNodes, HealsThroughWhatMutingPassesOn) {
    const Graph graph = graphOf(kTower);
    EXPECT_EQ(source(removeNodes(graph, "", NodeIds{"moved"}, false), "cut", "b"), "");
    EXPECT_EQ(source(removeNodes(graph, "", NodeIds{"moved"}, true), "cut", "b"), "hole");
    EXPECT_EQ(source(removeNodes(graph, "", NodeIds{"cut"}, true), "out", "surface"), "tower");
    EXPECT_EQ(source(removeNodes(graph, "", NodeIds{"cut", "tower"}, true), "out", "surface"), "moved")
        << "the first source that is left";
    EXPECT_EQ(removeNodes(graph, "", NodeIds{"nobody"}, true), graph);
}

TEST(RemoveNodes, TakesAlongWhatSetsTheirInputs) {
    const Graph graph = graphOf(kTower, kReferences);
    ASSERT_TRUE(structuralErrors(graph).empty());
    const Graph left = removeNodes(graph, "", NodeIds{"hole"}, false);
    EXPECT_TRUE(structuralErrors(left).empty()) << structuralErrors(left)[0];
    EXPECT_TRUE(left.parameters.empty());
    EXPECT_EQ((*left.timeline)["tracks"].size(), 2u);
    EXPECT_EQ((*removeNodes(left, "", NodeIds{"moved"}, false).timeline)["tracks"].size(), 1u);
    const Graph broken = graphOf(kTower, R"(, "parameters": [{"name": "n", "node": "gone", "input": "x"}])");
    EXPECT_EQ(removeNodes(broken, "", NodeIds{"hole"}, false).parameters, broken.parameters)
        << "a mistake in the file stays to be seen";
}

TEST(RenameNode, LinksParametersAndTracksFollow) {
    const Graph graph = graphOf(kTower, kReferences);
    const Result<Graph> once = renameNode(graph, "", "hole", "window");
    ASSERT_TRUE(once);
    EXPECT_EQ(source(*once, "moved", "surface"), "window");
    EXPECT_EQ(once->parameters[0].node, "window");
    const Result<Graph> renamed = renameNode(*once, "", "moved", "there");
    ASSERT_TRUE(renamed);
    EXPECT_EQ((*renamed->timeline)["tracks"][0]["node"], "there");
    EXPECT_EQ((*renamed->timeline)["tracks"][0]["input"], "offset.y");
    EXPECT_TRUE(structuralErrors(*renamed).empty());
    EXPECT_EQ(renameNode(graph, "", "hole", "Window").error().message,
              "'Window' is no id for a node: use a-z, 0-9 and '_', beginning with a letter");
    EXPECT_EQ(renameNode(graph, "", "hole", "tower").error().message,
              "another node has the id 'tower': choose another");
    EXPECT_EQ(*renameNode(graph, "", "hole", "hole"), graph);
}

TEST(Duplicate, IsWiredAmongItself) {
    const Graph graph = graphOf(kTower);
    const Edited alone = duplicate(graph, "", NodeIds{"moved", "cut", "out"}, false);
    EXPECT_EQ(alone.nodes, (NodeIds{"moved_2", "cut_2"})) << "an output stands once";
    EXPECT_EQ(source(alone.graph, "cut_2", "b"), "moved_2");
    EXPECT_EQ(source(alone.graph, "cut_2", "a"), "");
    EXPECT_NE(alone.graph.node("cut_2")->at, graph.node("cut")->at);
    const Edited kept = duplicate(graph, "", NodeIds{"moved", "cut"}, true);
    EXPECT_EQ(source(kept.graph, "cut_2", "a"), "tower");
    EXPECT_EQ(source(kept.graph, "moved_2", "surface"), "hole");
    EXPECT_EQ(source(kept.graph, "out", "surface"), "cut");
}

TEST(SetInput, KeepsToWhatTheInputTakes) {
    const Graph graph = graphOf(kTower);
    EXPECT_EQ(setInput(graph, "", {"hole", "radius"}, InputValue{2.0}).node("hole")->input("radius")->value,
              InputValue{2.0}.value);
    EXPECT_EQ(setInput(graph, "", {"hole", "radius"}, std::nullopt).node("hole")->input("radius"), nullptr);
    EXPECT_EQ(setInput(graph, "", {"hole", "radius"}, InputValue{-1.0}), graph);
    EXPECT_EQ(setInput(graph, "", {"hole", "radius"}, InputValue{true}), graph);
    EXPECT_EQ(setInput(graph, "", {"hole", "breadth"}, InputValue{1.0}), graph);
    EXPECT_EQ(setInput(graph, "", {"nobody", "radius"}, InputValue{1.0}), graph);
    EXPECT_EQ(setInput(graph, "", {"hole", "radius"}, InputValue{Link{"cut", ""}}), graph) << "a cycle";
    const Graph tracked =
        graphOf(R"({"id": "e", "type": "expression", "code": "return n;", "inputs": {"n": 1}})",
                R"(, "parameters": [{"name": "n", "node": "e", "input": "n"}])");
    EXPECT_EQ(setInput(tracked, "", {"e", "n"}, InputValue{3.0}).parameters.size(), 1u);
    EXPECT_EQ(setInput(tracked, "", {"e", "n"}, std::nullopt).parameters.size(), 0u);
    EXPECT_TRUE(setInput(tracked, "", {"e", "m"}, InputValue{3.0}).node("e")->input("m"));
}

TEST(SetInput, TracksFollowTheNameOfAParameter) {
    const Graph graph = graphOf(
        R"({"id": "s", "type": "parameter", "inputs": {"name": "size"}},
           {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "s"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})",
        R"(, "timeline": {"tracks": [{"parameter": "size", "keys": [{"time": 0, "value": 0.5}]}]})");
    ASSERT_TRUE(structuralErrors(graph).empty());
    const Graph named = setInput(graph, "", {"s", "name"}, InputValue{std::string("girth")});
    EXPECT_EQ((*named.timeline)["tracks"][0]["parameter"], "girth");
    EXPECT_TRUE(structuralErrors(named).empty());
}

TEST(Toggle, MutesAllOrUnmutesAll) {
    const Graph graph = graphOf(kTower);
    const NodeIds two{"hole", "cut"};
    const Graph one = toggleMuted(graph, "", NodeIds{"hole"});
    EXPECT_TRUE(one.node("hole")->muted);
    const Graph both = toggleMuted(one, "", two);
    EXPECT_TRUE(both.node("hole")->muted && both.node("cut")->muted);
    EXPECT_EQ(toggleMuted(both, "", two), graph);
    EXPECT_EQ(toggleCollapsed(toggleCollapsed(graph, "", two), "", two), graph);
}

TEST(SwapInputs, ChangesTheFirstTwoThatAreAlike) {
    const Graph graph = graphOf(kTower);
    const Graph swapped = swapInputs(graph, "", "cut");
    EXPECT_EQ(source(swapped, "cut", "a"), "moved");
    EXPECT_EQ(source(swapped, "cut", "b"), "tower");
    EXPECT_EQ(writeGraph(swapInputs(swapped, "", "cut")), writeGraph(graph));
    EXPECT_EQ(swapInputs(graph, "", "moved"), graph);
}

TEST(Streams, FollowTheWires) {
    const Graph graph = graphOf(kTower);
    EXPECT_EQ(upstream(graph.nodes, NodeIds{"cut"}),
              (std::set<std::string>{"cut", "tower", "moved", "hole"}));
    EXPECT_EQ(downstream(graph.nodes, NodeIds{"hole"}),
              (std::set<std::string>{"hole", "moved", "cut", "out"}));
}

TEST(Edits, LeaveNoGraphLessSoundThanItWas) {
    uint32_t seed = 100;
    std::map<std::string, int> changes;  // by the kind of edit
    for (Graph graph : editor::test::graphsToEdit(90)) {
        editor::test::RandomEdits edits(++seed);
        std::vector<std::string> former = structuralErrors(graph);
        for (int i = 0; i < 120; ++i) {
            std::string name;
            Graph next = edits.next(graph, name);
            const std::vector<std::string> errors = structuralErrors(next);
            for (const std::string& error : errors)
                ASSERT_TRUE(std::ranges::find(former, error) != former.end())
                    << "seed " << seed << ", edit " << i << ", " << name << ": " << error << "\n"
                    << writeGraph(graph);
            former = errors;
            changes[name] += next != graph;
            graph = std::move(next);
        }
        const Result<Graph> read = parseGraph(writeGraph(graph), "", nullptr);
        ASSERT_TRUE(read) << format(read.error());
        EXPECT_EQ(writeGraph(*read), writeGraph(graph));
    }
    EXPECT_GE(changes.size(), 18u);
    for (const auto& [name, count] : changes) EXPECT_GT(count, 20) << name << " hardly ever did anything";
}

}  // namespace fw::editor::edits_test
