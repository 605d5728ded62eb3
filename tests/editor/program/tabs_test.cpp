// Several documents in one window.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "editor/document/edits.h"
#include "editor/files/tabs.h"
#include "graph/document/json.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/program.h"
#include "tests/support/graph/implicit_model.h"

namespace fw::editor::test::tabs_test {

using fw::test::readText;
using fw::test::writeText;

constexpr const char* kBall =
    R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere", "at": [0, 0]},
        {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}}]})";
constexpr const char* kBlock =
    R"({"fieldwright": 1, "nodes": [{"id": "block", "type": "box", "at": [0, 0]},
        {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "block"}, "resolution": 16}}]})";

Graph larger(const Graph& graph, const char* node, const char* input) {
    return setNumber(graph, "", {node, input}, 0, 2.5);
}

TEST(Tabs, FilesOfOtherProgramsOpenAsGraphs) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("part.3mf");
    writeText(file, fw::test::modelPackage(
                        fw::test::modelText(std::string("<m:texture2d xmlns:m='urn:m' id='30'/>") +
                                                fw::test::kBallFunction + fw::test::kLevelSet,
                                            "<item objectid='9'/>")));
    openFile(*editor, file);
    editor.settle();
    EXPECT_EQ(nameOf(*editor), "part.field.json");
    EXPECT_NE(editor->document.graph().group("ball"), nullptr);
    for (const Node& node : editor->document.graph().nodes) EXPECT_TRUE(node.at) << node.id;
    ASSERT_EQ(editor->files.message.problems.size(), 1u) << "what was left away is told";
    EXPECT_NE(editor->files.message.problems[0].message.find("texture2d"), std::string::npos);
    editor->files.message = {};

    openFile(*editor, file);
    editor.settle();
    EXPECT_EQ(nameOf(*editor), "part_2.field.json") << "a graph that is there stays";
    editor->files.message = {};
    writeText(file, "PK, they say");
    openFile(*editor, file);
    EXPECT_EQ(nameOf(*editor), "part_2.field.json");
    EXPECT_EQ(editor->files.message.title, "This file cannot be opened");
}

TEST(Tabs, EachDocumentIsAsItWasLeft) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string ball = editor.path("ball.field.json"), block = editor.path("block.field.json");
    writeText(ball, kBall), writeText(block, kBlock);
    openFile(*editor, ball);
    EXPECT_EQ(editor->tabs.all.size(), 1u) << "nothing was there to keep";
    editor->document.apply("Larger", larger(editor->document.graph(), "ball", "radius"));
    editor->canvas.select({"ball"});
    editor->viewport.pinned = "ball";
    editor->viewport.ownCamera = true, editor->viewport.orbit.distance = 17;
    editor.settle();
    const std::string changed = writeGraph(editor->document.graph());

    openFile(*editor, block);
    editor.settle();
    ASSERT_EQ(editor->tabs.all.size(), 2u);
    EXPECT_EQ(nameOf(*editor), "block.field.json");
    EXPECT_FALSE(editor->document.unsaved());
    EXPECT_TRUE(editor->canvas.selection.empty());
    EXPECT_EQ(editor->viewport.pinned, "");
    EXPECT_FALSE(editor->viewport.ownCamera);
    EXPECT_FALSE(editor->document.canUndo());
    editor->document.apply("Longer", larger(editor->document.graph(), "block", "half_extents"));

    editor.keys("alt+Next");
    EXPECT_EQ(writeGraph(editor->document.graph()), changed);
    EXPECT_EQ(editor->canvas.selection, std::set<std::string>{"ball"});
    EXPECT_EQ(editor->viewport.pinned, "ball");
    EXPECT_EQ(editor->viewport.orbit.distance, 17);
    editor.keys("ctrl+z");
    EXPECT_FALSE(editor->document.unsaved());
    editor.keys("ctrl+shift+z");
    EXPECT_EQ(writeGraph(editor->document.graph()), changed);
    editor.waitForPicture();
    EXPECT_TRUE(editor->viewport.shown.current);

    // A file that is open is shown, not read again over its changes.
    openFile(*editor, block);
    EXPECT_EQ(editor->tabs.all.size(), 2u);
    EXPECT_EQ(nameOf(*editor), "block.field.json");
    EXPECT_TRUE(editor->document.unsaved());
    EXPECT_NE(editor->notice.find("unsaved"), std::string::npos) << editor->notice;
    // Saving is of the one in front.
    EXPECT_TRUE(save(*editor));
    EXPECT_EQ(readText(ball), kBall);
    EXPECT_NE(readText(block), kBlock);
}

