// The library: parts on the disk, and in the real window their pictures, the click, the drag and the search.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/files/parts.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/editor/program.h"

namespace fw::editor::parts_test {

namespace fs = std::filesystem;
using fw::test::readText;
using fw::test::TempDir;
using fw::test::writeText;
using test::DrivenEditor;
using test::Program;

const std::string kBall =
    R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere", "inputs": {"radius": 0.25}}]})";

TEST(Parts, IsTheGraphFilesOfAFolder) {
    const TempDir folder;
    std::string problem;
    EXPECT_TRUE(listParts(folder.path("none"), problem).empty());
    EXPECT_EQ(problem, "");
    for (const char* each : {"screws/metric", ".hidden"}) fs::create_directories(folder.path(each));
    for (const char* each : {"b_part.field.json", "a.field.json", "notes.txt", ".c.field.json",
                             "screws/metric/hex_bolt.field.json", ".hidden/d.field.json"})
        writeText(folder.path(each), kBall);
    const std::vector<LibraryPart> parts = listParts(folder.path("."), problem);
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].label, "A");
    EXPECT_EQ(parts[1].label, "B part");
    EXPECT_EQ(parts[2].label, "Hex bolt");
    EXPECT_EQ(parts[2].folder, "screws/metric");
    writeText(folder.path("file"), "");
    listParts(folder.path("file"), problem);
    EXPECT_NE(problem, "");
}

TEST(Parts, NamesOfPartsAreNamesOfFiles) {
    EXPECT_EQ(partName("Hex bolt!"), "hex_bolt");
    EXPECT_EQ(partName("  M8 x 30  "), "m8_x_30");
    EXPECT_EQ(partName("../../etc"), "etc");
    EXPECT_EQ(partName("!"), "part");
    EXPECT_EQ(partName("Schraube groß"), "schraube_groß");
}

TEST(Parts, ANameIsProposed) {
    Graph graph = test::graphOf(R"({"id": "cup", "type": "subtract"}, {"id": "box_2", "type": "box"},
        {"id": "a", "type": "sphere", "label": "Marble"}, {"id": "g", "type": "group", "group": "left_wheel"})",
                                R"(, "groups": [{"id": "left_wheel", "nodes": []}])");
    graph.path.clear();
    EXPECT_EQ(proposedName(graph, "", "cup", {}), "Cup");
    EXPECT_EQ(proposedName(graph, "", "a", {}), "Marble");
    EXPECT_EQ(proposedName(graph, "", "g", {}), "Left wheel");
    EXPECT_EQ(proposedName(graph, "", "box_2", {}), "Part");
    graph.path = "/home/me/Tea_pot.field.json";
    EXPECT_EQ(proposedName(graph, "", "box_2", {}), "Tea pot");
    EXPECT_EQ(proposedName(graph, "", "gone", {}), "Tea pot");
    // None that is taken.
    const LibraryPart kept[] = {{"/l/cup.field.json", "", "Cup"},
                                {"/l/cup_2.field.json", "", "Cup 2"},
                                {"/l/x/marble.field.json", "x", "Marble"}};
    EXPECT_EQ(proposedName(graph, "", "cup", kept), "Cup 3");
    EXPECT_EQ(proposedName(graph, "", "a", kept), "Marble");
}

TEST(Parts, APictureIsOfWhatTheOutputShows) {
    using test::graphOf;
    EXPECT_EQ(shownNode(graphOf(R"({"id": "a", "type": "box"}, {"id": "b", "type": "sphere", "at": [200, 0]},
        {"id": "o", "type": "output", "inputs": {"surface": {"from": "a"}}})")),
              "a");
    EXPECT_EQ(
        shownNode(graphOf(
            R"({"id": "a", "type": "box", "at": [300, 0]}, {"id": "b", "type": "sphere", "at": [200, 0]})")),
        "a");
    EXPECT_EQ(shownNode(graphOf(R"({"id": "a", "type": "mesh_file"})")), "");
}

TEST(Parts, APartThatShowsAGroupStaysLinkedIfAsked) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("docs/a.field.json"), part = editor.path("parts/lamp.field.json");
    for (const char* each : {"docs", "parts"}) fs::create_directories(editor.path(each));
    writeText(file, kBall);
    writeText(part, R"({"fieldwright": 1, "nodes": [{"id": "lamp", "type": "group", "group": "lamp"}],
      "groups": [{"id": "lamp", "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
        {"id": "s", "type": "sphere"},
        {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "s"}}}]}]})");
    openFile(*editor, file);
    editor.settle();
    std::string problem;
    const LibraryPart lamp = listParts(editor.path("parts"), problem).at(0);
    addPart(*editor, lamp, {0, 300}, false);
    EXPECT_EQ(editor->document.graph().group("lamp")->file, "");
    editor.keys("ctrl+z");
    addPart(*editor, lamp, {0, 300}, true);
    editor.settle();
    ASSERT_NE(editor->document.graph().group("lamp"), nullptr);
    EXPECT_EQ(editor->document.graph().group("lamp")->file, "../parts/lamp.field.json");
    editor->files.groups.forget();
    editor->files.groups.look(editor->graph);
    ASSERT_NE(editor->files.groups.of("lamp"), nullptr);
    EXPECT_EQ(editor->files.groups.of("lamp")->state, LinkState::same);
}

