// What a mesh is required to be: how it is written, what it means, and what the command does of it.
#include "runtime/measure/mesh_requirements.h"

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::mesh_requirements_test {

using test::CommandResult;
using test::expectRefusal;
using test::runCommand;

/// The reasons, parted by "; ".
std::string missed(const std::string& list, const Report& report) {
    const Result<std::vector<Requirement>> required = parseRequirements(list);
    EXPECT_TRUE(required) << list;
    std::string all;
    for (const std::string& reason : unmet(*required, report)) all += (all.empty() ? "" : "; ") + reason;
    return all;
}

Report reportOf(const Mesh& mesh) {
    return reportOnMesh(mesh.positions, mesh.indices, {.selfIntersections = true});
}

TEST(MeshRequirements, EachIsMetByACube) {
    EXPECT_EQ(
        missed("closed,manifold,uncut,nondegenerate,bodies=1,cavities=0,triangles=12,angle=44.9,error=0",
               reportOf(test::cube())),
        "");
}

TEST(MeshRequirements, EachIsMissedByWhatItIsAbout) {
    Mesh open = test::cube();
    open.indices.resize(open.indices.size() - 3);
    EXPECT_EQ(missed("closed,manifold", reportOf(open)),
              "not closed: it has 3 open edges (edges of one triangle)");
    Mesh flipped = test::cube();
    std::swap(flipped.indices[0], flipped.indices[1]);
    EXPECT_EQ(missed("manifold", reportOf(flipped)),
              "not manifold: it has 3 edges between triangles that face opposite ways");
    const Mesh touching = test::join(test::cube(), test::moved(test::cube(), glm::vec3(2)));
    EXPECT_EQ(missed("manifold", reportOf(touching)), "not manifold: it has 1 vertices where parts touch");
    EXPECT_EQ(missed("bodies=1,cavities=0", reportOf(touching)),
              "not bodies=1: it has 2 bodies (pieces that hang together)");
    Mesh hollow = test::moved(test::cube(), glm::vec3(0));
    for (glm::vec3& p : hollow.positions) p *= 0.5f;
    for (std::size_t i = 0; i < hollow.indices.size(); i += 3)
        std::swap(hollow.indices[i], hollow.indices[i + 1]);
    const Mesh trapped = test::join(test::cube(), hollow);
    EXPECT_EQ(missed("bodies=1,cavities=0", reportOf(trapped)),
              "not cavities=0: it has 1 cavity (hollow that nothing leads out of)");
    const Mesh cut = test::join(test::cube(), test::moved(test::cube(), glm::vec3(0.9f, 0.8f, 0.7f)));
    EXPECT_NE(missed("uncut", reportOf(cut)).find("pairs of triangles that cut each other"),
              std::string::npos);
    Mesh flat = test::cube();
    flat.indices.insert(flat.indices.end(), {0, 0, 1});
    EXPECT_EQ(missed("nondegenerate", reportOf(flat)), "not nondegenerate: it has 1 triangles without area");
    EXPECT_EQ(missed("angle=46", reportOf(test::cube())), "not angle=46: its smallest angle is 45 degrees");
    EXPECT_EQ(missed("triangles=11", reportOf(test::cube())), "not triangles=11: it has 12 triangles");
    Report far = reportOf(test::cube());
    far.meshToSurface = {0.25, 0.125, 10}, far.surfaceToMesh = {0.5, 0.125, 10};
    EXPECT_EQ(missed("error=0.5", far), "");
    EXPECT_EQ(missed("error=0.3", far), "not error=0.3: a point of the surface is 0.5 m from it");
    EXPECT_EQ(missed("error=0.2", far), "not error=0.2: a point of it is 0.25 m from the surface");
    far.meshToSurface->max = std::numeric_limits<double>::infinity();
    EXPECT_EQ(missed("error=1e9", far), "not error=1e+09: a point of it is inf m from the surface");
}

TEST(MeshRequirements, WhatIsNoneIsRefusedWithAllThatAre) {
    for (const auto& [list, why] :
         {std::pair("solid", "\"solid\" is no requirement"), std::pair("", "\"\" is no requirement"),
          std::pair("closed,", "\"\" is no requirement"), std::pair("closed=1", "takes no number"),
          std::pair("error", "needs a number"), std::pair("error=", "needs a number that is not negative"),
          std::pair("error=-1", "not negative"), std::pair("error=nan", "not negative"),
          std::pair("error=1e999", "not negative"), std::pair("bodies=1.5", "needs a whole number"),
          std::pair("error=0.1m", "not negative")}) {
        const Result<std::vector<Requirement>> required = parseRequirements(list);
        ASSERT_FALSE(required) << list;
        EXPECT_NE(required.error().message.find(why), std::string::npos) << required.error().message;
        EXPECT_NE(required.error().message.find("closed manifold uncut"), std::string::npos);
    }
}

TEST(MeshRequirements, TheCommandFailsWithTheReasonAndKeepsTheFile) {
    const test::TempDir folder;
    const std::string graph = folder.path("ball.field.json"), mesh = folder.path("ball.stl");
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 32}}]})");
    const auto required = [&](const std::string& list) {
        return runCommand({"export", graph, "-o", mesh, "--require", list});
    };
    const CommandResult met = required("closed,manifold,uncut,bodies=1,error=0.01");
    EXPECT_EQ(met.status, 0) << met.errors;
    EXPECT_EQ(met.errors, "");
    const CommandResult missed = required("closed,bodies=2,error=0.0001");
    EXPECT_EQ(missed.status, 1);
    EXPECT_NE(missed.errors.find("ball.stl: not bodies=2: it has 1 body"), std::string::npos);
    EXPECT_NE(missed.errors.find("ball.stl: not error=0.0001: a point of"), std::string::npos);
    EXPECT_EQ(missed.errors.find("not closed"), std::string::npos);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"ball.field.json", "ball.stl"}));
    expectRefusal(required("clsed"), 2, {"--require", "\"clsed\" is no requirement", "closed manifold"});
}

}  // namespace fw::mesh_requirements_test
