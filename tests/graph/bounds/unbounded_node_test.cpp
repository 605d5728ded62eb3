// findUnboundedNode() names the node that makes a solid unbounded, upstream of any nodes that only move it or
// pass it on. It never names a node whose solid a later node cuts off.
#include "graph/compile/unbounded_node.h"

#include <gtest/gtest.h>

#include "graph/compile/compile.h"
#include "graph/compile/node_fields.h"
#include "graph/document/json.h"

namespace fw::unbounded_node_test {

Graph graphOf(const std::string& nodes, const std::string& shown, const std::string& groups = "") {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes +
                       R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": ")" + shown +
                       R"("}}}])" + (groups.empty() ? "" : R"(, "groups": [)" + groups + "]") + "}",
                   "graph", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    const Result<Program> program = compile(*graph);
    EXPECT_TRUE(program) << format(program.error());
    return *graph;
}

std::string describeFor(const std::string& nodes, const std::string& shown, const std::string& groups = "") {
    const std::optional<UnboundedNode> found = findUnboundedNode(graphOf(nodes, shown, groups));
    EXPECT_TRUE(!found || found->isCause);
    return found ? describe(*found) : "";
}

std::string node(const std::string& id, const std::string& type, const std::string& inputs = "",
                 const std::string& more = "") {
    return R"({"id": ")" + id + R"(", "type": ")" + type + R"(", "inputs": {)" + inputs + "}" + more + "}";
}

std::string from(const std::string& input, const std::string& id, const std::string& output = "") {
    return "\"" + input + R"(": {"from": ")" + id + "\"" +
           (output.empty() ? "" : R"(, "output": ")" + output + "\"") + "}";
}

/// A chain of translations "t1" to "t<count>" of `first`.
std::string translations(const std::string& first, int count) {
    std::string nodes;
    for (int i = 1; i <= count; ++i)
        nodes += "," + node("t" + std::to_string(i), "translate",
                            from("surface", i == 1 ? first : "t" + std::to_string(i - 1)) +
                                R"(, "offset": [0.1, 0.2, 0.3])");
    return nodes;
}

const std::string kBall = node("ball", "sphere") + ",";
const std::string kTwo = from("a", "ball") + "," + from("b", "other");
const std::string kMuted = R"(, "muted": true)";

TEST(UnboundedNode, UnboundedShapes) {
    for (const char* type : {"plane", "slab", "infinite_cylinder", "gyroid"}) {
        const std::string found =
            describeFor(kBall + node("other", type) + "," + node("both", "union", kTwo) + "," +
                            node("moved", "translate", from("surface", "both") + R"(, "offset": [1, 0, 0])"),
                        "moved");
        EXPECT_EQ(found.substr(0, 14), "node 'other' (") << type << found;
        EXPECT_TRUE(found.ends_with(") is unbounded")) << type << found;
    }
}

TEST(UnboundedNode, NothingOfABoundedSolid) {
    EXPECT_EQ(describeFor(kBall + node("t", "translate", from("surface", "ball")), "t"), "");
    // The plane is cut.
    EXPECT_EQ(describeFor(kBall + node("other", "plane") + "," + node("cut", "intersect", kTwo), "cut"), "");
}

TEST(UnboundedNode, ARepetitionWithoutACount) {
    EXPECT_EQ(
        describeFor(kBall + node("rows", "repeat", from("surface", "ball") + R"(, "period": [3, 3, 0])") +
                        "," + node("grown", "offset", from("surface", "rows")),
                    "grown"),
        "node 'rows' (Repeat) is unbounded");
}

TEST(UnboundedNode, ShapesThatAreCutAreNotNamed) {
    // The slab is cut by the ball; the drill is not.
    EXPECT_EQ(describeFor(kBall + node("other", "slab") + "," + node("lens", "intersect", kTwo) + "," +
                              node("drill", "infinite_cylinder") + "," +
                              node("all", "union", from("a", "lens") + "," + from("b", "drill")),
                          "all"),
              "node 'drill' (Infinite cylinder) is unbounded");
    // A plane that is subtracted is not the cause.
    EXPECT_EQ(describeFor(node("ground", "plane") + "," + node("slab", "slab") + "," +
                              node("cut", "subtract", from("a", "slab") + "," + from("b", "ground")),
                          "cut"),
              "node 'slab' (Slab) is unbounded");
    EXPECT_EQ(describeFor(kBall + node("other", "plane") + "," + node("half", "intersect", kTwo) + "," +
                              node("rows", "repeat", from("surface", "half") + R"(, "period": [3, 0, 0])"),
                          "rows"),
              "node 'rows' (Repeat) is unbounded");
}