TEST(Parts, APartComesWithTheFilesItReads) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    for (const char* each : {"docs", "parts"}) fs::create_directories(editor.path(each));
    writeText(editor.path("docs/a.field.json"), kBall);
    writeText(editor.path("parts/m.stl"), "solid a\nendsolid a\n");
    const std::string part = editor.path("parts/m.field.json");
    writeText(
        part,
        R"({"fieldwright": 1, "nodes": [{"id": "m", "type": "mesh_file", "inputs": {"path": "m.stl"}}]})");
    const LibraryPart mesh{part, "", "M"};
    addPart(*editor, mesh, {0, 0}, false);
    editor.settle();
    EXPECT_NE(editor->notice.find("save the document first"), std::string::npos) << editor->notice;
    editor.keys("Escape");
    openFile(*editor, editor.path("docs/a.field.json"));
    editor.settle();
    addPart(*editor, mesh, {0, 0}, false);
    EXPECT_EQ(editor->document.graph().nodes.size(), 2u);
    EXPECT_TRUE(fs::exists(editor.path("docs/m.stl")));
    // A part that is no graph says so.
    writeText(part, "nothing");
    addPart(*editor, mesh, {0, 0}, false);
    EXPECT_EQ(editor->document.graph().nodes.size(), 2u);
    EXPECT_NE(editor->notice.find("m.field.json"), std::string::npos) << editor->notice;
    // One that shows itself too, and not where it would have been pasted.
    writeText(part, R"({"fieldwright": 1, "nodes": [{"id": "g", "type": "group", "group": "g"}],
      "groups": [{"id": "g", "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
        {"id": "own", "type": "group", "group": "g"},
        {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "own"}}}]}]})");
    for (const bool linked : {false, true}) {
        addPart(*editor, mesh, {0, 0}, linked);
        EXPECT_EQ(editor->document.graph().nodes.size(), 2u);
        EXPECT_NE(editor->notice.find("contains itself"), std::string::npos) << editor->notice;
        EXPECT_NE(editor->notice.find("m.field.json"), std::string::npos) << editor->notice;
    }
}

TEST(Parts, KeepsNodesShowsThemAndGivesThemBack) {
    Program program(R"({"fieldwright": 1, "nodes": [
        {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 0.25}}]})");
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.frameAll();
    program.click(program.title("ball"));
    program.keys("F3");
    program.type("keep\n");
    program.waitFor("Nothing is kept yet");
    program.type("My marble\n");
    program.waitFor("kept as my_marble");
    const std::string kept = program.path("data/fieldwright/library/my_marble.field.json");
    EXPECT_TRUE(fs::exists(kept));
    program.waitFor("of the selection");  // the field is empty again
    const Area label = program.waitFor("My marble");
    // Its picture is of a grey ball before the dark: seen above its name, once it is made.
    const Area tile{{label.lo.x, label.lo.y - 80}, {label.lo.x + 80, label.lo.y - 8}};
    EXPECT_TRUE(test::eventually([&] {
        const Picture picture = program.screen(tile);
        const auto at = [&](int x, int y) { return picture.pixels[4 * std::size_t(y * picture.width + x)]; };
        return at(picture.width / 2, picture.height / 2) > at(2, 2) + 40;
    })) << "no ball is seen";
    program.click({label.lo.x + 40, label.lo.y - 40});
    EXPECT_EQ(program.saved().nodes.size(), 2u);
    // Dragged to a place.
    const ImVec2 there = program.nowhere();
    program.drag(
        {{label.lo.x + 40, label.lo.y - 40}, {there.x + 40, there.y + 60}, {there.x, there.y + 20}, there});
    ASSERT_EQ(program.saved().nodes.size(), 3u);
    EXPECT_EQ(std::get<double>(program.graph().nodes[2].input("radius")->value), 0.25);
    EXPECT_LT(std::abs(program.view.toScreen({float((*program.graph().nodes[2].at)[0]), 0.0f}).x - there.x),
              120.0f);
    // And by its name, from the menu.
    program.moveTo(there);
    program.keys("Shift+A");
    program.type("marble");
    program.waitFor("My marble (library)");
    program.keys("Enter");
    EXPECT_EQ(program.saved().nodes.size(), 4u);
}

}  // namespace fw::editor::parts_test
