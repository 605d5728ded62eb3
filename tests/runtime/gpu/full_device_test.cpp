// Devices without the memory that a mesh needs: an export is meshed in tiles, a picture has half of the
// cells, and both say so; what does not fit at all is refused with words.
#include <gtest/gtest.h>

#include <filesystem>

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "tests/support/command.h"
#include "tests/support/faults.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/vulkan_calls.h"

namespace fw::full_device_test {

using test::CommandResult;
using test::Fault;
using test::Faults;
using test::readText;

const std::string kTower = FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json";

CommandResult run(std::vector<std::string> words, const Fault& fault) {
    words.insert(words.begin() + 1, kTower);
    return test::runCommand(words, {.environment = Faults::environment(fault)});
}

TEST(FullDevice, AnExportIsMeshedInTilesAndSaysSo) {
    const test::TempDir folder;
    const std::string mesh = folder.path("a.ply");
    const std::vector<std::string> words = {"export", "--resolution", "256", "-o", mesh};
    ASSERT_EQ(run(words, {}).status, 0);
    const std::size_t whole = readText(mesh).size();
    // Nor is there room for tiles of the usual side, which are as large.
    for (const Fault& fault : {Fault{.memory = 30 << 20}, {.memory = 24 << 20}, {.mapped = 14 << 20}}) {
        std::filesystem::remove(mesh);
        const CommandResult result = run(words, fault);
        EXPECT_EQ(result.status, 0) << result.errors;
        EXPECT_NE(result.errors.find("it is meshed in tiles instead"), std::string::npos) << result.errors;
        EXPECT_EQ(readText(mesh).size(), whole);  // in another order
        EXPECT_FALSE(std::filesystem::exists(mesh + ".tiles"));
    }
    std::filesystem::remove(mesh);
    const CommandResult small = run(words, {.memory = 1 << 20});
    test::expectRefusal(small, 3, {"is out of memory", "a lower resolution needs less"});
    const CommandResult asked =
        run({"export", "--resolution", "256", "--tiles", "2", "-o", mesh}, {.memory = 4 << 20});
    test::expectRefusal(asked, 3, {"is out of memory", "take more --tiles"});
    const std::string whole3mf = folder.path("a.3mf");
    test::expectRefusal(run({"export", "--resolution", "256", "-o", whole3mf}, {.memory = 12 << 20}), 3,
                        {"is out of memory", "or let it be meshed in tiles"});
    EXPECT_FALSE(std::filesystem::exists(mesh) || std::filesystem::exists(whole3mf));
    const CommandResult measured = run(
        {"export", "--resolution", "256", "--require", "closed,manifold", "-o", mesh}, {.memory = 24 << 20});
    EXPECT_EQ(measured.status, 0) << measured.errors;
}

TEST(FullDevice, APictureHasHalfOfTheCellsAndSaysSo) {
    const test::TempDir folder;
    const std::string picture = folder.path("a.png");
    const std::vector<std::string> words = {"render", "--resolution", "512",  "--size", "64x48", "--samples",
                                            "1",      "-o",           picture};
    const CommandResult half = run(words, {.memory = 60'000'000});
    EXPECT_EQ(half.status, 0) << half.errors;
    EXPECT_NE(half.errors.find("a mesh of 512 cells along its longest side does not fit into the device: it "
                               "has 256 (device "),
              std::string::npos)
        << half.errors;
    EXPECT_TRUE(std::filesystem::exists(picture));
    test::expectRefusal(run(words, {.memory = 4'000'000}), 3, {"is out of memory"});
}

TEST(FullDevice, APlayersMeshIsAsItWouldBeWithHalfOfTheCells) {
    const auto played = [&](int resolution) {
        const Result<Graph> graph = readGraph(kTower, nullptr);
        EXPECT_TRUE(graph);
        Result<Device> device = createDevice({.validation = true});
        EXPECT_TRUE(device);
        Result<Player> player = Player::create(*graph, std::move(*device), {.resolution = resolution});
        EXPECT_TRUE(player);
        return std::move(*player);
    };
    Player whole = played(256), quarter = played(64);
    EXPECT_FALSE(whole.coarser());
    const_cast<Device&>(whole.device()).limits.allocation = 2 << 20;  // which the player owns
    const Result<Mesh> mesh = whole.mesh(), expected = quarter.mesh();
    ASSERT_TRUE(mesh && expected);
    EXPECT_EQ(whole.resolution(), 64);
    ASSERT_TRUE(whole.coarser());
    EXPECT_EQ(whole.coarser()->severity, Error::Severity::warning);
    EXPECT_GT(mesh->indices.size(), expected->indices.size() / 2);
    EXPECT_LT(mesh->indices.size(), expected->indices.size() * 2);
    // With other options it is tried with all of its cells.
    const Graph graph = whole.graph();
    ASSERT_TRUE(whole.reload(graph, {.resolution = 48}));
    ASSERT_TRUE(whole.mesh());
    EXPECT_FALSE(whole.coarser());
}

TEST(FullDevice, WhatOtherProgramsHaveIsHeeded) {
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    device->has.memoryBudget = true;
    test::setBudget(20 << 20);
    EXPECT_NO_THROW(createBuffer(*device, 18 << 20));
    try {
        createBuffer(*device, 24 << 20);
        ADD_FAILURE() << "more than the budget was allocated";
    } catch (const DeviceTooSmall& error) {
        EXPECT_NE(std::string(error.what()).find("does not fit into the 20 MiB that are left beside"),
                  std::string::npos)
            << error.what();
    }
    test::setBudget(0);
}

}  // namespace fw::full_device_test
