// The canvas' geometry, from descriptors alone: what is where, and what the mouse hits.
#include <gtest/gtest.h>

#include <sstream>

#include "editor/canvas/fields.h"
#include "editor/document/library.h"
#include "editor/document/wiring.h"
#include "editor/files/preferences.h"
#include "editor/shortcuts.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "graph/language/typed_number.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::canvas_test {

using editor::test::parsed;

/// A document with one node of this type.
Graph alone(const NodeType& type) {
    Graph graph;
    Node& node = graph.nodes.emplace_back();
    node.id = "it";
    node.type = type.id;
    node.at = {10, 20};
    return graph;
}

const char* const kSmall = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 2}},
    {"id": "block", "type": "box", "at": [0, 200]},
    {"id": "cut", "type": "subtract", "at": [300, 0], "inputs": {"a": {"from": "ball"}, "b": {"from": "block"}}},
    {"id": "way", "type": "reroute", "at": [520, 60], "inputs": {"value": {"from": "cut"}}},
    {"id": "out", "type": "output", "at": [600, 0], "inputs": {"surface": {"from": "way"}}}]})";

TEST(Boxes, EveryNodeTypeHasABoxWithARowASocket) {
    for (const NodeType& type : nodeTypes()) {
        const Graph graph = alone(type);
        const Boxes boxes(graph, "");
        ASSERT_EQ(boxes.nodes.size(), 1u);
        const NodeBox& box = boxes.nodes[0];
        EXPECT_EQ(box.type, &type);
        if (!type.open) {
            EXPECT_EQ(box.rows.size(), type.inputs.size() + type.outputs.size()) << type.id;
            EXPECT_FALSE(titleOf(box).empty());
        }
        for (const Row& row : box.rows) {
            EXPECT_TRUE(box.area.grown(1).contains(box.socket(row))) << type.id << '.' << row.name;
            for (int i = 0; i < row.fields; ++i) {
                const Area field = box.field(row, i);
                EXPECT_GT(field.width(), 20.0f);
                EXPECT_TRUE(box.area.contains(field.lo) && box.area.contains(field.hi))
                    << type.id << '.' << row.name;
            }
            EXPECT_LE(row.fields, 3);
        }
    }
}

TEST(Boxes, RowsOfANodeDoNotOverlap) {
    for (const NodeType& type : nodeTypes()) {
        const Graph graph = alone(type);
        const Boxes boxes(graph, "");
        float last = kTitleHeight;
        for (const Row& row : boxes.nodes[0].rows) {
            if (boxes.nodes[0].reroute) break;
            EXPECT_GE(row.y - 0.5f * kRowHeight, last - 0.01f) << type.id;
            last = row.y + 0.5f * kRowHeight + (row.fields > 1 ? kRowHeight : 0.0f);
        }
    }
}

TEST(Boxes, WiresLeadFromOutputsToInputs) {
    const Graph graph = parsed(kSmall);
    const Boxes boxes(graph, "");
    ASSERT_EQ(boxes.wires.size(), 4u);
    for (const Wire& wire : boxes.wires) {
        EXPECT_TRUE(boxes.nodes[wire.from].rows[wire.fromRow].output);
        EXPECT_FALSE(boxes.nodes[wire.to].rows[wire.toRow].output);
    }
    EXPECT_EQ(boxes.output(boxes.wires[0]).node, "ball");
    EXPECT_EQ(boxes.input(boxes.wires[0]), (Plug{"cut", "a"}));
}

TEST(Boxes, CollapsedNodesAreTheirTitle) {
    Graph graph = parsed(kSmall);
    graph.nodes[1].collapsed = true;
    const Boxes boxes(graph, "");
    EXPECT_EQ(boxes.nodes[1].area.height(), kTitleHeight);
    for (const Row& row : boxes.nodes[1].rows) EXPECT_EQ(row.fields, 0);
}

TEST(Boxes, BrokenDocumentsAreDrawnTheSame) {
    const Graph graph = parsed(R"({"fieldwright": 1, "nodes": [
        {"id": "a", "type": "no_such_type", "inputs": {"x": 1, "y": {"from": "nowhere"}}},
        {"id": "b", "type": "sphere", "inputs": {"no_such_input": {"from": "b"}, "radius": "text"}},
        {"id": "c", "type": "group", "group": "missing", "inputs": {"z": [1, 2, 3]}}]})");
    const Boxes boxes(graph, "");
    ASSERT_EQ(boxes.nodes.size(), 3u);
    EXPECT_EQ(boxes.nodes[0].rows.size(), 2u);
    EXPECT_TRUE(boxes.row({"b", "no_such_input"}, false));
    EXPECT_EQ(titleOf(boxes.nodes[0]), "no_such_type");
}

