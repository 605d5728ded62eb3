// What is dropped on the window: files become nodes, and what they say of themselves is shown.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "editor/document/file_nodes.h"
#include "graph/document/json.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/graph/picture_file.h"
#include "tests/support/graph/triangle_meshes.h"

namespace fw::editor::test::drop_test {

namespace fs = std::filesystem;
using fw::test::readText;
using fw::test::writeText;

const std::string kOut = R"({"id": "out", "type": "output", "inputs": {"resolution": 24}})";

/// A cube of 2 m, without its first `left` triangles.
std::string cubeText(std::size_t left = 0) {
    const TriangleMesh cube = fw::test::cubeFile();
    std::string text;
    for (const glm::vec3& p : cube.positions)
        text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    for (std::size_t i = 3 * left; i < cube.indices.size(); i += 3)
        text += "f " + std::to_string(cube.indices[i] + 1) + " " + std::to_string(cube.indices[i + 1] + 1) +
                " " + std::to_string(cube.indices[i + 2] + 1) + "\n";
    return text;
}

std::string sourceOf(const Graph& graph, const std::string& node, const std::string& input) {
    const InputValue* value = graph.node(node) ? graph.node(node)->input(input) : nullptr;
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    return link ? link->node : "";
}

/// The paths of a graph's mesh_file nodes, in their order.
std::vector<std::string> pathsOf(const Graph& graph) {
    std::vector<std::string> paths;
    for (const Node& node : graph.nodes)
        if (node.type == "mesh_file") paths.push_back(std::get<std::string>(node.input("path")->value));
    return paths;
}

TEST(AddFileNodes, MakesPairsAndGivesTheFirstToAFreeOutput) {
    const std::vector<std::string> paths{"a.obj", "sub/b.ply"};
    const Edited edited = addFileNodes(graphOf(kOut), "", paths, {10, 20});
    EXPECT_EQ(edited.nodes, (NodeIds{"mesh_file", "mesh_to_field", "mesh_file_2", "mesh_to_field_2"}));
    EXPECT_EQ(pathsOf(edited.graph), paths);
    EXPECT_EQ(sourceOf(edited.graph, "mesh_to_field", "mesh"), "mesh_file");
    EXPECT_EQ(sourceOf(edited.graph, "mesh_to_field_2", "mesh"), "mesh_file_2");
    EXPECT_EQ(sourceOf(edited.graph, "out", "surface"), "mesh_to_field");
    EXPECT_EQ(edited.graph.node("mesh_file")->at, (Position{10, 20}));
    EXPECT_GT((*edited.graph.node("mesh_to_field")->at)[0], 10 + 180);
    EXPECT_GT((*edited.graph.node("mesh_file_2")->at)[1], 20 + 150);

    // An output that shows something keeps it, be it a mesh.
    for (const char* taken : {R"("surface": {"from": "ball"})", R"("mesh": {"from": "cells"})"}) {
        const Graph graph = graphOf(R"({"id": "ball", "type": "sphere"},
            {"id": "cells", "type": "polygonize", "inputs": {"surface": {"from": "ball"}}},
            {"id": "out", "type": "output", "inputs": {)" +
                                    std::string(taken) + "}}");
        const Edited more = addFileNodes(graph, "", paths, {});
        EXPECT_EQ(more.nodes.size(), 4u);
        EXPECT_EQ(writeGraph(removeNodes(more.graph, "", more.nodes, false)), writeGraph(graph));
    }
    // In a group there is none.
    const Graph grouped = graphOf(R"({"id": "g", "type": "group", "group": "inner"},)" + kOut,
                                  R"(, "groups": [{"id": "inner", "nodes": []}])");
    const Edited within = addFileNodes(grouped, "inner", paths, {});
    EXPECT_EQ(nodesOf(within.graph, "inner").size(), 4u);
    EXPECT_EQ(sourceOf(within.graph, "out", "surface"), "");
}

class Dropped : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(editor.works()) << "Xvfb or xdotool is not installed: run ./.install test";
        fs::create_directories(editor.path("work/sub"));
        fs::create_directories(editor.path("elsewhere"));
        editor->document.setPath(work("g.field.json"));
        writeText(elsewhere("cube.obj"), cubeText());
        editor.settle();
    }
    std::string work(const std::string& name) const { return editor.path("work/" + name); }
    std::string elsewhere(const std::string& name) const { return editor.path("elsewhere/" + name); }
    /// As the window system does it.
    void drop(const std::vector<std::string>& files) {
        GLFWwindow* window = editor->shell.window();
        GLFWdropfun heard = glfwSetDropCallback(window, nullptr);
        ASSERT_NE(heard, nullptr);
        glfwSetDropCallback(window, heard);
        std::vector<const char*> paths;
        for (const std::string& file : files) paths.push_back(file.c_str());
        editor->notice.clear();
        heard(window, int(paths.size()), paths.data());
        editor.settle();
    }
    const Graph& graph() { return editor->document.graph(); }
    bool said(const std::string& words) { return editor->notice.find(words) != std::string::npos; }

