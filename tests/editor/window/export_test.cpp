// Exports of the editor: the same bytes as the command's, what is refused, and that a cancelled one leaves
// no file.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "editor/files/export_job.h"
#include "editor/panels/export_dialog.h"
#include "graph/document/json.h"
#include "graph/document/unit.h"
#include "tests/support/command.h"
#include "tests/support/faults.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::export_test {

using Phase = ExportState::Phase;
using fw::test::readText;
using fw::test::TempDir;
using fw::test::writeText;

std::shared_ptr<const Graph> read(const std::string& path) {
    const Result<Graph> graph = readGraph(path, nullptr);
    EXPECT_TRUE(graph) << path;
    return std::make_shared<const Graph>(*graph);
}
std::string sample(const std::string& name) {
    return std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json";
}
std::shared_ptr<const Graph> parse(const std::string& nodes) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]}", "", nullptr);
    EXPECT_TRUE(graph);
    return std::make_shared<const Graph>(*graph);
}

ExportState finish(const ExportJob& job) {
    while (job.state().phase == Phase::running) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return job.state();
}

TEST(Export, OfFunctionsGivesTheBytesOfTheCommandAndNamesWhatTheyCannotSay) {
    const TempDir folder;
    const auto exported = [&](const std::string& name) {
        const ExportJob job({.graph = read(sample(name)), .path = folder.path("ours.3mf"), .functions = true},
                            {});
        return finish(job);
    };
    const ExportState part = exported("csg_part");
    ASSERT_EQ(part.phase, Phase::done) << part.stage;
    EXPECT_GT(part.functions, 10u);
    const std::string theirs = folder.path("ours.3MF");  // the file's name is in the file
    const auto command = fw::test::runCommand({"export", sample("csg_part"), "-o", theirs, "--implicit"});
    ASSERT_EQ(command.status, 0) << command.errors;
    EXPECT_EQ(readText(part.files.paths.front()), readText(theirs));
    const ExportState noisy = exported("landscape");
    ASSERT_EQ(noisy.phase, Phase::failed);
    EXPECT_NE(noisy.problems.front().message.find("random"), std::string::npos)
        << format(noisy.problems.front());
}

