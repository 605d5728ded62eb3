// `fieldwright export` of many meshes, as a user calls it: of a timeline, as one file that moves, and of a
// sweep.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>
#include <sstream>

#include "runtime/export/whole.h"
#include "runtime/measure/mesh_report.h"
#include "tests/support/command.h"
#include "tests/support/glb.h"
#include "tests/support/gltf_validator.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::mesh_sequence_test {

using test::CommandResult;
using test::expectRefusal;
using test::floatsOf;
using test::jsonOfGlb;
using test::namesIn;
using test::readText;
using test::runCommand;
using test::TempDir;

/// A ball that rests, and one that goes to and fro: 0, 1/4, 1/2, 3/4, 1, 3/4, … metres.
const std::string kGraph = R"({"fieldwright": 1, "parameters": [
  {"name": "size", "node": "rest", "input": "radius", "min": 0.1, "max": 1}], "nodes": [
  {"id": "rest", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "lift", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 1.5, 0]}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "rest"}, "b": {"from": "lift"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 24}}],
 "timeline": {"length": 2, "fps": 4, "tracks": [{"node": "lift", "input": "offset", "keys": [
   {"time": 0, "value": [0, 1.5, 0]}, {"time": 1, "value": [1, 1.5, 0]}, {"time": 2, "value": [0, 1.5, 0]}]}]}})";

/// A ball that another one eats, from within.
const std::string kEaten = R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "bite", "type": "sphere", "inputs": {"radius": 0.3}},
  {"id": "cut", "type": "subtract", "inputs": {"a": {"from": "ball"}, "b": {"from": "bite"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "cut"}, "resolution": 16}}],
 "timeline": {"length": 1, "fps": 4, "tracks": [{"node": "bite", "input": "radius", "keys": [
   {"time": 0, "value": 0.3}, {"time": 0.25, "value": 1}, {"time": 0.5, "value": 1},
   {"time": 0.75, "value": 0.3}]}]}})";

struct MeshSequence : testing::Test {
    TempDir folder;
    std::string graph = folder.path("a.field.json"), frames = folder.path("frames");
    void SetUp() override { test::writeText(graph, kGraph); }

    CommandResult exported(const std::string& output, const std::vector<std::string>& more) const {
        std::vector<std::string> words = {"export", graph, "-o", output};
        words.insert(words.end(), more.begin(), more.end());
        return runCommand(words);
    }
    std::string frame(const std::string& path, int number, const std::string& ending = ".glb") const {
        return path + "/00000" + std::to_string(number) + ending;
    }
};

using Place = std::array<float, 3>;
/// The places of the vertices below a height.
std::set<Place> placesBelow(const std::string& path, float height) {
    const std::string glb = readText(path);
    const nlohmann::json document = jsonOfGlb(glb);
    const std::vector<float> values =
        floatsOf(glb, document, document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]);
    std::set<Place> places;
    for (std::size_t i = 0; i < values.size(); i += 3)
        if (values[i + 1] < height) places.insert({values[i], values[i + 1], values[i + 2]});
    return places;
}

TEST_F(MeshSequence, NumbersFramesByTheirTimeOnOneGrid) {
    const CommandResult all = exported(frames, {"--from", "0"});
    EXPECT_EQ(all.status, 0) << all.errors;
    EXPECT_EQ(all.output + all.errors, "");
    EXPECT_EQ(namesIn(frames),
              (std::vector<std::string>{"000000.glb", "000001.glb", "000002.glb", "000003.glb", "000004.glb",
                                        "000005.glb", "000006.glb", "000007.glb"}));
    const double ball = 4.0 / 3.0 * std::numbers::pi * 0.125;
    for (int number = 0; number < 8; ++number) {
        const Result<Report> report = reportOnFile(frame(frames, number));
        ASSERT_TRUE(report) << format(report.error());
        EXPECT_TRUE(report->closedManifold());
        EXPECT_EQ(report->shells, 2u);
        EXPECT_NEAR(report->volume, 2 * ball, 0.08 * ball) << "of cells as large as a seventh of its radius";
        EXPECT_NEAR(report->boundsMax[0], 0.5 + (number <= 4 ? number : 8 - number) / 4.0, 0.01) << number;
    }
    // What rests has the same vertices in every frame: the grid does not swim.
    const std::set<Place> resting = placesBelow(frame(frames, 0), 0.7f);
    EXPECT_GT(resting.size(), 100u);
    for (int number = 1; number < 8; ++number)
        EXPECT_TRUE(placesBelow(frame(frames, number), 0.7f) == resting) << number;
    // Some of the frames alone, and in another order, are the same bytes.
    const std::string part = folder.path("part");
    EXPECT_EQ(exported(part, {"--from", "1"}).status, 0);
    EXPECT_EQ(exported(part, {"--to", "1"}).status, 0);
    for (int number = 0; number < 8; ++number)
        EXPECT_TRUE(readText(frame(part, number)) == readText(frame(frames, number))) << number;
}

