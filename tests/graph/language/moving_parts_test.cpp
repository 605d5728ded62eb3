// Documents as parts that move as wholes.
#include "graph/compile/moving_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/document/timeline.h"
#include "graph/evaluate/evaluate.h"

namespace fw::moving_parts_test {

constexpr std::array kTimes = {0.0, 0.25, 0.5, 0.75};

std::optional<std::vector<PartNode>> partsOf(const std::string& nodes, const std::string& tracks) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes +
                                               R"(], "timeline": {"length": 1, "tracks": [)" + tracks + "]}}",
                                           "parts", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return movingParts(*graph, kTimes);
}

const std::string kBall = R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},)";
std::string shown(const std::string& id) {
    return R"({"id": "out", "type": "output", "inputs": {"surface": {"from": ")" + id + R"("}}})";
}
std::string moved(const std::string& node, const std::string& input, const std::string& from,
                  const std::string& to) {
    return R"({"node": ")" + node + R"(", "input": ")" + input + R"(", "keys": [{"time": 0, "value": )" +
           from + R"(}, {"time": 1, "value": )" + to + "}]}";
}

TEST(MovingParts, ASurfaceThatIsMoved) {
    const auto parts = partsOf(
        kBall +
            R"({"id": "go", "type": "translate", "label": "Going", "inputs": {"surface": {"from": "ball"}}},)" +
            shown("go"),
        moved("go", "offset", "[0, 0, 0]", "[4, 0, 8]"));
    ASSERT_TRUE(parts);
    ASSERT_EQ(parts->size(), 2u);
    EXPECT_EQ((*parts)[0].name, "Going");
    ASSERT_EQ((*parts)[0].poses.size(), kTimes.size());
    EXPECT_NEAR((*parts)[0].poses[1].move[0], 1.0, 1e-12);
    EXPECT_NEAR((*parts)[0].poses[3].move[2], 6.0, 1e-12);
    EXPECT_EQ((*parts)[1].name, "ball");
    EXPECT_EQ((*parts)[1].parent, 0u);
    // The part is the ball alone, where it is not moved.
    const Result<Program> program = compile((*parts)[1].part);
    ASSERT_TRUE(program) << format(program.error());
    EXPECT_NEAR(evaluate(program->ir, program->distance(), program->parameters(), Point{2, 0, 0}), 1.5,
                1e-12);
}

/// Applied to a point: what a program that plays the nodes makes of it.
std::array<double, 3> carried(const Pose& pose, std::array<double, 3> p) {
    const auto& [x, y, z, w] = pose.turn;
    for (double& along : p) along *= pose.size;
    const std::array<double, 3> t = {2 * (y * p[2] - z * p[1]), 2 * (z * p[0] - x * p[2]),
                                     2 * (x * p[1] - y * p[0])};
    return {p[0] + w * t[0] + y * t[2] - z * t[1] + pose.move[0],
            p[1] + w * t[1] + z * t[0] - x * t[2] + pose.move[1],
            p[2] + w * t[2] + x * t[1] - y * t[0] + pose.move[2]};
}

TEST(MovingParts, AreWhereTheFieldHasThem) {
    // Turned about an axis, of another size and moved, all at once and through several nodes.
    const std::string nodes =
        R"({"id": "bone", "type": "box", "inputs": {"half_extents": [1, 0.2, 0.1]}},
           {"id": "size", "type": "scale", "inputs": {"surface": {"from": "bone"}, "factor": 1}},
           {"id": "turn", "type": "rotate", "inputs": {"surface": {"from": "size"}, "angles": [0, 0, 0]}},
           {"id": "go", "type": "translate", "inputs": {"surface": {"from": "turn"}, "offset": [0, 0, 0]}},)" +
        shown("go");
    const std::string tracks = moved("size", "factor", "1", "3") + "," +
                               moved("turn", "angles", "[0, 0, 0]", "[200, -140, 400]") + "," +
                               moved("go", "offset", "[1, 2, 3]", "[-3, 0, 9]");
    const auto parts = partsOf(nodes, tracks);
    ASSERT_TRUE(parts);
    ASSERT_EQ(parts->size(), 4u);
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes +
                                               R"(], "timeline": {"length": 1, "tracks": [)" + tracks + "]}}",
                                           "parts", nullptr);
    ASSERT_TRUE(graph);
    const Result<Timeline> timeline = readTimeline(*graph);
    ASSERT_TRUE(timeline);
    for (std::size_t moment = 0; moment < kTimes.size(); ++moment) {
        const Result<Program> program = compile(atTime(*graph, *timeline, kTimes[moment]));
        ASSERT_TRUE(program);
        // Corners of the box, and places outside along its axes: their distances are known.
        for (const auto& [place, distance] : {std::pair<std::array<double, 3>, double>{{1, 0.2, 0.1}, 0.0},
                                              {{-1, 0.2, -0.1}, 0.0},
                                              {{1.5, 0, 0}, 0.5},
                                              {{0, -0.7, 0}, 0.5},
                                              {{0, 0, 0.4}, 0.3}}) {
            std::array<double, 3> p = place;
            double size = 1.0;
            for (std::size_t i = 3; i-- > 0;) {
                p = carried((*parts)[i].poses[moment], p);
                size *= (*parts)[i].poses[moment].size;
            }
            EXPECT_NEAR(evaluate(program->ir, program->distance(), program->parameters(), p), distance * size,
                        1e-9);
        }
    }
}

