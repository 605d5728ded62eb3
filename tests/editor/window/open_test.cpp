// Files as the editor in its window handles them: what is wrong with them, what other programs do to them,
// samples, and what is dropped on the window.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>

#include "editor/editor.h"
#include "graph/document/json.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::editor::open_test {

namespace fs = std::filesystem;
using Origin = Files::Origin;
using fw::test::readText;
using fw::test::TempDir;
using fw::test::writeText;

constexpr const char* kGood = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}]})";
constexpr const char* kOther = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "inputs": {"radius": 0.75}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}]})";
constexpr const char* kPartly = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "inputs": {"radius": null, "p": [0, 1, 0]}},
    {"id": 7, "type": "box"},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}]})";

class FilesInWindow : public testing::Test {
  protected:
    void SetUp() override {
        NEEDS_DISPLAY(display);
        for (const char* name : {"XDG_CONFIG_HOME", "XDG_STATE_HOME"})
            setenv(name, folder.path(std::string("home-") + name).c_str(), 1);
        shell.emplace(ShellOptions{.width = 640, .height = 480, .scale = 1.0f});
        editor.emplace(*shell, Graph(), DeviceOptions{});
        fs::create_directory(folder.path("files"));
    }
    std::string path(const std::string& name) const { return folder.path("files/" + name); }
    std::string written(const std::string& name, const char* text) const {
        writeText(path(name), text);
        return path(name);
    }
    void frames(int count = 3) {
        for (int i = 0; i < count; ++i) {
            shell->waitEvents(0.0);
            exchange(*editor);
            shell->frame([&] { showEditor(*editor); });
        }
    }
    /// Frames until it holds, at most some seconds.
    template <class Until>
    bool framesUntil(Until until) {
        for (int i = 0; i < 1000 && !until(); ++i) frames(1), fw::test::rest(0.01);
        return until();
    }
    void press(int key) {
        GLFWkeyfun keyed = glfwSetKeyCallback(shell->window(), nullptr);
        glfwSetKeyCallback(shell->window(), keyed);
        for (const int action : {GLFW_PRESS, GLFW_RELEASE}) {
            keyed(shell->window(), key, 0, action, 0);
            frames();
        }
    }
    const Graph& graph() const { return editor->document.graph(); }
    double radius() const { return std::get<double>(graph().node("ball")->input("radius")->value); }

    TempDir folder;
    fw::test::VirtualDisplay display{800, 600};
    std::optional<Shell> shell;
    std::optional<Editor> editor;
};

TEST_F(FilesInWindow, OpensWhatCanBeReadAndKeepsTheRest) {
    const std::string file = written("partly.field.json", kPartly);
    startFiles(*editor, file);
    frames();
    ASSERT_EQ(graph().nodes.size(), 2u);
    EXPECT_EQ(graph().node("ball")->input("radius"), nullptr);
    EXPECT_NE(graph().node("ball")->input("p"), nullptr);
    ASSERT_EQ(editor->files.found.size(), 2u);
    EXPECT_EQ(editor->files.found[0].line, 2);
    EXPECT_EQ(editor->files.found[1].line, 3);
    EXPECT_NE(editor->files.message.title, "");
    EXPECT_EQ(editor->files.origin, Origin::partly);
    editor->files.message = {};

    EXPECT_FALSE(save(*editor));  // a question instead
    frames();
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId));
    EXPECT_EQ(readText(file), kPartly);
    ASSERT_TRUE(writeFile(*editor, file));
    EXPECT_EQ(readText(file + ".old"), kPartly);
    EXPECT_TRUE(readGraph(file, nullptr));
    EXPECT_EQ(editor->files.origin, Origin::own);
    EXPECT_TRUE(editor->files.found.empty());
    EXPECT_TRUE(save(*editor));

    // Under another name the file is left alone.
    openFile(*editor, written("second.field.json", kPartly));
    ASSERT_TRUE(writeFile(*editor, path("third.field.json")));
    EXPECT_EQ(readText(path("second.field.json")), kPartly);
    EXPECT_FALSE(fs::exists(path("second.field.json.old")));
    EXPECT_EQ(graph().path, path("third.field.json"));
}