TEST_F(MeshSequence, GoesOnWhereItStopped) {
    for (const std::string ending : {".glb", ".gltf", ".obj", ".stl", ".ply", ".3mf"}) {
        const std::string at = folder.path("of_" + ending.substr(1));
        const std::vector<std::string> words = {"--to", "1", "--format", ending.substr(1)};
        ASSERT_EQ(exported(at, words).status, 0) << ending;
        std::string whole[4];
        for (int number = 0; number < 4; ++number) {
            whole[number] = readText(frame(at, number, ending));
            EXPECT_TRUE(isWholeMesh(frame(at, number, ending))) << ending;
        }
        std::filesystem::remove(frame(at, 1, ending));
        test::writeText(frame(at, 2, ending), whole[2].substr(0, whole[2].size() * 2 / 3 - 1));
        test::writeText(frame(at, 3, ending), "");
        const CommandResult more = exported(at, words);
        EXPECT_EQ(more.status, 0) << more.errors;
        EXPECT_NE(more.errors.find("1 of 4 frames were there already (--overwrite makes them anew)"),
                  std::string::npos)
            << ending << more.errors;
        for (int number = 0; number < 4; ++number)
            EXPECT_TRUE(readText(frame(at, number, ending)) == whole[number]) << ending << number;
    }
    const std::string at = folder.path("of_gltf");
    std::filesystem::remove(frame(at, 0, ".bin"));
    EXPECT_FALSE(isWholeMesh(frame(at, 0, ".gltf")));
    EXPECT_EQ(exported(folder.path("of_vdb"), {"--to", "0.5", "--format", "vdb"}).status, 0);
    EXPECT_EQ(namesIn(folder.path("of_vdb")), (std::vector<std::string>{"000000.vdb", "000001.vdb"}));
}

TEST_F(MeshSequence, SaysOfSolidsThinnerThanACellThatTheyAre) {
    // A ball that jumps 50 m each second: cells of the shared region are larger than it.
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [
      {"id": "e", "type": "expression", "code": "return length(p - vec3(50 * floor(time), 0, 0)) - 1;"},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "e"}, "resolution": 16}}],
      "timeline": {"length": 4, "fps": 1}})");
    const CommandResult made = exported(folder.path("thin"), {"--from", "0", "--to", "3"});
    EXPECT_EQ(made.status, 0) << made.errors;
    EXPECT_NE(made.errors.find("thinner than a cell of"), std::string::npos) << made.errors;
}

TEST_F(MeshSequence, FindsSolidsThatAppearBetweenTheMomentsOfTheRegion) {
    // A product, whose motion is not proven: far away for some frames between the moments that are searched.
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [
      {"id": "e", "type": "expression", "code": "x = time > 0.511 && time < 0.521 ? 20 : 0; vec3 q = p - vec3(x, 0, 0); return (dot(q, q) - 1) * (dot(q, q) + 4);"},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "e"}, "resolution": 64}}],
      "timeline": {"length": 1, "fps": 100}})");
    const CommandResult made = exported(folder.path("jump"), {"--from", "0.51", "--to", "0.53"});
    EXPECT_EQ(made.status, 0) << made.errors;
    EXPECT_EQ(made.errors, "");
    for (const char* name : {"000051.glb", "000052.glb"})
        EXPECT_FALSE(placesBelow(folder.path("jump") + "/" + name, 10.0f).empty()) << name;
}

TEST_F(MeshSequence, AFrameWithoutASolidIsAnEmptyFile) {
    test::writeText(graph, kEaten);
    for (const std::string ending : {".glb", ".gltf", ".obj", ".stl", ".ply", ".3mf", ".vdb"}) {
        const std::string at = folder.path("of_" + ending.substr(1));
        const CommandResult made = exported(at, {"--from", "0", "--format", ending.substr(1)});
        EXPECT_EQ(made.status, 0) << made.errors;
        EXPECT_EQ(made.errors, frame(at, 1, ending) +
                                   ": note: the solid is empty there, and the file has no triangles\n" + at +
                                   ": note: 2 files have no triangles\n");
        for (int number = 0; number < 4; ++number) EXPECT_TRUE(isWholeMesh(frame(at, number, ending)));
        EXPECT_LT(std::filesystem::file_size(frame(at, 2, ending)), 1500u) << ending;
        EXPECT_GT(std::filesystem::file_size(frame(at, 0, ending)),
                  4 * std::filesystem::file_size(frame(at, 2, ending)))
            << ending;
    }
    const nlohmann::json empty = jsonOfGlb(readText(frame(folder.path("of_glb"), 2)));
    EXPECT_FALSE(empty.contains("meshes"));
    EXPECT_EQ(empty["nodes"].size(), 1u);
}

