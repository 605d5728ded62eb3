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
    CompileOptions options;
    options.costByNode = true;
    Result<Program> program = compile(graph, options);
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
    EXPECT_EQ(efforts.at("shape").operations, 5.0);
    EXPECT_GT(efforts.at("shape").sample, 10);
    EXPECT_GT(efforts.at("bent").operations, 3.0);
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
    EXPECT_EQ(efforts.at("one/ball").operations, 4.0);  // of the length that both need half is of each
    EXPECT_EQ(efforts.at("two/ball").operations, 4.0);
}

TEST(Effort, NodesThatAreAlikeCostAlike) {
    const auto efforts = byNode(programOf(graphOf(R"(
        {"id": "a", "type": "expression", "code": "return length(p) - 0.5 + 0.05 * noise(p * 6.0);"},
        {"id": "b", "type": "expression", "code": "return length(p) - 0.5 + 0.05 * noise(p * 6.0);"},
        {"id": "right", "type": "rotate", "inputs": {"surface": {"from": "a"}, "angles": [10, 20, 30]}},
        {"id": "left", "type": "rotate", "inputs": {"surface": {"from": "b"}, "angles": [50, 60, 70]}},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "left"}, "b": {"from": "right"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})")));
    EXPECT_GT(efforts.at("a").sample, 20);
    EXPECT_EQ(efforts.at("a").sample, efforts.at("b").sample);
    EXPECT_EQ(efforts.at("right").operations, efforts.at("left").operations);
}

/// A union of so many balls within noises, of one code; or of small ones, each in its place.
Graph unionOf(int members, bool noises) {
    std::string code = "d = 1e3;";
    for (int i = 0; i < members; ++i) {
        const std::string place = "vec3(" + std::to_string(i % 9 - 4) + ", " + std::to_string(i / 9 % 9 - 4) +
                                  ", " + std::to_string(i / 81) + ")";
        code += noises ? " d = min(d, max(length(p) - 1, perlin(p * " + std::to_string(2 + 0.01 * i) + " + " +
                             place + ") + 0.2));"
                       : " d = min(d, length(p - " + place + ") - 0.2" + std::to_string(i) + ");";
    }
    return graphOf(R"({"id": "all", "type": "expression", "code": ")" + code + R"( return d;"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}}})");
}

TEST(Effort, WhatIsSlowToTraceIsAWarningWhereItIsAskedFor) {
    const Graph noises = unionOf(120, true), balls = unionOf(500, false);
    EXPECT_TRUE(check(noises).empty());
    EXPECT_TRUE(check(balls, true).empty());
    const std::vector<Error> findings = check(noises, true);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].severity, Error::Severity::warning);
    EXPECT_EQ(findings[0].node, "all");
    EXPECT_NE(findings[0].message.find("pictures are drafts"), std::string::npos) << findings[0].message;
    const Program program = programOf(noises);
    ASSERT_FALSE(program.families.empty());
    const Box box{{-1, -1, -1}, {1, 1, 1}};
    EXPECT_GT(secondsToTrace(weightAtSurface(program, box)), kMostSecondsToTrace);
    EXPECT_LT(secondsToTrace(weightAtSurface(programOf(balls), {{-5, -5, -1}, {5, 5, 7}})),
              kMostSecondsToTrace);
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
        options.costByNode = true;
        const Result<Program> program = compile(*graph, options);
        ASSERT_TRUE(program);
        std::size_t varying = 0;
        double operations = 0;
        for (IrId id = 0; id < program->ir.size(); ++id) varying += opInfo(program->ir[id].op).arity > 0;
        double code = 0, sample = 0;
        for (const NodeEffort& effort : effortByNode(*program)) {
            EXPECT_FALSE(effort.node.empty());
            operations += effort.operations;
            code += effort.code;
            sample += effort.sample;
        }
        EXPECT_NEAR(operations, double(varying), 1e-6 * double(varying));
        EXPECT_LE(code, sample * (1 + 1e-9));
        EXPECT_GE(code, codeWeight(program->ir, program->distance(), program->families) * (1 - 1e-9));
        EXPECT_LT(secondsToCompile(*program), kMostSecondsToCompile)
            << "samples have pictures with all light";
        ++samples;
    }
    EXPECT_GE(samples, 30);
}

TEST(Effort, TurnsOfTurnsAreOne) {
    std::string nodes = R"({"id": "turn0", "type": "box"})", last = "turn0";
    for (int i = 1; i <= 300; ++i) {
        const std::string id = "turn" + std::to_string(i);
        nodes += R"(, {"id": ")" + id + R"(", "type": "rotate", "inputs": {"surface": {"from": ")" + last +
                 R"("}, "angles": [1, 2, 3]}})";
        last = id;
    }
    const Graph graph = graphOf(
        nodes + R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": ")" + last + R"("}}})");
    EXPECT_TRUE(check(graph, true).empty());
    // Kept apart there are too many operations for a program.
    CompileOptions byNode;
    byNode.costByNode = true;
    const Result<Program> program = compile(graph, byNode);
    ASSERT_TRUE(program) << format(program.error());
    EXPECT_LT(program->ir.size(), 100u);
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