TEST(MovingParts, WhatOnlyLooksLikeCarryingIsNone) {
    // Grown by a length: of coordinates and 1 alone that looks like another size.
    EXPECT_FALSE(partsOf(kBall +
                             R"({"id": "grow", "type": "offset", "inputs": {"surface": {"from": "ball"}}},)" +
                             shown("grow"),
                         moved("grow", "distance", "0.1", "0.2")));
    const std::string far =
        R"({"id": "go", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 0, 0]}},
           {"id": "copies", "type": "repeat",
            "inputs": {"surface": {"from": "go"}, "period": [100, 0, 0], "count": [3, 1, 1]}},)";
    EXPECT_FALSE(partsOf(kBall + far + shown("copies"), moved("go", "offset", "[0, 0, 0]", "[1, 0, 0]")));
    // A blend over a short way is no plain union.
    const std::string blend =
        R"({"id": "go", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 0, 0]}},
           {"id": "box", "type": "box"},
           {"id": "both", "type": "union",
            "inputs": {"a": {"from": "go"}, "b": {"from": "box"}, "radius": 0.05}},)";
    EXPECT_FALSE(partsOf(kBall + blend + shown("both"), moved("go", "offset", "[0, 0, 0]", "[1, 0, 0]")));
}

TEST(MovingParts, TurnsGoTheShortWay) {
    const auto parts =
        partsOf(kBall + R"({"id": "turn", "type": "rotate", "inputs": {"surface": {"from": "ball"}}},)" +
                    shown("turn"),
                moved("turn", "angles", "[0, 0, 0]", "[0, 720, 0]"));
    ASSERT_TRUE(parts);
    const std::vector<Pose>& poses = (*parts)[0].poses;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        double along = 0.0;
        for (std::size_t k = 0; k < 4; ++k) along += poses[i].turn[k] * poses[i - 1].turn[k];
        EXPECT_GE(along, 0.0) << i;
    }
}

TEST(MovingParts, AreThereOnlyWhereWholesMove) {
    const std::string go = R"({"id": "go", "type": "translate", "inputs": {"surface": {"from": "ball"}}},)";
    const std::string goes = moved("go", "offset", "[0, 0, 0]", "[4, 0, 8]");
    EXPECT_FALSE(partsOf(kBall + shown("ball"), "")) << "nothing moves";
    EXPECT_FALSE(partsOf(kBall + shown("ball"), moved("ball", "radius", "1", "2"))) << "it grows in itself";
    const std::string rest = R"({"id": "rest", "type": "box"},)";
    const auto both = [&](const std::string& type, const std::string& more) {
        return kBall + go + rest + R"({"id": "both", "type": ")" + type +
               R"(", "inputs": {"a": {"from": "rest"}, "b": {"from": "go"})" + more + "}}," + shown("both");
    };
    EXPECT_TRUE(partsOf(both("union", ""), goes));
    EXPECT_FALSE(partsOf(both("union", R"(, "radius": 0.3)"), goes)) << "a blend";
    EXPECT_FALSE(partsOf(both("subtract", ""), goes)) << "a cut that moves";
    EXPECT_FALSE(partsOf(both("intersect", ""), goes));
    EXPECT_FALSE(partsOf(
        kBall + go +
            R"({"id": "many", "type": "repeat", "inputs": {"surface": {"from": "go"}, "spacing": [2, 2, 2]}},)" +
            shown("many"),
        goes))
        << "copies";
    EXPECT_FALSE(
        partsOf(kBall + R"({"id": "squash", "type": "stretch", "inputs": {"surface": {"from": "ball"}}},)" +
                    shown("squash"),
                moved("squash", "factors", "[1, 1, 1]", "[1, 2, 1]")))
        << "no similarity";
    // A colour that is fixed in space does not go along.
    const std::string painted = R"({"id": "stripes", "type": "expression", "code": "return vec3(p.x);"},
        {"id": "paint", "type": "material", "inputs": {"surface": {"from": "go"}, "base_color": {"from": "stripes"}}},)";
    EXPECT_FALSE(partsOf(kBall + go + painted + shown("paint"), goes));
}

}  // namespace fw::moving_parts_test