TEST(HitTest, FindsWhatIsThere) {
    const Graph graph = parsed(kSmall);
    const Boxes boxes(graph, "");
    const auto at = [&](ImVec2 p) { return hitTest(boxes, p, 8.0f); };
    const NodeBox& ball = boxes.nodes[0];
    EXPECT_EQ(at({90, 10}).what, Hit::What::title);
    EXPECT_EQ(at({-500, -500}).what, Hit::What::nothing);
    for (uint32_t r = 0; r < ball.rows.size(); ++r) {
        const Hit hit = at(ball.socket(ball.rows[r]));
        EXPECT_EQ(hit.what, ball.rows[r].output ? Hit::What::output : Hit::What::input);
        EXPECT_EQ(hit.row, r);
    }
    const Row* radius = boxes.row({"ball", "radius"}, false);
    ASSERT_TRUE(radius && radius->fields == 1);
    EXPECT_EQ(at(ball.field(*radius, 0).centre()).what, Hit::What::field);
    const Curve wire = curve(boxes.start(boxes.wires[0]), boxes.end(boxes.wires[0]));
    const Hit onWire = at(wire.at(0.5f));
    EXPECT_EQ(onWire.what, Hit::What::wire);
    EXPECT_EQ(onWire.index, 0u);
    // A reroute is moved by its middle; wires begin and end at its sides.
    const ImVec2 middle = boxes.nodes[3].area.centre();
    EXPECT_EQ(at(middle).what, Hit::What::title);
    EXPECT_EQ(at({middle.x + 6, middle.y}).what, Hit::What::output);
    EXPECT_EQ(at({middle.x - 6, middle.y}).what, Hit::What::input);
}

TEST(HitTest, WhatIsDrawnLastIsHitFirst) {
    Graph graph = parsed(kSmall);
    graph.nodes[1].at = graph.nodes[0].at;
    const Boxes boxes(graph, "");
    EXPECT_EQ(hitTest(boxes, {90, 10}, 8.0f).index, 1u);
}

TEST(HitTest, FramesLieBelowEverything) {
    Frame frame;
    frame.at = {-50, -50};
    frame.size = {400, 400};
    Frame elsewhere = frame;
    elsewhere.scope = "group";
    const Graph graph = setFrame(setFrame(parsed(kSmall), 0, frame), 1, elsewhere);
    const Boxes boxes(graph, "");
    EXPECT_EQ(hitTest(boxes, {-40, -40}, 8.0f).index, 0u);
    const auto at = [&](ImVec2 p) { return hitTest(boxes, p, 8.0f).what; };
    EXPECT_EQ(at({-40, -40}), Hit::What::frameTitle);
    EXPECT_EQ(at({345, 345}), Hit::What::frameCorner);
    EXPECT_EQ(at({-40, 100}), Hit::What::frame);
    EXPECT_EQ(at({90, 10}), Hit::What::title);
}

TEST(Curve, DistanceAndCrossing) {
    const Curve wire = curve({0, 0}, {200, 0});
    EXPECT_NEAR(wire.distance({100, 30}), 30.0f, 0.01f);
    EXPECT_NEAR(wire.distance({0, 0}), 0.0f, 0.01f);
    EXPECT_TRUE(wire.crosses({100, -20}, {100, 20}));
    EXPECT_FALSE(wire.crosses({100, 10}, {100, 20}));
    EXPECT_FALSE(wire.crosses({300, -20}, {300, 20}));
}

TEST(CanvasView, TheCursorStaysWhereItWasOnTheCanvas) {
    CanvasView view;
    view.panel = {{100, 50}, {900, 650}};
    const ImVec2 cursor(300, 200), before = view.toCanvas(cursor);
    for (float zoom : {0.3f, 1.7f, 100.0f, 0.001f}) {
        view.zoomTo(zoom, cursor);
        EXPECT_GE(view.zoom, kLeastZoom);
        EXPECT_LE(view.zoom, kMostZoom);
        EXPECT_NEAR(view.toCanvas(cursor).x, before.x, 1e-2f);
        EXPECT_NEAR(view.toCanvas(cursor).y, before.y, 1e-2f);
        EXPECT_NEAR(view.toScreen(view.toCanvas({5, 7})).x, 5.0f, 1e-2f);
    }
    view.frame({{-100, -100}, {5000, 400}});
    EXPECT_TRUE(view.panel.contains(view.toScreen({-100, -100})) || view.zoom == kLeastZoom);
}