TEST(Export, GivesTheBytesOfTheCommand) {
    const TempDir folder;
    struct Case {
        const char *sample, *ending;
        std::vector<std::string> options;
        MeshRequest mesh = {};
        double seconds = 0.0;
        MeshWish file = {};
        int triangles = 0;
    };
    const Case cases[] = {
        {"tower", ".glb", {}},
        {"goblet", ".obj", {"--resolution", "70"}, {{}, 70}},
        {"cube_morph", ".gltf", {"--resolution", "48", "--time", "1.25"}, {{}, 48}, 1.25},
        {"island", ".ply", {"--resolution", "64"}, {{}, 64}},
        {"csg_part",
         ".stl",
         {"--resolution", "60", "--region", "-0.5", "-0.6", "-0.7", "0.8", "0.9", "1"},
         {Box{{-0.5, -0.6, -0.7}, {0.8, 0.9, 1}}, 60}},
        {"brick_block", ".3mf", {"--resolution", "50"}, {{}, 50}},
        {"mushroom", ".vdb", {"--resolution", "60"}, {{}, 60}},
        {"moving_booleans", ".glb", {"--resolution", "50", "--manifold"}, {{}, 50}, 0.0, {.manifold = true}},
        {"csg_part",
         ".glb",
         {"--lods", "3", "--textures", "256", "--compress", "--triangles", "4000", "--resolution", "40"},
         {{}, 40},
         0.0,
         {.compress = true, .textures = 256, .lods = 3},
         4000},
        {"table_and_stool", ".gltf", {"--parts", "--resolution", "40"}, {{}, 40}, 0.0, {.parts = true}},
        {"talk_1_box",
         ".stl",
         {"--unit", "cm", "--up", "z", "--resolution", "30"},
         {{}, 30},
         0.0,
         {.placement = {.unit = "cm", .up = "z"}}},
    };
    for (const Case& each : cases) {
        SCOPED_TRACE(each.sample);
        const std::string name = std::string(each.sample) + each.ending;
        std::filesystem::create_directories(folder.path(each.sample));
        // Files beside each other name each other, so both exports have the same name in folders of their
        // own.
        const std::string mine = folder.path(std::string(each.sample) + "/" + name),
                          theirs = folder.path(name);
        std::vector<std::string> arguments{"export", sample(each.sample), "-o", theirs};
        arguments.insert(arguments.end(), each.options.begin(), each.options.end());
        const fw::test::CommandResult command = fw::test::runCommand(arguments);
        ASSERT_EQ(command.status, 0) << command.errors;
        ExportJob job({.graph = read(sample(each.sample)),
                       .path = mine,
                       .mesh = each.mesh,
                       .seconds = each.seconds,
                       .file = each.file,
                       .triangles = each.triangles},
                      {});
        const ExportState state = finish(job);
        ASSERT_EQ(state.phase, Phase::done) << (state.problems.empty() ? "" : format(state.problems[0]));
        ASSERT_EQ(state.files.paths, exportedPaths(mine));
        uint64_t bytes = 0;
        for (const std::string& path : state.files.paths) {
            const std::string other = folder.path(std::filesystem::path(path).filename().string());
            EXPECT_TRUE(readText(path) == readText(other)) << path;
            bytes += std::filesystem::file_size(path);
        }
        EXPECT_EQ(state.files.bytes, bytes);
        EXPECT_EQ(soundness(state.report), "");
        EXPECT_EQ(state.part, 1.0f);
        const Result<Report> measured = reportOnFile(mine);
        if (!exportFormat(mine)->measurable) continue;
        ASSERT_TRUE(measured);
        EXPECT_EQ(state.report.triangles, measured->triangles);
        const Result<fw::Placement> placement = placementOf(mine, *lengthUnit("m"), each.file.placement);
        EXPECT_NEAR(state.report.volume * std::pow(placement->scale, 3), measured->volume,
                    (each.file.compress ? 1e-3 : 1e-5) * std::abs(measured->volume));
    }
}

TEST(Export, GoesInTilesWhereTheDeviceHasNoRoomOrTheCellsAreMany) {
    const TempDir folder;
    const std::string mesh = folder.path("a.ply");
    const auto made = [&](MeshRequest request, const std::string& path) {
        ExportJob job({.graph = read(sample("tower")), .path = path, .mesh = request}, {});
        ExportState state = finish(job);
        EXPECT_EQ(state.phase, Phase::done) << (state.problems.empty() ? "" : format(state.problems[0]));
        return state;
    };
    const ExportState whole = made({{}, 200}, mesh);
    EXPECT_FALSE(whole.tiled);
    {
        // Nor is there room for tiles of the usual side.
        const fw::test::Faults small{{.memory = 20 << 20}};
        const ExportState tiled = made({{}, 200}, mesh);
        EXPECT_TRUE(tiled.tiled && tiled.measured);
        EXPECT_EQ(tiled.report.triangles, whole.report.triangles);
        EXPECT_EQ(tiled.report.vertices, whole.report.vertices);
        EXPECT_EQ(tiled.report.shells, 1u);
        EXPECT_TRUE(tiled.report.closedManifold());
        EXPECT_NEAR(tiled.report.volume, whole.report.volume, 1e-9);
        ExportJob job({.graph = read(sample("tower")), .path = folder.path("a.3mf"), .mesh = {{}, 200}}, {});
        const ExportState refused = finish(job);
        EXPECT_EQ(refused.phase, Phase::failed);
        ASSERT_FALSE(refused.problems.empty());
        EXPECT_NE(format(refused.problems[0]).find("out of memory"), std::string::npos);
    }
    const MeshRequest slice{Box{{-1, -1.9, -1}, {1, -1.85, -0.9}}, 1100};
    EXPECT_TRUE(made(slice, mesh).tiled);
    const std::string other = folder.path("b.ply");
    const fw::test::CommandResult command =
        fw::test::runCommand({"export", sample("tower"), "-o", other, "--resolution", "1100", "--region",
                              "-1", "-1.9", "-1", "1", "-1.85", "-0.9"});
    EXPECT_EQ(command.status, 0) << command.errors;
    EXPECT_TRUE(readText(mesh) == readText(other));
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.ply", "b.ply"}));
}

