// What Blender makes of the files, with FIELDWRIGHT_LONG: that it shows the same solids, moving ones too, and
// has their colours, textures, materials and parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "runtime/measure/mesh_report.h"
#include "tests/support/blender.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::blender_test {

using nlohmann::json;
using test::inBlender;
using test::TempDir;

/// A red ball beside a box of metal.
const std::string kPainted = R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.6}},
  {"id": "red", "type": "material", "label": "Red paint", "inputs": {"surface": {"from": "ball"},
    "base_color": [0.8, 0.1, 0.05], "roughness": 0.3}},
  {"id": "box", "type": "box", "inputs": {"half_extents": [0.3, 0.8, 0.4]}},
  {"id": "right", "type": "translate", "inputs": {"surface": {"from": "box"}, "offset": [1.5, 0, 0]}},
  {"id": "metal", "type": "material", "inputs": {"surface": {"from": "right"}, "base_color": [0.2, 0.3, 0.7],
    "roughness": 0.6, "metallic": 1}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "red"}, "b": {"from": "metal"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 32}}]})";
const double kRedColor[3] = {0.8, 0.1, 0.05}, kMetalColor[3] = {0.2, 0.3, 0.7};

/// A post, and a gate of 2 x 1 x 0.2 cm that turns about it by a right angle, with a bead that grows.
const std::string kGate = R"({"fieldwright": 1, "unit": "cm", "nodes": [
  {"id": "post", "type": "box", "label": "the post", "inputs": {"half_extents": [0.1, 1, 0.1]}},
  {"id": "leaf", "type": "box", "inputs": {"half_extents": [1, 0.5, 0.1]}},
  {"id": "bead", "type": "sphere", "inputs": {"radius": 0.2}},
  {"id": "grow", "type": "scale", "inputs": {"surface": {"from": "bead"}}},
  {"id": "above", "type": "translate", "inputs": {"surface": {"from": "grow"}, "offset": [0, 1.5, 0]}},
  {"id": "wing", "type": "union", "inputs": {"a": {"from": "leaf"}, "b": {"from": "above"}}},
  {"id": "beside", "type": "translate", "inputs": {"surface": {"from": "wing"}, "offset": [1.5, 0, 0]}},
  {"id": "hinge", "type": "rotate", "inputs": {"surface": {"from": "beside"}}},
  {"id": "all", "type": "union", "inputs": {"a": {"from": "post"}, "b": {"from": "hinge"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}, "resolution": 64}}],
 "timeline": {"length": 1, "fps": 30, "tracks": [
   {"node": "hinge", "input": "angles", "keys": [{"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [0, 90, 0]}]},
   {"node": "grow", "input": "factor", "keys": [{"time": 0, "value": 1}, {"time": 1, "value": 2}]}]}})";

struct Blender : testing::Test {
    TempDir folder;
    std::string graph = folder.path("a.field.json");
    void SetUp() override {
        if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "with FIELDWRIGHT_LONG";
    }
    std::string exported(const std::string& from, const std::string& file,
                         const std::vector<std::string>& more = {}) const {
        const std::string path = folder.path(file);
        std::vector<std::string> words = {"export", from, "-o", path};
        words.insert(words.end(), more.begin(), more.end());
        const test::CommandResult result = test::runCommand(words);
        EXPECT_EQ(result.status, 0) << result.errors;
        return path;
    }
    static Report measured(const std::string& path) {
        const Result<Report> report = reportOnFile(path);
        EXPECT_TRUE(report) << format(report.error());
        return report ? *report : Report{};
    }
    static void expectSame(const json& seen, const Report& report, double near = 1e-6) {
        EXPECT_NEAR(seen["volume"].get<double>(), report.volume, near * report.volume);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(seen["min"][k].get<double>(), report.boundsMin[k], near);
            EXPECT_NEAR(seen["max"][k].get<double>(), report.boundsMax[k], near);
        }
    }
    /// As a colour of eight bits can be.
    static void expectColor(const json& color, const double (&wanted)[3]) {
        ASSERT_EQ(color.size(), 3u);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(color[k].get<double>(), wanted[k], 0.005);
    }
};

TEST_F(Blender, ShowsTheFramesThatTakeTurns) {
    const std::string sample = FIELDWRIGHT_SOURCE_DIR "/samples/moving_booleans.field.json";
    const std::vector<std::string> words = {"--resolution", "32", "--from", "0", "--to", "1"};
    exported(sample, "frames", words);
    std::vector<std::string> animated = words;
    animated.push_back("--animated");
    const json read = inBlender(exported(sample, "moves.glb", animated), {0, 1, 20, 29});
    ASSERT_EQ(read["frames"].size(), 4u);
    for (const auto& [number, seen] : read["frames"].items()) {
        SCOPED_TRACE(number);
        EXPECT_EQ(seen["names"], json{"frame_" + number});
        expectSame(seen,
                   measured(folder.path("frames/" + std::string(6 - number.size(), '0') + number + ".glb")));
    }
    EXPECT_EQ(read["meshes"].size(), 30u);
}