TEST(UnboundedNode, LongChainsOfTranslations) {
    for (const int count : {40, 300})
        EXPECT_EQ(
            describeFor(node("ground", "plane") + translations("ground", count), "t" + std::to_string(count)),
            "node 'ground' (Plane) is unbounded")
            << count;
}

TEST(UnboundedNode, LongUnions) {
    std::string nodes = node("ground", "plane");
    std::string last = "ground";
    for (int i = 0; i < 200; ++i) {
        const std::string number = std::to_string(i);
        nodes += "," + node("s" + number, "sphere") + "," +
                 node("t" + number, "translate",
                      from("surface", "s" + number) + R"(, "offset": [)" + number + ", 0, 0]") +
                 "," + node("u" + number, "union", from("a", "t" + number) + "," + from("b", last));
        last = "u" + number;
    }
    EXPECT_EQ(describeFor(nodes, last), "node 'ground' (Plane) is unbounded");
}

TEST(UnboundedNode, StopsAtANodeThatIsKnownToBeUnbounded) {
    const Graph graph = graphOf(node("ground", "plane") + translations("ground", 40), "t40");
    const std::optional<UnboundedNode> found = findUnboundedNode(graph, {.maxSeconds = 0.0});
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->isCause);
    EXPECT_EQ(describe(*found), "node 't40' (Translate), or a node upstream of it, is unbounded");

    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(findUnboundedNode(graph, {.stop = stop.get_token()}));
}

TEST(UnboundedNode, InsideAGroup) {
    const std::string group = R"({"id": "pile",
        "inputs": [{"name": "top", "type": "surface"}], "outputs": [{"name": "made", "type": "surface"}],
        "nodes": [{"id": "in", "type": "group_input"}, {"id": "ground", "type": "plane"},
                  {"id": "both", "type": "union", "inputs": {"a": {"from": "in", "output": "top"}, "b": {"from": "ground"}}},
                  {"id": "end", "type": "group_output", "inputs": {"made": {"from": "both"}}}]})";
    const std::string instance = node("first", "group", from("top", "ball"), R"(, "group": "pile")");
    EXPECT_EQ(describeFor(kBall + instance, "first", group), "node 'first/ground' (Plane) is unbounded");
    // Muted, it passes on the ball.
    EXPECT_EQ(describeFor(
                  kBall + node("first", "group", from("top", "ball"), R"(, "group": "pile", "muted": true)"),
                  "first", group),
              "");
}

/// A group "moves" that translates its surface input.
const std::string kMoves = R"({"id": "moves",
    "inputs": [{"name": "solid", "type": "surface"}], "outputs": [{"name": "moved", "type": "surface"}],
    "nodes": [{"id": "in", "type": "group_input"},
              {"id": "t", "type": "translate", "inputs": {"surface": {"from": "in", "output": "solid"}, "offset": [1, 2, 3]}},
              {"id": "end", "type": "group_output", "inputs": {"moved": {"from": "t"}}}]})";
/// A group "nested" with an instance of it, and another whose surface is inside.
const std::string kNested = R"({"id": "nested",
    "inputs": [{"name": "solid", "type": "surface"}], "outputs": [{"name": "made", "type": "surface"}],
    "nodes": [{"id": "in", "type": "group_input"},
              {"id": "m", "type": "group", "group": "moves", "inputs": {"solid": {"from": "in", "output": "solid"}}},
              {"id": "end", "type": "group_output", "inputs": {"made": {"from": "m"}}}]})";

TEST(UnboundedNode, ThroughGroupInputsAndNestedGroups) {
    EXPECT_EQ(describeFor(node("ground", "plane") + "," +
                              node("g", "group", from("solid", "ground"), R"(, "group": "moves")"),
                          "g", kMoves),
              "node 'ground' (Plane) is unbounded");
    EXPECT_EQ(describeFor(node("ground", "plane") + "," +
                              node("g", "group", from("solid", "ground"), R"(, "group": "nested")") + "," +
                              node("h", "group", from("solid", "g"), R"(, "group": "moves")"),
                          "h", kMoves + "," + kNested),
              "node 'ground' (Plane) is unbounded");
    const std::string deep = R"({"id": "deep", "outputs": [{"name": "made", "type": "surface"}],
        "nodes": [{"id": "floor", "type": "plane"},
                  {"id": "n", "type": "group", "group": "nested", "inputs": {"solid": {"from": "floor"}}},
                  {"id": "end", "type": "group_output", "inputs": {"made": {"from": "n"}}}]})";
    EXPECT_EQ(describeFor(node("d", "group", "", R"(, "group": "deep")") + "," +
                              node("h", "group", from("solid", "d"), R"(, "group": "nested")"),
                          "h", kMoves + "," + kNested + "," + deep),
              "node 'd/floor' (Plane) is unbounded");
}