TEST_F(FilesInWindow, WhatIsNoGraphIsExplained) {
    const std::string file = written("bad.field.json", "{\"fieldwright\": 1,\n \"nodes\": [}");
    startFiles(*editor, file);
    frames();
    EXPECT_TRUE(graph().nodes.empty());
    EXPECT_EQ(graph().path, "");
    ASSERT_EQ(editor->files.message.problems.size(), 1u);
    EXPECT_EQ(editor->files.message.problems[0].line, 2);
    EXPECT_EQ(editor->files.message.problems[0].file, "bad.field.json");
    EXPECT_FALSE(save(*editor));
    EXPECT_EQ(editor->files.browser.folder, path("").substr(0, path("").size() - 1));
    EXPECT_NE(readText(file), writeGraph(graph()));

    openFile(*editor, written("good.field.json", kGood));
    for (const std::string& each : {file, path("none.field.json"), folder.path("files")}) {
        editor->files.message = {};
        openFile(*editor, each);
        EXPECT_NE(editor->files.message.title, "") << each;
        EXPECT_EQ(graph().path, path("good.field.json"));
        EXPECT_EQ(graph().nodes.size(), 2u);
    }
}

TEST_F(FilesInWindow, AFileThatIsNotThereYetIsMadeBySaving) {
    startFiles(*editor, path("new.field.json"));
    frames();
    EXPECT_EQ(graph().path, path("new.field.json"));
    EXPECT_NE(editor->notice.find("does not exist yet"), std::string::npos);
    EXPECT_FALSE(editor->document.unsaved());
    EXPECT_TRUE(save(*editor));
    EXPECT_EQ(readText(path("new.field.json")), writeGraph(graph()));
}

TEST_F(FilesInWindow, SoundFormWithWrongContentIsShown) {
    const std::string begin = R"({"fieldwright": 1, "nodes": [)";
    const std::string documents[] = {
        begin + R"({"id": "a", "type": "no_such_type", "inputs": {"x": 1, "y": {"from": "nobody"}}}]})",
        begin + R"({"id": "a", "type": "sphere"}, {"id": "a", "type": "box"}]})",
        begin + R"({"id": "a", "type": "union", "inputs": {"a": {"from": "b"}}},
                   {"id": "b", "type": "union", "inputs": {"a": {"from": "a", "output": "none"}}}]})",
        begin + R"({"id": "a", "type": "union", "inputs": {"a": {"from": "a"}}}]})",
        begin + R"({"id": "a", "type": "group", "group": "g"}],
                   "groups": [{"id": "g", "nodes": [{"id": "i", "type": "group", "group": "g"}]}]})",
        begin + R"({"id": "a", "type": "group", "group": "nowhere"}, {"id": "", "type": "group_output"}]})",
        begin + R"({"id": "A b", "type": "expression", "code": "}{", "at": [1e300, -1e300]}]})",
        begin + R"(], "timeline": {"tracks": 7}, "scene": {"camera": "x"}, "frames": [1, {}],
                   "parameters": [{"name": "x", "node": "n", "input": "i"}]})",
        begin +
            R"({"id": "a", "type": "sphere", "inputs": {"radius": [1, 2, 3], "radius2": true, "p": "x"}}]})",
    };
    for (const std::string& text : documents) {
        SCOPED_TRACE(text);
        openFile(*editor, written("wrong.field.json", text.c_str()));
        EXPECT_EQ(graph().path, path("wrong.field.json"));
        EXPECT_EQ(editor->files.origin, Origin::own);
        EXPECT_TRUE(framesUntil([&] {
            return editor->viewport.shown.revision == editor->document.revision() &&
                   !editor->viewport.shown.findings.empty();
        }));
        for (const Node& node : graph().nodes) {
            editor->canvas.select({node.id});
            frames(1);
        }
        EXPECT_TRUE(save(*editor));
        EXPECT_TRUE(readGraph(path("wrong.field.json"), nullptr));
    }
}