TEST_F(Blender, MovesThePartsThatMove) {
    test::writeText(graph, kGate);
    const json read = inBlender(exported(graph, "gate.glb", {"--animated"}), {0, 1, 20});
    ASSERT_EQ(read["frames"].size(), 3u);
    for (const int frame : {0, 1, 20}) {
        SCOPED_TRACE(frame);
        const json& seen = read["frames"][std::to_string(frame)];
        EXPECT_EQ(seen["names"], (json{"bead", "leaf", "the post"}));
        // In metres. The leaf's far corners or the bead are farthest from the post.
        const double turn = frame / 30.0 * std::numbers::pi / 2.0, bead = 0.002 * (1.0 + frame / 30.0);
        EXPECT_NEAR(seen["volume"].get<double>(),
                    0.08e-6 + 0.4e-6 + 4.0 / 3.0 * std::numbers::pi * std::pow(bead, 3), 0.01e-6);
        EXPECT_NEAR(seen["max"][0].get<double>(), 0.025 * std::cos(turn) + 0.001 * std::sin(turn), 3e-4);
        EXPECT_NEAR(seen["min"][2].get<double>(),
                    -std::max(0.025 * std::sin(turn) + 0.001 * std::cos(turn), 0.015 * std::sin(turn) + bead),
                    3e-4);
        EXPECT_NEAR(seen["max"][1].get<double>(), 0.015 + bead, 3e-4);
        EXPECT_NEAR(seen["min"][1].get<double>(), -0.01, 1e-4);
    }
    EXPECT_EQ(read["parents"]["leaf"], read["parents"]["above"]);
    EXPECT_EQ(read["parents"]["beside"], "hinge");
    EXPECT_EQ(read["parents"]["hinge"], read["parents"]["the post"]);
}

TEST_F(Blender, ShowsCopiesOfOneMesh) {
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [
      {"id": "cone", "type": "capped_cone", "inputs": {"half_height": 0.5, "radius_bottom": 0.4, "radius_top": 0.1}},
      {"id": "turned", "type": "rotate", "inputs": {"surface": {"from": "cone"}, "angles": [20, 0, 50]}},
      {"id": "off", "type": "translate", "inputs": {"surface": {"from": "turned"}, "offset": [2, 0, 0]}},
      {"id": "ring", "type": "polar_repeat", "inputs": {"surface": {"from": "off"}, "count": 7}},
      {"id": "high", "type": "translate", "inputs": {"surface": {"from": "ring"}, "offset": [0, 2, 0]}},
      {"id": "both", "type": "mirror", "inputs": {"surface": {"from": "off"}, "normal": [0.6, 0.8, 0.1]}},
      {"id": "all", "type": "union", "inputs": {"a": {"from": "high"}, "b": {"from": "both"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}, "resolution": 96}}]})");
    const std::string path = exported(graph, "copies.glb", {"--instances"});
    const json read = inBlender(path);
    expectSame(read["frames"]["0"], measured(path), 1e-5);  // transforms are in single precision
    EXPECT_EQ(read["frames"]["0"]["names"].size(), 9u);
    EXPECT_EQ(read["parents"]["ring_7"], "ring");
    EXPECT_EQ(read["parents"]["both_2"], "both");
}

TEST_F(Blender, HasColoursAndMaterials) {
    test::writeText(graph, kPainted);
    for (const std::string file : {"a.glb", "a.gltf", "a.obj"}) {
        SCOPED_TRACE(file);
        const std::string path = exported(graph, file);
        const json read = inBlender(path);
        ASSERT_EQ(read["meshes"].size(), 1u);
        expectSame(read["frames"]["0"], measured(path));
        const std::string red = file == "a.obj" ? "Red_paint" : "Red paint";
        const json& mesh = read["meshes"]["a"];
        EXPECT_EQ(mesh["triangles"], measured(path).triangles);
        ASSERT_EQ(mesh["materials"].size(), 2u);
        expectColor(mesh["materials"][red]["color"], kRedColor);
        expectColor(mesh["materials"]["metal"]["color"], kMetalColor);
        const json& metal = read["materials"]["metal"]["values"];
        EXPECT_NEAR(metal["Roughness"].get<double>(), 0.6, 1e-6);
        EXPECT_EQ(metal["Metallic"], 1.0);
        EXPECT_NEAR(read["materials"][red]["values"]["Roughness"].get<double>(), 0.3, 1e-6);
        EXPECT_EQ(read["materials"][red]["values"]["Metallic"], 0.0);
        EXPECT_EQ(read["materials"].size(), 2u);
    }
}

