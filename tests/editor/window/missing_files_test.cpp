// Files that are not where a document has them: which they are, where they are found, and that they come
// back.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/files/missing_files.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::missing_files_test {

namespace fs = std::filesystem;
using fw::test::TempDir;
using fw::test::writeText;
using test::DrivenEditor;
using test::parsed;

const std::string kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "duck", "type": "mesh_file", "at": [0, 0], "inputs": {"path": "meshes/duck.stl"}},
    {"id": "cat", "type": "mesh_file", "at": [0, 200], "inputs": {"path": "Cat.STL"}},
    {"id": "dog", "type": "mesh_file", "at": [0, 400], "inputs": {"path": "dog.stl"}}]})";
const std::string kMesh =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid a\n";

TEST(MissingFiles, AreFoundByTheirNames) {
    const TempDir folder;
    const Graph graph = parsed(kDocument);
    const std::string home = folder.path("home"), away = folder.path("away");
    for (const char* each : {"home", "away/old", "away/new/meshes", "away/.hidden"})
        fs::create_directories(folder.path(each));
    writeText(home + "/dog.stl", kMesh);
    const std::vector<NamedFile> missing = missingFiles(graph, home);
    ASSERT_EQ(missing.size(), 2u);
    EXPECT_EQ(missing[0].path, "meshes/duck.stl");
    EXPECT_TRUE(lookFor(missing, away).empty());
    EXPECT_TRUE(lookFor(missing, folder.path("none")).empty());
    writeText(away + "/.hidden/duck.stl", kMesh);
    EXPECT_TRUE(lookFor(missing, away).empty());
    writeText(away + "/old/duck.stl", kMesh);
    writeText(away + "/old/cat.stl", kMesh);
    fs::create_directories(away + "/new/Cat.STL");  // a folder of that name
    EXPECT_EQ(lookFor(missing, away),
              (std::map<std::string, std::string>{{"meshes/duck.stl", away + "/old/duck.stl"},
                                                  {"Cat.STL", away + "/old/cat.stl"}}));
    // Of two the one whose folders are more alike.
    writeText(away + "/new/meshes/duck.stl", kMesh);
    EXPECT_EQ(lookFor(missing, away)["meshes/duck.stl"], away + "/new/meshes/duck.stl");
}

TEST(MissingFiles, ComeBackAllAtOnceAsOneStep) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const std::string file = editor.path("home/a.field.json");
    for (const char* each : {"home", "away/meshes"}) fs::create_directories(editor.path(each));
    writeText(file, kDocument);
    writeText(editor.path("away/meshes/duck.stl"), kMesh);
    writeText(editor.path("away/cat.stl"), kMesh);
    openFile(*editor, file);
    EXPECT_NE(editor->notice.find("3 files that it names are missing"), std::string::npos) << editor->notice;
    editor.settle();
    editor.keys("F3");
    editor.type("missing");
    editor.keys("Return");
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
    // "Look in a folder" is the first button below the list.
    editor.keys("Escape");
    EXPECT_FALSE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
    editor->files.missing.browser.endings.clear();
    open(editor->files.missing.browser, FileBrowser::Kind::folder, editor.path("away"));
    editor.settle();
    editor.keys("Return");
    EXPECT_NE(editor->notice.find("2 found, 1 still missing"), std::string::npos) << editor->notice;
    const auto named = [&](const char* node) {
        return std::get<std::string>(editor->document.graph().node(node)->input("path")->value);
    };
    EXPECT_EQ(named("duck"), "duck.stl");
    EXPECT_EQ(named("cat"), "cat.stl");
    EXPECT_EQ(named("dog"), "dog.stl");
    EXPECT_TRUE(fs::exists(editor.path("home/duck.stl")));
    EXPECT_TRUE(fs::exists(editor.path("away/meshes/duck.stl"))) << "copied, not moved";
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) << "one is missing still";
    editor.keys("Escape ctrl+z");
    EXPECT_EQ(named("duck"), "meshes/duck.stl");
    EXPECT_EQ(editor->document.step(), 0u);
}

}  // namespace fw::editor::missing_files_test
