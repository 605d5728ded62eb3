// Devices that are lost: the command, the player and its window go on with another, once, and what they make
// is as if nothing had been.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "tests/support/command.h"
#include "tests/support/faults.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::lost_device_test {

using test::CommandResult;
using test::Fault;
using test::Faults;
using test::readText;
using test::TempDir;
using test::writeText;

constexpr char kAgain[] = "the device was lost (its driver crashed or was reset): beginning again";
constexpr char kGivenUp[] = "and again after it was opened anew: lower the resolution";

/// A ball that rises for a second.
std::string ball(const std::string& color = "[0.8, 0.02, 0.02]") {
    return R"({"fieldwright": 1, "nodes": [
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
      {"id": "paint", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": )" +
           color + R"(}},
      {"id": "lift", "type": "translate", "inputs": {"surface": {"from": "paint"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "lift"}, "resolution": 32}}],
      "parameters": [{"name": "radius", "node": "ball", "input": "radius", "min": 0.1, "max": 0.8}],
      "timeline": {"length": 1, "fps": 4, "tracks": [{"node": "lift", "input": "offset.y",
        "keys": [{"time": 0, "value": 0}, {"time": 1, "value": 0.5}]}]}})";
}

struct LostDevice : testing::Test {
    TempDir folder;
    std::string graph = folder.path("a.field.json");
    void SetUp() override { writeText(graph, ball()); }

    CommandResult run(std::vector<std::string> words, const Fault& fault) const {
        words.insert(words.begin() + 1, graph);
        return test::runCommand(words, {.environment = Faults::environment(fault)});
    }
    bool says(const CommandResult& result, const std::string& words) const {
        return result.errors.find(words) != std::string::npos;
    }
};

TEST_F(LostDevice, AnExportIsMadeAgainFromItsStart) {
    const std::string mesh = folder.path("a.ply");
    ASSERT_EQ(run({"export", "-o", mesh}, {}).status, 0);
    const std::string whole = readText(mesh);
    for (const long at : {1, 6, -4, -9}) {
        std::filesystem::remove(mesh);
        const CommandResult result = run({"export", "-o", mesh}, {.lose = {at}});
        EXPECT_EQ(result.status, 0) << at << ": " << result.errors;
        EXPECT_TRUE(says(result, kAgain)) << at << ": " << result.errors;
        EXPECT_TRUE(readText(mesh) == whole) << at;
    }
    std::filesystem::remove(mesh);
    const std::string told = folder.path("lose");
    writeText(told, "2");
    const CommandResult result = run({"export", "-o", mesh}, {.loseWhenThere = told});
    EXPECT_EQ(result.status, 3);
    EXPECT_TRUE(says(result, kGivenUp)) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(mesh));
}

TEST_F(LostDevice, ASequenceGoesOnAtTheFrameThatWasLost) {
    const std::string told = folder.path("lose"), whole = folder.path("whole"), lost = folder.path("lost");
    const auto words = [&](const std::string& frames) {
        return std::vector<std::string>{"render", graph,    "-o",    frames,      "--fps",
                                        "40",     "--size", "48x32", "--samples", "2"};
    };
    ASSERT_EQ(test::runCommand(words(whole)).status, 0);
    const auto there = [&](const char* frame) { return std::filesystem::exists(lost + frame); };
    const auto loseAfter = [&](const char* frame, const char* times) {
        while (!there(frame) && !there("/000039.png")) test::rest(0.005);
        writeText(told, times);
        while (std::filesystem::exists(told) && !there("/000039.png")) test::rest(0.005);
    };
    test::CommandOptions options{.environment = Faults::environment({.loseWhenThere = told}), .signal = 0};
    options.meanwhile = [&] {
        loseAfter("/000000.png", "1");
        loseAfter("/000005.png", "1");
    };
    const CommandResult result = test::runCommand(words(lost), options);
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_TRUE(says(result, "going on at 0000")) << result.errors;
    EXPECT_FALSE(says(result, kAgain)) << result.errors;
    for (const auto& frame : std::filesystem::directory_iterator(whole))
        EXPECT_TRUE(readText(frame.path()) == readText(lost + "/" + frame.path().filename().string()))
            << frame.path();
    std::filesystem::remove_all(lost);
    options.meanwhile = [&] { loseAfter("/000003.png", "2"); };
    const CommandResult twice = test::runCommand(words(lost), options);
    EXPECT_EQ(twice.status, 3);
    EXPECT_TRUE(says(twice, kGivenUp)) << twice.errors;
    EXPECT_TRUE(there("/000003.png"));
}

