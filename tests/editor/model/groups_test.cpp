// Grouping and ungrouping: the field stays what it was, and so does what sets its numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "editor/document/edits.h"
#include "editor/document/frames.h"
#include "graph/check/check.h"
#include "graph/check/typed_parameter.h"
#include "graph/compile/compile.h"
#include "graph/document/named_parameters.h"
#include "graph/document/timeline.h"
#include "graph/evaluate/evaluate.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/editor/random_edits.h"

namespace fw::editor::groups_test {

using editor::test::graphOf;
using editor::test::structuralErrors;

/// Distance and material at some points; empty if the graph does not compile, be it for a node that nothing
/// needs.
std::vector<double> valuesOf(const Graph& graph) {
    if (hasErrors(check(graph))) return {};
    const Result<Program> program = compile(graph, {.bake = boxInPlace});
    if (!program) return {};
    std::mt19937 random(3);
    std::vector<Point> points(20);
    for (Point& point : points)
        for (int axis = 0; axis < 3; ++axis) point[axis] = std::uniform_real_distribution(-2.0, 2.0)(random);
    std::vector<double> all, values(points.size());
    // Who painted a place is told by a number of the document's nodes, which groups change.
    for (const IrId id : std::span(program->surface).first(painterComponent)) {
        evaluate(program->ir, id, program->parameters(), points, values);
        all.insert(all.end(), values.begin(), values.end());
    }
    return all;
}

bool alike(const std::vector<double>& a, const std::vector<double>& b) {
    return std::ranges::equal(a, b, [](double x, double y) {
        return x == y || (std::isnan(x) && std::isnan(y)) ||
               std::abs(x - y) <= 1e-9 * std::max({1.0, std::abs(x), std::abs(y)});
    });
}

constexpr const char* kTower = R"(
  {"id": "tower", "type": "box", "at": [0, 0], "inputs": {"half_extents": [1, 2, 1]}},
  {"id": "hole", "type": "sphere", "at": [0, 160], "inputs": {"radius": 0.5}},
  {"id": "moved", "type": "translate", "at": [240, 160], "inputs": {"surface": {"from": "hole"}, "offset": [0, 1, 0]}},
  {"id": "cut", "type": "subtract", "at": [480, 0], "inputs": {"a": {"from": "tower"}, "b": {"from": "moved"}}},
  {"id": "out", "type": "output", "at": [720, 0], "inputs": {"surface": {"from": "cut"}}})";

constexpr const char* kReferences = R"(,
  "parameters": [{"name": "size", "node": "hole", "input": "radius", "min": 0.1, "max": 0.9}],
  "timeline": {"tracks": [
    {"node": "moved", "input": "offset.y", "keys": [{"time": 0, "value": 0}, {"time": 1, "value": 1}]},
    {"parameter": "size", "keys": [{"time": 0, "value": 0.2}, {"time": 1, "value": 0.4}]}]},
  "frames": [{"at": [-20, 140], "size": [500, 300], "text": "Window"}])";

TEST(Group, HasTheWiresOfItsNodesAsInputsAndOutputs) {
    const Graph graph = graphOf(kTower);
    const Result<Edited> made = groupNodes(graph, "", NodeIds{"moved", "cut"});
    ASSERT_TRUE(made) << format(made.error());
    const Graph& grouped = made->graph;
    ASSERT_EQ(made->nodes, NodeIds{"group"});
    ASSERT_EQ(grouped.groups.size(), 1u);
    const Group& group = grouped.groups[0];
    ASSERT_EQ(group.inputs.size(), 2u);
    EXPECT_EQ(group.inputs[0].name, "surface");
    EXPECT_EQ(group.inputs[0].type, "surface");
    EXPECT_EQ(group.inputs[1].name, "a");
    ASSERT_EQ(group.outputs.size(), 1u);
    EXPECT_EQ(group.nodes.size(), 4u);
    EXPECT_EQ(std::get<Link>(grouped.node("group")->input("a")->value).node, "tower");
    EXPECT_EQ(std::get<Link>(grouped.node("out")->input("surface")->value), (Link{"group", ""}));
    EXPECT_TRUE(check(grouped).empty()) << format(check(grouped)[0]);
    EXPECT_TRUE(alike(valuesOf(grouped), valuesOf(graph)));
    const Edited back = ungroup(grouped, "", "group");
    EXPECT_EQ(back.nodes, (NodeIds{"moved", "cut"}));
    EXPECT_TRUE(back.graph.groups.empty());
    EXPECT_EQ(back.graph.node("cut")->inputs, graph.node("cut")->inputs);
    EXPECT_TRUE(alike(valuesOf(back.graph), valuesOf(graph)));
}

