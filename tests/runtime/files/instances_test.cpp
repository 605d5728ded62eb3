// Copies that share a mesh in the file (export --instances).
#include <gtest/gtest.h>
#include <cstdlib>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/measure/mesh_report.h"
#include "tests/support/command.h"
#include "tests/support/gltf_validator.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::instances_test {

using nlohmann::json;
using test::CommandResult;
using test::readText;
using test::runCommand;

/// A peg that no turn or mirror image leaves as it is, of two materials.
const std::string kPeg = R"(
    {"id": "foot", "type": "box", "inputs": {"half_extents": [0.5, 0.25, 0.4]}},
    {"id": "stone", "type": "material",
     "inputs": {"surface": {"from": "foot"}, "base_color": [0.2, 0.3, 0.4], "roughness": 0.9}},
    {"id": "pin", "type": "sphere", "inputs": {"radius": 0.3}},
    {"id": "up", "type": "translate", "inputs": {"surface": {"from": "pin"}, "offset": [0.25, 0.3, 0.15]}},
    {"id": "gold", "type": "material",
     "inputs": {"surface": {"from": "up"}, "base_color": [0.9, 0.7, 0.1], "metallic": 1, "roughness": 0.2}},
    {"id": "peg", "type": "union", "inputs": {"a": {"from": "stone"}, "b": {"from": "gold"}}},)";

struct Instances : testing::Test {
    test::TempDir folder;
    std::string graph = folder.path("copies.field.json");

    /// The peg, and behind it what is shown, of which the last is "all".
    void write(const std::string& nodes, int resolution = 96) const {
        test::writeText(graph, R"({"fieldwright": 1, "nodes": [)" + kPeg + nodes + R"(,
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}, "resolution": )" +
                                   std::to_string(resolution) + "}}]}");
    }
    std::string exported(const std::string& file, const std::vector<std::string>& more) const {
        std::vector<std::string> words = {"export", graph, "-o", folder.path(file)};
        words.insert(words.end(), more.begin(), more.end());
        const CommandResult result = runCommand(words);
        EXPECT_EQ(result.status, 0) << result.errors;
        return result.errors;
    }
    json document(const std::string& file) const { return json::parse(readText(folder.path(file))); }

    /// Exports the graph in both forms, compressed and not, and as one mesh: the same solid each time, with
    /// so many copies of one mesh, `others` beside it. The notes of the first.
    std::string expectCopies(std::size_t copies, std::size_t others = 0, double near = 0.02,
                             const std::vector<std::string>& more = {}) const {
        const auto with = [&](std::vector<std::string> words) {
            words.insert(words.end(), more.begin(), more.end());
            return words;
        };
        exported("plain.gltf", with({}));
        const std::string notes = exported("nodes.gltf", with({"--instances"}));
        exported("gpu.gltf", with({"--instances", "gpu"}));
        exported("small.gltf", with({"--instances", "nodes", "--compress"}));
        exported("gpu_small.gltf", with({"--instances", "gpu", "--compress"}));
        const Result<Report> plain = reportOnFile(folder.path("plain.gltf"));
        EXPECT_TRUE(plain);
        if (!plain) return notes;
        for (const char* file : {"nodes.gltf", "gpu.gltf", "small.gltf", "gpu_small.gltf"}) {
            const Result<Report> report = reportOnFile(folder.path(file));
            EXPECT_TRUE(report) << file << ": " << format(report.error());
            if (!report) continue;
            EXPECT_NEAR(report->volume, plain->volume, near * plain->volume) << file;
            EXPECT_EQ(report->bodies(),
                      plain->bodies() + (notes.find("reach into") != std::string::npos ? copies : 0))
                << file;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(report->boundsMin[axis], plain->boundsMin[axis], 0.05) << file;
                EXPECT_NEAR(report->boundsMax[axis], plain->boundsMax[axis], 0.05) << file;
            }
            const json gltf = document(file);
            EXPECT_EQ(gltf["meshes"].size(), 1 + others) << file;
            std::size_t shown = 0;
            for (const json& node : gltf["nodes"]) {
                if (!node.contains("mesh")) continue;
                const json many =
                    node.value("/extensions/EXT_mesh_gpu_instancing/attributes"_json_pointer, json());
                shown += many.is_null() ? 1
                                        : gltf["accessors"][many["TRANSLATION"].get<std::size_t>()]["count"]
                                              .get<std::size_t>();
            }
            EXPECT_EQ(shown, copies + others) << file;
        }
        test::expectValidGltf({folder.path("nodes.gltf")});
        test::expectValidGltf(
            {folder.path("gpu.gltf"), folder.path("small.gltf"), folder.path("gpu_small.gltf")}, false);
        return notes;
    }
    /// Exports it, which has no copies that could share a mesh.
    void expectWhole(const std::string& says, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"--instances"};
        words.insert(words.end(), more.begin(), more.end());
        const std::string notes = exported("whole.gltf", words);
        EXPECT_NE(notes.find(says), std::string::npos) << notes;
        EXPECT_EQ(document("whole.gltf")["meshes"].size(), 1u);
        EXPECT_EQ(document("whole.gltf")["nodes"].size(), 2u);
    }
};

