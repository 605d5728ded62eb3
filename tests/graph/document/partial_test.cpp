// Graph files of which not all can be read: what is left out, what is said of it, what stays.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "graph/document/json.h"

namespace fw::partial_test {

PartialGraph parse(const std::string& members) {
    return parseWhatCanBeRead(R"({"fieldwright": 1, )" + members + "}", "a.json");
}

/// The places of the errors, "line:column", and the nodes that they name.
std::string errorsOf(const PartialGraph& partial) {
    std::string all;
    for (const Error& each : partial.findings)
        if (each.severity == Error::Severity::error)
            all += std::to_string(each.line) + ":" + std::to_string(each.column) + " " + each.node + "." +
                   each.input + ";";
    return all;
}

TEST(Partial, WhatIsWholeIsReadAsEver) {
    const std::string text =
        R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "sphere", "new": 1}], "later": 2})";
    const PartialGraph partial = parseWhatCanBeRead(text, "a.json");
    std::vector<Error> warnings;
    const Result<Graph> whole = parseGraph(text, "a.json", &warnings);
    ASSERT_TRUE(whole);
    EXPECT_EQ(partial.graph, *whole);
    EXPECT_TRUE(partial.whole);
    EXPECT_TRUE(partial.any);
    EXPECT_EQ(partial.findings.size(), 2u);
    EXPECT_EQ(partial.findings.size(), warnings.size());
}

TEST(Partial, LeavesOutTheLeastThatMakesNoSense) {
    const PartialGraph partial = parse(R"("nodes": [
{"id": "a", "type": "sphere", "at": 3, "muted": "yes", "inputs": {"radius": null, "p": [1, 2, 3], "x": {"to": "b"}}},
{"type": "box"},
17,
{"id": "b"},
{"id": "c", "type": "union", "inputs": {"a": {"from": "a"}, "b": {"from": 5}}}],
"groups": [{"id": "g", "inputs": [{"name": "r", "type": "float", "value": {}}, {"name": "s", "type": "float"}],
  "nodes": [{"id": "n", "type": 4}, {"id": "m", "type": "sphere"}]}, {}],
"parameters": [{"name": "p", "node": "a", "input": "radius"}, {"name": "q", "node": 1, "input": "x"}],
"timeline": 4, "scene": {"x": 1})");
    EXPECT_TRUE(partial.any);
    EXPECT_FALSE(partial.whole);
    const Graph& graph = partial.graph;
    ASSERT_EQ(graph.nodes.size(), 2u);
    EXPECT_EQ(graph.nodes[0].id, "a");
    EXPECT_FALSE(graph.nodes[0].at);
    ASSERT_EQ(graph.nodes[0].inputs.size(), 1u);
    EXPECT_EQ(graph.nodes[0].inputs[0].first, "p");
    ASSERT_EQ(graph.nodes[1].inputs.size(), 1u);
    ASSERT_EQ(graph.groups.size(), 1u);
    ASSERT_EQ(graph.groups[0].inputs.size(), 1u);
    EXPECT_EQ(graph.groups[0].inputs[0].name, "s");
    ASSERT_EQ(graph.groups[0].nodes.size(), 1u);
    EXPECT_EQ(graph.groups[0].nodes[0].id, "m");
    ASSERT_EQ(graph.parameters.size(), 1u);
    EXPECT_TRUE(graph.timeline->is_null());
    EXPECT_TRUE(graph.scene->is_object());
    // The place of each, in the text's order; the two nodes without a type are named twice or once.
    const std::string errors = errorsOf(partial);
    for (const char* each : {"2:37 a.;", "2:49 a.;", "2:77 a.radius;", "a.x;", "3:1 .;", "4:1 .;", "5:1 b.;",
                             "c.b;", "g/n.;", "10:"})
        EXPECT_NE(errors.find(each), std::string::npos) << each << " in " << errors;
    // What was read can be written and read again.
    EXPECT_TRUE(parseGraph(writeGraph(graph), "", nullptr));
}

TEST(Partial, ReadsNothingOfWhatIsNoGraph) {
    for (const char* text :
         {"", "{", "[1, 2]", "{}", R"({"fieldwright": 2, "nodes": []})",
          R"({"fieldwright": "1", "nodes": []})", "\xff", R"({"fieldwright": 1, "nodes": [)"}) {
        const PartialGraph partial = parseWhatCanBeRead(text, "a.json");
        EXPECT_FALSE(partial.any) << text;
        EXPECT_FALSE(partial.whole) << text;
        EXPECT_TRUE(partial.graph.nodes.empty());
        ASSERT_EQ(partial.findings.size(), 1u) << text;
        EXPECT_NE(partial.findings[0].message, "");
    }
    EXPECT_TRUE(parseWhatCanBeRead(R"({"fieldwright": 1})", "").any);
    EXPECT_TRUE(parseWhatCanBeRead(R"({"fieldwright": 1, "nodes": 3})", "").any);
}

TEST(Partial, SaysNoMoreThanAPersonReads) {
    std::string nodes = "17";
    for (int i = 0; i < 500; ++i) nodes += ", 17";
    const PartialGraph partial = parse("\"nodes\": [" + nodes + "]");
    EXPECT_TRUE(partial.graph.nodes.empty());
    EXPECT_LE(partial.findings.size(), 110u);
    EXPECT_NE(partial.findings.back().message.find("401 more"), std::string::npos);
}

}  // namespace fw::partial_test