TEST_F(MeshSequence, IsMeasuredFrameByFrame) {
    test::writeText(graph, kEaten);
    const std::string report = folder.path("report.json");
    EXPECT_EQ(exported(frames, {"--to", "0.25"}).status, 0);
    const CommandResult made =
        exported(frames, {"--from", "0", "--report", report, "--require", "closed,cavities=1"});
    EXPECT_EQ(made.status, 1) << made.errors;
    EXPECT_NE(made.errors.find("000001.glb: "), std::string::npos) << made.errors;
    EXPECT_EQ(made.errors.find("000003.glb: "), std::string::npos) << made.errors;
    const nlohmann::json measured = nlohmann::json::parse(readText(report));
    ASSERT_EQ(measured["frames"].size(), 4u);
    EXPECT_EQ(measured["frames"][3]["file"], "000003.glb");
    EXPECT_EQ(measured["frames"][3]["time"], 0.75);
    EXPECT_EQ(measured["frames"][3]["cavities"], 1);
    EXPECT_TRUE(measured["frames"][3]["meshToSurfaceMax"].is_number());
    EXPECT_EQ(measured["frames"][0]["cavities"], 1) << "it was there already";
    EXPECT_TRUE(measured["frames"][0]["meshToSurfaceMax"].is_null());
    EXPECT_EQ(measured["frames"][1]["triangles"], 0);
}

/// A blend of the two is no part that moves, though they are too far apart for it to be seen.
std::string blended() {
    std::string text = kGraph;
    const std::string link = R"("b": {"from": "lift"})";
    return text.replace(text.find(link), link.size(), link + R"(, "radius": 0.3)");
}

TEST_F(MeshSequence, IsOneFileInWhichFramesTakeTurns) {
    test::writeText(graph, blended());
    const std::string path = folder.path("moves.glb");
    const CommandResult made = exported(path, {"--animated"});
    EXPECT_EQ(made.status, 0) << made.errors;
    const std::string glb = readText(path);
    const nlohmann::json document = jsonOfGlb(glb);
    ASSERT_EQ(document["animations"].size(), 1u);
    const nlohmann::json& animation = document["animations"][0];
    // The way back is the way there: five places for eight frames.
    EXPECT_EQ(document["meshes"].size(), 5u);
    EXPECT_EQ(animation["channels"].size(), 5u);
    EXPECT_EQ(document["nodes"][0]["children"].size(), 5u);
    for (int number = 0; number < 8; ++number) {
        const double seconds = (number + 0.5) / 4.0;
        std::vector<std::size_t> shown;
        for (const nlohmann::json& channel : animation["channels"]) {
            const nlohmann::json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
            EXPECT_EQ(sampler["interpolation"], "STEP");
            EXPECT_EQ(channel["target"]["path"], "scale");
            const std::vector<float> times = floatsOf(glb, document, sampler["input"]),
                                     scales = floatsOf(glb, document, sampler["output"]);
            ASSERT_EQ(scales.size(), 3 * times.size());
            EXPECT_TRUE(std::ranges::is_sorted(times));
            EXPECT_EQ(times.front(), 0.0f);
            EXPECT_LE(times.back(), 2.0f);
            const auto after = std::ranges::upper_bound(times, float(seconds)) - times.begin();
            const float scale = scales[std::size_t(3 * (after - 1))];
            EXPECT_TRUE(scale == 0.0f || scale == 1.0f);
            if (scale == 1.0f) shown.push_back(channel["target"]["node"]);
        }
        ASSERT_EQ(shown.size(), 1u) << number;
        const nlohmann::json& mesh =
            document["meshes"][document["nodes"][shown[0]]["mesh"].get<std::size_t>()];
        const nlohmann::json& positions =
            document["accessors"][mesh["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
        EXPECT_NEAR(positions["max"][0].get<double>(), 0.5 + (number <= 4 ? number : 8 - number) / 4.0, 0.01);
    }
    // A program that plays nothing shows the first frame.
    for (std::size_t node = 1; node < document["nodes"].size(); ++node)
        EXPECT_EQ(document["nodes"][node].contains("scale"), node > 1) << node;
    EXPECT_EQ(document["accessors"].size(), document["bufferViews"].size());
    // The same as text with its buffer beside it, and in two runs.
    EXPECT_EQ(exported(folder.path("moves.gltf"), {"--animated"}).status, 0);
    EXPECT_TRUE(isWholeMesh(folder.path("moves.gltf")));
    EXPECT_EQ(exported(folder.path("again.glb"), {"--animated"}).status, 0);
    EXPECT_EQ(readText(folder.path("again.glb")).size(), glb.size());
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.field.json", "again.glb", "moves.bin", "moves.glb",
                                                        "moves.gltf"}));
    // Nothing is there while the solid is empty.
    test::writeText(graph, kEaten);
    const CommandResult empty = exported(path, {"--animated", "--to", "0.75"});
    EXPECT_EQ(empty.status, 0);
    EXPECT_EQ(empty.errors, path + ": note: the solid is empty at frame 1, and nothing is shown there\n");
    const std::string eaten = readText(path);
    const nlohmann::json gone = jsonOfGlb(eaten);
    EXPECT_EQ(gone["meshes"].size(), 1u);
    const std::size_t input = gone["animations"][0]["samplers"][0]["input"];
    EXPECT_EQ(floatsOf(eaten, gone, input), (std::vector<float>{0.0f, 0.25f}));
}