TEST_F(Instances, OfARepeatedSolid) {
    write(R"({"id": "all", "type": "repeat", "label": "Pegs",
              "inputs": {"surface": {"from": "peg"}, "period": [1.5, 0, 1.25], "count": [4, 1, 3]}})");
    EXPECT_EQ(expectCopies(12), "");
    const json file = document("nodes.gltf");
    ASSERT_EQ(file["nodes"].size(), 14u);
    EXPECT_EQ(file["nodes"][0]["name"], "nodes");
    EXPECT_EQ(file["nodes"][1]["name"], "Pegs");
    EXPECT_EQ(file["nodes"][2]["name"], "Pegs_1");
    EXPECT_FALSE(file["nodes"][2].contains("rotation"));
    ASSERT_EQ(file["materials"].size(), 2u);
    EXPECT_EQ(file["materials"][0]["name"], "stone");
    EXPECT_EQ(file["materials"][1]["name"], "gold");
    EXPECT_FALSE(file.contains("extensionsRequired"));
    EXPECT_EQ(document("gpu.gltf")["extensionsRequired"], json{"EXT_mesh_gpu_instancing"});
    EXPECT_EQ(document("gpu.gltf")["nodes"].size(), 3u);
    // One mesh in place of twelve.
    EXPECT_LT(6 * std::filesystem::file_size(folder.path("nodes.bin")),
              std::filesystem::file_size(folder.path("plain.bin")));
}

TEST_F(Instances, OfACircleThatIsPlacedAndPainted) {
    write(R"({"id": "off", "type": "translate", "inputs": {"surface": {"from": "peg"}, "offset": [3, 0, 0]}},
             {"id": "ring", "type": "polar_repeat", "inputs": {"surface": {"from": "off"}, "count": 9}},
             {"id": "put", "type": "transform", "inputs": {"surface": {"from": "ring"},
              "translation": [5, 1, 2], "rotation": [20, 30, 40], "scale": 2}},
             {"id": "all", "type": "material",
              "inputs": {"surface": {"from": "put"}, "base_color": [0, 0, 1]}})",
          128);
    expectCopies(9);
    EXPECT_EQ(document("nodes.gltf")["materials"].size(), 1u);
}

TEST_F(Instances, OfMirrorImages) {
    write(
        R"({"id": "off", "type": "translate", "inputs": {"surface": {"from": "peg"}, "offset": [2, 0.5, 1]}},
           {"id": "all", "type": "mirror",
            "inputs": {"surface": {"from": "off"}, "normal": [1, 0.5, 0.2]}})");
    expectCopies(2);
    EXPECT_EQ(document("gpu.gltf")["nodes"].size(), 4u);
}

TEST_F(Instances, OfScatteredSolidsOfManySizes) {
    write(R"({"id": "all", "type": "scatter",
              "inputs": {"surface": {"from": "peg"}, "period": [2, 0, 2], "chance": 0.7, "seed": 4}})",
          200);
    // The region cuts no copy, for it was chosen so.
    const std::string notes =
        exported("nodes.gltf", {"--instances", "--region", "-7", "-1", "-7", "7", "1", "7"});
    const json file = document("nodes.gltf");
    std::size_t copies = 0, turned = 0, sized = 0;
    for (const json& node : file["nodes"]) {
        copies += node.contains("mesh");
        turned += node.contains("rotation"), sized += node.contains("scale");
    }
    EXPECT_GT(copies, 20u);
    EXPECT_GE(turned, copies - 1 - file["meshes"].size());
    EXPECT_GE(sized, copies - 1 - file["meshes"].size());
    exported("plain.gltf", {"--region", "-7", "-1", "-7", "7", "1", "7"});
    const Result<Report> plain = reportOnFile(folder.path("plain.gltf")),
                         shared = reportOnFile(folder.path("nodes.gltf"));
    ASSERT_TRUE(plain && shared);
    EXPECT_EQ(shared->bodies(), plain->bodies());
    EXPECT_NEAR(shared->volume, plain->volume, 0.05 * plain->volume);
}

