// The part of a solid through which no light passes, which compile() makes beside the whole.
#include <gtest/gtest.h>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"

namespace fw::transmission_test {

/// A ball of glass of radius 1 at the origin, and an opaque one at x = 3.
const std::string kTwo = R"(
    {"id": "ball", "type": "sphere"},
    {"id": "glass", "type": "material", "inputs": {"surface": {"from": "ball"}, "transmission": 1}},
    {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [3, 0, 0]}},
    {"id": "red", "type": "material", "inputs": {"surface": {"from": "moved"}, "base_color": [1, 0, 0]}},)";

Program compiled(const std::string& nodes, const std::string& last, const CompileOptions& options = {}) {
    const Result<Graph> graph = parseGraph(
        R"({"fieldwright": 1, "nodes": [)" + nodes +
            R"({"id": "out", "type": "output", "inputs": {"surface": {"from": ")" + last + R"("}}}]})",
        "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    Result<Program> program = compile(*graph, options);
    EXPECT_TRUE(program) << format(program.error());
    return std::move(*program);
}
double at(const Program& program, IrId root, double x, double y = 0, double z = 0) {
    return evaluate(program.ir, root, program.parameters(), {x, y, z});
}
double opaque(const Program& program, double x) { return at(program, program.opaque[distanceComponent], x); }
double whole(const Program& program, double x) { return at(program, program.distance(), x); }

TEST(Transmission, WithoutItThereIsOneSolid) {
    const Program program = compiled(
        kTwo + R"({"id": "both", "type": "union", "inputs": {"a": {"from": "ball"}, "b": {"from": "red"}}},)",
        "both");
    EXPECT_FALSE(program.transmits());
}

TEST(Transmission, OfAUnionTheOpaquePartIsLeft) {
    for (const char* radius : {"0", "0.5"}) {
        const Program program = compiled(
            kTwo +
                R"({"id": "both", "type": "union", "inputs": {"a": {"from": "glass"}, "b": {"from": "red"}, "radius": )" +
                radius + "}},",
            "both");
        ASSERT_TRUE(program.transmits());
        EXPECT_DOUBLE_EQ(whole(program, 0), -1);
        EXPECT_DOUBLE_EQ(opaque(program, 0), 2);
        EXPECT_DOUBLE_EQ(opaque(program, 3), -1);
        EXPECT_EQ(at(program, program.opaque[baseColorComponent], 0), 1);
        EXPECT_EQ(at(program, program.surface[transmissionComponent], 0), 1);
        EXPECT_EQ(at(program, program.surface[transmissionComponent], 3), 0);
    }
}

TEST(Transmission, GlassCutsWhatIsOpaque) {
    const Program program = compiled(R"(
        {"id": "ball", "type": "sphere"}, {"id": "block", "type": "box", "inputs": {"half_extents": [2, 2, 2]}},
        {"id": "glass", "type": "material", "inputs": {"surface": {"from": "ball"}, "transmission": 1}},
        {"id": "hollow", "type": "subtract", "inputs": {"a": {"from": "block"}, "b": {"from": "glass"}}},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "hollow"}, "b": {"from": "glass"}}},)",
                                     "both");
    EXPECT_DOUBLE_EQ(opaque(program, 0), 1);
    EXPECT_DOUBLE_EQ(opaque(program, 1.5), -0.5);
    EXPECT_DOUBLE_EQ(whole(program, 0), -1);
}

TEST(Transmission, PassesThroughGroupsAndCode) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1,
        "groups": [{"id": "paint", "name": "Paint", "inputs": [{"name": "surface", "type": "surface"}], "outputs": [{"name": "surface", "type": "surface"}],
            "nodes": [{"id": "in", "type": "group_input"},
                      {"id": "clear", "type": "material", "inputs": {"surface": {"from": "in", "output": "surface"}, "transmission": 0.5}},
                      {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "clear"}}}]}],
        "nodes": [{"id": "ball", "type": "sphere"}, {"id": "post", "type": "box", "inputs": {"half_extents": [0.1, 3, 0.1]}},
            {"id": "painted", "type": "group", "group": "paint", "inputs": {"surface": {"from": "ball"}}},
            {"id": "code", "type": "expression", "code": "a.transmission = 1.0; return min(a, b);",
             "inputs": {"a": {"from": "painted"}, "b": {"from": "post"}}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "code"}}}]})",
                                           "", nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    const Result<Program> program = compile(*graph);
    ASSERT_TRUE(program) << format(program.error());
    EXPECT_DOUBLE_EQ(opaque(*program, 0.6), 0.5);
    EXPECT_DOUBLE_EQ(whole(*program, 0.6), -0.4);
    EXPECT_EQ(at(*program, program->surface[transmissionComponent], 0.6), 1);
}