TEST(Group, SaysWhyItCannotBe) {
    const Graph graph = graphOf(kTower);
    EXPECT_EQ(groupNodes(graph, "", NodeIds{"cut", "out"}).error().message,
              "a node of type 'output' stands for itself: leave it out");
    EXPECT_EQ(groupNodes(graph, "", NodeIds{"hole", "cut"}).error().message,
              "a way leads out of the group to 'moved' and back into it: choose that node too");
    EXPECT_FALSE(groupNodes(graph, "", NodeIds{"nobody"}));
    const Graph wrong = graphOf(
        R"({"id": "e", "type": "expression", "code": "return nothing;"}, {"id": "t", "type": "translate", "inputs": {"surface": {"from": "e"}}})");
    EXPECT_EQ(groupNodes(wrong, "", NodeIds{"t"}).error().message,
              "what node 'e' gives is not known while it has errors: correct them first");
}

TEST(Group, TypesOfExpressionsAreThoseOfTheirResults) {
    const Graph graph = graphOf(R"(
      {"id": "e", "type": "expression", "code": "return p * k;", "inputs": {"k": 1.5}},
      {"id": "bend", "type": "reroute", "inputs": {"value": {"from": "e"}}},
      {"id": "ball", "type": "sphere", "inputs": {"p": {"from": "bend"}}},
      {"id": "f", "type": "expression", "code": "return length(q) - 1.0;", "inputs": {"q": {"from": "bend"}}},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "ball"}, "b": {"from": "f"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})");
    const Result<Edited> made = groupNodes(graph, "", NodeIds{"ball", "f"});
    ASSERT_TRUE(made) << format(made.error());
    const Group& group = made->graph.groups[0];
    ASSERT_EQ(group.inputs.size(), 1u) << "one source, one input";
    EXPECT_EQ(group.inputs[0].type, "vec3");
    ASSERT_EQ(group.outputs.size(), 2u);
    EXPECT_EQ(group.outputs[0].type, "surface");
    EXPECT_EQ(group.outputs[1].type, "float");
    EXPECT_TRUE(alike(valuesOf(made->graph), valuesOf(graph)));
}

TEST(Group, ParametersTracksAndFramesFollow) {
    const Graph graph = graphOf(kTower, kReferences);
    ASSERT_TRUE(structuralErrors(graph).empty()) << structuralErrors(graph)[0];
    const Result<Edited> made = groupNodes(graph, "", NodeIds{"hole", "moved"});
    ASSERT_TRUE(made) << format(made.error());
    const Graph& grouped = made->graph;
    ASSERT_EQ(grouped.parameters.size(), 1u);
    EXPECT_EQ(grouped.parameters[0].node, "group");
    EXPECT_EQ(grouped.parameters[0].input, "radius");
    EXPECT_EQ((*grouped.timeline)["tracks"].size(), 2u);
    EXPECT_EQ((*grouped.timeline)["tracks"][0]["node"], "group");
    EXPECT_EQ((*grouped.timeline)["tracks"][0]["input"], "offset.y");
    EXPECT_EQ(framesOf(grouped).at(0).scope, "group");
    EXPECT_TRUE(check(grouped).empty()) << format(check(grouped)[0]);
    for (const double time : {0.0, 0.3, 1.0})
        EXPECT_TRUE(alike(valuesOf(atTime(grouped, *readTimeline(grouped), time)),
                          valuesOf(atTime(graph, *readTimeline(graph), time))));
    const Graph back = ungroup(grouped, "", "group").graph;
    EXPECT_EQ(back.parameters, graph.parameters);
    EXPECT_EQ(back.timeline, graph.timeline);
    EXPECT_EQ(framesOf(back).at(0).scope, "");
    EXPECT_TRUE(alike(valuesOf(back), valuesOf(graph)));
}

