// What a file held before it was saved over: which of it is kept, for how long, and that it comes back.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/files/versions.h"
#include "graph/document/json.h"
#include "tests/editor/driven_editor.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::versions_test {

namespace fs = std::filesystem;
using fw::test::readText;
using fw::test::TempDir;
using fw::test::writeText;
using std::chrono::minutes;
using test::DrivenEditor;

const Wall::time_point kNoon = Wall::from_time_t(1'800'000'000);

TEST(Versions, OneOfAQuarterOfAnHourAndTheLastTenAreKept) {
    const TempDir folder;
    const std::string file = folder.path("a.field.json");
    EXPECT_TRUE(keepVersion(file, kNoon)) << "there is nothing to keep";
    EXPECT_TRUE(versionsOf(file).empty());
    for (int minute = 0; minute <= 300; minute += 5) {
        writeText(file, "as of minute " + std::to_string(minute));
        ASSERT_TRUE(keepVersion(file, kNoon + minutes(minute)));
    }
    const std::vector<Version> versions = versionsOf(file);
    ASSERT_EQ(versions.size(), kMostVersions);
    for (std::size_t i = 0; i < versions.size(); ++i) {
        const int minute = 300 - 15 * int(i);
        EXPECT_EQ(versions[i].until, kNoon + minutes(minute));
        EXPECT_EQ(readText(versions[i].path), "as of minute " + std::to_string(minute));
        EXPECT_EQ(versions[i].bytes, readText(versions[i].path).size());
    }
    // Of another file beside it there are none, and what lies in the folder besides is not theirs.
    EXPECT_TRUE(versionsOf(folder.path("b.field.json")).empty());
    writeText(fs::path(versions[0].path).parent_path() / "mine.txt", "mine");
    EXPECT_EQ(versionsOf(file).size(), kMostVersions);
    // A clock that was set back loses none.
    ASSERT_TRUE(keepVersion(file, kNoon - minutes(60)));
    EXPECT_EQ(versionsOf(file).size(), kMostVersions);
}

TEST(Versions, WhatCannotBeKeptIsSaid) {
    const TempDir folder;
    const std::string file = folder.path("a.field.json");
    writeText(file, "before");
    writeText(folder.path(".a.field.json.versions"), "a file where the folder should be");
    EXPECT_FALSE(keepVersion(file, kNoon));
    EXPECT_EQ(readText(file), "before");
}

constexpr const char* kBall = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0]},
    {"id": "out", "type": "output", "at": [240, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}}]})";

TEST(Versions, AreKeptBySavingAndComeBackAsAStep) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("a.field.json");
    writeText(file, kBall);
    openFile(*editor, file);
    editor.settle();
    editor->canvas.select({"ball"});
    editor.keys("Delete ctrl+s");
    EXPECT_EQ(editor->document.graph().nodes.size(), 1u);
    ASSERT_EQ(versionsOf(file).size(), 1u);
    EXPECT_EQ(readText(versionsOf(file)[0].path), kBall);
    editor.keys("F3");
    editor.type("versions");
    editor.keys("Return");
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
    editor.keys("Return");
    EXPECT_EQ(editor->document.graph().nodes.size(), 2u) << "Enter takes the last one";
    EXPECT_EQ(editor->document.graph().path, file) << "files that it names lie where they lay";
    EXPECT_TRUE(editor->document.unsaved());
    EXPECT_NE(readText(file), kBall) << "until it is saved the file stays";
    editor.keys("ctrl+z");
    EXPECT_EQ(editor->document.graph().nodes.size(), 1u);
}

TEST(Versions, NoneKeepsSavingFromBeingDone) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("a.field.json");
    writeText(file, kBall);
    writeText(editor.path(".a.field.json.versions"), "in the way");
    openFile(*editor, file);
    editor->canvas.select({"ball"});
    editor.settle();
    editor.keys("Delete ctrl+s");
    EXPECT_FALSE(editor->document.unsaved());
    EXPECT_NE(readText(file), kBall);
    EXPECT_NE(editor->notice.find("no version"), std::string::npos) << editor->notice;
}

}  // namespace fw::editor::versions_test
