// What an export leaves behind when it cannot finish: unwritable places, full disks, Ctrl-C, broken caches.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::command_output_test {

using test::CommandOptions;
using test::CommandResult;
using test::expectRefusal;
using test::runCommand;
using test::TempDir;
namespace fs = std::filesystem;

constexpr const char* kGyroid = R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere"},
  {"id": "weave", "type": "gyroid", "inputs": {"period": 0.25, "thickness": 0.04}},
  {"id": "cut", "type": "intersect", "inputs": {"a": {"from": "ball"}, "b": {"from": "weave"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "cut"}}}]})";

struct CommandOutput : testing::Test {
    TempDir input, folder;
    std::string graph = input.path("gyroid.field.json");
    void SetUp() override { test::writeText(graph, kGyroid); }
    std::vector<std::string> to(const std::string& output, const std::string& resolution = "64") const {
        return {"export", graph, "-o", output, "--resolution", resolution};
    }
};

TEST_F(CommandOutput, PlacesThatCannotBeWritten) {
    expectRefusal(runCommand(to(folder.path("none/a.glb"))), 3, {"none/a.glb: error", "No such file"});
    fs::create_directory(folder.path("folder.glb"));
    expectRefusal(runCommand(to(folder.path("folder.glb"))), 3, {"folder.glb: error"});
    EXPECT_EQ(folder.names(), std::vector<std::string>{"folder.glb"});
    expectRefusal(runCommand(to("/proc/a.glb")), 3, {"/proc/a.glb: error"});
    expectRefusal(runCommand(to("/dev/null/a.glb")), 3, {"/dev/null/a.glb: error"});
    std::vector<std::string> arguments = to(folder.path("a.glb"));
    arguments.insert(arguments.end(), {"--report", folder.path("none/report.json")});
    expectRefusal(runCommand(arguments), 3, {"none/report.json: error"});
}

TEST_F(CommandOutput, AFullQuotaKeepsTheOldFile) {
    for (const char* extension : {".glb", ".gltf", ".obj", ".stl", ".ply", ".3mf", ".vdb"}) {
        const std::string path = folder.path(std::string("a") + extension);
        test::writeText(path, "before");
        CommandOptions options;
        options.maxFileBytes = 100'000;
        expectRefusal(runCommand(to(path), options), 3, {path.substr(0, path.size() - 4), "error"});
        EXPECT_EQ(test::readText(path), "before");
        fs::remove(path);
        EXPECT_TRUE(folder.names().empty());
    }
}

TEST_F(CommandOutput, AFullDiskKeepsTheOldFile) {
    const std::string disk = folder.path("disk");
    fs::create_directory(disk);
    const std::string mount = "mount -t tmpfs -o size=64k none '" + disk + "' && ";
    if (test::runProgram("unshare -rm sh -c \"" + mount + "true\"").status != 0)
        GTEST_SKIP() << "mounting is not permitted here";
    CommandOptions options;
    // The words after the script are its "$0" "$@": the program and its arguments.
    options.wrapper = {"unshare", "-rm", "sh", "-c",
                       mount + "printf before > '" + disk + "/a.stl' && \"$0\" \"$@\"; status=$?; ls -A '" +
                           disk + "' >&2; cat '" + disk + "/a.stl' >&2; echo >&2; exit $status"};
    expectRefusal(runCommand(to(disk + "/a.stl"), options), 3,
                  {"a.stl: error", "No space left", "\na.stl\nbefore\n"});
}

TEST_F(CommandOutput, AFullDiskOfTheCachesIsNoMatter) {
    const std::string disk = folder.path("disk");
    fs::create_directory(disk);
    const std::string mount = "mount -t tmpfs -o size=1m none '" + disk + "' && ";
    if (test::runProgram("unshare -rm sh -c \"" + mount + "true\"").status != 0)
        GTEST_SKIP() << "mounting is not permitted here";
    CommandOptions options;
    options.environment = {"XDG_CACHE_HOME=" + disk};
    options.wrapper = {"unshare", "-rm", "sh", "-c",
                       mount + "mkdir '" + disk + "/mesa_shader_cache' && truncate -s 1310728 '" + disk +
                           "/mesa_shader_cache/index' && { cat /dev/zero > '" + disk +
                           "/full' 2> /dev/null; \"$0\" \"$@\"; }"};
    if (std::getenv("MESA_SHADER_CACHE_DIR")) options.environment.push_back("MESA_SHADER_CACHE_DIR=" + disk);
    const CommandResult result = runCommand(to(folder.path("a.stl"), "16"), options);
    EXPECT_EQ(result.status, 0) << result.errors;
}