    DrivenEditor editor{graphOf(kOut)};
};

/// Of a node that is there: chosen in a window, and brought like what is dropped.
TEST_F(Dropped, AFileIsChosenForAnInput) {
    apply(*editor, "Add", addNode(graph(), "", "mesh_file", {0, 300}));
    editor.settle();
    const Plug plug{"mesh_file", "path"};
    const auto take = [plug](Editor& in, const std::string& path) {
        in.document.apply("Set", setInput(in.document.graph(), "", plug, InputValue{.value = path}));
    };
    pickFile(*editor, kMeshFile, "", take);
    editor.settle();
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
    editor.type(elsewhere("cube"));  // its ending is one that meshes have
    editor.keys("Return");
    EXPECT_FALSE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
    EXPECT_EQ(pathsOf(graph()), std::vector<std::string>{"cube.obj"});
    EXPECT_TRUE(said("copied cube.obj beside the document")) << editor->notice;
    EXPECT_TRUE(fs::exists(work("cube.obj")));
    // What is there is offered first; leaving it changes nothing.
    pickFile(*editor, kMeshFile, "cube.obj", take);
    editor.settle();
    EXPECT_EQ(editor->files.pick.browser.name, "cube.obj");
    editor.keys("Escape");
    EXPECT_EQ(pathsOf(graph()), std::vector<std::string>{"cube.obj"});
    // Beside a document without a file there is no place for files.
    editor->document.setPath("");
    pickFile(*editor, kMeshFile, "", take);
    EXPECT_TRUE(said("save the document first")) << editor->notice;
    editor.settle();
    editor.keys("Escape");
}

TEST_F(Dropped, AMeshBecomesTwoNodesInOneStepAndIsSeen) {
    writeText(work("sub/cube.obj"), cubeText());
    const Graph before = graph();
    const Area& panel = editor->canvas.view.panel;
    const ImVec2 mouse(panel.lo.x + 0.3f * panel.width(), panel.lo.y + 0.6f * panel.height());
    editor.moveTo(mouse);
    drop({work("sub/cube.obj")});
    EXPECT_EQ(editor->notice, "");
    EXPECT_EQ(pathsOf(graph()), std::vector<std::string>{"sub/cube.obj"});
    EXPECT_EQ(editor->canvas.selection, (std::set<std::string>{"mesh_file", "mesh_to_field"}));
    EXPECT_EQ(sourceOf(graph(), "out", "surface"), "mesh_to_field");
    const ImVec2 there = editor->canvas.view.toScreen(vec(*graph().node("mesh_file")->at));
    EXPECT_NEAR(there.x, mouse.x, 1.5);
    EXPECT_NEAR(there.y, mouse.y, 1.5);
    editor.waitForPicture();
    EXPECT_TRUE(editor->viewport.shown.current);
    EXPECT_TRUE(editor->viewport.shown.findings.empty());
    EXPECT_GT(editor->viewport.shown.statistics.triangles, 100u);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(editor->viewport.shown.region.lo[axis], -1.0, 0.5);
        EXPECT_NEAR(editor->viewport.shown.region.hi[axis], 1.0, 0.5);
    }
    EXPECT_FALSE(editor->preview.baking());

    EXPECT_EQ(editor->document.undoName(), "Add File");
    editor.keys("ctrl+z");
    EXPECT_EQ(writeGraph(graph()), writeGraph(before));
}

