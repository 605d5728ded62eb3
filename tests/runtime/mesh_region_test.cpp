// meshRegion(): what it says of solids that have no region, and that it can be cancelled. Needs no device.
#include <gtest/gtest.h>

#include "graph/document/json.h"
#include "runtime/play/mesh_program.h"
#include "runtime/play/session.h"

namespace fw::mesh_region_test {

constexpr char kRemedy[] =
    "intersect it with a box, or give a region (--region, or region_min and region_max of a polygonize node)";

Graph graphOf(const std::string& nodes, const std::string& shown, const std::string& more = "") {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes +
                       R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": ")" + shown +
                       R"("}}}])" + more + "}",
                   "graph", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return *graph;
}

Result<Box> regionAt(const Graph& graph, double seconds, std::stop_token stop = {}) {
    const Result<Program> program = compileAtTime(graph, seconds);
    EXPECT_TRUE(program) << format(program.error());
    return meshRegion(*program, {}, regionContext(graph, seconds, std::move(stop)));
}

std::string messageOf(const Graph& graph, double seconds = 0.0) {
    const Result<Box> region = regionAt(graph, seconds);
    return region ? std::string() : region.error().message;
}

const std::string kPlane = R"({"id": "ground", "type": "plane"})";
/// Far away there is solid only near the crossings of three surfaces where a sine is 0.
const std::string kWarped = R"({"id": "ball", "type": "sphere"},
    {"id": "by", "type": "expression", "code": "return p * sin(p.yzx);"},
    {"id": "w", "type": "warp", "inputs": {"surface": {"from": "ball"}, "p": {"from": "by"}}})";

TEST(MeshRegion, NamesTheNodeThatIsUnbounded) {
    EXPECT_EQ(messageOf(graphOf(kPlane + R"(, {"id": "t", "type": "translate",
        "inputs": {"surface": {"from": "ground"}, "offset": [0, 1, 0]}})",
                                "t")),
              std::string("node 'ground' (Plane) is unbounded: ") + kRemedy);
    const Result<Program> program = compile(graphOf(kPlane, "ground"));
    const Result<Box> unnamed = meshRegion(*program, {});
    ASSERT_FALSE(unnamed);
    EXPECT_EQ(unnamed.error().message, std::string("the solid is unbounded: ") + kRemedy);
}

TEST(MeshRegion, SaysWhereSolidMayBe) {
    const std::string message = messageOf(graphOf(kWarped, "w"));
    EXPECT_TRUE(message.starts_with("node 'w' (Warp) cannot be proven bounded: there may be solid between ("))
        << message;
    EXPECT_TRUE(message.ends_with(std::string("); ") + kRemedy)) << message;
}

TEST(MeshRegion, SaysThatASolidIsEmpty) {
    const std::string empty = R"({"id": "e", "type": "expression", "code": "return length(p) + 1;"})";
    EXPECT_EQ(messageOf(graphOf(empty, "e")),
              "the solid is empty: the field is nowhere negative; check the nodes that cut it (subtract, "
              "intersect) and its sizes");
}

TEST(MeshRegion, LooksAtTheGraphAtItsTime) {
    // The ball cuts the half space only before 1 s.
    const Graph graph = graphOf(R"({"id": "ball", "type": "sphere"},
            {"id": "e", "type": "expression", "code": "return max(p.y, (length(p) - 1) * step(time, 1));"})",
                                "e", R"(, "timeline": {"length": 4, "tracks": []})");
    EXPECT_TRUE(regionAt(graph, 0.0));
    EXPECT_TRUE(messageOf(graph, 2.0).starts_with("node 'e' (Expression) is unbounded: "))
        << messageOf(graph, 2.0);
}

TEST(MeshRegion, IsCancelled) {
    std::stop_source stop;
    stop.request_stop();
    for (const Graph& graph : {graphOf(kPlane, "ground"), graphOf(kWarped, "w")}) {
        const Result<Box> region = regionAt(graph, 0.0, stop.get_token());
        ASSERT_FALSE(region);
        EXPECT_EQ(region.error(), cancelledError());
    }
}

}  // namespace fw::mesh_region_test
