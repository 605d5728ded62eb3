// What a field costs, by node.
#include "graph/compile/effort.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"

namespace fw::effort_test {

Graph graphOf(const std::string& nodes, const std::string& more = "") {
    Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]" + more + "}", "test.field.json", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return std::move(*graph);
}

Program programOf(const Graph& graph) {
    Result<Program> program = compile(graph);
    EXPECT_TRUE(program) << format(program.error());
    return std::move(*program);
}

std::map<std::string, NodeEffort> byNode(const Program& program) {
    std::map<std::string, NodeEffort> result;
    for (const NodeEffort& effort : effortByNode(program))
        EXPECT_TRUE(result.emplace(effort.node, effort).second);
    return result;
}

TEST(Effort, WhatATransformMakesOfANodeIsTheNodes) {
    const auto efforts = byNode(programOf(graphOf(R"(
        {"id": "shape", "type": "expression", "code": "return sin(p.x) + sin(p.y) + sin(p.z);"},
        {"id": "bent", "type": "twist", "inputs": {"surface": {"from": "shape"}}},
        {"id": "unused", "type": "sphere"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "bent"}}})")));
    ASSERT_TRUE(efforts.contains("shape") && efforts.contains("bent"));
    EXPECT_EQ(efforts.size(), 2u);
    EXPECT_EQ(efforts.at("shape").operations, 5u);
    EXPECT_GT(efforts.at("shape").sample, 10);
    EXPECT_GT(efforts.at("bent").operations, 3u);
}

TEST(Effort, NodesInGroupsAreNamedByTheirPath) {
    const auto efforts = byNode(programOf(graphOf(
        R"({"id": "one", "type": "group", "group": "ball"},
           {"id": "two", "type": "group", "group": "ball", "inputs": {"radius": 2}},
           {"id": "both", "type": "union", "inputs": {"a": {"from": "one"}, "b": {"from": "two"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})",
        R"(, "groups": [{"id": "ball", "inputs": [{"name": "radius", "type": "float", "value": 1}],
            "outputs": [{"name": "surface", "type": "surface"}],
            "nodes": [{"id": "in", "type": "group_input"},
                      {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "in", "output": "radius"}}},
                      {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "ball"}}}]}])")));
    // The length that both need is of the one that was lowered first.
    EXPECT_EQ(efforts.at("one/ball").operations + efforts.at("two/ball").operations, 8u);
    EXPECT_NE(efforts.at("one/ball").operations, efforts.at("two/ball").operations);
}

TEST(Effort, PartsOfEverySampleMakeUpTheWhole) {
    int samples = 0;
    for (const auto& entry : std::filesystem::directory_iterator(FIELDWRIGHT_SOURCE_DIR "/samples")) {
        if (!entry.path().string().ends_with(".field.json")) continue;
        SCOPED_TRACE(entry.path().filename().string());
        const Result<Graph> graph = readGraph(entry.path(), nullptr);
        ASSERT_TRUE(graph);
        CompileOptions options;
        options.bake = boxInPlace;
        const Result<Program> program = compile(*graph, options);
        ASSERT_TRUE(program);
        std::size_t varying = 0, operations = 0;
        for (IrId id = 0; id < program->ir.size(); ++id) varying += opInfo(program->ir[id].op).arity > 0;
        double code = 0, sample = 0;
        for (const NodeEffort& effort : effortByNode(*program)) {
            EXPECT_FALSE(effort.node.empty());
            operations += effort.operations;
            code += effort.code;
            sample += effort.sample;
        }
        EXPECT_EQ(operations, varying);
        EXPECT_LE(code, sample);
        EXPECT_GE(code, codeWeight(program->ir, program->distance(), program->families));
        EXPECT_LT(secondsToCompile(*program), kMostSecondsToCompile)
            << "samples have pictures with all light";
        ++samples;
    }
    EXPECT_GE(samples, 30);
}

TEST(Effort, CheckNamesTheNodeThatKeepsTheDriverBusy) {
    std::string waves = "return length(p) - 1.0";
    for (int i = 0; i < 400; ++i)
        waves += " + 0.001 * sin(dot(p, vec3(" + std::to_string(i) + ", 1, " + std::to_string(i % 7) + ")))";
    const auto findings =
        check(graphOf(R"({"id": "ball", "type": "sphere"}, {"id": "waves", "type": "expression", "code": ")" +
                      waves + R"(;"},
           {"id": "both", "type": "union", "inputs": {"a": {"from": "ball"}, "b": {"from": "waves"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})"));
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].severity, Error::Severity::warning);
    EXPECT_EQ(findings[0].node, "waves");
    EXPECT_NE(findings[0].message.find("busy"), std::string::npos);
}

}  // namespace fw::effort_test
