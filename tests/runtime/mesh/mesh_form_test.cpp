// How a mesh is put into its file, as a user asks for it: compressed, in parts, in another unit, with another
// axis up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "runtime/export/export.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/mesh/separate_parts.h"
#include "tests/support/command.h"
#include "tests/support/glb.h"
#include "tests/support/gltf_validator.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::mesh_form_test {

using nlohmann::json;
using test::CommandResult;
using test::readText;
using test::runCommand;

/// A plate of 60 x 10 x 20, and a ball of 8 whose middle is 40 above it, in the unit.
std::string plateAndBall(const std::string& unit) {
    return R"({"fieldwright": 1, )" + (unit.empty() ? "" : "\"unit\": \"" + unit + "\", ") + R"("nodes": [
      {"id": "plate", "type": "box", "inputs": {"half_extents": [30, 5, 10]}},
      {"id": "ball", "type": "sphere", "inputs": {"radius": 8}},
      {"id": "lift", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 40, 0]}},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "plate"}, "b": {"from": "lift"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 64}}]})";
}
constexpr double kBall = 4.0 / 3.0 * std::numbers::pi * 512.0, kVolume = 12'000.0 + kBall;

struct MeshForm : testing::Test {
    test::TempDir folder;
    std::string graph = folder.path("part.field.json");
    void SetUp() override { test::writeText(graph, plateAndBall("mm")); }

    CommandResult exported(const std::string& file, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"export", graph, "-o", file};
        words.insert(words.end(), more.begin(), more.end());
        return runCommand(words);
    }
    /// The report of such an export, which must come to its end.
    json reported(const std::string& file, std::vector<std::string> more = {}) const {
        more.insert(more.end(), {"--report", folder.path("report.json")});
        const CommandResult result = exported(file, more);
        EXPECT_EQ(result.status, 0) << result.errors;
        return json::parse(readText(folder.path("report.json")));
    }
};

/// Expects the file to hold the plate and the ball, in a unit that is so many of the document's, and with z
/// up or y.
void expectHolds(const std::string& file, double scale, bool zUp) {
    const Result<Report> report = reportOnFile(file);
    ASSERT_TRUE(report) << format(report.error());
    EXPECT_NEAR(report->volume / std::pow(scale, 3), kVolume, 0.01 * kVolume) << file;
    const std::array<double, 3> least = zUp ? std::array{-30.0, -10.0, -5.0} : std::array{-30.0, -5.0, -10.0},
                                greatest = zUp ? std::array{30.0, 10.0, 48.0} : std::array{30.0, 48.0, 10.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(report->boundsMin[axis] / scale, least[axis], 0.3) << file << ", axis " << axis;
        EXPECT_NEAR(report->boundsMax[axis] / scale, greatest[axis], 0.3) << file << ", axis " << axis;
    }
    EXPECT_TRUE(report->closedManifold()) << file;
}