/// A post, and a gate that turns on its hinge and has a bead which slides along it and grows.
const std::string kGate = R"({"fieldwright": 1, "unit": "cm", "nodes": [
  {"id": "post", "type": "box", "label": "the post", "inputs": {"half_extents": [0.1, 1, 0.1]}},
  {"id": "leaf", "type": "box", "inputs": {"half_extents": [0.8, 0.6, 0.05]}},
  {"id": "bead", "type": "sphere", "inputs": {"radius": 0.1}},
  {"id": "grow", "type": "scale", "inputs": {"surface": {"from": "bead"}, "factor": 1}},
  {"id": "slide", "type": "translate", "inputs": {"surface": {"from": "grow"}, "offset": [-0.5, 0, 0.3]}},
  {"id": "wing", "type": "union", "inputs": {"a": {"from": "leaf"}, "b": {"from": "slide"}}},
  {"id": "out_of_post", "type": "translate", "inputs": {"surface": {"from": "wing"}, "offset": [1, 0, 0]}},
  {"id": "hinge", "type": "rotate", "inputs": {"surface": {"from": "out_of_post"}, "angles": [0, 0, 0]}},
  {"id": "all", "type": "union", "inputs": {"a": {"from": "post"}, "b": {"from": "hinge"}}},
  {"id": "paint", "type": "material", "inputs": {"surface": {"from": "all"}, "roughness": 0.3}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"}, "resolution": 64}}],
 "timeline": {"length": 1, "fps": 8, "tracks": [
   {"node": "hinge", "input": "angles", "keys": [{"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [0, 90, 0]}]},
   {"node": "slide", "input": "offset", "keys": [{"time": 0, "value": [-0.5, 0, 0.3]}, {"time": 1, "value": [0.5, 0, 0.3]}]},
   {"node": "grow", "input": "factor", "keys": [{"time": 0, "value": 1}, {"time": 1, "value": 2}]}]}})";

TEST_F(MeshSequence, PartsThatMoveAsWholesAreNodesThatMove) {
    test::writeText(graph, kGate);
    const std::string path = folder.path("gate.glb");
    const CommandResult made = exported(path, {"--animated"});
    EXPECT_EQ(made.status, 0) << made.errors;
    const std::string glb = readText(path);
    const nlohmann::json document = jsonOfGlb(glb);
    // Named as in the graph, each behind what carries it; what carries nothing else is one with its part.
    std::map<std::string, nlohmann::json> nodes;
    for (const nlohmann::json& node : document["nodes"]) nodes[node["name"]] = node;
    std::vector<std::string> names;
    for (const auto& [name, node] : nodes) names.push_back(name);
    EXPECT_EQ(names, (std::vector<std::string>{"bead", "gate", "grow", "hinge", "leaf", "out_of_post",
                                               "slide", "the post"}));
    EXPECT_EQ(document["meshes"].size(), 3u);
    for (const char* part : {"bead", "leaf", "the post"}) EXPECT_TRUE(nodes[part].contains("mesh")) << part;
    EXPECT_NEAR(nodes["out_of_post"]["translation"][0].get<double>(), 0.01, 1e-9) << "in metres";
    for (const nlohmann::json& material : document["materials"])
        EXPECT_NEAR(material["pbrMetallicRoughness"]["roughnessFactor"].get<double>(), 0.3, 1e-6);
    std::map<std::string, std::vector<float>> values;
    const nlohmann::json& animation = document["animations"][0];
    for (const nlohmann::json& channel : animation["channels"]) {
        const nlohmann::json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
        const nlohmann::json& node = document["nodes"][channel["target"]["node"].get<std::size_t>()];
        values[node["name"].get<std::string>() + "." + channel["target"]["path"].get<std::string>()] =
            floatsOf(glb, document, sampler["output"]);
        EXPECT_EQ(floatsOf(glb, document, sampler["input"]).size(), 8u);
    }
    ASSERT_EQ(values.size(), 3u);
    EXPECT_NEAR(values["slide.translation"][3 * 4], 0.0f, 1e-6f);
    EXPECT_NEAR(values["grow.scale"][3 * 4], 1.5f, 1e-6f);
    // 45 degrees about y, counter-clockwise from its tip.
    EXPECT_NEAR(values["hinge.rotation"][4 * 4 + 1], std::sin(std::numbers::pi / 8), 1e-6);
    EXPECT_NEAR(values["hinge.rotation"][4 * 4 + 3], std::cos(std::numbers::pi / 8), 1e-6);
    test::expectValidGltf({path});
    // Where parts meet on their way, and where one changes, frames take turns.
    for (const auto& [from, to] :
         {std::pair<std::string, std::string>{"\"offset\": [1, 0, 0]", "\"offset\": [0.5, 0, 0]"},
          {R"("node": "grow", "input": "factor")", R"("node": "bead", "input": "radius")"}}) {
        std::string other = kGate;
        other.replace(other.find(from), from.size(), to);
        test::writeText(graph, other);
        EXPECT_EQ(exported(path, {"--animated", "--to", "0.5"}).status, 0);
        const nlohmann::json turns = jsonOfGlb(readText(path));
        EXPECT_EQ(turns["meshes"].size(), 4u) << to;
        EXPECT_EQ(turns["animations"][0]["samplers"][0]["interpolation"], "STEP") << to;
    }
}

/// What a point cache holds: samples of places.
struct CachedPoints {
    std::vector<float> times;  ///< of .mdd
    std::vector<std::vector<float>> samples;
};

CachedPoints readPc2(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
    std::array<uint32_t, 2> head{};
    std::array<float, 2> frames{};
    uint32_t samples = 0;
    std::memcpy(head.data(), &bytes[12], 8);
    std::memcpy(frames.data(), &bytes[20], 8);
    std::memcpy(&samples, &bytes[28], 4);
    EXPECT_EQ(head[0], 1u);
    EXPECT_EQ(frames, (std::array{0.0f, 1.0f}));
    EXPECT_EQ(bytes.size(), 32 + std::size_t(12) * head[1] * samples);
    CachedPoints points;
    for (uint32_t i = 0; i < samples; ++i) {
        std::vector<float>& sample = points.samples.emplace_back(3 * head[1]);
        std::memcpy(sample.data(), &bytes[32 + std::size_t(12) * head[1] * i], 12 * head[1]);
    }
    return points;
}

CachedPoints readMdd(const std::string& bytes) {
    std::size_t at = 0;
    const auto word = [&] {
        uint32_t value = 0;
        for (int i = 0; i < 4; ++i) value = value << 8 | uint8_t(bytes[at++]);
        return value;
    };
    const auto number = [&] { return std::bit_cast<float>(word()); };
    const uint32_t samples = word(), count = word();
    EXPECT_EQ(bytes.size(), 8 + 4 * samples + std::size_t(12) * count * samples);
    CachedPoints points;
    for (uint32_t i = 0; i < samples; ++i) points.times.push_back(number());
    for (uint32_t i = 0; i < samples; ++i)
        for (uint32_t k = 0; k < 3 * count; ++k) {
            if (k == 0) points.samples.emplace_back();
            points.samples.back().push_back(number());
        }
    return points;
}

TEST_F(MeshSequence, WhatKeepsItsTrianglesIsAPointCache) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    test::writeText(graph, kGate);
    for (const char* name : {"gate.pc2", "gate.mdd"}) {
        const CommandResult made = exported(folder.path(name), {"--animated"});
        EXPECT_EQ(made.status, 0) << made.errors;
    }
    EXPECT_EQ(folder.names(),
              (std::vector<std::string>{"a.field.json", "gate.mdd", "gate.mtl", "gate.obj", "gate.pc2"}));
    const CachedPoints points = readPc2(readText(folder.path("gate.pc2"))),
                       same = readMdd(readText(folder.path("gate.mdd")));
    EXPECT_EQ(points.samples, same.samples);
    ASSERT_EQ(points.samples.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(same.times[i], float(i) / 8.0f);
    // The mesh beside it is the first sample, point for point.
    std::istringstream object(readText(folder.path("gate.obj")));
    std::vector<float> places;
    std::size_t faces = 0;
    for (std::string line; std::getline(object, line); faces += line.starts_with("f "))
        if (line.starts_with("v ")) {
            std::istringstream words(line.substr(2));
            std::array<float, 3> place{};
            words >> place[0] >> place[1] >> place[2];
            places.insert(places.end(), place.begin(), place.end());
        }
    EXPECT_GT(faces, 1000u);
    ASSERT_EQ(places.size(), points.samples[0].size());
    for (std::size_t i = 0; i < places.size(); ++i) ASSERT_NEAR(places[i], points.samples[0][i], 1e-6f);
    // Each sample has the extent of the mesh of that frame.
    EXPECT_EQ(exported(frames, {"--format", "obj", "--from", "0"}).status, 0);
    for (int i : {0, 3, 7}) {
        const Result<Report> report = reportOnFile(frame(frames, i, ".obj"));
        ASSERT_TRUE(report);
        std::array<float, 3> least{1e9f, 1e9f, 1e9f}, greatest{-1e9f, -1e9f, -1e9f};
        const std::vector<float>& sample = points.samples[std::size_t(i)];
        for (std::size_t k = 0; k < sample.size(); ++k) {
            least[k % 3] = std::min(least[k % 3], sample[k]);
            greatest[k % 3] = std::max(greatest[k % 3], sample[k]);
        }
        const double cell = 3.0 / 64;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(least[axis], report->boundsMin[axis], cell) << i << " " << axis;
            EXPECT_NEAR(greatest[axis], report->boundsMax[axis], cell) << i << " " << axis;
        }
    }
    // What rests keeps its triangles too; what grows into other triangles does not.
    test::writeText(graph, kGraph);
    EXPECT_EQ(exported(folder.path("still.mdd"), {"--animated", "--to", "0.2"}).status, 0);
    test::writeText(graph, kEaten);
    const CommandResult gone = exported(folder.path("eaten.pc2"), {"--animated"});
    EXPECT_NE(gone.status, 0);
    EXPECT_NE(gone.errors.find("eaten.pc2: error: the solid is empty"), std::string::npos) << gone.errors;
    test::writeText(graph, blended());
    const CommandResult changed = exported(folder.path("eaten.pc2"), {"--animated"});
    EXPECT_NE(changed.status, 0);
    EXPECT_NE(changed.errors.find("write a .glb, or a mesh for every frame"), std::string::npos)
        << changed.errors;
    EXPECT_NE(changed.errors.find("frame 1"), std::string::npos) << changed.errors;
    for (const char* without : {"--compress", "--parts", "--manifold"})
        expectRefusal(exported(folder.path("no.pc2"), {"--animated", without}), 2, {".glb and .gltf alone"});
    expectRefusal(exported(folder.path("no.pc2"), {"--animated", "--textures", "64"}), 2, {"--textures"});
    expectRefusal(exported(folder.path("no.pc2"), {}), 2, {"no.pc2"});
    for (const std::string& name : folder.names())
        EXPECT_TRUE(!name.starts_with("eaten") && !name.starts_with("no")) << name;
}

TEST_F(MeshSequence, FramesHaveTexturesOfTheirOwn) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const std::vector<std::string> few{"--to", "0.5", "--textures", "64"};
    std::vector<std::string> asFiles = few;
    asFiles.insert(asFiles.end(), {"--format", "gltf"});
    ASSERT_EQ(exported(frames, asFiles).status, 0);
    const std::vector<std::string> names = namesIn(frames);
    for (const char* name :
         {"000000.gltf", "000000.bin", "000000_gltf_base_color.png", "000001_gltf_normal.png"})
        EXPECT_TRUE(std::ranges::count(names, name)) << name;
    test::expectValidGltf({frame(frames, 0, ".gltf"), frame(frames, 1, ".gltf")});
    // In one file too: of parts, each has its own.
    std::vector<std::string> animated = few;
    animated.push_back("--animated");
    for (const char* file : {"moves.glb", "moves.gltf"}) {
        ASSERT_EQ(exported(folder.path(file), animated).status, 0);
        const std::string text = readText(folder.path(file));
        const nlohmann::json document =
            file == std::string("moves.glb") ? jsonOfGlb(text) : nlohmann::json::parse(text);
        EXPECT_EQ(document["meshes"].size(), 1u) << "the balls are alike";
        EXPECT_EQ(document["images"].size(), 3u);
        test::expectValidGltf({folder.path(file)});
    }
    EXPECT_TRUE(std::filesystem::exists(folder.path("moves_gltf_normal.png")));
    // Meshes that differ have a set each.
    test::writeText(graph, kGate);
    ASSERT_EQ(exported(folder.path("gate.gltf"), animated).status, 0);
    for (const char* name : {"gate_gltf_normal.png", "gate_gltf_2_normal.png", "gate_gltf_3_normal.png"})
        EXPECT_TRUE(std::filesystem::exists(folder.path(name))) << name;
    test::expectValidGltf({folder.path("gate.gltf")});
}

