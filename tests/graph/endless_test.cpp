// The node by which a solid has no bounds is found: behind booleans, in groups, and not where it is cut.
#include "graph/compile/endless.h"

#include <gtest/gtest.h>

#include "graph/document/json.h"

namespace fw::endless_test {

std::string endless(const std::string& nodes, const std::string& shown, const std::string& groups = "") {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes +
                       R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": ")" + shown +
                       R"("}}}])" + groups + "}",
                   "graph", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return endlessNode(*graph);
}

std::string node(const std::string& id, const std::string& type, const std::string& inputs = "") {
    return R"({"id": ")" + id + R"(", "type": ")" + type + R"(", "inputs": {)" + inputs + "}}";
}

const std::string kBall = node("ball", "sphere") + ",";
const std::string kTwo = R"("a": {"from": "ball"}, "b": {"from": "other"})";

TEST(Endless, ShapesWithoutEnd) {
    for (const char* type : {"plane", "slab", "infinite_cylinder", "gyroid"}) {
        const std::string found =
            endless(kBall + node("other", type) + "," + node("both", "union", kTwo) + "," +
                        node("moved", "translate", R"("surface": {"from": "both"}, "offset": [1, 0, 0])"),
                    "moved");
        EXPECT_EQ(found.substr(0, 9), "'other' (") << type << found;
    }
}

TEST(Endless, ARepetitionWithoutACount) {
    EXPECT_EQ(endless(kBall + node("rows", "repeat", R"("surface": {"from": "ball"}, "period": [3, 3, 0])") +
                          "," + node("grown", "offset", R"("surface": {"from": "rows"})"),
                      "grown"),
              "'rows' (Repeat)");
}

TEST(Endless, WhatIsCutOffIsNotToBlame) {
    // The slab is cut by the ball; the drill is not.
    EXPECT_EQ(endless(kBall + node("other", "slab") + "," + node("lens", "intersect", kTwo) + "," +
                          node("drill", "infinite_cylinder") + "," +
                          node("all", "union", R"("a": {"from": "lens"}, "b": {"from": "drill"})"),
                      "all"),
              "'drill' (Infinite cylinder)");
}

TEST(Endless, InsideAGroup) {
    const std::string groups = R"(, "groups": [{"id": "pile",
        "inputs": [{"name": "top", "type": "surface"}], "outputs": [{"name": "made", "type": "surface"}],
        "nodes": [{"id": "in", "type": "group_input"}, {"id": "ground", "type": "plane"},
                  {"id": "both", "type": "union", "inputs": {"a": {"from": "in", "output": "top"}, "b": {"from": "ground"}}},
                  {"id": "end", "type": "group_output", "inputs": {"made": {"from": "both"}}}]}])";
    const std::string instance =
        R"({"id": "first", "type": "group", "group": "pile", "inputs": {"top": {"from": "ball"}}})";
    EXPECT_EQ(endless(kBall + instance, "first", groups), "'first/ground' (Plane)");
}

}  // namespace fw::endless_test
