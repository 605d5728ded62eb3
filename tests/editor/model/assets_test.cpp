// The files that a document reads: nodes for them, copies of them where it is saved, and what changes of
// them.
#include "editor/files/assets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "editor/document/file_nodes.h"
#include "editor/document/soundness.h"
#include "editor/files/watch.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::test::assets_test {

namespace fs = std::filesystem;
using fw::test::readText;
using fw::test::TempDir;
using fw::test::writeText;
using Paths = std::vector<std::string>;

/// A graph that reads all three kinds of files.
Graph reading(const std::string& mesh, const std::string& particles, const std::string& picture) {
    return graphOf(R"({"id": "out", "type": "output"},
        {"id": "m", "type": "mesh_file", "inputs": {"path": ")" +
                   mesh + R"("}}, {"id": "p", "type": "particle_file", "inputs": {"path": ")" + particles +
                   R"("}}, {"id": "t", "type": "triplanar", "inputs": {"image": ")" + picture + R"("}})");
}
Paths pathsOf(const Graph& graph) {
    Paths paths;
    for (const NamedFile& file : namedFiles(graph)) paths.push_back(file.path);
    return paths;
}
/// What lies in the folder and in those below it.
Paths filesIn(const std::string& folder) {
    Paths paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (!entry.is_directory()) paths.push_back(fs::relative(entry.path(), folder).string());
    std::ranges::sort(paths);
    return paths;
}

TEST(FileNodes, EveryEndingHasANode) {
    for (const FileKind* kind : fileKindsOfNodes())
        for (const std::string_view ending : kind->endings) {
            const std::string path = "a" + std::string(ending);
            const std::optional<FileInput> input = fileInputFor(path);
            ASSERT_TRUE(input) << path;
            EXPECT_TRUE(endsAs(*input->input->file, path)) << path;
            // Its nodes end in a surface, which the output shows.
            const Edited edited =
                addFileNodes(graphOf(R"({"id": "out", "type": "output"})"), "", Paths{path}, {10, 20});
            ASSERT_EQ(edited.nodes.size(), fileNodeCount(Paths{path})) << path;
            EXPECT_EQ(edited.graph.node(edited.nodes[0])->type, input->type->id);
            EXPECT_EQ(edited.graph.node(edited.nodes[0])->at, (Position{10, 20}));
            EXPECT_EQ(pathsOf(edited.graph), Paths{path});
            const InputValue* shown = edited.graph.node("out")->input("surface");
            ASSERT_TRUE(shown) << path;
            EXPECT_EQ(std::get<Link>(shown->value).node, edited.nodes.back());
            EXPECT_EQ(errorCount(edited.graph), 0u) << path;
        }
    EXPECT_EQ(fileInputFor("a.PNG")->type->id, "heightfield");
    EXPECT_EQ(fileInputFor("a.ply")->type->id, "mesh_file");
    EXPECT_EQ(fileInputFor("a.csv")->type->id, "particle_file");
    for (const char* path : {"", "a", "png", "a.pdf", "a.png.zip", "a.field.json"})
        EXPECT_FALSE(fileInputFor(path)) << path;
}

TEST(FileNodes, StandBelowOneAnother) {
    const Paths paths{"a.png", "b.csv", "c.obj"};
    const Edited edited = addFileNodes({}, "", paths, {0, 0});
    EXPECT_EQ(edited.nodes,
              (NodeIds{"heightfield", "particle_file", "particles_to_field", "mesh_file", "mesh_to_field"}));
    const auto y = [&](const char* id) { return (*edited.graph.node(id)->at)[1]; };
    EXPECT_GT(y("particle_file"), y("heightfield") + 50);
    EXPECT_EQ(y("particle_file"), y("particles_to_field"));
    EXPECT_GT(y("mesh_file"), y("particle_file") + 50);
    const Position size = sizeOfFileNodes(paths);
    EXPECT_GT(size[1], y("mesh_file"));
    EXPECT_GT(size[0], (*edited.graph.node("mesh_to_field")->at)[0]);
}

TEST(FileNodes, AWrongFileKeepsNoNodeFromBeingAdded) {
    const Graph graph = reading("a.obj", "a.csv", "a.png"), wrong = reading("a.png", "a.glb", "a.png");
    EXPECT_EQ(newError(graph, wrong), std::nullopt);
    EXPECT_EQ(errorCount(wrong), 0u);
}

class Brought : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* name : {"from/sub", "to"}) fs::create_directories(folder.path(name));
        write("from/m.obj", "mtllib colours.mtl\nv 0 0 0\n");
        write("from/colours.mtl", "newmtl red\n");
        write("from/sub/p.csv", "1 2 3\n");
        write("from/t.png", "picture");
    }
    void write(const std::string& name, const std::string& text) { writeText(folder.path(name), text); }
    std::string read(const std::string& name) { return readText(folder.path(name)); }
    Graph bring(const Graph& graph) {
        told.clear();
        return bringFiles(graph, folder.path("from"), folder.path("to"), told);
    }
    const TempDir folder;
    std::vector<std::string> told;
};