TEST_F(Dropped, BesideTheCanvasTheyGoToItsMiddle) {
    for (const char* name : {"a.obj", "b.OBJ"}) writeText(work(name), cubeText());
    const Area seen = editor->canvas.view.seen();
    /// Those of these nodes, each apart from the others.
    const auto placeOf = [&](const NodeIds& ids) {
        Area all = editor->boxes->find(ids[0])->area;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const Area& area = editor->boxes->find(ids[i])->area;
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_FALSE(area.overlaps(editor->boxes->find(ids[k])->area));
            all.add(area);
        }
        EXPECT_TRUE(seen.contains(all.lo) && seen.contains(all.hi));
        return all;
    };
    editor.moveAway();
    // The output is in the middle: there is room below it.
    drop({work("a.obj")});
    placeOf({"out", "mesh_file", "mesh_to_field"});
    editor.keys("ctrl+z");

    editor->document.apply("Empty", removeNodes(graph(), "", NodeIds{"out"}, false));
    editor.settle();
    drop({work("a.obj"), work("b.OBJ")});
    EXPECT_EQ(pathsOf(graph()), (std::vector<std::string>{"a.obj", "b.OBJ"}));
    const NodeIds made{"mesh_file", "mesh_to_field", "mesh_file_2", "mesh_to_field_2"};
    EXPECT_EQ(editor->canvas.selection, std::set<std::string>(made.begin(), made.end()));
    const Area all = placeOf(made);
    EXPECT_NEAR(all.centre().x, seen.centre().x, 2);
    EXPECT_NEAR(all.centre().y, seen.centre().y, 2);
    EXPECT_EQ(editor->document.undoName(), "Add Files");
    editor.keys("ctrl+z");
    EXPECT_EQ(graph().nodes.size(), 0u);
}

TEST_F(Dropped, WhatLiesElsewhereIsCopiedBesideTheDocument) {
    drop({elsewhere("cube.obj")});
    EXPECT_TRUE(said("copied cube.obj beside the document")) << editor->notice;
    EXPECT_EQ(pathsOf(graph()), std::vector<std::string>{"cube.obj"});
    EXPECT_EQ(readText(work("cube.obj")), cubeText());
    // Again: it is there.
    drop({elsewhere("cube.obj")});
    EXPECT_TRUE(said("it is the same")) << editor->notice;
    EXPECT_EQ(pathsOf(graph()).back(), "cube.obj");
    // Another of that name, twice.
    writeText(elsewhere("cube.obj"), cubeText(1));
    for (int i = 0; i < 2; ++i) {
        drop({elsewhere("cube.obj")});
        EXPECT_TRUE(said("cube-2.obj")) << editor->notice;
        EXPECT_EQ(pathsOf(graph()).back(), "cube-2.obj");
    }
    EXPECT_EQ(readText(work("cube.obj")), cubeText());
    EXPECT_EQ(readText(work("cube-2.obj")), cubeText(1));
    EXPECT_FALSE(fs::exists(work("cube-3.obj")));
    // A link out of the folder leads to nothing that the graph may read.
    fs::create_symlink(elsewhere("cube.obj"), work("link.obj"));
    drop({work("link.obj")});
    EXPECT_EQ(pathsOf(graph()).back(), "link-2.obj");
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(work("link-2.obj"))));
}

