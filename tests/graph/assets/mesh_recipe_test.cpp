// How a graph's mesh is made: what polygonize says and the stages behind it, found through all that a wire
// may pass, and what check() says where it cannot be.
#include <gtest/gtest.h>

#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"

namespace fw::mesh_recipe_test {

using Kind = MeshStage::Kind;

Graph graphOf(const std::string& nodes, const std::string& more = "") {
    const std::string text = R"({"fieldwright": 1, "nodes": [
        {"id": "ball", "type": "sphere"},
        {"id": "poly", "type": "polygonize", "inputs": {"surface": {"from": "ball"}, "resolution": 33,
            "method": "dual-contouring", "region_min": [-2, -2, -2], "region_max": [2, 2, 1]}},
        )" + nodes + "]" + more +
                             "}";
    Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    return std::move(*graph);
}

Program programOf(const Graph& graph, const CompileOptions& options = {}) {
    for (const Error& error : check(graph)) ADD_FAILURE() << format(error);
    Result<Program> program = compile(graph, options);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

/// As programOf, where warnings are meant.
Program compiled(const Graph& graph) {
    Result<Program> program = compile(graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

const std::string kSmooth =
    R"({"id": "smooth", "type": "smooth", "inputs": {"mesh": {"from": "poly"}, "iterations": 3}},)";
const std::string kSplit =
    R"({"id": "split", "type": "subdivide", "inputs": {"mesh": {"from": "smooth"}, "levels": 2, "project": false}},)";
const std::string kFewer =
    R"({"id": "fewer", "type": "decimate", "inputs": {"mesh": {"from": "split"}, "error": 0.125}},)";

std::string output(const std::string& from) {
    return R"({"id": "out", "type": "output", "inputs": {"resolution": 7, "mesh": {"from": ")" + from +
           "\"}}}";
}

void expectPolygonized(const Program& program) {
    EXPECT_EQ(program.resolution, 33);
    EXPECT_EQ(program.method, MeshMethod::dualContouring);
    ASSERT_TRUE(program.region);
    EXPECT_EQ(*program.region, (Box{{-2, -2, -2}, {2, 2, 1}}));
}

TEST(MeshRecipe, StagesStandInTheOrderOfTheirChain) {
    const Program program = programOf(graphOf(kSmooth + kSplit + kFewer + output("fewer")));
    expectPolygonized(program);
    const std::vector<MeshStage> expected = {{.kind = Kind::smooth, .times = 3},
                                             {.kind = Kind::subdivide, .times = 2, .project = false},
                                             {.kind = Kind::decimate, .error = 0.125}};
    EXPECT_EQ(program.stages, expected);
    EXPECT_TRUE(program.exactness.exact());
}

TEST(MeshRecipe, WithoutStagesThereAreNone) {
    const Program direct = programOf(graphOf(output("poly")));
    expectPolygonized(direct);
    EXPECT_TRUE(direct.stages.empty());
    EXPECT_TRUE(compiled(graphOf(kSmooth + R"({"id": "out", "type": "output",
        "inputs": {"surface": {"from": "ball"}}})"))
                    .stages.empty())
        << "of what the output does not show";
}

TEST(MeshRecipe, AStageIsNoPartOfTheStructure) {
    EXPECT_EQ(programOf(graphOf(output("poly"))).structureHash,
              programOf(graphOf(kSmooth + kSplit + output("split"))).structureHash);
}

TEST(MeshRecipe, TheChainLeadsThroughReroutesMutedNodesAndGroups) {
    const std::string rerouted =
        R"({"id": "bend", "type": "reroute", "inputs": {"value": {"from": "smooth"}}},)";
    EXPECT_EQ(programOf(graphOf(kSmooth + rerouted + output("bend"))).stages.size(), 1u);

    std::string muted = kSmooth;
    muted.insert(1, R"("muted": true, )");
    const Program without = programOf(graphOf(muted + kSplit + output("split")));
    expectPolygonized(without);
    ASSERT_EQ(without.stages.size(), 1u);
    EXPECT_EQ(without.stages[0].kind, Kind::subdivide);

    const std::string group = R"(, "groups": [{"id": "finish",
        "inputs": [{"name": "rough", "type": "mesh"}], "outputs": [{"name": "fine", "type": "mesh"}],
        "nodes": [{"id": "in", "type": "group_input"},
                  {"id": "even", "type": "smooth", "inputs": {"mesh": {"from": "in", "output": "rough"}, "iterations": 5}},
                  {"id": "end", "type": "group_output", "inputs": {"fine": {"from": "even"}}}]}])";
    const std::string instance =
        R"({"id": "finish", "type": "group", "group": "finish", "inputs": {"rough": {"from": "smooth"}}},)";
    const Program grouped = programOf(graphOf(kSmooth + instance + output("finish"), group));
    expectPolygonized(grouped);
    ASSERT_EQ(grouped.stages.size(), 2u);
    EXPECT_EQ(grouped.stages[1].times, 5);
    std::string mutedInstance = instance;
    mutedInstance.insert(1, R"("muted": true, )");
    EXPECT_EQ(programOf(graphOf(kSmooth + mutedInstance + output("finish"), group)).stages.size(), 1u);
}

