// Where layout, alignment and frames put nodes.
#include "editor/document/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "editor/document/frames.h"
#include "editor/document/layers.h"
#include "editor/document/wiring.h"
#include "tests/support/editor/random_edits.h"
#include "tests/support/graph/random_graph.h"

namespace fw::editor::layout_test {

struct Rect {
    Position low, high;
};

std::vector<Rect> rectsOf(const Graph& graph, std::string_view scope) {
    const Wiring wiring(graph, scope);
    std::vector<Rect> rects;
    for (uint32_t i = 0; i < wiring.scope().nodes.size(); ++i) {
        const Position at = wiring.scope().nodes[i].at.value_or(Position{NAN, NAN});
        const Position size = aboutSize(wiring.scope(), i);
        rects.push_back({at, {at[0] + size[0], at[1] + size[1]}});
    }
    return rects;
}

/// Pairs of nodes of which one covers a part of the other.
int overlaps(const Graph& graph, std::string_view scope) {
    const std::vector<Rect> rects = rectsOf(graph, scope);
    int count = 0;
    for (std::size_t i = 0; i < rects.size(); ++i)
        for (std::size_t k = i + 1; k < rects.size(); ++k)
            count += rects[i].low[0] < rects[k].high[0] && rects[k].low[0] < rects[i].high[0] &&
                     rects[i].low[1] < rects[k].high[1] && rects[k].low[1] < rects[i].high[1];
    return count;
}

NodeIds idsOf(const Graph& graph, std::string_view scope) {
    NodeIds ids;
    for (const Node& node : nodesOf(graph, scope)) ids.push_back(node.id);
    return ids;
}

std::vector<double> heightsOf(const Graph& graph, std::string_view scope) {
    std::vector<double> heights;
    for (const Rect& rect : rectsOf(graph, scope)) heights.push_back(rect.high[1] - rect.low[1]);
    return heights;
}

Graph withoutPlaces(Graph graph) {
    for (Node& node : graph.nodes) node.at.reset();
    for (Group& group : graph.groups)
        for (Node& node : group.nodes) node.at.reset();
    return graph;
}

/// Wires that lead to the left.
int backward(const Graph& graph, std::string_view scope) {
    int count = 0;
    for (const Node& node : nodesOf(graph, scope))
        for (const auto& [name, value] : node.inputs)
            if (const Link* link = std::get_if<Link>(&value.value))
                if (const Node* source = findNode(nodesOf(graph, scope), link->node))
                    count += (*source->at)[0] >= (*node.at)[0];
    return count;
}

TEST(Layout, PutsEveryNodeRightOfItsSourcesAndOnNoOther) {
    for (const Graph& graph : editor::test::graphsToEdit(40)) {
        const Graph placed = placeAll(withoutPlaces(graph));
        EXPECT_EQ(overlaps(placed, ""), 0) << graph.path;
        EXPECT_EQ(backward(placed, ""), 0) << graph.path;
        for (const Group& group : graph.groups) {
            EXPECT_EQ(overlaps(placed, group.id), 0) << graph.path;
            EXPECT_EQ(backward(placed, group.id), 0) << graph.path;
        }
        const Graph again = layOut(placed, "", idsOf(placed, ""), heightsOf(placed, ""));
        EXPECT_EQ(overlaps(again, ""), 0) << graph.path;
        EXPECT_EQ(backward(again, ""), 0) << graph.path;
    }
}

TEST(Layout, LeavesOthersAndTheMiddleWhereTheyWere) {
    const Graph graph = editor::test::graphsToEdit(0).front();
    NodeIds ids = idsOf(graph, "");
    ASSERT_GT(ids.size(), 3u);
    ids.pop_back();
    std::vector<double> heights = heightsOf(graph, "");
    heights.pop_back();
    const Graph moved = moveNodes(graph, "", ids, {1000, 2000});
    const Graph laid = layOut(moved, "", ids, heights);
    EXPECT_EQ(laid.nodes.back(), moved.nodes.back());
    const auto middle = [&](const Graph& of) {
        std::vector<Rect> rects = rectsOf(of, "");
        rects.pop_back();
        Position low = rects[0].low, high = rects[0].high;
        for (const Rect& rect : rects)
            for (int axis = 0; axis < 2; ++axis)
                low[axis] = std::min(low[axis], rect.low[axis]),
                high[axis] = std::max(high[axis], rect.high[axis]);
        return Position{0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])};
    };
    EXPECT_NEAR(middle(laid)[0], middle(moved)[0], 1.0);
    EXPECT_NEAR(middle(laid)[1], middle(moved)[1], 1.0);
}