TEST(Tabs, WhatChangesBehindIsNoticedInFront) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string ball = editor.path("ball.field.json"), block = editor.path("block.field.json");
    writeText(ball, kBall), writeText(block, kBlock);
    openFile(*editor, ball);
    openFile(*editor, block);
    writeText(ball, kBlock);
    turnTabs(*editor, 1);
    EXPECT_TRUE(watchFile(*editor, FileWatch::Clock::now() + std::chrono::seconds(10)));
    EXPECT_TRUE(editor->document.graph().node("block"));
    editor.keys("ctrl+z");
    EXPECT_TRUE(editor->document.graph().node("ball"));
}

TEST(Tabs, QuitAsksOfEachAndKeepsWhatIsUnsavedTillThen) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string ball = editor.path("ball.field.json"), block = editor.path("block.field.json");
    writeText(ball, kBall), writeText(block, kBlock);
    openFile(*editor, ball);
    editor->document.apply("Larger", larger(editor->document.graph(), "ball", "radius"));
    openFile(*editor, block);
    // What is behind would survive a crash.
    ASSERT_TRUE(unsavedTab(*editor));
    const Recovery& kept = editor->tabs.all[*unsavedTab(*editor)]->file.recovery;
    const std::string copy = kept.path();
    EXPECT_TRUE(std::filesystem::exists(copy));
    EXPECT_NE(copy, editor->files.recovery.path());
    EXPECT_NE(keepForNextTime(*editor), "");

    editor->document.apply("Longer", larger(editor->document.graph(), "block", "half_extents"));
    editor.keys("ctrl+q");
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
    editor.keys("Escape");
    EXPECT_FALSE(editor->quit);
    EXPECT_EQ(editor->tabs.all.size(), 2u);
    editor.keys("ctrl+q Return");  // saves this one, and asks of the other
    EXPECT_NE(readText(block), kBlock);
    EXPECT_FALSE(editor->quit);
    EXPECT_EQ(nameOf(*editor), "ball.field.json");
    EXPECT_EQ(readText(ball), kBall);
    editor.keys("Return");
    EXPECT_NE(readText(ball), kBall);
    EXPECT_TRUE(editor->quit);
    discardKept(*editor);
    EXPECT_FALSE(std::filesystem::exists(copy));
}

TEST(Tabs, AClosedOneLeavesItsNeighbour) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    for (const char* name : {"a", "b", "c"}) {
        const std::string path = editor.path(std::string(name) + ".field.json");
        writeText(path, kBall);
        openFile(*editor, path);
    }
    ASSERT_EQ(editor->tabs.all.size(), 3u);
    showTab(*editor, 1);
    editor.keys("ctrl+w");
    EXPECT_EQ(nameOf(*editor), "c.field.json");
    for (int i = 0; i < 2; ++i) editor.keys("ctrl+w");
    ASSERT_EQ(editor->tabs.all.size(), 1u);
    EXPECT_EQ(nameOf(*editor), "untitled");
    EXPECT_TRUE(isUntouched(*editor));
    editor.keys("ctrl+w");
    EXPECT_TRUE(isUntouched(*editor));
    // The copies' folder holds nothing of those that were closed.
    discardKept(*editor);
    for (const auto& entry : std::filesystem::directory_iterator(recoveryFolder()))
        EXPECT_FALSE(entry.path().string().ends_with(".field.json")) << entry.path();
}