TEST(MeshRecipe, BehindAMutedPolygonizeTheOutputSaysHow) {
    const Program program = compiled(graphOf(
        R"({"id": "flat", "type": "polygonize", "muted": true, "inputs": {"surface": {"from": "ball"}, "resolution": 50}},
           {"id": "smooth", "type": "smooth", "inputs": {"mesh": {"from": "flat"}}},)" +
        output("smooth")));
    EXPECT_EQ(program.resolution, 7);
    EXPECT_EQ(program.stages.size(), 1u);
}

TEST(MeshRecipe, NumbersAreFoldedAndMayComeFromConstants) {
    const std::string linked =
        R"({"id": "number", "type": "value", "inputs": {"value": 0.25}},
           {"id": "fewer", "type": "decimate", "inputs": {"mesh": {"from": "poly"}, "error": {"from": "number"}}},)";
    EXPECT_EQ(programOf(graphOf(linked + output("fewer"))).stages[0].error, 0.25);
    const Program asked = programOf(graphOf(kSmooth + kSplit + kFewer + output("fewer")),
                                    {.live = {"fewer.error", "poly.region_min"}});
    EXPECT_TRUE(asked.live.empty());
    EXPECT_EQ(asked.stages[2].error, 0.125);

    const Result<Program> varying = compile(graphOf(
        R"({"id": "number", "type": "distance", "inputs": {"surface": {"from": "ball"}}},
           {"id": "fewer", "type": "decimate", "inputs": {"mesh": {"from": "poly"}, "error": {"from": "number"}}},)" +
        output("fewer")));
    ASSERT_FALSE(varying);
    EXPECT_EQ(varying.error().node, "fewer");
    EXPECT_EQ(varying.error().input, "error");
    EXPECT_NE(varying.error().message.find("one number"), std::string::npos) << varying.error().message;
}

TEST(MeshRecipe, DecimationTakesAnErrorANumberOrBoth) {
    const auto fewer = [](const std::string& wish) {
        return graphOf(R"({"id": "fewer", "type": "decimate", "inputs": {"mesh": {"from": "poly"}, )" + wish +
                       "}}," + output("fewer"));
    };
    const std::vector<MeshStage> both = {{.kind = Kind::decimate, .error = 0.25, .triangles = 300}};
    EXPECT_EQ(programOf(fewer(R"("error": 0.25, "triangles": 300)")).stages, both);
    EXPECT_EQ(programOf(fewer(R"("error": 0, "triangles": 300)")).stages[0].error, 0.0);
    EXPECT_EQ(programOf(fewer(R"("error": 0.25)")).stages[0].triangles, 0);
    const Result<Program> neither = compile(fewer(R"("error": 0, "triangles": 0)"));
    ASSERT_FALSE(neither);
    EXPECT_EQ(neither.error().node, "fewer");
    EXPECT_EQ(neither.error().input, "error");

    // What is asked for from outside comes behind all.
    const Program program = programOf(fewer(R"("error": 0.25)"), {.triangles = 50});
    const std::vector<MeshStage> two = {{.kind = Kind::decimate, .error = 0.25},
                                        {.kind = Kind::decimate, .triangles = 50}};
    EXPECT_EQ(program.stages, two);
}

TEST(MeshRecipe, AStageWithoutAMeshIsFound) {
    const auto finding = [](const std::string& inputs) {
        const std::vector<Error> found = check(
            graphOf(R"({"id": "smooth", "type": "smooth", "inputs": {)" + inputs + "}}," + output("smooth")));
        EXPECT_EQ(found.size(), 1u);
        return found.empty() ? Error{} : found[0];
    };
    const Error unlinked = finding(R"("iterations": 2)");
    EXPECT_EQ(unlinked.severity, Error::Severity::error);
    EXPECT_EQ(unlinked.node + "." + unlinked.input, "smooth.mesh");
    EXPECT_NE(unlinked.message.find("link a node that gives a mesh"), std::string::npos);
    const Error surface = finding(R"("mesh": {"from": "ball"})");
    EXPECT_EQ(surface.severity, Error::Severity::error);
    EXPECT_NE(surface.message.find("gives surface but this input takes mesh"), std::string::npos);
    const Error many = finding(R"("mesh": {"from": "poly"}, "iterations": 101)");
    EXPECT_NE(many.message.find("100"), std::string::npos) << many.message;
}

}  // namespace fw::mesh_recipe_test