TEST_F(Blender, HasTheTextures) {
    test::writeText(graph, kPainted);
    for (const std::string file : {"a.glb", "a.gltf", "a.obj"}) {
        SCOPED_TRACE(file);
        const std::string path = exported(graph, file, {"--textures", "256"});
        const json read = inBlender(path);
        ASSERT_EQ(read["meshes"].size(), 1u);
        expectSame(read["frames"]["0"], measured(path));
        const bool obj = file == "a.obj";
        const json& mesh = read["meshes"]["a"];
        EXPECT_GE(mesh["uv"][0], 0.0);
        EXPECT_LE(mesh["uv"][1], 1.0);
        EXPECT_GT(mesh["uv"][1], 0.5);
        ASSERT_EQ(mesh["materials"].size(), 2u);
        expectColor(mesh["materials"][obj ? "Red_paint" : "Red paint"]["color"], kRedColor);
        expectColor(mesh["materials"]["metal"]["color"], kMetalColor);
        EXPECT_EQ(read["images"].size(), 3u);
        for (const auto& [name, image] : read["images"].items()) {
            EXPECT_EQ(image["size"], (json{256, 256})) << name;
            if (!obj) { EXPECT_EQ(image["space"], name == "base_color" ? "sRGB" : "Non-Color"); }
        }
        for (const auto& [name, material] : read["materials"].items()) {
            EXPECT_EQ(material["from"]["Base Color"], "TEX_IMAGE") << name;
            for (const char* input : {"Roughness", "Metallic"})
                EXPECT_EQ(material["from"][input], obj ? "TEX_IMAGE" : "SEPARATE_COLOR") << name;
            if (!obj) { EXPECT_EQ(material["from"]["Normal"], "NORMAL_MAP") << name; }
        }
    }
}

TEST_F(Blender, HasLevelsOfDetailThatShareMaterialsAndTextures) {
    test::writeText(graph, kPainted);
    const json read = inBlender(exported(graph, "a.glb", {"--lods", "3", "--textures", "128"}));
    ASSERT_EQ(read["meshes"].size(), 3u);
    std::size_t before = std::size_t(-1);
    for (const char* level : {"a_LOD0", "a_LOD1", "a_LOD2"}) {
        ASSERT_TRUE(read["meshes"].contains(level)) << read["meshes"].dump();
        const json& mesh = read["meshes"][level];
        EXPECT_LT(mesh["triangles"], before) << level;
        before = mesh["triangles"];
        EXPECT_GE(mesh["uv"][0], 0.0);
        EXPECT_LE(mesh["uv"][1], 1.0);
        expectColor(mesh["materials"]["Red paint"]["color"], kRedColor);
    }
    const double volume = measured(exported(graph, "whole.glb")).volume;
    EXPECT_NEAR(read["frames"]["0"]["volume"].get<double>(), 3 * volume, 0.1 * volume);
    EXPECT_EQ(read["materials"].size(), 2u);
}

TEST_F(Blender, HasThePartsAsObjects) {
    test::writeText(graph, kPainted);
    const json read = inBlender(exported(graph, "a.glb", {"--parts"}));
    EXPECT_EQ(read["meshes"].size(), 2u);
    expectSame(read["frames"]["0"], measured(exported(graph, "whole.glb")));
    for (const auto& [name, mesh] : read["meshes"].items()) EXPECT_EQ(mesh["materials"].size(), 1u) << name;
}

TEST_F(Blender, MovesThePointsOfACache) {
    test::writeText(graph, kGate);
    const json nodes = inBlender(exported(graph, "gate.glb", {"--animated"}), {0, 10, 29});
    for (const char* file : {"gate.pc2", "gate.mdd"}) {
        SCOPED_TRACE(file);
        const json points = inBlender(exported(graph, file, {"--animated", "--unit", "m"}), {0, 10, 29});
        for (const char* frame : {"0", "10", "29"}) {
            const json &seen = points["frames"][frame], &wanted = nodes["frames"][frame];
            EXPECT_NEAR(seen["volume"].get<double>(), wanted["volume"].get<double>(),
                        1e-4 * wanted["volume"].get<double>())
                << frame;
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_NEAR(seen["min"][k].get<double>(), wanted["min"][k].get<double>(), 1e-5) << frame;
                EXPECT_NEAR(seen["max"][k].get<double>(), wanted["max"][k].get<double>(), 1e-5) << frame;
            }
        }
    }
}

}  // namespace fw::blender_test