TEST_F(MeshSequence, ASweepIsAMeshForEveryValue) {
    const CommandResult made = exported(frames, {"--sweep", "size=0.2:0.8:4", "--format", "ply"});
    EXPECT_EQ(made.status, 0) << made.errors;
    EXPECT_EQ(namesIn(frames),
              (std::vector<std::string>{"size=0.2.ply", "size=0.4.ply", "size=0.6.ply", "size=0.8.ply"}));
    for (const double radius : {0.2, 0.4, 0.6, 0.8}) {
        const Result<Report> report =
            reportOnFile(frames + "/size=" + std::to_string(radius).substr(0, 3) + ".ply");
        ASSERT_TRUE(report);
        EXPECT_NEAR(report->boundsMin[0], -std::max(radius, 0.5), 0.02) << radius;
        EXPECT_NEAR(report->boundsMin[1], -radius, 0.02) << radius;
    }
    // A variant does not depend on those before it.
    const std::string whole = readText(frames + "/size=0.8.ply");
    std::filesystem::remove(frames + "/size=0.8.ply");
    const CommandResult more = exported(frames, {"--sweep", "size=0.2:0.8:4", "--format", "ply"});
    EXPECT_NE(more.errors.find("3 of 4 variants were there already"), std::string::npos) << more.errors;
    EXPECT_TRUE(readText(frames + "/size=0.8.ply") == whole);
    // Of a table; what it says of each stands in the report.
    test::writeText(folder.path("sizes.csv"), "size\n0.3\n0.7\n");
    const std::string report = folder.path("report.json");
    EXPECT_EQ(
        exported(folder.path("table"), {"--sweep", folder.path("sizes.csv"), "--report", report}).status, 0);
    const nlohmann::json measured = nlohmann::json::parse(readText(report));
    ASSERT_EQ(measured["variants"].size(), 2u);
    EXPECT_EQ(measured["variants"][1]["values"]["size"], 0.7);
    // A value that cannot be is told before any mesh is made.
    const std::string none = folder.path("none");
    expectRefusal(exported(none, {"--sweep", "size=0.5:2:3"}), 2, {"size", "--sweep"});
    expectRefusal(exported(none, {"--sweep", "sise=0.1:0.2:3"}), 2, {"sise", "'size'"});
    expectRefusal(exported(none, {"--sweep", "size=0.1"}), 2, {"name=from:to:count"});
    expectRefusal(exported(none, {"--sweep", "size=0.2:0.8:4", "--fps", "4"}), 2, {"--sweep", "--fps"});
    EXPECT_FALSE(std::filesystem::exists(none));
}

