// Levels of detail: fewer triangles for the same solid, in one file, with the same materials and textures.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "graph/document/json.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/textures/textured.h"
#include "tests/support/command.h"
#include "tests/support/glb.h"
#include "tests/support/gltf_validator.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::levels_test {

using nlohmann::json;
using test::CommandResult;

/// A red ball with a blue band, on a rough plate.
constexpr char kGraph[] = R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.8}},
  {"id": "color", "type": "expression", "code": "return abs(p.y) < 0.2 ? vec3(0.1, 0.1, 0.9) : vec3(0.9, 0.1, 0.1);"},
  {"id": "red", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": {"from": "color"}, "roughness": 0.2}},
  {"id": "plate", "type": "box", "inputs": {"half_extents": [0.9, 0.2, 0.9]}},
  {"id": "down", "type": "translate", "inputs": {"surface": {"from": "plate"}, "offset": [0, -0.9, 0]}},
  {"id": "grey", "type": "material", "inputs": {"surface": {"from": "down"}, "base_color": [0.4, 0.4, 0.4], "roughness": 0.9}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "red"}, "b": {"from": "grey"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 64}}]})";

struct LevelsOfDetail : testing::Test {
    test::TempDir folder;
    std::string graph = folder.path("thing.field.json");
    void SetUp() override { test::writeText(graph, kGraph); }

    CommandResult exported(const std::string& file, const std::vector<std::string>& more) const {
        std::vector<std::string> words = {"export", graph, "-o", folder.path(file)};
        words.insert(words.end(), more.begin(), more.end());
        return test::runCommand(words);
    }
};

std::vector<json> levelNodes(const json& document) {
    std::vector<json> nodes;
    for (const json& child : document["nodes"][0]["children"])
        nodes.push_back(document["nodes"][child.get<std::size_t>()]);
    return nodes;
}

std::size_t trianglesOf(const json& document, const json& node) {
    std::size_t corners = 0;
    for (const json& primitive : document["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
        corners += document["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>();
    return corners / 3;
}

TEST_F(LevelsOfDetail, HaveAQuarterOfTheTrianglesAndTheSameMaterials) {
    const CommandResult made = exported("thing.gltf", {"--lods", "4", "--report", folder.path("r.json"),
                                                       "--require", "closed,manifold,uncut"});
    ASSERT_EQ(made.status, 0) << made.errors;
    const json document = json::parse(test::readText(folder.path("thing.gltf"))),
               report = json::parse(test::readText(folder.path("r.json")));
    const std::vector<json> nodes = levelNodes(document);
    ASSERT_EQ(nodes.size(), 4u);
    ASSERT_EQ(report["levels"].size(), 4u);
    std::set<std::string> materials;
    for (const json& material : document["materials"]) materials.insert(material["name"]);
    EXPECT_EQ(materials, (std::set<std::string>{"grey", "red"}));
    EXPECT_EQ(document["materials"].size(), 2u);
    const std::size_t finest = trianglesOf(document, nodes[0]);
    EXPECT_EQ(report["triangles"], finest) << "the report is that of the finest";
    EXPECT_EQ(report["bodies"], 1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::string name = "thing_LOD" + std::to_string(i);
        EXPECT_EQ(nodes[i]["name"], name);
        const std::size_t triangles = trianglesOf(document, nodes[i]);
        EXPECT_NEAR(double(triangles), double(finest) / double(1 << 2 * i), 4.0) << name;
        EXPECT_EQ(report["levels"][i]["name"], name);
        EXPECT_EQ(report["levels"][i]["triangles"], triangles);
        EXPECT_LT(report["levels"][i]["error"].get<double>(), i < 3 ? 0.05 : 0.08) << "a cell is 0.03";
        EXPECT_NE(made.errors.find(name + " has " + std::to_string(triangles) + " triangles, at most "),
                  std::string::npos)
            << made.errors;
        EXPECT_FALSE(nodes[i].contains("scale")) << "all stand at one place";
    }
    test::expectValidGltf({folder.path("thing.gltf")});
}

TEST_F(LevelsOfDetail, ShareTheirTextures) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--compress"}}) {
        std::vector<std::string> words{"--lods", "3", "--textures", "256"};
        words.insert(words.end(), more.begin(), more.end());
        const CommandResult made = exported("thing.glb", words);
        ASSERT_EQ(made.status, 0) << made.errors;
        const json document = test::jsonOfGlb(test::readText(folder.path("thing.glb")));
        EXPECT_EQ(document["images"].size(), 3u);
        EXPECT_EQ(document["meshes"].size(), 3u);
        for (const json& mesh : document["meshes"])
            for (const json& primitive : mesh["primitives"]) {
                EXPECT_TRUE(primitive["attributes"].contains("TEXCOORD_0"));
                EXPECT_FALSE(primitive["attributes"].contains("COLOR_0"));
                const json& material = document["materials"][primitive["material"].get<std::size_t>()];
                EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
            }
        const Result<Report> report = reportOnFile(folder.path("thing.glb"));
        ASSERT_TRUE(report) << format(report.error());
        EXPECT_EQ(report->shells, 1u) << "the finest is read back";
        test::expectValidGltf({folder.path("thing.glb")}, more.empty());
    }
}

// No level's chart lies on another's, and each has half the texels of the one before.
TEST_F(LevelsOfDetail, LieBesideEachOtherInTheTexture) {
    std::vector<Mesh> levels{test::torus(48, 24), test::torus(24, 12), test::torus(12, 6)};
    const Result<Graph> ring = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "ring", "type": "torus", "inputs": {"major_radius": 1, "minor_radius": 0.25}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ring"}}}]})",
                                          "ring.field.json", nullptr);
    ASSERT_TRUE(ring);
    const Result<Program> program = compile(*ring);
    ASSERT_TRUE(program);
    constexpr int kSize = 256;
    const Result<std::vector<Mesh>> made = texturedLevels(levels, *program, kSize);
    ASSERT_TRUE(made) << format(made.error());
    std::vector<int> owner(std::size_t(kSize * kSize), -1);
    std::vector<double> density;
    for (int level = 0; level < 3; ++level) {
        const Mesh& mesh = (*made)[std::size_t(level)];
        EXPECT_EQ(mesh.triangleCount(), levels[std::size_t(level)].triangleCount());
        EXPECT_EQ(mesh.textures, (*made)[0].textures);
        double flat = 0, area = 0;
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
            glm::vec2 corner[3];
            glm::vec3 place[3];
            for (std::size_t k = 0; k < 3; ++k) {
                corner[k] = float(kSize) * mesh.uvs[mesh.indices[t + k]];
                place[k] = mesh.positions[mesh.indices[t + k]];
            }
            const glm::vec2 a = corner[1] - corner[0], b = corner[2] - corner[0];
            flat += 0.5 * std::abs(a.x * b.y - a.y * b.x);
            area += 0.5 * glm::length(glm::cross(place[1] - place[0], place[2] - place[0]));
            const glm::vec2 middle = (corner[0] + corner[1] + corner[2]) / 3.0f;
            int& there = owner[std::size_t(int(middle.y) * kSize + int(middle.x))];
            EXPECT_TRUE(there == -1 || there == level);
            there = level;
        }
        density.push_back(std::sqrt(flat / area));
    }
    EXPECT_NEAR(density[1] / density[0], 0.5, 0.02);
    EXPECT_NEAR(density[2] / density[0], 0.25, 0.02);
}

