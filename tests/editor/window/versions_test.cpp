// What a file held before it was saved over: which of it is kept, for how long, and that it comes back.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/files/versions.h"
#include "graph/document/json.h"
#include "tests/support/editor/driven_editor.h"
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
    EXPECT_TRUE(keepVersion(file, false, kNoon)) << "there is nothing to keep";
    EXPECT_TRUE(versionsOf(file).empty());
    for (int minute = 0; minute <= 300; minute += 5) {
        writeText(file, "as of minute " + std::to_string(minute));
        ASSERT_TRUE(keepVersion(file, false, kNoon + minutes(minute)));
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
}

TEST(Versions, AClockThatWasSetBackLosesNone) {
    const TempDir folder;
    const std::string file = folder.path("a.field.json");
    for (int i = 0; i < int(kMostVersions); ++i) {
        writeText(file, "before " + std::to_string(i));
        ASSERT_TRUE(keepVersion(file, false, kNoon + minutes(15 * i)));
    }
    // An hour's saves, two days back: still one of a quarter, each in the place of the first of before.
    for (int minute = 0; minute < 60; minute += 5) {
        writeText(file, "after " + std::to_string(minute));
        ASSERT_TRUE(keepVersion(file, false, kNoon - minutes(2 * 24 * 60 - minute)));
    }
    std::vector<std::string> texts;
    for (const Version& version : versionsOf(file)) texts.push_back(readText(version.path));
    EXPECT_EQ(texts, (std::vector<std::string>{"before 9", "before 8", "before 7", "before 6", "before 5",
                                               "before 4", "after 45", "after 30", "after 15", "after 0"}));
}

TEST(Versions, WhatWouldBeLostForGoodIsAlwaysKept) {
    const TempDir folder;
    const std::string file = folder.path("a.field.json");
    for (const char* text : {"one", "two", "three"}) {
        writeText(file, text);
        ASSERT_TRUE(keepVersion(file, true, kNoon));
    }
    const std::vector<Version> versions = versionsOf(file);
    ASSERT_EQ(versions.size(), 3u) << "within a second too";
    EXPECT_EQ(readText(versions[0].path), "three");
    EXPECT_EQ(readText(versions[2].path), "one");
}

TEST(Versions, AreToldWithTheYearIfItIsAnother) {
    EXPECT_EQ(words(kNoon, kNoon).find("2027"), std::string::npos);
    EXPECT_NE(words(kNoon, kNoon + minutes(400 * 24 * 60)).find("2027"), std::string::npos);
}

TEST(Versions, WhatCannotBeKeptIsSaid) {
    const TempDir folder;
    const std::string file = folder.path("a.field.json");
    writeText(file, "before");
    writeText(folder.path(".a.field.json.versions"), "a file where the folder should be");
    EXPECT_FALSE(keepVersion(file, false, kNoon));
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

TEST(Versions, WhatUndoCannotGiveBackIsKeptWhateverTheTime) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("a.field.json"), other = editor.path("b.field.json");
    writeText(file, kBall);
    writeText(other, "of another program");
    openFile(*editor, file);
    editor.settle();
    const auto change = [&](const char* label) {
        Graph graph = editor->document.graph();
        graph.nodes[0].label = label;
        editor->document.apply("Label", graph);
    };
    change("one");
    ASSERT_TRUE(writeFile(*editor, file));
    change("two");
    ASSERT_TRUE(writeFile(*editor, file));
    ASSERT_EQ(versionsOf(file).size(), 1u) << "one of a quarter of an hour";
    // Going back, and saving that.
    const std::string two = readText(file);
    restore(*editor, versionsOf(file)[0]);
    ASSERT_TRUE(writeFile(*editor, file));
    ASSERT_EQ(versionsOf(file).size(), 2u);
    EXPECT_EQ(readText(versionsOf(file)[0].path), two);
    change("three");
    ASSERT_TRUE(writeFile(*editor, file));
    EXPECT_EQ(versionsOf(file).size(), 2u) << "once";
    // Over another file.
    ASSERT_TRUE(writeFile(*editor, other));
    ASSERT_EQ(versionsOf(other).size(), 1u);
    EXPECT_EQ(readText(versionsOf(other)[0].path), "of another program");
}

TEST(Versions, OfWhichAPartCannotBeReadSayIt) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("a.field.json");
    writeText(file, kBall);
    openFile(*editor, file);
    editor.settle();
    std::string damaged = kBall;
    damaged.insert(damaged.find("{\"id\": \"out\""), "{\"id\": 7}, ");
    const std::string version = editor.path("damaged.field.json");
    writeText(version, damaged);
    restore(*editor, Version{version, kNoon, damaged.size()});
    EXPECT_EQ(editor->document.graph().nodes.size(), 2u);
    EXPECT_EQ(editor->files.message.title, "Not all could be read");
    EXPECT_FALSE(editor->files.found.empty()) << "listed under Problems";
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