TEST_F(Dropped, WhatCannotBeDoneIsSaid) {
    const auto refused = [&](const std::vector<std::string>& files, const std::string& words) {
        drop(files);
        EXPECT_TRUE(said(words)) << words << ": " << editor->notice;
        EXPECT_EQ(graph().nodes.size(), 1u);
        EXPECT_FALSE(editor->document.canUndo());
    };
    for (const char* name : {"a.pdf", "a.json", "a", "a.obj.zip"}) {
        writeText(elsewhere(name), "x");
        refused({elsewhere(name)},
                std::string(name) + " cannot be dropped here: what can is a picture (.png, ");
    }
    writeText(elsewhere("a.field.json"), R"({"fieldwright": 1, "nodes": []})");
    refused({elsewhere("cube.obj"), elsewhere("a.field.json")}, "drop one graph by itself");
    writeText(elsewhere("a.gltf"), R"({"buffers": [{"uri": "a.bin"}]})");
    writeText(elsewhere("a.bin"), "x");
    writeText(work("a.bin"), "another");
    refused({elsewhere("a.gltf")}, "a.gltf reads a.bin, and there is another a.bin");
    fs::remove(work("a.bin"));
    fs::create_directory(elsewhere("folder.obj"));
    refused({elsewhere("folder.obj")}, "folder.obj is no ordinary file");
    refused({elsewhere("gone.obj")}, "gone.obj is no ordinary file");
    fs::copy_file(elsewhere("cube.obj"), elsewhere("caf\xe9.obj"));
    refused({elsewhere("caf\xe9.obj")}, "UTF-8");
    EXPECT_TRUE(fs::is_empty(work("sub")));
    EXPECT_EQ(std::distance(fs::directory_iterator(work("")), {}), 1);  // nothing was copied

    // What can be done of several files is.
    drop({elsewhere("gone.obj"), elsewhere("cube.obj")});
    EXPECT_TRUE(said("gone.obj is no ordinary file; copied cube.obj")) << editor->notice;
    EXPECT_EQ(graph().nodes.size(), 3u);
    // A window that asks is answered first.
    editor->files.message = {"Title", "Text"};
    editor.settle();
    drop({elsewhere("cube.obj")});
    EXPECT_TRUE(said("close the window that asks")) << editor->notice;
    EXPECT_EQ(graph().nodes.size(), 3u);
}

TEST_F(Dropped, PicturesAndParticlesBecomeNodesToo) {
    fw::test::writePictureFile(elsewhere("hill.png"), 2, 2, std::vector<uint8_t>(12, 200));
    writeText(elsewhere("drops.csv"), "0 0 0\n0.1 0 0\n");
    drop({elsewhere("drops.csv"), elsewhere("hill.png")});
    EXPECT_TRUE(said("copied drops.csv beside the document; copied hill.png")) << editor->notice;
    EXPECT_EQ(sourceOf(graph(), "out", "surface"), "particles_to_field");
    EXPECT_EQ(sourceOf(graph(), "particles_to_field", "particles"), "particle_file");
    const auto textOf = [&](const char* node, const char* input) {
        return std::get<std::string>(graph().node(node)->input(input)->value);
    };
    EXPECT_EQ(textOf("particle_file", "path"), "drops.csv");
    EXPECT_EQ(textOf("heightfield", "image"), "hill.png");
    EXPECT_EQ(errorsOf(graph()), "");
    EXPECT_EQ(editor->document.undoName(), "Add Files");
}

TEST_F(Dropped, AFileThatChangesIsReadAnew) {
    const std::vector<std::string> path{"cube.obj"};
    editor->document.apply("Add", addFileNodes(graph(), "", path, {}).graph);
    editor.waitForPicture();
    const auto found = [&] {
        const std::vector<Error>& findings = editor->viewport.shown.findings;
        return findings.empty() ? "" : findings[0].message;
    };
    EXPECT_NE(found().find("does not exist"), std::string::npos) << found();
    const uint64_t before = editor->document.revision();
    writeText(work("cube.obj"), "v 0 0 0\n");
    for (int i = 0; i < 200 && editor->document.revision() == before; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        exchange(*editor);
    }
    editor.waitForPicture();
    EXPECT_NE(found().find("has no faces"), std::string::npos) << found();
    EXPECT_EQ(editor->document.undoName(), "Add");  // it is no step of its own
}