TEST_F(LevelsOfDetail, OfASweepAreInEachFile) {
    test::writeText(graph, R"({"fieldwright": 1, "parameters": [
        {"name": "size", "node": "ball", "input": "radius", "min": 0.1, "max": 1}], "nodes": [
        {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}]})");
    const CommandResult made = exported("many", {"--sweep", "size=0.4:0.8:3", "--lods", "2", "--textures",
                                                 "64", "--report", folder.path("r.json")});
    ASSERT_EQ(made.status, 0) << made.errors;
    const json report = json::parse(test::readText(folder.path("r.json")));
    for (const json& variant : report["variants"]) EXPECT_EQ(variant["levels"].size(), 2u);
    const json document = test::jsonOfGlb(test::readText(folder.path("many/size=0.6.glb")));
    EXPECT_EQ(levelNodes(document)[1]["name"], "size=0.6_LOD1");
    EXPECT_EQ(document["images"].size(), 3u);
}

TEST_F(LevelsOfDetail, EndWhereNothingCanGoAndAreRefusedWhereTheyCannotBe) {
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere", "inputs": {}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 8}}]})");
    const CommandResult few = exported("few.glb", {"--lods", "8"});
    ASSERT_EQ(few.status, 0) << few.errors;
    EXPECT_NE(few.errors.find("it has no further levels"), std::string::npos) << few.errors;
    EXPECT_LT(levelNodes(test::jsonOfGlb(test::readText(folder.path("few.glb")))).size(), 8u);
    for (const char* bad : {"0", "9", "-1", "x"})
        test::expectRefusal(exported("a.glb", {"--lods", bad}), 2, {"--lods"});
    test::expectRefusal(exported("a.stl", {"--lods", "2"}), 2, {"a.stl", ".glb and .gltf alone"});
    test::expectRefusal(exported("a.glb", {"--lods", "2", "--parts"}), 2, {"choose one"});
    for (const char* without : {"--tiles", "--tile"})
        test::expectRefusal(exported("a.glb", {"--lods", "2", without, "2"}), 2, {"--lods", without});
    test::expectRefusal(exported("a.glb", {"--lods", "2", "--animated"}), 2, {"--lods", "--animated"});
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"few.glb", "thing.field.json"}));
}

}  // namespace fw::levels_test
