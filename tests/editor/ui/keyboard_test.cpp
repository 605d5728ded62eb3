// The canvas by keyboard: which node lies where, and which wires a list can offer.
#include "editor/canvas/keyboard.h"

#include <gtest/gtest.h>

#include "editor/document/connections.h"
#include "graph/document/json.h"

namespace fw::editor::keyboard_test {

Graph read(const std::string& text) {
    const Result<Graph> graph = parseGraph(text, "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? *graph : Graph{};
}

const char* const kGraph = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0]},
    {"id": "low", "type": "box", "at": [10, 300]},
    {"id": "both", "type": "union", "at": [300, 40], "inputs": {"a": {"from": "ball"}}},
    {"id": "out", "type": "output", "at": [600, 0], "inputs": {"surface": {"from": "both"}}},
    {"id": "far", "type": "torus", "at": [300, -900]}]})";

std::string idOf(const NodeBox* box) { return box ? box->node->id : ""; }

TEST(Neighbour, IsWhatLiesAheadBeforeWhatLiesAside) {
    const Graph graph = read(kGraph);
    const Boxes boxes(graph, "");
    EXPECT_EQ(idOf(neighbour(boxes, "ball", {1, 0})), "both");
    EXPECT_EQ(idOf(neighbour(boxes, "both", {1, 0})), "out");
    EXPECT_EQ(idOf(neighbour(boxes, "both", {-1, 0})), "ball");
    EXPECT_EQ(idOf(neighbour(boxes, "ball", {0, 1})), "low");
    EXPECT_EQ(idOf(neighbour(boxes, "both", {0, -1})), "far");
    EXPECT_EQ(neighbour(boxes, "ball", {-1, 0}), nullptr);
    EXPECT_EQ(neighbour(boxes, "nobody", {1, 0}), nullptr);
    EXPECT_EQ(idOf(nearestNode(boxes, {400, 90})), "both");
    EXPECT_EQ(nearestNode(Boxes(Graph{}, ""), {0, 0}), nullptr);
}

TEST(Neighbour, EveryNodeIsReachedByArrows) {
    const Graph graph = read(kGraph);
    const Boxes boxes(graph, "");
    std::set<std::string> reached{"ball"};
    for (std::size_t before = 0; before != reached.size();) {
        before = reached.size();
        for (const std::string& id : std::set<std::string>(reached))
            for (const ImVec2 to : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)})
                if (const NodeBox* next = neighbour(boxes, id, to)) reached.insert(next->node->id);
    }
    EXPECT_EQ(reached.size(), 5u);
}

TEST(Step, SelectsAndBringsIntoSight) {
    const Graph graph = read(kGraph);
    const Boxes boxes(graph, "");
    Canvas canvas;
    canvas.view.panel = {{0, 0}, {400, 300}};
    canvas.view.middle = {90, 50};
    step(canvas, boxes, {1, 0}, false);
    EXPECT_EQ(canvas.active, "ball") << "nothing was active: what is in the middle";
    const ImVec2 before = canvas.view.middle;
    step(canvas, boxes, {1, 0}, true);
    EXPECT_EQ(canvas.selection, (std::set<std::string>{"ball", "both"}));
    EXPECT_EQ(canvas.active, "both");
    EXPECT_GT(canvas.view.middle.x, before.x);
    const Area box = boxes.find("both")->area, seen = canvas.view.seen();
    EXPECT_GE(seen.hi.x, box.hi.x);
    EXPECT_LE(seen.lo.x, box.lo.x);
    step(canvas, boxes, {1, 0}, false);
    EXPECT_EQ(canvas.selection, (std::set<std::string>{"out"}));
    step(canvas, boxes, {1, 0}, false);
    EXPECT_EQ(canvas.active, "out") << "nothing lies further";
}

TEST(Step, NodesAddedInOnePlaceDoNotHideEachOther) {
    const Graph graph = read(kGraph);
    const Boxes boxes(graph, "");
    const ImVec2 place = freePlace(boxes, {3, -2});
    EXPECT_EQ(place.x, 3);
    EXPECT_GE(place.y, boxes.find("ball")->area.hi.y);
    EXPECT_EQ(freePlace(boxes, {100, 30}).y, 30) << "over a node, but its corner is seen";
}

TEST(Step, EditsTheFirstNumberOfTheActiveNode) {
    const Graph graph = read(kGraph);
    const Boxes boxes(graph, "");
    Canvas canvas;
    canvas.view.panel = {{0, 0}, {400, 300}};
    Document document(graph);
    EXPECT_FALSE(typeFirstValue(canvas, document, boxes));
    canvas.select({"ball"});
    ASSERT_TRUE(typeFirstValue(canvas, document, boxes));
    EXPECT_TRUE(canvas.number.types("ball.radius", 0));
    EXPECT_EQ(std::string(canvas.number.typed.text), "1");
    EXPECT_TRUE(document.holds(canvas.number.hand));
    document.settle();
    canvas.number.follow(document);
    EXPECT_FALSE(canvas.number.types("ball.radius", 0)) << "the document has ended it";
    canvas.view.zoom = kLeastZoom;
    EXPECT_FALSE(typeFirstValue(canvas, document, boxes)) << "too small to be seen";
}

TEST(Connections, AreThoseWithoutARefusal) {
    const Graph graph = read(kGraph);
    const std::vector<Connection> all = connectionsOf(graph, "", "both", {});
    for (const Connection& each : all)
        EXPECT_EQ(refusal(graph, "", each.output, each.input), "")
            << each.output.node << " " << each.input.node << "." << each.input.name;
    const auto has = [&](const Connection& wire) { return std::ranges::count(all, wire) == 1; };
    EXPECT_TRUE(has({{"low", "surface"}, {"both", "b"}}));
    EXPECT_TRUE(has({{"far", "surface"}, {"both", "a"}})) << "in place of the ball";
    EXPECT_FALSE(has({{"ball", "surface"}, {"both", "a"}})) << "it is there";
    EXPECT_FALSE(has({{"both", "surface"}, {"out", "surface"}})) << "it is there";
    EXPECT_TRUE(connectionsOf(graph, "", "nobody", {}).empty());

    // Those to what is selected come first, of them those to free inputs.
    const std::vector<Connection> near = connectionsOf(graph, "", "both", {"both", "low"});
    ASSERT_FALSE(near.empty());
    EXPECT_EQ(near[0], (Connection{{"low", "surface"}, {"both", "b"}}));
    EXPECT_EQ(near.size(), all.size());
}

TEST(Connections, AnExpressionTakesOneMoreInput) {
    const Graph graph = read(R"({"fieldwright": 1, "nodes": [
        {"id": "number", "type": "time"},
        {"id": "code", "type": "expression", "inputs": {"a": 1}, "code": "return a;"}]})");
    const std::vector<Connection> all = connectionsOf(graph, "", "code", {});
    const auto into = [&](const char* name) {
        return std::ranges::any_of(all, [&](const Connection& each) { return each.input.name == name; });
    };
    EXPECT_TRUE(into("a"));
    EXPECT_TRUE(into("a2"));
}

}  // namespace fw::editor::keyboard_test
