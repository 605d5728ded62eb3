// meshRegion(): its messages for solids without a region, and that it can be cancelled; the same of Player.
#include <gtest/gtest.h>

#include "graph/document/json.h"
#include "runtime/play/mesh_program.h"
#include "runtime/play/player.h"
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

TEST(MeshRegion, SaysWhatFlatShapesNeed) {
    EXPECT_EQ(
        messageOf(graphOf(R"({"id": "disc", "type": "circle"})", "disc")),
        std::string("node 'disc' (Circle) is unbounded: it is a flat shape, the same at every z: extrude "
                    "or revolve it, ") +
            kRemedy);
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

/// The ball cuts the half space only before 1 s.
Graph cutForASecond() {
    return graphOf(
        R"({"id": "e", "type": "expression",
            "code": "return max(p.y, (length(p) - 1) * step(time, 1) - 0.1);"})",
        "e", R"(, "timeline": {"length": 4, "tracks": []})");
}

TEST(MeshRegion, LooksAtTheGraphAtItsTime) {
    EXPECT_TRUE(regionAt(cutForASecond(), 0.0));
    EXPECT_EQ(messageOf(cutForASecond(), 2.0), std::string("node 'e' (Expression) is unbounded: ") + kRemedy);
}

Result<Player> playerOf(const Graph& graph, const PlayerOptions& options = {}) {
    Result<Device> device = createDevice({});
    if (!device) return device.error();
    return Player::create(graph, std::move(*device), options);
}

TEST(MeshRegion, APlayerNamesTheNodeAndTheTime) {
    const Result<Player> player = playerOf(cutForASecond());
    ASSERT_FALSE(player);
    const std::string& message = player.error().message;
    EXPECT_TRUE(message.starts_with("node 'e' (Expression) is unbounded: ")) << message;
    EXPECT_TRUE(message.ends_with(" s)")) << message;
}

TEST(MeshRegion, APlayerRefusesWhatIsUnprovenAtSomeTime) {
    const Result<Player> player = playerOf(graphOf(
        R"({"id": "ball", "type": "sphere"},
           {"id": "by", "type": "expression", "code": "return lerp(p, p * sin(p.yzx), step(1, time));"},
           {"id": "w", "type": "warp", "inputs": {"surface": {"from": "ball"}, "p": {"from": "by"}}})",
        "w", R"(, "timeline": {"length": 4, "tracks": []})"));
    ASSERT_FALSE(player);
    EXPECT_TRUE(player.error().message.starts_with("node 'w' (Warp) cannot be proven bounded: "))
        << player.error().message;
}

TEST(MeshRegion, APlayerIsCancelled) {
    const auto stop = std::make_unique<std::stop_source>();  // on the stack GCC 12 warns of it at -Og
    stop->request_stop();
    for (const Graph& graph : {cutForASecond(), graphOf(R"({"id": "b", "type": "sphere"})", "b")}) {
        const Result<Player> player = playerOf(graph, {.stop = [&] { return stop->get_token(); }});
        ASSERT_FALSE(player);
        EXPECT_EQ(player.error().message, "cancelled");
        EXPECT_EQ(player.error().code, Error::Code::cancelled);
    }
}

TEST(MeshRegion, IsCancelled) {
    const auto stop = std::make_unique<std::stop_source>();  // on the stack GCC 12 warns of it at -Og
    stop->request_stop();
    for (const Graph& graph : {graphOf(kPlane, "ground"), graphOf(kWarped, "w")}) {
        const Result<Box> region = regionAt(graph, 0.0, stop->get_token());
        ASSERT_FALSE(region);
        EXPECT_EQ(region.error(), cancelledError());
    }
}

}  // namespace fw::mesh_region_test