TEST_F(MeshForm, FormatsHaveTheirUnits) {
    // What read_back reads of 3MF is metres.
    const struct {
        const char* file;
        std::vector<std::string> words;
        double scale;
        bool zUp;
        const char* said;
    } kinds[] = {
        {"a.glb", {}, 0.001, false, "metres, +Y up"},
        {"a.gltf", {}, 0.001, false, "metres, +Y up"},
        {"a.3mf", {}, 0.001, false, "millimetres, +Y up"},
        {"a.stl", {}, 1.0, false, "millimetres, +Y up"},
        {"b.3mf", {"--for", "print"}, 0.001, true, "millimetres, +Z up"},
        {"b.stl", {"--for", "print"}, 1.0, true, "millimetres, +Z up"},
        {"c.stl", {"--for", "print", "--tiles", "2"}, 1.0, true, "millimetres, +Z up"},
        {"a.obj", {"--unit", "in", "--up", "z"}, 1.0 / 25.4, true, "inches, +Z up"},
        {"a.ply", {"--unit", "m"}, 0.001, false, "metres, +Y up"},
        {"b.ply", {"--up", "z", "--unit", "cm", "--tiles", "2"}, 0.1, true, "centimetres, +Z up"},
    };
    for (const auto& kind : kinds) {
        const std::string file = folder.path(kind.file);
        const json report = reported(file, kind.words);
        expectHolds(file, kind.scale, kind.zUp);
        // The report is in the document's unit whatever the file has.
        EXPECT_EQ(report["unit"], "mm") << kind.file;
        EXPECT_EQ(report["fileLengths"], kind.said) << kind.file;
        EXPECT_NEAR(report["volume"].get<double>(), kVolume, 0.01 * kVolume) << kind.file;
        EXPECT_NEAR(report["boundsMax"][1].get<double>(), 48.0, 0.3) << kind.file;
        EXPECT_LT(report["surfaceToMeshMax"].get<double>(), 2.0) << kind.file;
    }
    EXPECT_NE(readText(folder.path("b.stl")).find("millimetres, +Z up"), std::string::npos);
    EXPECT_NE(readText(folder.path("a.obj")).find(", inches, +Z up\n"), std::string::npos);
    EXPECT_EQ(exported(folder.path("a.vdb"), {"--unit", "m"}).status, 0);
    test::expectValidGltf({folder.path("a.glb"), folder.path("a.gltf")});
}

TEST_F(MeshForm, AnUnlikelySizeIsSaid) {
    const std::string file = folder.path("a.stl");
    EXPECT_EQ(exported(file, {"--for", "print"}).errors, "");
    test::writeText(graph, plateAndBall(""));
    EXPECT_EQ(exported(file).errors, "");  // of numbers without a unit nothing can be said
    const CommandResult large = exported(file, {"--for", "print"});
    EXPECT_NE(large.errors.find("it is 60000 mm long, which is large for a part"), std::string::npos)
        << large.errors;
    expectHolds(file, 1000.0, true);
}

TEST_F(MeshForm, SequencesAndAnimationsHaveTheUnitToo) {
    const std::string frames = folder.path("frames");
    const json report = reported(frames, {"--to", "0.1", "--fps", "10", "--format", "stl", "--for", "print"});
    expectHolds(frames + "/000000.stl", 1.0, true);
    const json& first = report["frames"][0];
    EXPECT_EQ(first["file"], "000000.stl");
    EXPECT_EQ(first["unit"], "mm");
    EXPECT_NEAR(first["boundsMax"][1].get<double>(), 48.0, 0.3);
    // What was there is measured likewise.
    const json again = reported(frames, {"--to", "0.1", "--fps", "10", "--format", "stl", "--for", "print"});
    EXPECT_EQ(again["frames"][0]["boundsMax"], first["boundsMax"]);
    const std::string moves = folder.path("moves.glb");
    EXPECT_EQ(exported(moves, {"--animated", "--to", "0.2", "--fps", "10"}).status, 0);
    expectHolds(moves, 0.001, false);
}

TEST_F(MeshForm, ACompressedMeshIsTheSameSolid) {
    for (const char* name : {"a.glb", "a.gltf"}) {
        const std::string plain = folder.path(std::string("plain_") + name), small = folder.path(name);
        const json before = reported(plain), after = reported(small, {"--compress"});
        for (const char* same : {"triangles", "vertices", "bodies", "boundaryEdges", "nonManifoldEdges",
                                 "eulerCharacteristic", "degenerateTriangles"})
            EXPECT_EQ(before[same], after[same]) << same;
        EXPECT_NEAR(after["volume"].get<double>(), before["volume"].get<double>(), 0.001 * kVolume);
        const auto sizeOfAll = [](const std::string& path) {
            uint64_t bytes = 0;
            for (const std::string& file : exportedPaths(path)) bytes += std::filesystem::file_size(file);
            return bytes;
        };
        EXPECT_LT(4 * sizeOfAll(small), sizeOfAll(plain)) << name;
    }
    test::expectValidGltf({folder.path("a.glb"), folder.path("a.gltf")}, false);
    // Frames that take turns: their nodes' scales move, and steps are the business of children.
    const std::string moves = folder.path("moves.glb");
    EXPECT_EQ(exported(moves, {"--animated", "--compress", "--to", "0.2", "--fps", "10"}).status, 0);
    expectHolds(moves, 0.001, false);
    test::expectValidGltf({moves}, false);
}