TEST_F(MeshSequence, RefusesWhatMakesNoSequence) {
    const auto refuse = [&](const std::string& output, const std::vector<std::string>& words,
                            const std::string& part) { expectRefusal(exported(output, words), 2, {part}); };
    refuse(frames, {"--from", "3", "--to", "1"}, "there is no frame from");
    refuse(frames, {"--to", "1e9"}, "frames are numbered up to 1000000");
    refuse(frames, {"--range"}, "the timeline has no range");
    refuse(frames, {"--to", "1", "--time", "1"}, "--time");
    refuse(frames, {"--to", "1", "--format", "fbx"}, "glb");
    refuse(frames, {"--to", "1", "--tiles", "2"}, "--tiles");
    refuse(frames, {"--to", "1", "--format", "vdb", "--report", folder.path("r.json")}, "no triangles");
    refuse(folder.path("a.glb"), {"--to", "1"}, "give its name, and --format glb");
    refuse(folder.path("a.glb"), {"--overwrite"}, "--overwrite is for a sequence");
    refuse(folder.path("a.glb"), {"--format", "ply"}, "--format ply");
    refuse(folder.path("a.ply"), {"--animated"}, "a .glb or .gltf");
    refuse(folder.path("a.glb"), {"--animated", "--manifold"}, "is not marked as a solid");
    refuse(folder.path("a.glb"), {"--animated", "--require", "closed"}, "--require");
    refuse(graph, {"--to", "1"}, "this is a file");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.field.json"});
    std::filesystem::create_directories(frames + "/000002.glb");
    refuse(frames, {"--to", "1"}, "000002.glb is no ordinary file");
    expectRefusal(exported("/proc/frames", {"--to", "1"}), 3,
                  {"/proc/frames: error: cannot make the folder"});
}

