// A document in another unit that keeps its sizes: the same solid, so many times as large in numbers.
#include "editor/document/unit_edits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "graph/document/scene.h"
#include "graph/document/timeline.h"
#include "graph/document/unit.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/play/mesh_program.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::test::unit_edits_test {

const LengthUnit &mm = *lengthUnit("mm"), &inch = *lengthUnit("in"), &metre = *lengthUnit("m");

std::vector<double> inputOf(const Graph& graph, const char* node, const char* input) {
    return inputNumbers(*graph.node(node), input);
}

TEST(UnitEdits, EveryLengthIsReckonedWhereverItStands) {
    const Graph graph = graphOf(R"(
      {"id": "ball", "type": "sphere"},
      {"id": "wide", "type": "value", "inputs": {"value": 0.25}},
      {"id": "many", "type": "value", "inputs": {"value": 0.5}},
      {"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.25, 2]}},
      {"id": "thick", "type": "offset", "inputs": {"surface": {"from": "box"}, "distance": {"from": "wide"}}},
      {"id": "turned", "type": "twist", "inputs": {"surface": {"from": "thick"}}},
      {"id": "shrunk", "type": "scale", "inputs": {"surface": {"from": "turned"}, "factor": {"from": "many"}}},
      {"id": "made", "type": "group", "group": "pair", "inputs": {"r": 0.2}},
      {"id": "sum", "type": "math", "inputs": {"a": {"from": "wide"}, "b": 2}},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "shrunk"}, "b": {"from": "made"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})",
                                R"(,
      "groups": [{"id": "pair", "inputs": [{"name": "r", "type": "float", "value": 0.125}],
        "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
        {"id": "in", "type": "group_input"},
        {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "in", "output": "r"}}},
        {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "ball"}}}]}],
      "parameters": [{"name": "size", "node": "ball", "input": "radius", "min": 0.1, "max": 2}],
      "timeline": {"length": 1, "tracks": [
        {"parameter": "size", "keys": [{"time": 0, "value": 0.5}, {"time": 1, "value": 1, "in": 2}]},
        {"scene": "camera.position", "keys": [{"time": 0, "value": [1, 2, 3]}]},
        {"scene": "sun.azimuth", "keys": [{"time": 0, "value": 40}]}]},
      "scene": {"camera": {"position": [4, 3, 5], "target": [0, 0, 0], "fov": 30}, "fog": {},
                "lights": [{"type": "point"}]})");
    const OtherUnit other = keepSizes(graph, mm);
    const Graph& to = other.graph;
    EXPECT_EQ(&unitOf(to), &mm);
    EXPECT_EQ(inputOf(to, "ball", "radius"), std::vector{1000.0}) << "also a default";
    EXPECT_EQ(inputOf(to, "box", "half_extents"), (std::vector{500.0, 250.0, 2000.0}));
    EXPECT_EQ(inputOf(to, "turned", "rate"), std::vector{0.045}) << "degrees a millimetre";
    EXPECT_EQ(inputOf(to, "many", "value"), std::vector{0.5}) << "it is a factor";
    EXPECT_EQ(inputOf(to, "made", "r"), std::vector{200.0}) << "inside it is a radius";
    EXPECT_EQ(std::get<double>(to.groups[0].inputs[0].value->value), 125.0);
    EXPECT_EQ(*to.parameters[0].min, 100.0);
    EXPECT_EQ(*to.parameters[0].max, 2000.0);
    const Result<Timeline> timeline = readTimeline(to);
    ASSERT_TRUE(timeline);
    EXPECT_EQ(timeline->tracks[0].keys[1].value, std::vector{1000.0});
    EXPECT_EQ(timeline->tracks[0].keys[1].in, std::vector{2000.0});
    EXPECT_EQ(timeline->tracks[1].keys[0].value, (std::vector{1000.0, 2000.0, 3000.0}));
    EXPECT_EQ(timeline->tracks[2].keys[0].value, std::vector{40.0});
    const Result<Scene> scene = readScene(to.scene);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->camera->position, (Triple{4000, 3000, 5000}));
    EXPECT_EQ(scene->camera->fov, 30.0);
    EXPECT_EQ(scene->fog->density, 5e-5);
    EXPECT_EQ(scene->lights[0].strength, 1e7) << "as bright a thousand times as far in numbers";
    // A number for a length and for a calculation is nobody's.
    EXPECT_EQ(other.left, (std::vector<std::string>{"wide", "sum"}));
    EXPECT_EQ(inputOf(to, "wide", "value"), std::vector{0.25});
    // And back.
    const OtherUnit back = keepSizes(to, metre);
    EXPECT_EQ(inputOf(back.graph, "box", "half_extents"), (std::vector{0.5, 0.25, 2.0}));
    EXPECT_EQ(inputOf(keepSizes(to, inch).graph, "ball", "radius"), std::vector{39.3700787401575});
}

/// What nothing stays of has the same field, in other numbers.
TEST(UnitEdits, SamplesKeepTheirFields) {
    int held = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples")) {
        if (!entry.path().string().ends_with(".field.json")) continue;
        const Result<Graph> graph = readGraph(entry.path().string(), nullptr);
        ASSERT_TRUE(graph);
        const OtherUnit other = keepSizes(*graph, mm);
        if (!other.left.empty()) continue;
        const double factor = unitOf(*graph).metres / mm.metres;
        EXPECT_FALSE(hasErrors(check(other.graph))) << entry.path();
        const Result<Program> one = compile(*graph, {.bake = boxInPlace}),
                              two = compile(other.graph, {.bake = boxInPlace});
        ASSERT_EQ(bool(one), bool(two)) << entry.path();
        if (!one || !one->ir.volumes().empty()) continue;
        ++held;
        const Result<Box> region = meshRegion(*one, {});
        const Box box = region ? *region : Box{{-2, -2, -2}, {2, 2, 2}};
        std::mt19937 random(3);
        for (int i = 0; i < 200; ++i) {
            Point p, q;
            for (std::size_t a = 0; a < 3; ++a) {
                p[a] = std::uniform_real_distribution(box.lo[a], box.hi[a])(random);
                q[a] = p[a] * factor;
            }
            const double f = evaluate(one->ir, one->distance(), one->parameters(), p) * factor,
                         g = evaluate(two->ir, two->distance(), two->parameters(), q);
            ASSERT_NEAR(f, g, 1e-6 * factor) << entry.path() << " at " << p[0] << " " << p[1] << " " << p[2];
        }
    }
    EXPECT_GE(held, 8);
}

}  // namespace fw::editor::test::unit_edits_test