TEST(Layout, KeepsAnOrderThatCostsNothing) {
    Graph graph = addNode({}, "", "union", {400, 0}).graph;
    for (const char* type : {"sphere", "box", "torus"}) graph = addNode(graph, "", type, {0, 0}).graph;
    for (const auto& [above, below] : {std::pair("sphere", "box"), std::pair("box", "sphere")}) {
        Graph wired = connect(graph, "", {above, ""}, {"union", "a"});
        wired = connect(wired, "", {below, ""}, {"union", "b"});
        const Graph laid = layOut(wired, "", idsOf(wired, ""), heightsOf(wired, ""));
        EXPECT_LT((*laid.node(above)->at)[1], (*laid.node(below)->at)[1]) << "or the wires would cross";
        EXPECT_LT((*laid.node(above)->at)[0], (*laid.node("union")->at)[0]);
    }
    // Two of a kind, on which no wire depends: as they stood.
    for (const double y : {-300.0, 300.0}) {
        Graph wired = connect(graph, "", {"sphere", ""}, {"union", "a"});
        wired = connect(wired, "", {"torus", ""}, {"box", "rounding"});
        wired = moveNodes(wired, "", NodeIds{"torus", "box"}, {0, y});
        const Graph laid = layOut(wired, "", idsOf(wired, ""), heightsOf(wired, ""));
        EXPECT_EQ((*laid.node("torus")->at)[1] < (*laid.node("sphere")->at)[1], y < 0);
    }
}

TEST(Layout, UncrossesWires) {
    // Three rows wired upside down: as many crossings as can be, and none is needed.
    std::vector<LayerBox> boxes(6, {100, 50});
    const std::vector<LayerEdge> edges{{0, 5, 25, 25}, {1, 4, 25, 25}, {2, 3, 25, 25}};
    const auto places = layered(boxes, edges, {0, 1, 2, 3, 4, 5});
    for (const LayerEdge& edge : edges) {
        EXPECT_EQ(places[edge.from].column, 0u);
        EXPECT_EQ(places[edge.to].column, 1u);
        EXPECT_NEAR(places[edge.from].y, places[edge.to].y, 1e-9) << "a wire alone is level";
    }
    EXPECT_LT(places[0].y, places[1].y) << "the order that was wished for";
}

TEST(Layout, StandsCyclesAndWrongLinks) {
    Graph graph;
    for (const char* id : {"a", "b", "c"}) {
        Node node;
        node.id = id, node.type = "union";
        graph.nodes.push_back(node);
    }
    graph.nodes[0].set("a", {Link{"b", ""}});
    graph.nodes[1].set("a", {Link{"a", ""}});
    graph.nodes[2].set("a", {Link{"c", ""}});
    graph.nodes[2].set("b", {Link{"nobody", ""}});
    graph.nodes.push_back(graph.nodes[2]);  // the same id twice
    graph.nodes.push_back({});
    const Graph placed = placeAll(graph);
    EXPECT_EQ(overlaps(placed, ""), 0);
    for (const Node& node : placed.nodes) EXPECT_TRUE(node.at);
    EXPECT_EQ(placeAll(placed), placed);
}

TEST(Layout, PlacesWhatHasNoPlaceBesideWhatHas) {
    Graph graph = editor::test::graphsToEdit(0).front();
    const Graph placed = placeAll(graph);
    EXPECT_EQ(placed, graph) << "samples have places";
    for (const char* type : {"sphere", "box", "torus"}) {
        graph = addNode(graph, "", type, {}).graph;
        graph.nodes.back().at.reset();
    }
    EXPECT_EQ(overlaps(placeAll(graph), ""), 0);
}