TEST_F(FilesInWindow, RemembersWhatWasOpenedAndHearsOfDroppedFiles) {
    const std::string a = written("a.field.json", kGood), b = written("b.field.json", kOther);
    startFiles(*editor, a);
    frames();
    GLFWdropfun drop = glfwSetDropCallback(shell->window(), nullptr);
    ASSERT_NE(drop, nullptr);
    glfwSetDropCallback(shell->window(), drop);
    const char* paths[] = {b.c_str()};
    drop(shell->window(), 1, paths);
    EXPECT_TRUE(shell->waitEvents(0.0));
    frames();
    EXPECT_EQ(graph().path, b);
    std::string problem;
    EXPECT_EQ(readPreferences(preferencesPath(), problem).recent, (std::vector<std::string>{b, a}));

    // What is unsaved stays open behind.
    Graph changed = graph();
    changed.node("ball")->label = "x";
    editor->document.apply("Rename", changed);
    paths[0] = a.c_str();
    drop(shell->window(), 1, paths);
    frames();
    EXPECT_EQ(graph().path, a);
    ASSERT_TRUE(unsavedTab(*editor));
    showTab(*editor, *unsavedTab(*editor));
    EXPECT_EQ(graph().path, b);
    EXPECT_EQ(graph().node("ball")->label, "x");
}

TEST_F(FilesInWindow, SamplesOpenAsCopies) {
    const std::string samples = samplesFolder();
    ASSERT_EQ(samples, std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples");
    const std::string island = samples + "/island.field.json", before = readText(island);
    editor->files.samples.opening = true;
    ASSERT_TRUE(framesUntil([&] {
        const std::vector<ImTextureID>& textures = editor->files.samples.textures;
        return !textures.empty() && std::ranges::all_of(textures, [](ImTextureID id) { return id; });
    }));
    const std::vector<Sample>& all = editor->files.samples.all;
    const auto found = std::ranges::find(all, island, &Sample::path);
    ASSERT_NE(found, all.end());
    EXPECT_EQ(found->label, "Island");
    const Picture picture = pictureOf(*found);
    EXPECT_EQ(std::pair(picture.width, picture.height), std::pair(240, 135));
    frames();
    if (const char* shots = std::getenv("FIELDWRIGHT_SHOTS"))
        (void)savePicture(shell->capture(), std::string(shots) + "/samples.png");

    openFile(*editor, island);
    frames();
    EXPECT_EQ(editor->files.origin, Origin::sample);
    EXPECT_EQ(nameOf(*editor), "untitled");
    EXPECT_TRUE(editor->files.preferences.recent.empty());
    EXPECT_FALSE(save(*editor));
    EXPECT_EQ(editor->files.browser.name, "island.field.json");
    EXPECT_NE(editor->files.browser.folder, samples);
    ASSERT_TRUE(writeFile(*editor, path("mine.field.json")));
    EXPECT_EQ(readText(path("textures/island.png")), readText(samples + "/textures/island.png"));
    EXPECT_EQ(readText(island), before);
    EXPECT_EQ(editor->files.origin, Origin::own);
    EXPECT_EQ(nameOf(*editor), "mine.field.json");
}

TEST_F(FilesInWindow, ReloadsWhatAnotherProgramChanged) {
    const std::string file = written("a.field.json", kGood);
    startFiles(*editor, file);
    frames();
    editor->canvas.select({"ball"});
    editor->canvas.view.middle = {123, 45};
    writeText(file, kOther);
    ASSERT_TRUE(framesUntil([&] { return radius() == 0.75; }));
    EXPECT_FALSE(editor->document.unsaved());
    EXPECT_EQ(editor->document.undoName(), "Reload");
    EXPECT_EQ(editor->canvas.active, "ball");
    EXPECT_EQ(editor->canvas.view.middle.x, 123);
    EXPECT_TRUE(editor->document.undo());
    EXPECT_EQ(radius(), 0.5);
    EXPECT_TRUE(editor->document.unsaved());

    // With changes here it is asked first.
    Graph mine = graph();
    mine.node("ball")->label = "mine";
    editor->document.apply("Rename", mine);
    std::string theirs = kOther;
    theirs.replace(theirs.find("0.75"), 4, "0.25");
    writeText(file, theirs);
    ASSERT_TRUE(framesUntil([&] { return editor->files.outside.has_value(); }));
    frames();
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId));
    EXPECT_EQ(radius(), 0.5);
    reload(*editor, *editor->files.outside);
    editor->files.outside.reset();
    EXPECT_EQ(radius(), 0.25);
    EXPECT_TRUE(editor->document.undo());
    EXPECT_EQ(graph().node("ball")->label, "mine");

    // What it cannot read it does not take, and does not overwrite either.
    EXPECT_TRUE(writeFile(*editor, file));
    writeText(file, "half a fi");
    ASSERT_TRUE(framesUntil([&] { return editor->files.origin == Origin::partly; }));
    EXPECT_EQ(graph().node("ball")->label, "mine");
    EXPECT_TRUE(editor->document.unsaved());
    EXPECT_FALSE(save(*editor));
    EXPECT_EQ(readText(file), "half a fi");
}