TEST_F(MeshSequence, AFullDiskLeavesWholeFilesAloneAndIsGoneOnWith) {
    const std::string disk = folder.path("disk"), left = folder.path("left");
    std::filesystem::create_directory(disk);
    if (test::runProgram("unshare -rm mount -t tmpfs none '" + disk + "'").status != 0)
        GTEST_SKIP() << "mounting is not permitted here";
    std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
        {"frames", {"--from", "0"}},
        {"a.glb", {"--animated"}},
        {"a.obj", {"--textures", "64"}},
        {"a.gltf", {"--parts"}},
        {"frames", {"--from", "0", "--format", "gltf"}},
        {"frames", {"--sweep", "size=0.3:0.8:8", "--format", "ply"}},
        {"a.gltf", {"--animated"}},
        {"a.glb", {"--textures", "64"}},
        {"a.glb", {"--parts", "--compress"}}};
    if (!std::getenv("FIELDWRIGHT_LONG")) cases.resize(4);
    for (const auto& [output, words] : cases) {
        SCOPED_TRACE(output + " " + words[0] + " " + words.back());
        const TempDir whole;
        EXPECT_EQ(exported(whole.path(output), words).status, 0);
        std::map<std::string, std::string> wanted;
        std::size_t bytes = 0;
        for (const auto& each : std::filesystem::recursive_directory_iterator(whole.folder))
            if (each.is_regular_file()) {
                const std::string name = std::filesystem::relative(each.path(), whole.folder).string();
                bytes += (wanted[name] = readText(each.path().string())).size();
            }
        test::CommandOptions half;  // of the room that they need, on a disk that ends with the command
        half.wrapper = {"unshare", "-rm", "sh", "-c",
                        "mount -t tmpfs -o size=" + std::to_string(bytes / 2) + " none '" + disk +
                            "' && \"$0\" \"$@\"; status=$?; cp -r '" + disk + "' '" + left +
                            "'; exit $status"};
        std::vector<std::string> full = {"export", graph, "-o", disk + "/" + output};
        full.insert(full.end(), words.begin(), words.end());
        const CommandResult result = runCommand(full, half);
        EXPECT_EQ(result.status, 3) << result.errors;
        EXPECT_TRUE(result.errors.starts_with(disk + "/" + output.substr(0, 1))) << result.errors;
        EXPECT_NE(result.errors.find("No space left on device"), std::string::npos) << result.errors;
        std::size_t there = 0;
        for (const auto& each : std::filesystem::recursive_directory_iterator(left)) {
            if (!each.is_regular_file()) continue;
            const std::string name = std::filesystem::relative(each.path(), left).string();
            EXPECT_TRUE(wanted.contains(name) && readText(each.path().string()) == wanted[name]) << name;
            ++there;
        }
        EXPECT_EQ(there > 0, output == "frames");
        EXPECT_EQ(exported(left + "/" + output, words).status, 0);
        for (const auto& [name, content] : wanted)
            EXPECT_TRUE(readText(left + "/" + name) == content) << name;
        std::filesystem::remove_all(left);
    }
}