TEST(Fields, NumbersAreTypedAsExpressions) {
    EXPECT_NEAR(*constantOf("2*pi/3"), 2.0943951, 1e-6);
    EXPECT_EQ(*constantOf("-1.5e3"), -1500.0);
    EXPECT_EQ(*constantOf(" 7 "), 7.0);
    EXPECT_NEAR(*constantOf("sqrt(2)"), 1.41421356, 1e-7);
    for (const char* bad : {"", "1,5", "two", "1/0", "p.x", "time", "1; return 2", "(", "1e999"})
        EXPECT_FALSE(constantOf(bad)) << bad;
}

TEST(Fields, ValuesStayInRange) {
    const Graph graph = parsed(kSmall);
    const Boxes boxes(graph, "");
    const Row* radius = boxes.row({"ball", "radius"}, false);
    ASSERT_TRUE(radius);
    EXPECT_EQ(numbersOf(*radius), std::vector<double>{2.0});
    EXPECT_GE(rangeOf(*radius, 2.0).min, 0.0);
    EXPECT_EQ(inputNumbers(*setNumber(graph, "", {"ball", "radius"}, 0, 3.0).node("ball"), "radius"),
              std::vector<double>{3.0});
    const Row* half = boxes.row({"block", "half_extents"}, false);
    ASSERT_TRUE(half);
    ASSERT_EQ(half->fields, 3);
    const Graph wider = setNumber(graph, "", {"block", "half_extents"}, 1, 3.0);
    EXPECT_EQ(inputNumbers(*wider.node("block"), "half_extents").at(1), 3.0);
    for (const int component : {-1, 3})
        EXPECT_EQ(setNumber(graph, "", {"block", "half_extents"}, component, 3.0), graph);
    EXPECT_EQ(setNumber(graph, "", {"nobody", "radius"}, 0, 3.0), graph);
    EXPECT_EQ(setNumber(graph, "no_group", {"ball", "radius"}, 0, 3.0), graph);
    const Row* cells = boxes.row({"out", "resolution"}, false);
    ASSERT_TRUE(cells);
    EXPECT_TRUE(rangeOf(*cells, 64.0).whole);
    EXPECT_EQ(rangeOf(*cells, 64.0).max, cells->spec->max);
}

TEST(Wires, TheWayThroughOneLeadsFromTheFirstNodeToTheLast) {
    const Graph graph = parsed(kSmall);
    const Boxes boxes(graph, "");
    const auto wireInto = [&](const std::string& node, const std::string& input) {
        for (uint32_t i = 0; i < boxes.wires.size(); ++i)
            if (boxes.input(boxes.wires[i]) == Plug{node, input}) return i;
        ADD_FAILURE() << node;
        return 0u;
    };
    const uint32_t a = wireInto("cut", "a"), b = wireInto("cut", "b"), last = wireInto("out", "surface");
    const std::vector<bool> through = wayThrough(boxes, a);
    EXPECT_TRUE(through[a] && through[wireInto("way", "value")] && through[last]);
    EXPECT_FALSE(through[b]) << "it leads beside";
    const std::vector<bool> all = wayThrough(boxes, last);
    EXPECT_EQ(std::ranges::count(all, true), std::ssize(all));
}

TEST(Wires, FitWhereTheyAreNotRefused) {
    for (const char* name : {"tower", "island", "goblet", "wet_city", "table_and_stool"}) {
        const Result<Graph> graph =
            readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json", nullptr);
        ASSERT_TRUE(graph) << name;
        std::vector<std::string> scopes{""};
        for (const Group& group : graph->groups) scopes.push_back(group.id);
        for (const std::string& scope : scopes) {
            const Boxes boxes(*graph, scope);
            const Wiring wiring(*graph, scope);
            for (const NodeBox& box : boxes.nodes)
                for (const Row& row : box.rows) {
                    const Plug plug{box.node->id, row.name};
                    const std::set<Plug> partners = wiring.partners(plug, row.output);
                    for (const NodeBox& other : boxes.nodes)
                        for (const Row& end : other.rows) {
                            if (end.output == row.output) continue;
                            const Plug to{other.node->id, end.name};
                            const std::string why =
                                row.output ? wiring.refusal(plug, to) : wiring.refusal(to, plug);
                            EXPECT_EQ(partners.contains(to), why.empty())
                                << name << ": " << plug.node << "." << plug.name << " and " << to.node << "."
                                << to.name << ": " << why;
                        }
                }
        }
    }
}