TEST_F(LostDevice, APlayerGoesOnWithAnotherAsItWas) {
    const std::string told = folder.path("lose");
    const Faults faults({.loseWhenThere = told});
    const auto played = [&] {
        Result<Device> device = createDevice({.validation = true});
        EXPECT_TRUE(device);
        Result<Player> player = Player::create(*parseGraph(ball(), "", nullptr), std::move(*device));
        EXPECT_TRUE(player && player->set("radius", 0.3));
        return std::move(*player);
    };
    Player player = played(), undisturbed = played();
    for (Player* each : {&player, &undisturbed}) each->seek(0.75);
    for (const int when : {0, 1}) {
        if (when == 1) { ASSERT_TRUE(player.mesh()); }
        writeText(told, "1");
        player.seek(when == 0 ? 0.5 : 0.25);
        EXPECT_THROW((void)player.mesh(), DeviceLost);
        EXPECT_FALSE(std::filesystem::exists(told));
        player.renewDevice();
        const Result<Mesh> mesh = player.mesh();
        undisturbed.seek(player.time());
        const Result<Mesh> expected = undisturbed.mesh();
        ASSERT_TRUE(mesh && expected);
        EXPECT_EQ(mesh->positions, expected->positions);
        EXPECT_EQ(mesh->indices, expected->indices);
    }
    const RenderOptions picture{.width = 64, .height = 48, .samples = 2};
    writeText(told, "1");
    EXPECT_THROW((void)player.frame(picture), DeviceLost);
    player.renewDevice();
    const Result<Picture> drawn = player.frame(picture), expected = undisturbed.frame(picture);
    ASSERT_TRUE(drawn && expected);
    EXPECT_EQ(drawn->pixels, expected->pixels);
}

TEST_F(LostDevice, PlayGoesOnInItsWindow) {
    const test::VirtualDisplay display;
    NEEDS_DISPLAY(display);
    const auto eventually = [](auto holds) {
        for (int i = 0; i < 600; ++i, test::rest(0.1))
            if (holds()) return true;
        return false;
    };
    const std::string told = folder.path("lose"), errors = folder.path("errors");
    const Faults faults({.loseWhenThere = told});
    const pid_t process = fork();
    if (process == 0) {
        if (!std::freopen(errors.c_str(), "w", stderr)) _exit(126);
        execl(FIELDWRIGHT_BINARY_DIR "/fieldwright", "fieldwright", "play", graph.c_str(), "--size",
              "320x200", nullptr);
        _exit(127);
    }
    const auto middle = [&] { return display.pixel(160, 100); };
    EXPECT_TRUE(eventually([&] { return middle().r > middle().g + 40; })) << readText(errors);
    for (const std::string color : {"[0.02, 0.6, 0.02]", "[0.02, 0.02, 0.8]"}) {
        writeText(told, "1");
        EXPECT_TRUE(eventually([&] { return !std::filesystem::exists(told); })) << readText(errors);
        writeText(graph, ball(color));
        const bool green = color.starts_with("[0.02, 0.6");
        EXPECT_TRUE(eventually([&] { return (green ? middle().g : middle().b) > middle().r + 40; }))
            << readText(errors);
    }
    kill(process, SIGINT);
    int status = 0;
    waitpid(process, &status, 0);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 130) << readText(errors);
    const std::string said = readText(errors);
    EXPECT_NE(said.find("the device was lost (its driver crashed or was reset): going on"), std::string::npos)
        << said;
    EXPECT_EQ(said.find("validation layer"), std::string::npos) << said;
}

}  // namespace fw::lost_device_test