TEST_F(MeshForm, CompressedFilesThatAreBrokenAreRefused) {
    const std::string file = folder.path("a.glb"), broken = folder.path("broken.glb");
    ASSERT_EQ(exported(file, {"--compress"}).status, 0);
    const std::string whole = readText(file);
    const auto refused = [&](const std::string& bytes) {
        test::writeText(broken, bytes);
        const Result<Report> report = reportOnFile(broken);
        return !report;
    };
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = whole;
        const std::size_t at = changed.rfind(from);
        EXPECT_NE(at, std::string::npos) << from;
        EXPECT_EQ(from.size(), to.size());
        return changed.replace(at, to.size(), to);
    };
    EXPECT_TRUE(refused(with("\"mode\":\"TRIANGLES\"", "\"mode\":\"TRIANGLE_\"")));
    EXPECT_TRUE(refused(with("Required\":[\"KHR_mesh", "Required\":[\"KHR_mush")));
    EXPECT_TRUE(refused(with("\"buffer\":0", "\"buffer\":7")));
    // The code itself, each byte of its head and some behind.
    const std::size_t code = whole.find("BIN") + 4;
    std::size_t noticed = 0, tried = 0;
    for (std::size_t at = code; at < whole.size(); at += 1 + at % 97, ++tried) {
        std::string changed = whole;
        changed[at] = char(~changed[at]);
        noticed += refused(changed);  // or it is another mesh; it is never a crash
    }
    EXPECT_GT(noticed, 0u);
    EXPECT_GT(tried, 100u);
}

TEST_F(MeshForm, PartsAreNodes) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--compress"}}) {
        const std::string file = folder.path("a.gltf");
        std::vector<std::string> words = {"--parts"};
        words.insert(words.end(), more.begin(), more.end());
        const json report = reported(file, words), document = json::parse(readText(file));
        EXPECT_EQ(report["bodies"], 2);
        expectHolds(file, 0.001, false);
        ASSERT_EQ(document["meshes"].size(), 2u);
        ASSERT_EQ(document["nodes"].size(), 3u);
        EXPECT_EQ(document["nodes"][0]["children"], (json{1, 2}));
        EXPECT_EQ(document["nodes"][1]["name"], "a_1");
        EXPECT_EQ(document["nodes"][2]["name"], "a_2");
        test::expectValidGltf({file}, more.empty());
    }
}

TEST_F(MeshForm, PartsAndCompressedMeshesHaveTextures) {
    for (const char* how : {"--parts", "--compress"})
        for (const char* name : {"a.gltf", "a.glb"}) {
            const std::string file = folder.path(name);
            const json report = reported(file, {how, "--textures", "64"});
            expectHolds(file, 0.001, false);
            const std::string text = readText(file);
            const json document = name == std::string("a.glb") ? test::jsonOfGlb(text) : json::parse(text);
            EXPECT_EQ(document["images"].size(), 3u) << how << name;
            for (const json& mesh : document["meshes"])
                EXPECT_TRUE(mesh["primitives"][0]["attributes"].contains("TEXCOORD_0"));
            for (const json& material : document["materials"])
                EXPECT_EQ(material["normalTexture"]["index"], 2) << how << name;
            test::expectValidGltf({file}, how == std::string("--parts"));
        }
    EXPECT_TRUE(std::filesystem::exists(folder.path("a_gltf_normal.png")));
}