TEST_F(CommandOutput, CtrlCStopsCleanlyAtAnyTime) {
    test::writeText(folder.path("a.stl"), "before");
    int interrupted = 0;
    for (int delay : {0, 5, 20, 50, 100, 200, 400, 800}) {
        CommandOptions options;
        options.interruptAfterMs = delay;
        const CommandResult result = runCommand(to(folder.path("a.stl"), "256"), options);
        EXPECT_EQ(folder.names(), std::vector<std::string>{"a.stl"}) << "after " << delay << " ms";
        EXPECT_LT(result.peakMegabytes, test::kMostMegabytes);
        // Done before, or interrupted between the mesh and the end.
        if (result.status == 0 || result.errors == "fieldwright: interrupted; the mesh was written\n") {
            EXPECT_GT(fs::file_size(folder.path("a.stl")), 100'000u);
            test::writeText(folder.path("a.stl"), "before");
            continue;
        }
        ++interrupted;
        EXPECT_EQ(result.status, 130) << result.errors;
        EXPECT_EQ(test::readText(folder.path("a.stl")).substr(0, 100), "before")
            << "after " << delay << " ms";
        if (!result.killed) {  // by the signal itself, before the command was read
            EXPECT_EQ(result.errors, "fieldwright: interrupted; nothing was written\n");
        }
    }
    EXPECT_GT(interrupted, 0);
}

TEST_F(CommandOutput, CtrlCEndsACompilationOfTheDriver) {
    // Takes the driver minutes, in which it looks at nothing.
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "expression", "code":
        "d = length(p) - 1; for (int i = 0; i < 200; i++) d += 0.0001 * perlin(p * (1 + i), i); return d;"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}]})");
    CommandOptions options;
    options.interruptAfterMs = 3000;
    const CommandResult result =
        runCommand({"render", graph, "-o", folder.path("a.png"), "--quality", "full"}, options);
    EXPECT_EQ(result.status, 130);
    EXPECT_TRUE(result.errors.ends_with("fieldwright: interrupted; nothing was written\n")) << result.errors;
    EXPECT_LT(result.cpuSeconds, 20.0);
    EXPECT_TRUE(folder.names().empty());
}

TEST_F(CommandOutput, TheGraphAndOtherOutputsAreNotReplaced) {
    const std::string mesh = folder.path("a.glb"), text = test::readText(graph);
    const auto refused = [&](const std::string& output, const std::string& report, const std::string& said) {
        SCOPED_TRACE(output + " " + report);
        std::vector<std::string> words = to(output, "8");
        if (!report.empty()) words.insert(words.end(), {"--report", report});
        expectRefusal(runCommand(words), 2, {said});
        EXPECT_EQ(test::readText(graph), text);
        EXPECT_EQ(input.names().size(), 1u);
    };
    fs::create_symlink(graph, folder.path("link.stl"));
    refused(mesh, graph, "gyroid.field.json: error: this would replace the graph");
    refused(mesh, input.path("./gyroid.field.json"), "this would replace the graph");
    refused(folder.path("link.stl"), "", "this would replace the graph");
    refused(mesh, mesh, "two outputs would go to this file");
    refused(mesh, folder.path("./a.glb"), "two outputs would go to this file");
    refused(folder.path("a.gltf"), folder.path("a.bin"), "two outputs would go to this file");
    refused(folder.path("a.obj"), folder.path("a.mtl"), "two outputs would go to this file");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"link.stl"});

    for (const char* name : {"b.bin", "b.mtl", "b.png"}) fs::copy_file(graph, folder.path(name));
    for (const auto& [from, to] : {std::pair("b.bin", "b.gltf"), std::pair("b.mtl", "b.obj")}) {
        expectRefusal(runCommand({"export", folder.path(from), "-o", folder.path(to)}), 2, {"the graph"});
        EXPECT_EQ(test::readText(folder.path(from)), text);
    }
    expectRefusal(runCommand({"render", folder.path("b.png"), "-o", folder.path("b.png")}), 2, {"the graph"});
    EXPECT_EQ(test::readText(folder.path("b.png")), text);
}

