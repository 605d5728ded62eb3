// Edits that the panels make of parameters, expressions and the sockets of groups.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "editor/document/expression_inputs.h"
#include "editor/document/group_sockets.h"
#include "editor/document/parameters.h"
#include "graph/compile/compile.h"
#include "graph/document/timeline.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::panels_test {

using editor::test::errorsOf;
using editor::test::parsed;

const char* const kBall = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "inputs": {"radius": 2}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}}]})";

TEST(Parameters, AnInputIsExposedUnderItsNameWithItsRange) {
    const Graph graph = exposeInput(parsed(kBall), {"ball", "radius"});
    ASSERT_EQ(graph.parameters.size(), 1u);
    EXPECT_EQ(graph.parameters[0].name, "radius");
    EXPECT_EQ(graph.parameters[0].node, "ball");
    EXPECT_EQ(graph.parameters[0].min, std::optional(0.0));
    EXPECT_FALSE(graph.parameters[0].max);
    EXPECT_EQ(errorsOf(graph), "");
    EXPECT_EQ(parameterOf(graph, {"ball", "radius"}), std::optional<std::size_t>(0));
    EXPECT_NE(exposureRefusal(graph, {"ball", "radius"}), "") << "it is one already";
    EXPECT_EQ(exposeInput(graph, {"ball", "radius"}), graph);
}

TEST(Parameters, TwoOfOneNameAreToldApart) {
    Graph graph = parsed(R"({"fieldwright": 1, "nodes": [
        {"id": "a", "type": "sphere"}, {"id": "b", "type": "sphere"},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "a"}, "b": {"from": "b"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}}]})");
    graph = exposeInput(exposeInput(graph, {"a", "radius"}), {"b", "radius"});
    ASSERT_EQ(graph.parameters.size(), 2u);
    EXPECT_EQ(graph.parameters[1].name, "b_radius");
    EXPECT_EQ(errorsOf(graph), "");
    EXPECT_FALSE(renameParameter(graph, 1, "radius")) << "taken";
    EXPECT_FALSE(renameParameter(graph, 1, ""));
    EXPECT_FALSE(renameParameter(graph, 1, "a=b"));
    const Graph swapped = moveParameter(graph, 1, 0);
    EXPECT_EQ(swapped.parameters[0].name, "b_radius");
    EXPECT_EQ(swapped.parameters[1].name, "radius");
    EXPECT_EQ(moveParameter(swapped, 0, 1), graph);
}

TEST(Parameters, OnlyNumbersWithAValueOfTheirOwnAreExposed) {
    const Graph graph = parsed(kBall);
    EXPECT_NE(exposureRefusal(graph, {"out", "surface"}), "") << "linked";
    EXPECT_NE(exposureRefusal(graph, {"out", "method"}), "") << "words";
    EXPECT_NE(exposureRefusal(graph, {"ball", "p"}), "") << "the position";
    EXPECT_NE(exposureRefusal(graph, {"ball", "nothing"}), "");
    EXPECT_NE(exposureRefusal(graph, {"nobody", "radius"}), "");
    EXPECT_EQ(exposureRefusal(graph, {"ball", "radius"}), "");
}

TEST(Parameters, TracksFollowANameAndOutliveTheParameter) {
    Graph graph = exposeInput(parsed(kBall), {"ball", "radius"});
    graph.timeline =
        Json::parse(R"({"tracks": [{"note": 1, "parameter": "radius", "keys": [{"time": 0, "value": 1}]}]})");
    const Result<Graph> renamed = renameParameter(graph, 0, "size");
    ASSERT_TRUE(renamed);
    EXPECT_EQ((*renamed->timeline)["tracks"][0]["parameter"], "size");
    EXPECT_EQ(errorsOf(*renamed), "");
    const Graph without = removeParameter(*renamed, 0);
    EXPECT_TRUE(without.parameters.empty());
    EXPECT_EQ((*without.timeline)["tracks"][0].dump(),
              R"({"note":1,"node":"ball","input":"radius","keys":[{"time":0,"value":1}]})");
    EXPECT_EQ(errorsOf(without), "");
}

TEST(Parameters, ARangeNeverTurnsOver) {
    Graph graph = exposeInput(parsed(kBall), {"ball", "radius"});
    graph = setParameterMax(graph, 0, 3.0);
    graph = setParameterMin(graph, 0, 5.0);
    EXPECT_EQ(graph.parameters[0].max, std::optional(5.0));
    graph = setParameterMax(graph, 0, 1.0);
    EXPECT_EQ(graph.parameters[0].min, std::optional(1.0));
    graph = setParameterMin(graph, 0, std::nullopt);
    EXPECT_FALSE(graph.parameters[0].min);
    EXPECT_EQ(setParameterMin(graph, 7, 1.0), graph);
}

const char* const kCode = R"({"fieldwright": 1, "nodes": [
    {"id": "code", "type": "expression", "inputs": {"r": 1}, "code": "v = p.r; return length(p) - r*r2;"},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "code"}}}]})";

TEST(ExpressionInputs, AreAddedWithATypeAndOneName) {
    const Result<Graph> graph = addExpressionInput(parsed(kCode), "", "code", "r2", Type::vec3);
    ASSERT_TRUE(graph);
    const InputValue* value = graph->node("code")->input("r2");
    ASSERT_TRUE(value);
    EXPECT_EQ(typeOfValue(*value), Type::vec3);
    EXPECT_FALSE(addExpressionInput(*graph, "", "code", "r2", Type::scalar)) << "taken";
    EXPECT_FALSE(addExpressionInput(*graph, "", "code", "2r", Type::scalar));
    EXPECT_FALSE(addExpressionInput(*graph, "", "code", "a b", Type::scalar));
    EXPECT_FALSE(addExpressionInput(*graph, "", "code", "", Type::scalar));
}