TEST(Watch, WhatCannotBeReadForAWhileIsNoticedWhenItCan) {
    const TempDir folder;
    const std::string file = folder.path("a.field.json");
    writeText(file, kGood);
    FileWatch watch;
    watch.follow(file, kGood);
    EXPECT_FALSE(watch.lookNow());
    writeText(file, kOther);
    rlimit old{};
    ASSERT_EQ(0, ::getrlimit(RLIMIT_NOFILE, &old));
    const rlimit none{0, old.rlim_max};
    ASSERT_EQ(0, ::setrlimit(RLIMIT_NOFILE, &none));
    const bool noticed = watch.lookNow().has_value();
    ASSERT_EQ(0, ::setrlimit(RLIMIT_NOFILE, &old));
    EXPECT_FALSE(noticed);
    const auto change = watch.lookNow();
    ASSERT_TRUE(change);
    EXPECT_EQ(change->text, kOther);
}

TEST_F(FilesInWindow, AFileThatWasMendedOutsideIsWholeAgain) {
    const std::string file = written("a.field.json", kPartly);
    startFiles(*editor, file);
    frames();
    ASSERT_EQ(editor->files.origin, Origin::partly);
    press(GLFW_KEY_ESCAPE);  // that parts of it could not be read
    writeText(file, kGood);
    EXPECT_TRUE(framesUntil([&] { return editor->files.origin == Origin::own; }));
    ASSERT_NE(graph().node("ball")->input("radius"), nullptr);
    EXPECT_TRUE(save(*editor)) << "it holds nothing that is not here";
}

TEST_F(FilesInWindow, WhatAnotherProgramWroteIsNotSavedOverBeforeItIsDecided) {
    const std::string file = written("a.field.json", kGood);
    startFiles(*editor, file);
    frames();
    Graph mine = graph();
    mine.node("ball")->label = "mine";
    editor->document.apply("Rename", mine);
    writeText(file, kOther);
    for (int i = 0; i < 2; ++i) {
        EXPECT_FALSE(save(*editor));
        ASSERT_TRUE(editor->files.outside);
        frames();
        EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId));
        press(GLFW_KEY_ESCAPE);
        EXPECT_FALSE(editor->files.outside);
        EXPECT_EQ(readText(file), kOther) << "it was asked about, and nothing was answered";
    }
    // Loaded as a step, it is no question any more.
    reload(*editor, kOther);
    EXPECT_TRUE(editor->document.undo());
    EXPECT_TRUE(save(*editor));
    EXPECT_EQ(graph().node("ball")->label, "mine");
}