TEST_F(Instances, OfCopiesOfCopies) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    write(
        R"({"id": "off", "type": "translate", "inputs": {"surface": {"from": "peg"}, "offset": [1.5, 0, 0]}},
             {"id": "ring", "type": "polar_repeat", "inputs": {"surface": {"from": "off"}, "count": 5}},
             {"id": "all", "type": "repeat", "inputs": {"surface": {"from": "ring"}, "period": [5, 0, 5],
              "count": [2, 1, 2]}})",
        160);
    expectCopies(4, 0, 0.05);
}

TEST_F(Instances, OfAGroupAndOfCode) {
    write(R"({"id": "all", "type": "expression", "inputs": {"a": {"from": "peg"}},
              "code": "float k = clamp(floor(p.x / 2 + 0.5), -2, 1);\nreturn a(p - vec3(2 * k, 0, 0));"})");
    expectCopies(4);
}

TEST_F(Instances, StandOnGroundThatIsNoCopy) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "some ten seconds: with FIELDWRIGHT_LONG";
    const std::string pegs =
        R"({"id": "pegs", "type": "repeat",
            "inputs": {"surface": {"from": "peg"}, "period": [1.5, 0, 0], "count": [4, 1, 1]}},
           {"id": "plate", "type": "box", "inputs": {"half_extents": [4, 0.25, 2]}},
           {"id": "ground", "type": "translate", "inputs": {"surface": {"from": "plate"}, "offset": [0, )";
    const std::string all =
        R"(, 0]}}, {"id": "all", "type": "union", "inputs": {"a": {"from": "pegs"}, "b": {"from": "ground"}}})";
    write(pegs + "-1.5" + all);
    EXPECT_EQ(expectCopies(4, 1), "");
    write(pegs + "-0.4" + all);  // each 0.1 deep in it
    const std::string notes = expectCopies(4, 1, 0.1);
    EXPECT_NE(notes.find("solids that reach into each other are each whole"), std::string::npos) << notes;
}

TEST_F(Instances, ThatARegionCutsAreAMesh) {
    write(
        R"({"id": "all", "type": "repeat", "inputs": {"surface": {"from": "peg"}, "period": [1.5, 0, 0]}})");
    const std::string notes = expectCopies(3, 1, 0.05, {"--region", "-3", "-1", "-1", "3", "1", "1"});
    EXPECT_NE(notes.find("'all': 3 copies share a mesh, and the rest is another"), std::string::npos)
        << notes;
}

TEST_F(Instances, ThatAreNotAlikeOrNotApartAreOneMesh) {
    write(R"({"id": "all", "type": "repeat",
              "inputs": {"surface": {"from": "peg"}, "period": [0.9, 0, 0], "count": [3, 1, 1]}})");
    expectWhole("'all' is one mesh, for its copies do not stand apart");
    // A cell's border cuts them.
    write(R"({"id": "all", "type": "repeat", "inputs": {"surface": {"from": "peg"}, "neighbours": false,
              "period": [0.9, 0, 2], "count": [1, 1, 3]}},
             {"id": "unused", "type": "sphere"})");
    expectCopies(3);
    write(
        R"({"id": "side", "type": "translate", "inputs": {"surface": {"from": "peg"}, "offset": [0.4, 0, 0]}},
             {"id": "all", "type": "expression", "inputs": {"a": {"from": "side"}},
              "code": "float k = clamp(floor(p.x / 1.5 + 0.5), -1, 1);\ns = a(p - vec3(1.5 * k, 0, 0));\nreturn with_distance(s, max(s.distance, abs(p.x - 1.5 * k) - 0.7));"})");
    expectWhole("are not whole");
    write(R"({"id": "pegs", "type": "repeat",
              "inputs": {"surface": {"from": "peg"}, "period": [1.5, 0, 0], "count": [3, 1, 1]}},
             {"id": "hue", "type": "expression", "inputs": {}, "code": "return vec3(0.5 + 0.2 * p.x, 0, 0);"},
             {"id": "all", "type": "material",
              "inputs": {"surface": {"from": "pegs"}, "base_color": {"from": "hue"}}})");
    expectWhole("are not of the same material");
    // Of a size that depends on the copy's number, though the map is that of a plain repeat.
    write(R"({"id": "all", "type": "expression", "inputs": {"a": {"from": "peg"}},
              "code": "float k = clamp(floor(p.x / 2 + 0.5), -1, 1);\ns = a(p - vec3(2 * k, 0, 0));\nreturn with_distance(s, s.distance - 0.05 * k);"})");
    expectWhole("are not whole");
    // Nothing is copied: a blend makes one of all, and there is no copy in a twist.
    write(R"({"id": "pegs", "type": "repeat",
              "inputs": {"surface": {"from": "peg"}, "period": [1.5, 0, 0], "count": [3, 1, 1]}},
             {"id": "bar", "type": "box", "inputs": {"half_extents": [3, 0.1, 0.1]}},
             {"id": "all", "type": "union",
              "inputs": {"a": {"from": "pegs"}, "b": {"from": "bar"}, "radius": 0.05}})");
    expectWhole("nothing in it is a copy by itself");
    write(R"({"id": "all", "type": "twist", "inputs": {"surface": {"from": "peg"}}})");
    expectWhole("nothing in it is a copy by itself");
}

