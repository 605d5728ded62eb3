// What an export leaves behind when it cannot finish: unwritable places, full disks, Ctrl-C, broken caches.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/command.h"
#include "tests/support/temp_dir.h"

namespace fw {
namespace {

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
    for (const char* extension : {".glb", ".gltf", ".obj", ".stl", ".ply"}) {
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

TEST_F(CommandOutput, CtrlCStopsCleanlyAtAnyTime) {
    test::writeText(folder.path("a.stl"), "before");
    int interrupted = 0;
    for (int delay : {0, 5, 20, 50, 100, 200, 400, 800}) {
        CommandOptions options;
        options.interruptAfterMs = delay;
        const CommandResult result = runCommand(to(folder.path("a.stl"), "256"), options);
        EXPECT_EQ(folder.names(), std::vector<std::string>{"a.stl"}) << "after " << delay << " ms";
        EXPECT_LT(result.peakMegabytes, 500.0);
        if (result.status == 0) {  // it was done before
            EXPECT_GT(fs::file_size(folder.path("a.stl")), 100'000u);
            test::writeText(folder.path("a.stl"), "before");
            continue;
        }
        ++interrupted;
        EXPECT_EQ(result.status, 130) << result.errors;
        EXPECT_EQ(test::readText(folder.path("a.stl")), "before") << "after " << delay << " ms";
        if (!result.killed) {  // by the signal itself, before the command was read
            EXPECT_EQ(result.errors, "fieldwright: interrupted; nothing was written\n");
        }
    }
    EXPECT_GT(interrupted, 0);
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

    test::writeText(folder.path("no_folder"), "");
    options.environment = {"XDG_CACHE_HOME=" + folder.path("no_folder")};
    EXPECT_EQ(mesh(), first) << "a file where the folder should be";
    options.environment = {"XDG_CACHE_HOME=", "HOME="};
    EXPECT_EQ(mesh(), first) << "no place for a cache";
    options.environment = {"XDG_CACHE_HOME=/proc"};
    EXPECT_EQ(mesh(), first) << "a place that cannot be written";
}

}  // namespace
}  // namespace fw