TEST_F(MeshSequence, KilledAtAnyTimeGoesOnToTheSameBytes) {
    // Sixty frames; with FIELDWRIGHT_LONG of the sample.
    const bool all = std::getenv("FIELDWRIGHT_LONG");
    if (all) test::writeText(graph, readText(FIELDWRIGHT_SOURCE_DIR "/samples/moving_booleans.field.json"));
    const auto words = [&](const std::string& output) -> std::vector<std::string> {
        return {"export", graph, "-o", output, "--fps", "30", "--to", "2", "--resolution", all ? "48" : "24"};
    };
    EXPECT_EQ(runCommand(words(frames)).status, 0);
    EXPECT_EQ(namesIn(frames).size(), 60u);
    const std::string other = folder.path("other");
    std::mt19937 random(7);
    const int kills = all ? 20 : 3;
    for (int kill = 0; kill < kills; ++kill) {
        test::CommandOptions options;
        options.interruptAfterMs = 200 + int(random() % 600);
        options.signal = kill % 2 == 0 ? SIGKILL : SIGTERM;
        runCommand(words(other), options);
        if (!std::filesystem::exists(other)) continue;
        for (const std::string& name : namesIn(other))
            EXPECT_TRUE(name.starts_with('.') || isWholeMesh(other + "/" + name)) << name;
    }
    EXPECT_EQ(runCommand(words(other)).status, 0);
    EXPECT_EQ(namesIn(other), namesIn(frames)) << "nothing temporary is left";
    for (const std::string& name : namesIn(frames))
        EXPECT_TRUE(readText(other + "/" + name) == readText(frames + "/" + name)) << name;
}

}  // namespace fw::mesh_sequence_test