TEST(UnboundedNode, PastMutedNodesAndReroutes) {
    const std::string ground = node("ground", "plane") + ",";
    EXPECT_EQ(describeFor(ground + node("m", "translate", from("surface", "ground"), kMuted), "m"),
              "node 'ground' (Plane) is unbounded");
    EXPECT_EQ(describeFor(ground + node("r", "reroute", from("value", "ground")) + "," +
                              node("s", "reroute", from("value", "r")) + translations("s", 2),
                          "t2"),
              "node 'ground' (Plane) is unbounded");
    // A muted union passes on its first input; the plane has no part in the solid.
    EXPECT_EQ(describeFor(kBall + node("other", "plane") + "," + node("u", "union", kTwo, kMuted), "u"), "");
    EXPECT_EQ(describeFor(kBall + node("other", "plane") + "," + node("drill", "infinite_cylinder") + "," +
                              node("u", "union", from("a", "drill") + "," + from("b", "other"), kMuted),
                          "u"),
              "node 'drill' (Infinite cylinder) is unbounded");
}

TEST(UnboundedNode, ExpressionsWithUnboundedCode) {
    const std::string code = node("e", "expression", "", R"(, "code": "return p.y - 0.1 * sin(p.x);")");
    EXPECT_EQ(describeFor(code, "e"), "node 'e' (Expression) is unbounded");
    // A number that is used as a surface.
    EXPECT_EQ(describeFor(code + "," + node("t", "translate", from("surface", "e")), "t"),
              "node 'e' (Expression) is unbounded");
    // The code makes a bounded solid unbounded.
    EXPECT_EQ(
        describeFor(kBall + node("e", "expression", from("d", "ball"), R"(, "code": "return -d;")"), "e"),
        "node 'e' (Expression) is unbounded");
    EXPECT_EQ(describeFor(node("ground", "plane") + "," +
                              node("e", "expression", from("d", "ground"), R"(, "code": "return d - 1;")"),
                          "e"),
              "node 'ground' (Plane) is unbounded");
}

TEST(UnboundedNode, MeshStagesAreFollowed) {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + node("ground", "plane") + translations("ground", 1) +
                       "," + node("cells", "polygonize", from("surface", "t1")) + "," +
                       node("less", "decimate", from("mesh", "cells")) + "," +
                       node("out", "output", from("mesh", "less")) + "]}",
                   "graph", nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    ASSERT_TRUE(compile(*graph));
    const std::optional<UnboundedNode> found = findUnboundedNode(*graph);
    ASSERT_TRUE(found);
    EXPECT_EQ(describe(*found), "node 'ground' (Plane) is unbounded");
}

TEST(UnboundedNode, AWarpThatCannotBeProven) {
    // Far away there is solid only near the crossings of three surfaces where a sine is 0, which no sample
    // hits and no interval excludes.
    const std::string nodes = kBall + node("by", "expression", "", R"(, "code": "return p * sin(p.yzx);")") +
                              "," + node("w", "warp", from("surface", "ball") + "," + from("p", "by")) +
                              translations("w", 3);
    const std::optional<UnboundedNode> found = findUnboundedNode(graphOf(nodes, "t3"), {.maxSeconds = 1e3});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->path, "w");
    EXPECT_EQ(found->extent, Extent::unproven);
    EXPECT_GT(longestSide(found->unproven), 0.0);
    EXPECT_TRUE(describe(*found).starts_with(
        "node 'w' (Warp) cannot be proven bounded: there may be solid between ("))
        << describe(*found);
}

TEST(UnboundedNode, APartOfAUnionThatIsUnboundedComesFirst) {
    const std::string nodes = kBall + node("by", "expression", "", R"(, "code": "return p * sin(p.yzx);")") +
                              "," + node("w", "warp", from("surface", "ball") + "," + from("p", "by")) + "," +
                              node("ground", "plane") + "," +
                              node("u", "union", from("a", "w") + "," + from("b", "ground"));
    EXPECT_EQ(describeFor(nodes, "u"), "node 'ground' (Plane) is unbounded");
}

TEST(UnboundedNode, TheTimeCounts) {
    // Cut until 1 s.
    const std::string nodes =
        node("e", "expression", "", R"(, "code": "return max(p.y, (length(p) - 1) * step(time, 1) - 0.1);")");
    const Graph graph = graphOf(nodes, "e");
    EXPECT_TRUE(findUnboundedNode(graph, {.time = 2.0}));
    EXPECT_FALSE(findUnboundedNode(graph, {.time = 0.0}));
}

}  // namespace fw::unbounded_node_test
