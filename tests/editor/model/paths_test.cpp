// Paths of nodes in groups: from a path to its place, and from a place to all its instances.
#include "editor/document/paths.h"

#include <gtest/gtest.h>

#include "graph/compile/compile.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::paths_test {

/// A group `pair` of two instances of the group `ball`, and the document with two of `pair` and one of
/// `ball`.
constexpr char kNested[] = R"({"fieldwright": 1,
  "groups": [
    {"id": "ball", "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
      {"id": "sphere", "type": "sphere"},
      {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "sphere"}}}]},
    {"id": "pair", "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
      {"id": "left", "type": "group", "group": "ball"},
      {"id": "right", "type": "group", "group": "ball"},
      {"id": "both", "type": "subtract", "inputs": {"a": {"from": "left"}, "b": {"from": "right"}}},
      {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "both"}}}]},
    {"id": "unused", "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
      {"id": "itself", "type": "group", "group": "unused"},
      {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "itself"}}}]}],
  "nodes": [
    {"id": "first", "type": "group", "group": "pair"},
    {"id": "second", "type": "group", "group": "pair"},
    {"id": "third", "type": "group", "group": "ball"},
    {"id": "two", "type": "union", "inputs": {"a": {"from": "first"}, "b": {"from": "second"}}},
    {"id": "all", "type": "union", "inputs": {"a": {"from": "two"}, "b": {"from": "third"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}}}]})";

Graph nested() { return editor::test::parsed(kNested); }

using Strings = std::vector<std::string>;
using Place = std::pair<std::string, std::string>;

TEST(Paths, LeadToThePlaceOfANode) {
    const Graph graph = nested();
    EXPECT_EQ(placeOf(graph, "all"), Place("", "all"));
    EXPECT_EQ(placeOf(graph, "ball/sphere"), Place("ball", "sphere"));
    EXPECT_EQ(placeOf(graph, "second/left/sphere.radius"), Place("ball", "sphere.radius"));
    EXPECT_EQ(placeOf(graph, "no_such/sphere"), Place("", "sphere"));
}

TEST(Paths, EveryInstanceOfANodeHasOne) {
    const Graph graph = nested();
    EXPECT_EQ(instancesOf(graph, "", "all"), Strings{"all"});
    EXPECT_EQ(instancesOf(graph, "pair", "both"), (Strings{"first/both", "second/both"}));
    EXPECT_EQ(instancesOf(graph, "ball", "sphere.radius"),
              (Strings{"first/left/sphere.radius", "first/right/sphere.radius", "second/left/sphere.radius",
                       "second/right/sphere.radius", "third/sphere.radius"}));
    EXPECT_EQ(instancesOf(graph, "unused", "itself"), Strings{});
    for (const std::string& path : instancesOf(graph, "ball", "sphere"))
        EXPECT_EQ(placeOf(graph, path), Place("ball", "sphere")) << path;
}

TEST(Paths, TheCompilerKnowsEveryInstance) {
    Graph graph = nested();
    graph.groups.pop_back();  // the one that holds itself
    CompileOptions options;
    for (const std::string& name : instancesOf(graph, "ball", "sphere.radius")) options.live.insert(name);
    const Result<Program> program = compile(graph, options);
    ASSERT_TRUE(program) << format(program.error());
    EXPECT_EQ(program->live.size(), 5u);
    EXPECT_TRUE(program->nodeExactness.at("third/sphere").exactness.exact());
    const NodeExactness& both = program->nodeExactness.at("second/both");
    EXPECT_FALSE(both.exactness.exact());
    EXPECT_EQ(both.spoiledBy, "second/both");
}

}  // namespace fw::editor::paths_test
