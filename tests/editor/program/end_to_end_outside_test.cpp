// What another program does to the document's file while there are unsaved changes, in the real window.
#include <gtest/gtest.h>

#include "editor/files/versions.h"
#include "tests/support/editor/program.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::test::end_to_end_outside_test {

using fw::test::readText;
using fw::test::writeText;

constexpr const char* kBall =
    R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere", "at": [0, 0]},
        {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}}]})";
constexpr const char* kTheirs =
    R"({"fieldwright": 1, "nodes": [{"id": "theirs", "type": "torus", "at": [0, 0]}]})";
constexpr const char* kLater =
    R"({"fieldwright": 1, "nodes": [{"id": "later", "type": "torus", "at": [0, 0]}]})";

TEST(EndToEndOutside, MineIsKeptAndTheirsIsAVersion) {
    Program program(kBall);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.save();
    program.frameAll();
    program.click(program.title("ball"));
    program.keys("Delete");
    EXPECT_TRUE(eventually([&] { return program.title().find('*') != std::string::npos; }));
    writeText(program.file(), kTheirs);
    program.clickOn("Keep mine");
    program.waitUntilGone("Keep mine");
    EXPECT_EQ(readText(program.file()), kTheirs) << "until it is saved";
    // It was decided: saving asks no more, and what they wrote can be gone back to.
    program.save();
    EXPECT_EQ(program.saved().nodes.size(), 1u);
    std::vector<std::string> kept;
    for (const Version& version : versionsOf(program.file())) kept.push_back(readText(version.path));
    EXPECT_EQ(std::ranges::count(kept, kTheirs), 1);

    // Left undecided it is asked about again, by whoever saves.
    program.keys("Ctrl+A");
    program.keys("Delete");
    EXPECT_TRUE(eventually([&] { return program.title().find('*') != std::string::npos; }));
    writeText(program.file(), kLater);
    program.waitFor("Keep mine");
    program.keys("Escape");
    program.waitUntilGone("Keep mine");
    program.keys("Ctrl+S");
    program.waitFor("Save mine over it");
    EXPECT_EQ(readText(program.file()), kLater);
    program.clickOn("Save mine over it");
    EXPECT_TRUE(eventually([&] { return program.title().find('*') == std::string::npos; }));
    EXPECT_NE(readText(program.file()), kLater);
}

}  // namespace fw::editor::test::end_to_end_outside_test