TEST(Group, ASurfaceThatFeedsAnExposedNumberIsNoParameter) {
    const Graph graph = graphOf(
        R"({"id": "near", "type": "box"},
           {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "near"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})",
        R"(, "parameters": [{"name": "size", "node": "ball", "input": "radius"}])");
    ASSERT_TRUE(structuralErrors(graph).empty()) << structuralErrors(graph)[0];
    const Result<Edited> made = groupNodes(graph, "", NodeIds{"ball"});
    ASSERT_TRUE(made) << format(made.error());
    EXPECT_EQ(made->graph.groups[0].inputs[0].type, "surface");
    EXPECT_TRUE(made->graph.parameters.empty());
    EXPECT_TRUE(structuralErrors(made->graph).empty()) << structuralErrors(made->graph)[0];
    EXPECT_TRUE(alike(valuesOf(made->graph), valuesOf(graph)));
}

TEST(Group, AParameterNodeInsideIsExposedByItsName) {
    const Graph graph = graphOf(
        R"({"id": "s", "type": "parameter", "inputs": {"name": "size", "value": 0.7, "max": 2}},
           {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "s"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})",
        R"(, "timeline": {"tracks": [{"parameter": "size", "keys": [{"time": 0, "value": 0.5}]}]})");
    const Result<Edited> made = groupNodes(graph, "", NodeIds{"s", "ball"});
    ASSERT_TRUE(made) << format(made.error());
    const auto parameter = findParameter(made->graph, "size");
    ASSERT_TRUE(parameter);
    EXPECT_EQ(parameter->node, "group");
    EXPECT_EQ(parameter->max, 2.0);
    EXPECT_EQ((*made->graph.timeline)["tracks"].size(), 1u);
    EXPECT_TRUE(check(made->graph).empty()) << format(check(made->graph)[0]);
    EXPECT_TRUE(alike(valuesOf(made->graph), valuesOf(graph)));
    const Graph apart = ungroup(made->graph, "", "group").graph;
    EXPECT_TRUE(apart.parameters.empty()) << "its name alone exposes it again";
    EXPECT_EQ(findParameter(apart, "size")->node, "s");
}

TEST(Ungroup, GivesInputsTheValuesOfTheInstance) {
    const Result<Graph> graph =
        readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/table_and_stool.field.json", nullptr);
    ASSERT_TRUE(graph);
    const Edited table = ungroup(*graph, "", "table");
    EXPECT_EQ(table.graph.groups.size(), 1u) << "the stool still shows it";
    EXPECT_TRUE(check(table.graph).empty()) << format(check(table.graph)[0]);
    EXPECT_TRUE(alike(valuesOf(table.graph), valuesOf(*graph)));
    EXPECT_EQ(table.graph.parameters.size(), 3u);
    for (const ExposedParameter& parameter : table.graph.parameters) {
        Graph a = *graph, b = table.graph;
        ASSERT_TRUE(setParameter(a, parameter.name, "0.75"));
        ASSERT_TRUE(setParameter(b, parameter.name, "0.75"));
        EXPECT_TRUE(alike(valuesOf(a), valuesOf(b))) << parameter.name;
        EXPECT_FALSE(alike(valuesOf(a), valuesOf(*graph))) << parameter.name;
    }
    const Edited both = ungroup(table.graph, "", "stool");
    EXPECT_TRUE(both.graph.groups.empty());
    EXPECT_TRUE(check(both.graph).empty());
    EXPECT_TRUE(alike(valuesOf(both.graph), valuesOf(*graph)));
    EXPECT_EQ(ungroup(*graph, "", "both").graph, *graph) << "no group";
}