TEST(Library, TheBestMatchIsFirst) {
    std::vector<const NodeType*> all;
    for (const NodeType& type : nodeTypes()) all.push_back(&type);
    EXPECT_EQ(findTypes("", all).size(), all.size());
    for (const NodeType* type : all) {
        EXPECT_EQ(findTypes(type->id, all).front()->id, type->id);
        EXPECT_FALSE(findTypes(type->label.substr(0, 3), all).empty());
    }
    EXPECT_EQ(findTypes("sph", all).front()->id, "sphere");
    EXPECT_EQ(findTypes("SUBTR", all).front()->id, "subtract");
    EXPECT_TRUE(findTypes("no such thing at all", all).empty());
}

TEST(Library, WordsCountInAnyOrderAndOtherProgramsNamesToo) {
    std::vector<const NodeType*> all;
    for (const NodeType& type : nodeTypes()) {
        all.push_back(&type);
        // Each name leads to its node.
        std::istringstream names{std::string(otherNames(type.id))};
        for (std::string name; names >> name;) {
            const auto found = findTypes(name, all);
            EXPECT_TRUE(std::ranges::find(found, &type) != found.end()) << name << ": " << type.id;
        }
    }
    for (const auto& [typed, id] : {std::pair{"repeat polar", "polar_repeat"},
                                    {"field mesh to", "mesh_to_field"},
                                    {"xyz COMBINE", "combine_xyz"},
                                    {"principled bsdf", "material"},
                                    {"difference", "subtract"},
                                    {"pModPolar", "polar_repeat"},
                                    {"xform", "transform"},
                                    {"marching cubes", "polygonize"},
                                    {"solidify", "shell"}}) {
        const auto found = findTypes(typed, all);
        ASSERT_FALSE(found.empty()) << typed;
        const std::size_t first =
            typed == std::string("solidify") || typed == std::string("difference") ? 2 : 1;
        EXPECT_TRUE(std::ranges::any_of(std::span(found).first(std::min(first, found.size())),
                                        [&](const NodeType* type) { return type->id == id; }))
            << typed << " finds " << found[0]->id;
    }
    EXPECT_TRUE(findTypes("polar nonsense", all).empty());
}

TEST(Library, WhatWasTakenLastComesFirst) {
    std::vector<const NodeType*> all;
    for (const NodeType& type : nodeTypes()) all.push_back(&type);
    std::vector<std::string> recent;
    toFront(recent, "torus", kMostTaken);
    toFront(recent, "twist", kMostTaken);
    toFront(recent, "torus", kMostTaken);
    EXPECT_EQ(recent, (std::vector<std::string>{"torus", "twist"}));
    EXPECT_EQ(findTypes("t", all, recent)[0]->id, "torus");
    EXPECT_EQ(findTypes("t", all, recent)[1]->id, "twist");
    EXPECT_EQ(findTypes("sphere", all, {{"cut_sphere"}})[0]->id, "sphere") << "a better match all the same";
    const auto usual = usualTypes(all, recent, 4);
    ASSERT_EQ(usual.size(), 4u);
    EXPECT_EQ(usual[0]->id, "torus");
    EXPECT_EQ(usual[1]->id, "twist");
    EXPECT_EQ(usual[2]->id, "union");
    EXPECT_EQ(usualTypes({}, recent, 4).size(), 0u);
    EXPECT_EQ(usualTypes(all, {{"no_such_node"}}, 1)[0]->id, "union");
    for (int i = 0; i < 100; ++i) toFront(recent, "x" + std::to_string(i), kMostTaken);
    EXPECT_EQ(recent.size(), kMostTaken);
    EXPECT_EQ(recent[0], "x99");
}

TEST(Shortcuts, AreReadAsTheyAreWritten) {
    for (const char* text :
         {"Ctrl+Shift+D", "X", "F1", "Space", "Alt+S", "Shift+Tab", "Delete", "Pad0", "Period"}) {
        const auto shortcut = shortcutOf(text);
        ASSERT_TRUE(shortcut) << text;
        EXPECT_EQ(textOf(*shortcut), text);
    }
    EXPECT_EQ(shortcutOf("ctrl+z"), shortcutOf("Ctrl+Z"));
    for (const char* bad : {"", "Ctrl+", "Hyper+X", "Ctrl+Ctrl+X", "F99", "+"})
        EXPECT_FALSE(shortcutOf(bad)) << bad;
}

}  // namespace fw::editor::canvas_test