TEST(Transmission, ALiveOneDecidesAsItIs) {
    CompileOptions options;
    options.live = {"glass.transmission"};
    Program program = compiled(kTwo, "glass", options);
    ASSERT_EQ(program.live.size(), 1u);
    EXPECT_GT(opaque(program, 0), 1e6);
    program.live[0].value = 0;
    EXPECT_DOUBLE_EQ(opaque(program, 0), -1);
}

TEST(Transmission, WhatIsPaintedAnewIsWhatItsPaintIs) {
    const Program program = compiled(
        kTwo +
            R"({"id": "again", "type": "material", "inputs": {"surface": {"from": "glass"}, "transmission": 0}},
                  {"id": "more", "type": "material", "inputs": {"surface": {"from": "again"}, "transmission": 1}},
                  {"id": "both", "type": "union", "inputs": {"a": {"from": "again"}, "b": {"from": "red"}}},)",
        "both");
    EXPECT_DOUBLE_EQ(opaque(program, 0), -1);
    EXPECT_DOUBLE_EQ(opaque(program, 3), -1);
}

TEST(Transmission, DoesNotDependOnTheOrderOfAssignments) {
    for (const char* code : {"s = a; s.transmission = 1; s.distance = length(p) - 2; return s;",
                             "s = a; s.distance = length(p) - 2; s.transmission = 1; return s;"}) {
        const Program program = compiled(std::string(R"({"id": "ball", "type": "sphere"},
            {"id": "code", "type": "expression", "inputs": {"a": {"from": "ball"}}, "code": ")") +
                                             code + "\"},",
                                         "code");
        EXPECT_DOUBLE_EQ(whole(program, 0), -2);
        EXPECT_GT(opaque(program, 0), 1e6);
    }
}

TEST(Transmission, GlassHoldsWhatFlowsAndMayFlow) {
    for (const char* of : {"source", "collide"}) {
        const std::string nodes = std::string(R"(
            {"id": "ball", "type": "sphere", "inputs": {"radius": 0.4}},
            {"id": "glass", "type": "material", "inputs": {"surface": {"from": "ball"}, "transmission": 1}},
            {"id": "flow", "type": "sph_fluid", "inputs": {"source": {"from": ")") +
                                  (of == std::string("source") ? "glass" : "ball") +
                                  R"("}, "collide": {"from": "glass"}}},
            {"id": "water", "type": "particles_to_field", "inputs": {"particles": {"from": "flow"}}},
            {"id": "both", "type": "union", "inputs": {"a": {"from": "water"}, "b": {"from": "glass"}}},)";
        const Program program = compiled(nodes, "both");
        EXPECT_TRUE(program.transmits());
        EXPECT_EQ(program.ir.volumes().size(), 1u);
    }
}

TEST(Transmission, SimulationsAndMeshesAreNotMadeTwice) {
    const Program program = compiled(R"(
        {"id": "ball", "type": "sphere", "inputs": {"radius": 0.4}}, {"id": "post", "type": "box"},
        {"id": "flow", "type": "sph_fluid", "inputs": {"source": {"from": "ball"}}},
        {"id": "water", "type": "particles_to_field", "inputs": {"particles": {"from": "flow"}}},
        {"id": "clear", "type": "material", "inputs": {"surface": {"from": "water"}, "transmission": 1}},
        {"id": "solid", "type": "union", "inputs": {"a": {"from": "water"}, "b": {"from": "post"}}},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "clear"}, "b": {"from": "solid"}}},)",
                                     "both");
    EXPECT_TRUE(program.transmits());
    EXPECT_EQ(program.ir.volumes().size(), 1u);
}

}  // namespace fw::transmission_test