TEST_F(CommandOutput, NothingThatTheGraphReadsIsReplaced) {
    fs::create_directory(input.path("sub"));
    const std::string mesh = input.path("sub/m.gltf"), image = input.path("i.png"),
                      cloud = input.path("p.xyz");
    const auto words = [](const std::string& path) { return test::readText(path); };
    ASSERT_EQ(runCommand(to(mesh, "16")).status, 0);
    ASSERT_EQ(runCommand({"render", graph, "-o", image, "--size", "32x32", "--samples", "1"}).status, 0);
    fs::copy_file(image, input.path("c.png"));
    test::writeText(cloud, "0 0 0\n");
    const std::string all = input.path("all.field.json");
    test::writeText(all, R"({"fieldwright": 1, "nodes": [
      {"id": "file", "type": "mesh_file", "inputs": {"path": "sub/m.gltf"}},
      {"id": "solid", "type": "mesh_to_field", "inputs": {"mesh": {"from": "file"}}},
      {"id": "paint", "type": "triplanar", "inputs": {"image": "i.png", "surface": {"from": "solid"}}},
      {"id": "coat", "type": "material", "inputs": {"surface": {"from": "solid"}, "base_color": {"from": "paint"}}},
      {"id": "cloud", "type": "particle_file", "inputs": {"path": "p.xyz"}},
      {"id": "code", "type": "expression", "code": "return length(p) - image_grey(\"c.png\", p.x, p.y);"},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "coat"}, "b": {"from": "code"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}}]})");
    fs::create_symlink(image, folder.path("link.png"));
    fs::create_hard_link(cloud, folder.path("twin.ply"));
    const std::string buffer = input.path("sub/m.bin");
    const std::vector<std::string> read = {mesh, buffer, image, cloud, input.path("c.png")};
    std::vector<std::string> before;
    for (const std::string& file : read) before.push_back(words(file));
    const std::string other = folder.path("new.ply");
    for (const auto& [arguments, name] :
         {std::pair(std::vector<std::string>{"export", all, "-o", mesh}, "'m.gltf', which is read"),
          {{"export", all, "-o", input.path("sub/../sub/m.gltf")}, "'m.gltf'"},
          {{"export", all, "-o", other, "--report", buffer}, "'m.bin'"},
          {{"export", all, "-o", other, "--report", cloud}, "'p.xyz'"},
          {{"export", all, "-o", folder.path("twin.ply")}, "'p.xyz'"},
          {{"export", all, "-o", other, "--tiles", "2", "--region", "0", "0", "0", "1", "1", "1", "--report",
            image},
           "'i.png'"},
          {{"render", all, "-o", image}, "'i.png'"},
          {{"render", all, "-o", folder.path("link.png")}, "'i.png'"}}) {
        SCOPED_TRACE(arguments[3]);
        expectRefusal(runCommand(arguments), 2, {name});
    }
    for (std::size_t i = 0; i < read.size(); ++i) EXPECT_TRUE(words(read[i]) == before[i]) << read[i];
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"link.png", "twin.ply"}));
}

TEST_F(CommandOutput, FramesDoNotReplaceWhatTheGraphReads) {
    const std::string image = input.path("000001.png");
    ASSERT_EQ(runCommand({"render", graph, "-o", image, "--size", "32x32", "--samples", "1"}).status, 0);
    const std::string text = test::readText(image);
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere"},
      {"id": "paint", "type": "triplanar", "inputs": {"image": "000001.png", "surface": {"from": "ball"}}},
      {"id": "coat", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": {"from": "paint"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "coat"}}}]})");
    for (const char* more : {"--overwrite", "--reference"})
        expectRefusal(
            runCommand({"render", graph, "-o", input.folder.string(), "--to", "1", "--fps", "4", more}), 2,
            {"000001.png", "which is read"});
    EXPECT_EQ(test::readText(image), text);
}

TEST_F(CommandOutput, PipesAreNoGraphsAndNoFrames) {
    ASSERT_EQ(mkfifo(folder.path("pipe.field.json").c_str(), 0600), 0);
    expectRefusal(runCommand({"export", folder.path("pipe.field.json"), "-o", folder.path("a.stl")}), 1,
                  {"pipe.field.json"});
    const std::string frames = folder.path("frames");
    fs::create_directory(frames);
    ASSERT_EQ(mkfifo((frames + "/000000.png").c_str(), 0600), 0);
    expectRefusal(
        runCommand({"render", graph, "-o", frames, "--to", "0.1", "--fps", "10", "--size", "32x32"}), 2,
        {"000000.png", "no ordinary file"});
}