TEST_F(FilesInWindow, AFileThatIsGoneCountsAsUnsaved) {
    const std::string file = written("a.field.json", kGood);
    startFiles(*editor, file);
    frames();
    fs::remove(file);
    ASSERT_TRUE(framesUntil([&] { return editor->document.unsaved(); }));
    EXPECT_NE(editor->notice.find("is gone"), std::string::npos);
    EXPECT_TRUE(save(*editor));
    EXPECT_FALSE(editor->document.unsaved());
    EXPECT_EQ(readText(file), writeGraph(graph()));
}

TEST_F(FilesInWindow, AFullDiskTakesNothing) {
    const std::string file = written("a.field.json", kGood);
    startFiles(*editor, file);
    frames();
    Graph changed = graph();
    changed.nodes[0].label = std::string(4000, 'x');
    editor->document.apply("Rename", changed);
    frames();
    rlimit old{};
    ASSERT_EQ(0, ::getrlimit(RLIMIT_FSIZE, &old));
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, old.rlim_max};
    ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &small));
    const bool saved = save(*editor);
    ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &old));
    ::signal(SIGXFSZ, handler);
    EXPECT_FALSE(saved);
    EXPECT_NE(editor->notice.find("File too large"), std::string::npos) << editor->notice;
    EXPECT_TRUE(editor->document.unsaved());
    EXPECT_EQ(readText(file), kGood);
    EXPECT_EQ(graph(), changed);
    // When there is room again it is saved.
    EXPECT_TRUE(save(*editor));
    EXPECT_FALSE(editor->document.unsaved());
    EXPECT_EQ(readText(file), writeGraph(graph()));
}

TEST_F(FilesInWindow, AnExportIsNotEndedUnasked) {
    openFile(*editor, std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/tower.field.json");
    frames();
    openExport(*editor);
    frames();
    EXPECT_EQ(fs::path(exportPath(*editor)).filename(), "tower.glb");
    EXPECT_NE(fs::path(exportPath(*editor)).parent_path(), samplesFolder());
    std::mutex held;
    std::unique_lock holds(held);
    editor->exporting.job = std::make_unique<ExportJob>(
        ExportWish{.graph = editor->graph, .path = path("tower.glb"), .mesh = {{}, 32}},
        [&] { std::lock_guard waits(held); });
    EXPECT_TRUE(exports(*editor));
    proceed(*editor, Files::Next::quit);
    frames();
    EXPECT_FALSE(editor->quit);
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId));
    EXPECT_FALSE(fs::exists(path("tower.glb")));
    holds.unlock();
    EXPECT_TRUE(framesUntil([&] { return editor->quit; }));
    EXPECT_TRUE(fs::exists(path("tower.glb")));
    frames();
    if (const char* shots = std::getenv("FIELDWRIGHT_SHOTS"))
        (void)savePicture(shell->capture(), std::string(shots) + "/export.png");
    editor->exporting.job.reset();
}

TEST_F(FilesInWindow, WhatThePreviewsFailureCouldTakeIsKept) {
    startFiles(*editor);
    Graph changed = *parseGraph(kGood, "", nullptr);
    editor->document.apply("Change", changed);
    frames();
    editor->viewport.shown.failure = "the device was lost";
    frames();
    EXPECT_EQ(editor->files.message.title, "The preview has stopped");
    const Result<Graph> kept = readGraph(editor->files.recovery.path(), nullptr);
    ASSERT_TRUE(kept);
    EXPECT_NE(kept->node("ball"), nullptr);
    EXPECT_NE(editor->files.message.text.find(editor->files.recovery.path()), std::string::npos);
    editor->files.recovery.discard();
}

}  // namespace fw::editor::open_test