TEST_F(Instances, HaveTheUnitOfTheFile) {
    write(R"({"id": "off", "type": "translate", "inputs": {"surface": {"from": "peg"}, "offset": [3, 0, 0]}},
             {"id": "all", "type": "polar_repeat", "inputs": {"surface": {"from": "off"}, "count": 6}})");
    std::string text = readText(graph);
    text.insert(1, "\"unit\": \"mm\", ");
    test::writeText(graph, text);
    for (const char* form : {"nodes", "gpu"}) {
        exported("a.gltf", {"--instances", form, "--report", folder.path("report.json")});
        const Result<Report> report = reportOnFile(folder.path("a.gltf"));
        ASSERT_TRUE(report) << format(report.error());
        EXPECT_NEAR(report->boundsMax[0], 0.0035, 0.0001);
        const json measured = document("report.json");
        EXPECT_NEAR(measured["boundsMax"][0].get<double>(), 3.5, 0.1);
        EXPECT_EQ(measured["bodies"], 6);
        EXPECT_LT(measured["meshToSurfaceMax"].get<double>(), 0.1);
    }
}

TEST_F(Instances, AreRefusedWithWhatTheyDoNotGoWith) {
    write(R"({"id": "all", "type": "repeat", "inputs": {"surface": {"from": "peg"}, "count": [2, 1, 1]}})");
    const auto refuse = [&](const char* file, const std::vector<std::string>& more, const char* says) {
        std::vector<std::string> words = {"export", graph, "-o", folder.path(file), "--instances"};
        words.insert(words.end(), more.begin(), more.end());
        const CommandResult result = runCommand(words);
        EXPECT_EQ(result.status, 2) << says;
        EXPECT_NE(result.errors.find(says), std::string::npos) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(folder.path(file)));
    };
    refuse("a.stl", {}, "in .glb and .gltf alone: leave --instances out for .stl");
    refuse("a.glb", {"many"}, "'many' is none of nodes, gpu");
    refuse("a.glb", {"nodes", "--animated"}, "--animated");
    refuse("a.glb", {"gpu", "--tiles", "2"}, "--tiles");
    refuse("a.glb", {"gpu", "--manifold"}, "--manifold");
    refuse("a.glb", {"gpu", "--textures", "256"}, "--textures");
}

TEST_F(Instances, TenThousandCopiesAreAFewKilobytes) {
    write(R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.4}},
             {"id": "all", "type": "repeat",
              "inputs": {"surface": {"from": "ball"}, "period": [1, 0, 1], "count": [100, 1, 100]}})",
          500);
    EXPECT_EQ(exported("a.gltf", {"--instances", "gpu"}), "");
    const json file = document("a.gltf");
    EXPECT_EQ(file["meshes"].size(), 1u);
    EXPECT_EQ(file["accessors"].back()["count"], 10'000);
    EXPECT_LT(std::filesystem::file_size(folder.path("a.bin")), 10'000u * 40 + 20'000u);
    EXPECT_EQ(exported("b.gltf", {"--instances"}), "");
    EXPECT_EQ(document("b.gltf")["nodes"].size(), 10'002u);
    EXPECT_EQ(document("b.gltf")["nodes"][2]["translation"], (json{-49.5, 0.0, -49.5}));
}

}  // namespace fw::instances_test