TEST_F(CommandOutput, RunIsFoundThroughALink) {
    const std::string home = folder.path("home");
    for (const char* part : {"graph", "runtime", "shaders", "tests/bench", "build/release"})
        fs::create_directories(home + "/" + part);
    fs::copy_file(FIELDWRIGHT_SOURCE_DIR "/run", home + "/run");
    for (const char* file : {"CMakeLists.txt", "CMakePresets.json"}) test::writeText(home + "/" + file, "");
    for (const char* program : {"/.install", "/build/release/fieldwright"}) {
        test::writeText(home + program, "#!/bin/sh\necho called \"$@\"\n");
        fs::permissions(home + program, fs::perms::owner_all);
    }
    test::writeText(home + "/build/release/fieldwright.up_to_date", "");
    fs::create_symlink("home/run", folder.path("link"));
    const test::ProgramResult result = test::runProgram("sh '" + folder.path("link") + "' info 'a b'");
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_NE(result.output.find("called info a b\n"), std::string::npos) << result.output;
}

TEST_F(CommandOutput, PathsOfAllKinds) {
    const fs::path before = fs::current_path();
    fs::current_path(folder.folder);
    EXPECT_EQ(runCommand(to("a.stl", "8")).status, 0);  // relative, new
    EXPECT_EQ(runCommand(to("./a.STL", "8")).status, 0);
    EXPECT_EQ(runCommand(to("ä b.obj", "8")).status, 0);
    fs::create_directory("deep");
    EXPECT_EQ(runCommand(to("deep/../deep/a.ply", "8")).status, 0);
    fs::create_symlink("deep/b.ply", "link.ply");
    test::writeText("deep/b.ply", "before");
    EXPECT_EQ(runCommand(to("link.ply", "8")).status, 0);
    fs::current_path(before);
    EXPECT_EQ(test::readText(folder.path("link.ply")).substr(0, 3), "ply");
    EXPECT_EQ(test::readText(folder.path("a.stl")), test::readText(folder.path("a.STL")));
    EXPECT_EQ(folder.names().size(), 6u);  // those and the .mtl beside the .obj
}

TEST_F(CommandOutput, BrokenCachesAreMadeAnew) {
    CommandOptions options;
    options.environment = {"XDG_CACHE_HOME=" + folder.path("cache")};
    const auto mesh = [&] {
        const CommandResult result = runCommand(to(folder.path("a.stl"), "16"), options);
        EXPECT_EQ(result.status, 0) << result.errors;
        EXPECT_EQ(result.errors.find("error"), std::string::npos)
            << result.errors;  // the driver may add its own
        return test::readText(folder.path("a.stl"));
    };
    const std::string first = mesh();
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path("cache/fieldwright")))
        if (entry.is_regular_file()) files.push_back(entry.path());
    ASSERT_FALSE(files.empty());
    for (const fs::path& file : files) fs::resize_file(file, fs::file_size(file) / 2);
    EXPECT_EQ(mesh(), first) << "truncated";
    for (const fs::path& file : files) {
        std::string bytes = test::readText(file.string());
        for (std::size_t i = bytes.size() / 2; i < bytes.size(); i += 97) bytes[i] ^= 0x5A;
        test::writeText(file.string(), bytes);
    }
    EXPECT_EQ(mesh(), first) << "with flipped bits";
    for (const fs::path& file : files) test::writeText(file.string(), "");
    EXPECT_EQ(mesh(), first) << "emptied";
    std::string valid;
    for (const fs::path& file : files)
        if (file.extension() == ".spv") valid = test::readText(file.string());
    ASSERT_FALSE(valid.empty());
    for (const fs::path& file : files) test::writeText(file.string(), valid);
    EXPECT_EQ(mesh(), first) << "another's content";
    for (const fs::path& file : files) {
        fs::remove(file);
        ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    }
    EXPECT_EQ(mesh(), first) << "pipes";
    for (const fs::path& file : files) fs::remove(file), fs::create_directory(file);
    EXPECT_EQ(mesh(), first) << "folders";

    test::writeText(folder.path("no_folder"), "");
    options.environment = {"XDG_CACHE_HOME=" + folder.path("no_folder")};
    EXPECT_EQ(mesh(), first) << "a file where the folder should be";
    options.environment = {"XDG_CACHE_HOME=", "HOME="};
    EXPECT_EQ(mesh(), first) << "no place for a cache";
    options.environment = {"XDG_CACHE_HOME=/proc"};
    EXPECT_EQ(mesh(), first) << "a place that cannot be written";
}

}  // namespace fw::command_output_test