TEST(Tabs, ViewsOfAnUntitledDocumentStayWhileItIsBehind) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string block = editor.path("block.field.json");
    writeText(block, kBlock);
    newDocument(*editor);
    editor->document.apply("Longer", larger(editor->document.graph(), "box", "half_extents"));
    editor.settle();
    editor->viewport.ownCamera = true, editor->viewport.orbit.distance = 17;
    keepView(*editor);
    openFile(*editor, block);
    editor.settle();
    EXPECT_TRUE(editor->viewport.kept.views.empty()) << "those of another document";
    turnTabs(*editor, 1);
    editor.settle();
    EXPECT_EQ(nameOf(*editor), "untitled");
    ASSERT_EQ(editor->viewport.kept.views.size(), 1u);
    EXPECT_EQ(editor->viewport.kept.views[0].orbit.distance, 17);
    // Named at last, it has them in the preferences.
    const std::string mine = editor.path("mine.field.json");
    ASSERT_TRUE(saveTo(*editor, mine));
    editor.settle();
    EXPECT_TRUE(editor->files.preferences.views->contains(mine));
}

TEST(Tabs, AFileIsOneDocument) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string ball = editor.path("ball.field.json"), block = editor.path("block.field.json"),
                      link = editor.path("link.field.json");
    writeText(ball, kBall), writeText(block, kBlock);
    std::filesystem::create_symlink(ball, link);
    openFile(*editor, ball);
    editor->document.apply("Larger", larger(editor->document.graph(), "ball", "radius"));
    ASSERT_TRUE(save(*editor));
    openFile(*editor, block);
    openFile(*editor, link);
    EXPECT_EQ(editor->tabs.all.size(), 2u);
    EXPECT_EQ(nameOf(*editor), "ball.field.json") << "by the name that it has";
    EXPECT_TRUE(editor->document.canUndo()) << "it is shown, not read anew";
    // What another program wrote is there at once, as a step.
    writeText(ball, kBlock);
    openFile(*editor, link);
    EXPECT_TRUE(editor->document.graph().node("block"));
    EXPECT_EQ(editor->document.undoName(), "Reload");
    // None is saved over the other.
    const std::string before = readText(ball);
    showTab(*editor, *tabOf(*editor, block));
    editor->document.apply("Longer", larger(editor->document.graph(), "block", "half_extents"));
    for (const std::string& name : {ball, link}) {
        EXPECT_FALSE(saveTo(*editor, name));
        EXPECT_NE(editor->notice.find("is open as another document"), std::string::npos) << editor->notice;
    }
    EXPECT_EQ(readText(ball), before);
    EXPECT_EQ(editor->document.graph().path, block);
    EXPECT_TRUE(saveTo(*editor, block));
}

TEST(EndToEndTabs, AreSeenAndClicked) {
    Program program(kBall);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.save();
    const std::string title = program.title();
    const Area bar{{0, 0}, {1280, 30}};
    program.keys("Ctrl+N");
    const Area other = program.waitFor("document.field.json", bar);
    EXPECT_TRUE(program.title().starts_with("untitled"));
    program.click(other.centre());
    EXPECT_TRUE(eventually([&] { return program.title() == title; }));
    program.moveTo({200, 60});  // the path of the tab under the mouse hides its neighbour
    program.click(program.waitFor("untitled", bar).centre(), 2);
    program.waitUntilGone("untitled");
    EXPECT_EQ(program.title(), title);
}

TEST(EndToEndTabs, WhoStaysAfterAllHasLostNothing) {
    Program program(kBall);
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    const std::string kept = program.save();
    const auto changed = [&](const std::string& name) {
        EXPECT_TRUE(eventually([&] { return program.title().starts_with(name + " *"); })) << program.title();
    };
    program.keys("Ctrl+A");
    program.keys("Delete");
    changed("document.field.json");
    program.keys("Ctrl+N");
    program.waitForTitle("untitled - Fieldwright");
    program.keys("Ctrl+A");
    program.keys("Delete");
    changed("untitled");
    // One is given up, the other is asked about, and the answer is that the editor goes on.
    program.keys("Ctrl+Q");
    program.waitFor("changes of untitled");
    program.clickOn("Discard");
    program.waitFor("changes of document");
    program.keys("Escape");
    program.waitUntilGone("Discard");
    changed("document.field.json");
    program.keys("Alt+PageDown");
    changed("untitled");
    // And asked about anew when it ends.
    program.keys("Ctrl+Q");
    program.waitFor("changes of untitled");
    program.clickOn("Discard");
    program.waitFor("changes of document");
    program.clickOn("Discard");
    EXPECT_EQ(program.waitForEnd(), 0);
    EXPECT_EQ(readText(program.file()), kept);
}

}  // namespace fw::editor::test::tabs_test