TEST_F(Dropped, PastedNodesOfAnotherDocumentBringTheirFiles) {
    drop({elsewhere("cube.obj")});
    editor->document.setPath(work("g.field.json"));
    editor.keys("ctrl+c");
    // Another document, of another folder.
    fs::create_directories(editor.path("other"));
    editor->document.apply("Empty", graphOf(kOut));
    editor->document.setPath(editor.path("other/h.field.json"));
    writeText(editor.path("other/cube.obj"), cubeText(1));
    editor.settle();
    editor.keys("ctrl+v");
    EXPECT_EQ(pathsOf(graph()), std::vector<std::string>{"cube-2.obj"});
    EXPECT_TRUE(said("copied cube.obj as cube-2.obj")) << editor->notice;
    EXPECT_EQ(readText(editor.path("other/cube-2.obj")), cubeText());
    // One that has no folder yet cannot have it.
    editor->document.apply("Empty", graphOf(kOut));
    editor->document.setPath("");
    editor.settle();
    editor.keys("ctrl+v");
    EXPECT_TRUE(said("save the document, and paste them again")) << editor->notice;
    EXPECT_EQ(pathsOf(graph()), std::vector<std::string>{"cube.obj"});
}

TEST_F(Dropped, ADocumentWithoutAFileIsSavedFirst) {
    editor->document.setPath("");
    editor->files.browser.folder = work("");
    drop({elsewhere("cube.obj")});
    EXPECT_TRUE(said("save the document first")) << editor->notice;
    EXPECT_EQ(graph().nodes.size(), 1u);
    // What is not saved gets no mesh, not even later.
    editor.keys("Escape");
    EXPECT_EQ(graph().nodes.size(), 1u);
    drop({elsewhere("cube.obj")});
    editor.type("new");
    editor.keys("Return");
    EXPECT_EQ(graph().path, work("new.field.json"));
    EXPECT_EQ(pathsOf(graph()), std::vector<std::string>{"cube.obj"});
    EXPECT_TRUE(fs::exists(work("cube.obj")));

    // Saved elsewhere, it takes its mesh along, and reads it there under the name that it has got.
    writeText(work("sub/cube.obj"), cubeText(1));
    ASSERT_TRUE(writeFile(*editor, work("sub/other.field.json")));
    EXPECT_TRUE(said("copied cube.obj as cube-2.obj")) << editor->notice;
    EXPECT_EQ(readText(work("sub/cube-2.obj")), cubeText());
    EXPECT_EQ(pathsOf(graph()), std::vector<std::string>{"cube-2.obj"});
    EXPECT_EQ(pathsOf(parsed(readText(work("sub/other.field.json")))), pathsOf(graph()));
    EXPECT_EQ(readText(work("new.field.json")).find("cube-2"), std::string::npos);
    EXPECT_FALSE(editor->document.unsaved());
}

TEST_F(Dropped, WhatIsToBeKnownOfAMeshIsAWarning) {
    writeText(work("open.obj"), cubeText(2));
    drop({work("open.obj")});
    editor.waitForPicture();
    const PreviewResult& shown = editor->viewport.shown;
    EXPECT_TRUE(shown.current);
    ASSERT_EQ(shown.findings.size(), 1u);
    EXPECT_EQ(shown.findings[0].severity, Error::Severity::warning);
    EXPECT_EQ(shown.findings[0].node, "mesh_to_field");
    EXPECT_NE(shown.findings[0].message.find("open"), std::string::npos) << shown.findings[0].message;
    const CanvasMarks marks = marksOf(*editor);
    ASSERT_TRUE(marks.findings.contains("mesh_to_field"));
    EXPECT_EQ(marks.findings.find("mesh_to_field")->second, &shown.findings[0]);

    // A file that is no mesh is an error, and what was seen stays.
    writeText(work("bad.obj"), "f 1 2 3\n");
    editor->document.apply("Set Path",
                           setInput(graph(), "", {"mesh_file", "path"}, InputValue{.value = "bad.obj"}));
    editor.waitForPicture();
    EXPECT_FALSE(shown.current);
    ASSERT_EQ(shown.findings.size(), 1u);
    EXPECT_EQ(shown.findings[0].severity, Error::Severity::error);
    EXPECT_NE(shown.findings[0].message.find("bad.obj"), std::string::npos);
}

}  // namespace fw::editor::test::drop_test