TEST(Export, SaysWhyItCannotBeDone) {
    const TempDir folder;
    const std::string out = R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}})";
    const auto ball = parse(R"({"id": "a", "type": "sphere"})" + out);
    const auto refused = [&](std::shared_ptr<const Graph> graph, const std::string& path, const char* why,
                             DeviceOptions device = {}) {
        ExportJob job({.graph = std::move(graph), .path = path, .device = std::move(device)}, {});
        const ExportState state = finish(job);
        EXPECT_EQ(state.phase, Phase::failed) << why;
        ASSERT_FALSE(state.problems.empty()) << why;
        EXPECT_NE(format(state.problems[0]).find(why), std::string::npos) << format(state.problems[0]);
    };
    const std::string file = folder.path("a.stl");
    refused(ball, folder.path("a.xyz"), "unknown format");
    refused(ball, folder.path("none/a.stl"), "cannot create a file");
    refused(ball, file, "nosuchdevice", {.pick = "nosuchdevice"});
    refused(parse(R"({"id": "a", "type": "plane"})" + out), file, "is unbounded");
    refused(parse(R"({"id": "a", "type": "sphere", "inputs": {"radius": "x"}})" + out), file, "radius");
    Graph itself = *ball;
    itself.path = file;
    writeText(file, "the graph");
    refused(std::make_shared<const Graph>(itself), file, "would replace the graph");
    EXPECT_EQ(readText(file), "the graph");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.stl"});
}

TEST(Export, LeavesNoFileWhenCancelled) {
    const TempDir folder;
    const std::string file = folder.path("tower.glb");
    writeText(file, "before");
    const std::shared_ptr<const Graph> tower = read(sample("tower"));
    // At each stage in turn: cancelled by the one who hears of it.
    std::vector<std::string> stages;
    for (std::size_t at = 0; at < 20; ++at) {
        std::mutex making;
        std::vector<std::string> seen;
        ExportJob* heard =
            nullptr;  // not the owner's pointer, which is null while the job goes and may still tell
        std::unique_lock lock(making);
        auto job =
            std::make_unique<ExportJob>(ExportWish{.graph = tower, .path = file, .mesh = {{}, 64}}, [&] {
                std::lock_guard made(making);
                seen.push_back(heard->state().stage);
                if (seen.size() == at + 1) heard->cancel();
            });
        heard = job.get();
        lock.unlock();
        const ExportState state = finish(*job);
        job.reset();
        if (state.phase == Phase::done) {  // heard of the end when it was too late
            EXPECT_GE(at, 8u);
            EXPECT_NE(readText(file), "before");
            break;
        }
        EXPECT_EQ(state.phase, Phase::cancelled);
        EXPECT_EQ(readText(file), "before") << seen.back();
        EXPECT_EQ(folder.names(), std::vector<std::string>{"tower.glb"});
        stages = seen;
    }
    EXPECT_GE(stages.size(), 9u);
}

TEST(Export, SaysWhatIsWrongWithAMesh) {
    Report report;
    EXPECT_EQ(soundness(report), "");
    report.boundaryEdges = 1234;
    report.flippedEdges = 1;
    EXPECT_EQ(soundness(report), "1,234 open edges, 1 edges between triangles that face opposite ways");
}

}  // namespace fw::editor::export_test