TEST(Ungroup, ConvertsAsTheGroupsEndsDid) {
    // The group takes a surface as a distance, a number as a surface, and values that its nodes cannot hold.
    const Graph graph = graphOf(R"(
      {"id": "ball", "type": "sphere"},
      {"id": "red", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": [1, 0, 0]}},
      {"id": "number", "type": "value", "inputs": {"value": 0.3}},
      {"id": "g", "type": "group", "group": "g", "inputs": {"d": {"from": "red"}, "v": {"from": "number"}, "big": 0.7}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "g"}}})",
                                R"(, "groups": [{"id": "g",
      "inputs": [{"name": "d", "type": "float"}, {"name": "v", "type": "vec3"}, {"name": "big", "type": "float"},
                 {"name": "none", "type": "float"}],
      "outputs": [{"name": "result", "type": "surface"}],
      "nodes": [{"id": "in", "type": "group_input"},
        {"id": "bend", "type": "reroute", "inputs": {"value": {"from": "in", "output": "big"}}},
        {"id": "mat", "type": "material", "inputs": {"surface": {"from": "in", "output": "d"},
          "base_color": {"from": "in", "output": "v"}, "roughness": {"from": "in", "output": "big"}}},
        {"id": "moved", "type": "expression", "code": "return a + length(v) * 0.1 + n + b * 0.01;", "inputs":
          {"a": {"from": "mat"}, "v": {"from": "in", "output": "v"}, "n": {"from": "in", "output": "none"}, "b": {"from": "bend"}}},
        {"id": "low", "type": "union", "inputs": {"a": {"from": "moved"}, "b": {"from": "in", "output": "d"}}},
        {"id": "end", "type": "group_output", "inputs": {"result": {"from": "low"}}}]}])");
    ASSERT_TRUE(structuralErrors(graph).empty()) << structuralErrors(graph)[0];
    ASSERT_FALSE(valuesOf(graph).empty());
    const Edited apart = ungroup(graph, "", "g");
    EXPECT_TRUE(structuralErrors(apart.graph).empty()) << structuralErrors(apart.graph)[0];
    EXPECT_TRUE(apart.graph.groups.empty());
    EXPECT_TRUE(alike(valuesOf(apart.graph), valuesOf(graph))) << writeGraph(apart.graph);
}

TEST(Group, TheFieldStaysAsItWas) {
    std::mt19937 random(11);
    int grouped = 0, ungrouped = 0, compiled = 0;
    const bool all = std::getenv("FIELDWRIGHT_LONG");  // else every third
    int number = 0;
    for (const Graph& start : editor::test::graphsToEdit(80)) {
        if (!all && number++ % 3 != 0) continue;
        Graph graph = start;
        const std::vector<double> values = valuesOf(graph);
        compiled += !values.empty();
        for (int i = 0; i < 6; ++i) {
            const std::string scope =
                graph.groups.empty() || i < 2 ? "" : graph.groups[random() % graph.groups.size()].id;
            const std::vector<Node>& nodes = nodesOf(graph, scope);
            NodeIds chosen;
            for (const Node& node : nodes)
                if (random() % 3 == 0 && !node.type.starts_with("group_") && node.type != "output")
                    chosen.push_back(node.id);
            const Node& one = nodes[random() % nodes.size()];
            Graph next = graph;
            if (i % 3 == 2 && one.type == "group") {
                next = ungroup(graph, scope, one.id).graph;
                ungrouped += next != graph;
            } else if (const Result<Edited> made = groupNodes(graph, scope, chosen)) {
                next = made->graph;
                ++grouped;
            }
            ASSERT_TRUE(structuralErrors(next).empty()) << structuralErrors(next)[0] << "\n"
                                                        << writeGraph(graph) << writeGraph(next);
            // What is out of range is not seen where it comes in from outside: a graph with errors has less.
            ASSERT_TRUE(values.empty() || alike(valuesOf(next), values))
                << scope << " " << one.id << writeGraph(graph) << writeGraph(next);
            graph = std::move(next);
        }
        for (bool any = true; any;) {  // and all apart again
            any = false;
            const std::vector<Node> nodes = graph.nodes;
            for (const Node& node : nodes) {
                if (node.type != "group") continue;
                Graph next = ungroup(graph, "", node.id).graph;
                ASSERT_FALSE(next == graph) << node.id << writeGraph(graph);
                graph = std::move(next);
                any = true;
            }
        }
        EXPECT_TRUE(structuralErrors(graph).empty()) << structuralErrors(graph)[0];
        ASSERT_TRUE(alike(valuesOf(graph), values)) << writeGraph(graph);
        EXPECT_EQ(graph.parameters.size(), start.parameters.size());
    }
    EXPECT_GT(compiled, 30);
    EXPECT_GT(grouped, 60);
    EXPECT_GT(ungrouped, 5);
}

}  // namespace fw::editor::groups_test