TEST(Align, MovesAlongOneAxis) {
    Graph graph = addNode({}, "", "sphere", {10, 20}).graph;
    graph = addNode(graph, "", "box", {300, 500}).graph;
    graph = addNode(graph, "", "torus", {40, 90}).graph;
    const NodeIds ids = idsOf(graph, "");
    const auto at = [&](const Graph& of, const char* id) { return *of.node(id)->at; };
    EXPECT_EQ(at(align(graph, "", ids, Alignment::left), "box"), (Position{10, 500}));
    EXPECT_EQ(at(align(graph, "", ids, Alignment::right), "sphere"), (Position{300, 20}));
    EXPECT_EQ(at(align(graph, "", ids, Alignment::top), "box"), (Position{300, 20}));
    const std::vector<Rect> bottoms = rectsOf(align(graph, "", ids, Alignment::bottom), "");
    EXPECT_EQ(bottoms[0].high[1], bottoms[1].high[1]);
    EXPECT_EQ(bottoms[0].high[1], bottoms[2].high[1]);
    const std::vector<Rect> centres = rectsOf(align(graph, "", ids, Alignment::centre), "");
    EXPECT_EQ(centres[0].low[1] + centres[0].high[1], centres[1].low[1] + centres[1].high[1]);
    const std::vector<Rect> apart = rectsOf(distribute(graph, "", ids, false), "");
    EXPECT_NEAR(apart[2].low[1] - apart[0].high[1], apart[1].low[1] - apart[2].high[1], 1e-9);
    EXPECT_EQ(apart[0].low[1], 20);
    EXPECT_EQ(apart[1].low[1], 500);
    EXPECT_EQ(at(distribute(graph, "", ids, true), "torus")[1], 90);
}

TEST(Frames, AreReadAndWrittenWithWhatIsUnknown) {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "box"}], "frames": [
        {"at": [1, 2], "size": [30, 40], "text": "Windows", "color": [1, 0.5, 0], "pinned": true},
        "no frame", {"scope": "g", "at": [0, 0], "size": [5, 5]}]})",
                   "", nullptr);
    ASSERT_TRUE(graph);
    const std::vector<Frame> frames = framesOf(*graph);
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(frames[0].text, "Windows");
    EXPECT_EQ(frames[1].scope, "g");
    EXPECT_EQ(setFrame(*graph, 0, frames[0]).frames, graph->frames);
    EXPECT_EQ(setFrame(*graph, 1, frames[1]).frames, graph->frames);
    Frame moved = frames[1];
    moved.at = {7, 8};
    const Graph second = setFrame(*graph, 1, moved);
    EXPECT_EQ(second.frames->size(), 3u);
    EXPECT_EQ(framesOf(second)[1].at, (Position{7, 8}));
    EXPECT_EQ((*second.frames)[1], "no frame");
    EXPECT_EQ(framesOf(setFrame(*graph, 0, std::nullopt)).size(), 1u);
    EXPECT_EQ(framesOf(setFrame(*graph, 2, moved)).size(), 3u);
    EXPECT_TRUE(setFrame(setFrame(Graph{}, 0, moved), 0, std::nullopt).frames->is_null());
}

TEST(Frames, HoldTheNodesTheyArePutAround) {
    Graph graph = addNode({}, "", "sphere", {10, 20}).graph;
    graph = addNode(graph, "", "box", {300, 500}).graph;
    const Frame frame = framesOf(frameNodes(graph, "", NodeIds{"sphere", "box"})).at(0);
    for (const Rect& rect : rectsOf(graph, ""))
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_LT(frame.at[axis], rect.low[axis]);
            EXPECT_GT(frame.at[axis] + frame.size[axis], rect.high[axis]);
        }
    EXPECT_EQ(framesOf(frameNodes(graph, "", {})).size(), 1u);
}

}  // namespace fw::editor::layout_test
