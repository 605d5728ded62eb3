// What the dialogs of exports and pictures say, and what they forget with another document.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/files/tabs.h"
#include "tests/support/editor/driven_editor.h"

namespace fw::editor::test::dialogs_test {

using fw::test::writeText;
using Phase = RenderState::Phase;

constexpr const char* kBall =
    R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere", "at": [0, 0]},
        {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}}]})";
constexpr const char* kNested = R"({"fieldwright": 1,
    "nodes": [{"id": "left", "type": "group", "group": "tower", "at": [0, 0]},
              {"id": "right", "type": "group", "group": "tower", "at": [0, 200]},
              {"id": "both", "type": "union", "at": [200, 0], "inputs": {"a": {"from": "left"}, "b": {"from": "right"}}},
              {"id": "out", "type": "output", "at": [400, 0], "inputs": {"surface": {"from": "both"}, "resolution": 16}}],
    "groups": [
        {"id": "tower", "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
            {"id": "window", "type": "group", "group": "frame", "at": [0, 0]},
            {"id": "out", "type": "group_output", "at": [200, 0], "inputs": {"surface": {"from": "window"}}}]},
        {"id": "frame", "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
            {"id": "pane", "type": "box", "at": [0, 0]}, {"id": "bar", "type": "sphere", "at": [0, 200]},
            {"id": "joined", "type": "union", "at": [200, 0], "inputs": {"a": {"from": "pane"}, "b": {"from": "bar"}}},
            {"id": "out", "type": "group_output", "at": [400, 0], "inputs": {"surface": {"from": "joined"}}}]}]})";

TEST(Dialogs, AnExportBeginsAnewWithAnotherDocument) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string one = editor.path("one.field.json"), other = editor.path("other.field.json");
    writeText(one, kBall), writeText(other, kBall);
    openFile(*editor, one);
    openExport(*editor);
    editor.settle();
    EXPECT_EQ(exportPath(*editor), editor.path("one.glb"));
    ExportDialog::OfDocument& of = editor->exporting.of;
    of.path = editor.path("elsewhere.stl"), of.givesRegion = true, of.seconds = 3.0;
    editor.settle();
    EXPECT_EQ(exportPath(*editor), editor.path("elsewhere.stl"));
    openFile(*editor, other);
    EXPECT_EQ(exportPath(*editor), editor.path("other.glb")) << "not even before a frame";
    editor.settle();
    EXPECT_EQ(exportPath(*editor), editor.path("other.glb"));
    EXPECT_FALSE(of.givesRegion);
    EXPECT_FALSE(of.seconds);
    turnTabs(*editor, 1);
    editor.settle();
    EXPECT_EQ(exportPath(*editor), editor.path("one.glb"));
}

TEST(Dialogs, APictureIsToldOfInALine) {
    RenderItem item{.id = 1};
    item.wish.path = "a.png";
    EXPECT_EQ(wordsOf(item), "waiting");
    item.state = {.phase = Phase::running, .stage = "tracing light"};
    EXPECT_EQ(wordsOf(item), "tracing light");
    item.state.cancelling = true;
    EXPECT_EQ(wordsOf(item), "cancelling …");
    item.state.phase = Phase::cancelled;
    EXPECT_EQ(wordsOf(item), "cancelled");
    item.state.phase = Phase::done;
    EXPECT_EQ(wordsOf(item), "done") << "whatever was asked for too late";
    item.state.phase = Phase::failed, item.state.problems = {{.message = "the disk is full"}};
    EXPECT_EQ(wordsOf(item), "the disk is full");

    item.wish.frames = *framesBetween(0.0, 4.0, 2.0);
    item.state = {.phase = Phase::running, .stage = "tracing light", .ready = 2, .seconds = 20.0, .made = 2};
    EXPECT_EQ(wordsOf(item), "frame 2 of 8, 1:00 left");
    item.state.cancelling = true;
    EXPECT_EQ(wordsOf(item), "cancelling …");
    item.state.phase = Phase::cancelled;
    EXPECT_EQ(wordsOf(item), "cancelled after 2 frames");
}

TEST(Dialogs, CostsOfGroupsInGroupsAreOfTheNodeThatIsSeen) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("nested.field.json");
    writeText(file, kNested);
    openFile(*editor, file);
    ASSERT_TRUE(editor->document.graph().group("frame"));
    editor->canvas.costs = true;
    editor.settle();
    editor->viewport.shown.efforts = {{.node = "left/window/pane", .sample = 4.0},
                                      {.node = "left/window/bar", .sample = 2.0},
                                      {.node = "right/window/pane", .sample = 1.0},
                                      {.node = "both", .sample = 1.0}};
    const auto costs = [&](const char* scope) {
        enter(*editor, scope);
        editor.settle();
        return marksOf(*editor).costs;
    };
    const auto outside = costs("");
    EXPECT_DOUBLE_EQ(outside.at("left"), 0.75);
    EXPECT_DOUBLE_EQ(outside.at("right"), 0.125);
    EXPECT_DOUBLE_EQ(outside.at("both"), 0.125);
    EXPECT_FALSE(outside.contains("out"));
    EXPECT_DOUBLE_EQ(costs("tower").at("window"), 0.875) << "of both instances";
    const auto inside = costs("frame");
    EXPECT_DOUBLE_EQ(inside.at("pane"), 0.625);
    EXPECT_DOUBLE_EQ(inside.at("bar"), 0.25);
}

TEST(Dialogs, AnOutlineFarAwayIsShown) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("far.field.json");
    writeText(file,
              R"({"fieldwright": 1, "nodes": [{"id": "flat", "type": "polygon", "at": [0, 0], "inputs": {
            "points": [[7e15, 7e15], [7000000000000001, 7e15], [7e15, 7000000000000001]]}}]})");
    openFile(*editor, file);
    editor.settle();
    openOutline(*editor, "flat", "points");
    editor.settle();
    EXPECT_TRUE(editor->outline.open);
    EXPECT_GT(editor->outline.zoom, 0.0);
}

}  // namespace fw::editor::test::dialogs_test