TEST_F(Brought, AllKindsGoToTheNewFolderWithWhatTheyName) {
    const Graph graph = reading("m.obj", "sub/p.csv", "t.png");
    for (int again = 0; again < 2; ++again) {
        EXPECT_EQ(bring(graph), graph);
        EXPECT_EQ(told, Paths{});
        EXPECT_EQ(filesIn(folder.path("to")), (Paths{"colours.mtl", "m.obj", "sub/p.csv", "t.png"}));
    }
    EXPECT_EQ(read("to/sub/p.csv"), "1 2 3\n");

    write("from/b.gltf", R"({"buffers": [{"uri": "sub/a%20b.bin"}, {"uri": "../out.bin"}]})");
    write("from/sub/a b.bin", "bytes");
    write("out.bin", "not to be taken along");
    bring(reading("b.gltf", "", ""));
    EXPECT_EQ(told, Paths{});
    EXPECT_EQ(read("to/sub/a b.bin"), "bytes");
    EXPECT_FALSE(fs::exists(folder.path("to/out.bin")));
}

TEST_F(Brought, NoFileIsReplaced) {
    write("to/t.png", "another");
    write("to/m.obj", read("from/m.obj"));
    const Graph brought = bring(reading("m.obj", "sub/p.csv", "t.png"));
    EXPECT_EQ(pathsOf(brought), (Paths{"m.obj", "sub/p.csv", "t-2.png"}));
    EXPECT_EQ(told, Paths{"copied t.png as t-2.png since there is another of its name"});
    EXPECT_EQ(read("to/t.png"), "another");
    EXPECT_EQ(read("to/t-2.png"), "picture");
    // Again, it is there.
    EXPECT_EQ(pathsOf(bring(reading("m.obj", "sub/p.csv", "t.png"))),
              (Paths{"m.obj", "sub/p.csv", "t-2.png"}));
    EXPECT_EQ(told, Paths{});

    // A mesh that would read another's colours stays.
    write("from/n.obj", "mtllib colours.mtl\n");
    write("from/colours.mtl", "newmtl blue\n");
    EXPECT_EQ(pathsOf(bring(reading("n.obj", "", ""))), Paths{"n.obj"});
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("n.obj reads colours.mtl, and there is another"), std::string::npos) << told[0];
    EXPECT_FALSE(fs::exists(folder.path("to/n.obj")));
}

TEST_F(Brought, WhatTheGraphDoesNotReadStays) {
    write("out.png", "secret");
    fs::create_symlink(folder.path("out.png"), folder.path("from/link.png"));
    fs::create_directory(folder.path("from/folder.csv"));
    for (const std::string& picture :
         {std::string("../out.png"), std::string("link.png"), folder.path("from/t.png")})
        EXPECT_EQ(pathsOf(bring(reading("gone.obj", "folder.csv", picture))),
                  (Paths{"gone.obj", "folder.csv", picture}));
    EXPECT_EQ(told, Paths{});
    EXPECT_EQ(filesIn(folder.path("to")), Paths{});
    // Nor is anything written where a link leads.
    fs::create_directory(folder.path("elsewhere"));
    fs::create_directory_symlink(folder.path("elsewhere"), folder.path("to/sub"));
    bring(reading("", "sub/p.csv", ""));
    EXPECT_EQ(filesIn(folder.path("elsewhere")), Paths{});
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("p.csv cannot be copied to "), std::string::npos) << told[0];
}

TEST_F(Brought, WhatCannotBeCopiedIsTold) {
    write("to/sub", "a file where a folder is wanted");
    bring(reading("", "sub/p.csv", ""));
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("p.csv cannot be copied to "), std::string::npos) << told[0];
}

TEST_F(Brought, ChangesOfEveryKindAreNoticed) {
    Graph graph = reading("m.obj", "sub/p.csv", "gone.png");
    graph.path = folder.path("from/g.field.json");
    const auto shared = std::make_shared<const Graph>(graph);
    AssetWatch watch;
    AssetWatch::Clock::time_point now = AssetWatch::Clock::now();
    const auto look = [&](const std::shared_ptr<const Graph>& at) {
        now += std::chrono::milliseconds(int(1000 * kWatchSeconds) + 1);
        return watch.look(at, now);
    };
    EXPECT_FALSE(look(shared));
    for (const char* name : {"from/m.obj", "from/sub/p.csv", "from/gone.png"}) {
        write(name, "something longer than it was");
        EXPECT_FALSE(watch.look(shared, now)) << name;  // not as often as that
        EXPECT_TRUE(look(shared)) << name;
        EXPECT_FALSE(look(shared)) << name;
    }
    write("from/t.png", "what it does not read");
    EXPECT_FALSE(look(shared));
    // What is away for a moment has not changed yet.
    fs::rename(folder.path("from/m.obj"), folder.path("away"));
    EXPECT_FALSE(look(shared));
    fs::rename(folder.path("away"), folder.path("from/m.obj"));
    EXPECT_FALSE(look(shared));
    // Another document of the same folder.
    Graph other = reading("", "", "t.png");
    other.path = graph.path;
    const auto next = std::make_shared<const Graph>(other);
    EXPECT_FALSE(look(next));
    write("from/t.png", "now it does");
    EXPECT_TRUE(look(next));
    write("from/m.obj", "and this no more, however long it is");
    EXPECT_FALSE(look(next));
}

}  // namespace fw::editor::test::assets_test