TEST(ExpressionInputs, ARenamedOneIsRenamedInCodeAndParameters) {
    const Graph graph = exposeInput(parsed(kCode), {"code", "r"});
    ASSERT_EQ(graph.parameters.size(), 1u);
    const Result<Graph> renamed = renameExpressionInput(graph, "", {"code", "r"}, "radius");
    ASSERT_TRUE(renamed);
    EXPECT_EQ(renamed->node("code")->code, "v = p.r; return length(p) - radius*r2;");
    EXPECT_TRUE(renamed->node("code")->input("radius"));
    EXPECT_FALSE(renamed->node("code")->input("r"));
    EXPECT_EQ(renamed->parameters[0].input, "radius");
}

TEST(ExpressionInputs, ATypeKeepsTheNumbersThatFit) {
    Graph graph = setExpressionType(parsed(kCode), "", {"code", "r"}, Type::vec3);
    EXPECT_EQ(std::get<std::vector<double>>(graph.node("code")->input("r")->value),
              (std::vector<double>{1, 0, 0}));
    graph = setExpressionType(graph, "", {"code", "r"}, Type::scalar);
    EXPECT_EQ(std::get<double>(graph.node("code")->input("r")->value), 1.0);
}

const char* const kGroup = R"({"fieldwright": 1, "nodes": [
    {"id": "one", "type": "group", "group": "balls", "inputs": {"size": 2}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "one"}}}],
  "groups": [{"id": "balls",
    "inputs": [{"name": "size", "type": "float", "value": 1}],
    "outputs": [{"name": "ball", "type": "surface"}],
    "nodes": [{"id": "in", "type": "group_input"},
      {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "in"}}},
      {"id": "end", "type": "group_output", "inputs": {"ball": {"from": "ball"}}}]}]})";

TEST(GroupSockets, AFurtherOneLeavesTheWiresOfTheFirst) {
    ASSERT_EQ(errorsOf(parsed(kGroup)), "");
    const Result<Graph> added = addSocket(parsed(kGroup), "balls", GroupSide::inputs, "shift", Type::vec3);
    ASSERT_TRUE(added);
    EXPECT_EQ(errorsOf(*added), "");
    const Graph first = moveSocket(*added, "balls", GroupSide::inputs, "shift", 0);
    EXPECT_EQ(first.groups[0].inputs[0].name, "shift");
    EXPECT_EQ(errorsOf(first), "") << "the radius is fed by size, which is the second now";
    EXPECT_EQ(std::get<Link>(first.groups[0].nodes[1].input("radius")->value).output, "size");
    EXPECT_FALSE(addSocket(first, "balls", GroupSide::inputs, "shift", Type::vec3)) << "taken";
    EXPECT_FALSE(addSocket(first, "balls", GroupSide::outputs, "9", Type::vec3));
}

TEST(GroupSockets, ARenamedOneIsRenamedEverywhere) {
    Graph graph = exposeInput(parsed(kGroup), {"one", "size"});
    ASSERT_EQ(graph.parameters.size(), 1u);
    Result<Graph> renamed = renameSocket(graph, "balls", GroupSide::inputs, "size", "radius");
    ASSERT_TRUE(renamed);
    EXPECT_EQ(errorsOf(*renamed), "");
    EXPECT_TRUE(renamed->node("one")->input("radius"));
    EXPECT_EQ(renamed->parameters[0].input, "radius");
    renamed = renameSocket(*renamed, "balls", GroupSide::outputs, "ball", "solid");
    ASSERT_TRUE(renamed);
    EXPECT_EQ(errorsOf(*renamed), "");
    EXPECT_TRUE(renamed->groups[0].nodes[2].input("solid"));
    EXPECT_FALSE(renameSocket(*renamed, "balls", GroupSide::inputs, "radius", "no name"));
}

TEST(GroupSockets, ARemovedOneTakesItsWiresAndParametersAlong) {
    Graph graph = exposeInput(parsed(kGroup), {"one", "size"});
    graph = removeSocket(graph, "balls", GroupSide::inputs, "size");
    EXPECT_EQ(errorsOf(graph), "");
    EXPECT_TRUE(graph.groups[0].inputs.empty());
    EXPECT_FALSE(graph.node("one")->input("size"));
    EXPECT_FALSE(graph.groups[0].nodes[1].input("radius"));
    EXPECT_TRUE(graph.parameters.empty());
    graph = removeSocket(graph, "balls", GroupSide::outputs, "ball");
    EXPECT_FALSE(graph.node("out")->input("surface"));
    EXPECT_FALSE(graph.groups[0].nodes[2].input("ball"));
}

TEST(GroupSockets, AnotherTypeDropsWhatIsNotOfIt) {
    const Graph graph = setSocketType(parsed(kGroup), "balls", GroupSide::inputs, "size", Type::vec3);
    EXPECT_EQ(graph.groups[0].inputs[0].type, "vec3");
    EXPECT_FALSE(graph.node("one")->input("size")) << "a number is no vector";
    EXPECT_FALSE(graph.groups[0].inputs[0].value);
    EXPECT_FALSE(graph.groups[0].nodes[1].input("radius")) << "a vector is no radius";
    EXPECT_EQ(errorsOf(graph), "");
}

}  // namespace fw::editor::panels_test