TEST_F(MeshForm, WhatAFormatLacksIsRefused) {
    const auto refuse = [&](const char* file, const std::vector<std::string>& words, const char* says) {
        const CommandResult result = exported(folder.path(file), words);
        EXPECT_EQ(result.status, 2) << says;
        EXPECT_NE(result.errors.find(says), std::string::npos) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(folder.path(file)));
    };
    refuse("a.glb", {"--up", "z"}, "+Y up by its specification");
    refuse("a.glb", {"--unit", "mm"}, "in metres by its specification");
    refuse("a.3mf", {"--unit", "m"}, "written in millimetres");
    refuse("a.ply", {"--for", "print"}, "write .stl or .3mf");
    refuse("a.stl", {"--for", "milling"}, "'milling' is none of print");
    refuse("a.stl", {"--for", "print", "--up", "y"}, "--up");
    refuse("a.stl", {"--unit", "mmm"}, "did you mean 'mm'?");
    refuse("a.stl", {"--compress"}, "compressed in .glb and .gltf alone");
    refuse("a.3mf", {"--parts"}, "parted in .glb and .gltf alone");
    refuse("a.glb", {"--manifold", "--compress"}, "choose one");
    refuse("a.glb", {"--tiles", "2", "--compress"}, "which tiles are there to avoid");
    test::writeText(graph, plateAndBall("ell"));
    const CommandResult unknown = exported(folder.path("a.stl"));
    EXPECT_EQ(unknown.status, 1);
    EXPECT_NE(unknown.errors.find(":1:28: error: the unit 'ell' is none of mm, cm, in, m"), std::string::npos)
        << unknown.errors;
}

/// So many tetrahedra, of which each but the first of a pair touches the one before at a corner.
Mesh tetrahedra(std::size_t count, bool inPairs) {
    Mesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const bool touches = inPairs && i % 2 == 1;
        const glm::vec3 at(touches ? 3.0f * float(i - 1) + 1.0f : 3.0f * float(i), 0.0f, 0.0f);
        const auto first = uint32_t(mesh.positions.size());
        for (const glm::vec3 corner :
             {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)})
            mesh.positions.push_back(at + corner);
        for (const uint32_t corner : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3})
            mesh.indices.push_back(first + corner);
    }
    return mesh;
}

TEST(SeparateParts, TouchNowhere) {
    EXPECT_EQ(separateParts(tetrahedra(10, false)).size(), 10u);
    const std::vector<Mesh> pairs = separateParts(tetrahedra(10, true));
    ASSERT_EQ(pairs.size(), 5u);
    for (const Mesh& pair : pairs) EXPECT_EQ(pair.triangleCount(), 8u);
    EXPECT_TRUE(separateParts({}).empty());
}

TEST(SeparateParts, KeepTheirMaterials) {
    Mesh mesh = tetrahedra(3, false);
    Material gold, iron;
    gold.metallic = 1.0f, iron.roughness = 0.1f;
    mesh.parts = {{gold, 6}, {iron, 6}};  // the second one is of both
    mesh.colors.resize(mesh.positions.size(), glm::vec3(0.25f));
    const std::vector<Mesh> parts = separateParts(mesh);
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].material, gold);
    ASSERT_EQ(parts[1].parts.size(), 2u);
    EXPECT_EQ(parts[1].parts[0].triangles, 2u);
    EXPECT_EQ(parts[1].parts[1].material, iron);
    EXPECT_EQ(parts[2].material, iron);
    EXPECT_EQ(parts[2].colors.size(), parts[2].positions.size());
}

TEST(SeparateParts, AreAHundredThousand) {
    const test::TempDir folder;
    const std::string file = folder.path("a.glb");
    const std::size_t count = 100'000;
    const Mesh mesh = tetrahedra(count, false);
    ASSERT_EQ(separateParts(mesh).size(), count);
    Mesh few = tetrahedra(2'000, false);
    const Result<ExportedFiles> written = exportMesh(few, file, {.parts = true});
    ASSERT_TRUE(written) << format(written.error());
    const Result<Report> report = reportOnFile(file);
    ASSERT_TRUE(report) << format(report.error());
    EXPECT_EQ(report->shells, 2'000u);
}

}  // namespace fw::mesh_form_test
