// The render dialog in the real window: a still, frames that are cancelled and gone on with, and what the
// screen says of them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "runtime/pictures/wish.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_render_test {

namespace fs = std::filesystem;

constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0]},
    {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 24}}],
  "timeline": {"length": 1, "fps": 3, "tracks": [{"node": "ball", "input": "radius", "keys": [
    {"time": 0, "value": 1}, {"time": 1, "value": 0.5}]}]}})";

class EndToEndRender : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
        program.save();
        program.keys("Ctrl+Shift+E");
        program.waitFor("Samples");
        // Small ones, since many are made.
        for (const auto& [before, now] : {std::pair("1280", "96"), std::pair("720", "64")}) {
            const Area line = program.waitFor("width, height");
            program.clickOn(before, Area{{line.hi.x, line.lo.y - 6}, {1280, line.hi.y + 6}});
            program.type(std::string(now) + "\n");
            program.waitFor(now, Area{{line.hi.x, line.lo.y - 6}, {1280, line.hi.y + 6}});
        }
    }
    /// The words in the line of the button that closes the dialog.
    void press(const std::string& words) {
        const Area close = program.waitFor("Close");
        program.clickOn(words, Area{{0, close.lo.y - 6}, {close.lo.x, close.hi.y + 6}});
    }
    /// A choice of the dialog's list of what to make.
    void make(const std::string& words) {
        program.clickOn("A picture");
        program.clickOn(words);
        program.waitFor("Folder");
    }
    void keepShot(const char* name) {
        if (const char* shots = std::getenv("FIELDWRIGHT_SHOTS"))
            (void)savePicture(program.screen(), std::string(shots) + "/" + name);
    }
    std::string beside(const std::string& ending) const {
        const fs::path file = program.file();
        const std::string stem = file.filename().string();
        return (file.parent_path() / (stem.substr(0, stem.find('.')) + ending)).string();
    }

    Program program{kDocument};
};

TEST_F(EndToEndRender, AStillIsMadeAndSeen) {
    press("Render");
    const std::string file = beside(".png");
    EXPECT_TRUE(eventually([&] { return fs::exists(file); }));
    program.waitFor("done");
    keepShot("still.png");
    EXPECT_EQ(sizeOfPicture(file, PictureFormat::png), std::pair(96, 64));
    program.waitFor("is there and will be replaced");
    program.clickOn("Take off the list");
    program.waitUntilGone("done");
    program.keys("Escape");
    program.waitUntilGone("Samples");
}

TEST_F(EndToEndRender, FramesAreMadeAndCounted) {
    make("Frames of the timeline");
    program.waitFor("3 frames.");
    press("Render");
    program.waitFor("3 frames made");
    program.waitFor("3 are there and stay as they are");
    keepShot("frames.png");
    for (const char* name : {"000000.png", "000001.png", "000002.png"})
        EXPECT_TRUE(fs::exists(beside("_frames") + "/" + name)) << name;
    EXPECT_FALSE(fs::exists(beside("_frames") + "/000003.png"));
    fs::remove(beside("_frames") + "/000001.png");
    press("Render");
    program.waitFor("1 frames made, 2 were there");
    EXPECT_TRUE(fs::exists(beside("_frames") + "/000001.png"));
}

TEST_F(EndToEndRender, ATurntableIsCancelledAndGoneOnWith) {
    make("A turntable");
    // So many that none of what follows comes too late.
    const Area line = program.waitFor("Once around in");
    const Area value{{line.hi.x, line.lo.y - 6}, {1280, line.hi.y + 6}};
    program.clickOn("4", value);
    program.type("3600\n");
    program.waitFor("10800 frames.");
    const std::string folder = beside("_turntable");
    const auto made = [&] {
        std::error_code none;
        fs::directory_iterator each(folder, none);
        return none ? 0 : std::distance(each, fs::directory_iterator());
    };
    press("Render");
    ASSERT_TRUE(eventually([&] { return fs::exists(folder + "/000001_of_10800.png"); }));
    program.clickOn("Cancel");
    program.waitFor("cancelled after");
    keepShot("cancelled.png");
    const auto before = made();
    EXPECT_LT(before, 10800);
    program.clickOn("Go on");
    EXPECT_TRUE(eventually([&] { return made() > before + 1; }));
    program.clickOn("Cancel");
    program.waitFor("cancelled after");
    EXPECT_FALSE(fs::exists(folder + "/010799_of_10800.png"));
}

TEST_F(EndToEndRender, TheWholeReasonOfAFailureIsShown) {
    // A name so long that the item's own line has no room for the reason behind it.
    make("A turntable");
    fw::test::writeText(beside("_turntable"), "a file where the folder should be");
    press("Render");
    const Area said = program.waitFor("Go on");
    const Area below{{0, said.hi.y}, {1280, 800}};
    // The last words of it, wherever the lines are broken.
    EXPECT_TRUE(eventually([&] { return program.sees("sequence", below) && program.sees("folder", below); }));
    keepShot("failed.png");
    // Mended, it goes on.
    fs::remove(beside("_turntable"));
    program.clickOn("Go on");
    EXPECT_TRUE(eventually([&] { return fs::is_directory(beside("_turntable")); }));
}

}  // namespace fw::editor::test::end_to_end_render_test
