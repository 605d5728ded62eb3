// A person without a mouse: everything here is done by real keys.
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "editor/commands.h"
#include "editor/files/arrangement.h"
#include "editor/panels/side.h"
#include "graph/document/json.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::test::keyboard_only_test {

const Node* nodeOfType(const Graph& graph, std::string_view type) {
    for (const Node& node : graph.nodes)
        if (node.type == type) return &node;
    return nullptr;
}

std::string sourceOf(const Graph& graph, std::string_view type, std::string_view input) {
    const Node* node = nodeOfType(graph, type);
    const InputValue* value = node ? node->input(input) : nullptr;
    const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
    const Node* source = link ? graph.node(link->node) : nullptr;
    return source ? source->type : "";
}

TEST(KeyboardOnly, BuildsAUnionChangesAValueAndSaves) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    const auto graph = [&]() -> const Graph& { return editor->document.graph(); };
    const auto add = [&](const std::string& search) {
        editor.keys("shift+a");
        editor.type(search);
        editor.keys("Return");
    };
    const auto connect = [&](const std::string& search) {
        editor.keys("j");
        editor.type(search);
        editor.keys("Return");
    };
    for (const char* type : {"box", "sphere", "union"}) add(type);
    ASSERT_EQ(graph().nodes.size(), 3u);
    std::set<std::pair<double, double>> places;
    for (const Node& node : graph().nodes) EXPECT_TRUE(places.insert({(*node.at)[0], (*node.at)[1]}).second);
    connect("box union");
    connect("sphere union");
    EXPECT_EQ(sourceOf(graph(), "union", "a"), "box");
    EXPECT_EQ(sourceOf(graph(), "union", "b"), "sphere");
    add("output");
    connect("union output");
    EXPECT_EQ(sourceOf(graph(), "output", "surface"), "union");

    // From the output by arrows to the sphere, whose radius is typed.
    editor.keys("ctrl+l Home Left");
    EXPECT_EQ(editor->canvas.active, nodeOfType(graph(), "union")->id);
    editor.keys("Left");
    for (int i = 0; i < 2 && editor->canvas.active != nodeOfType(graph(), "sphere")->id; ++i)
        editor.keys(i == 0 ? "Down" : "Up Up");
    ASSERT_EQ(editor->canvas.active, nodeOfType(graph(), "sphere")->id);
    editor.keys("Return");
    editor.type("3/2");
    editor.keys("Return");
    const InputValue* radius = nodeOfType(graph(), "sphere")->input("radius");
    ASSERT_TRUE(radius);
    EXPECT_EQ(std::get<double>(radius->value), 1.5);

    // Moved, several at once, and a name.
    const Position before = *nodeOfType(graph(), "sphere")->at;
    editor.keys("ctrl+Right");
    editor.keys("ctrl+Down");
    EXPECT_EQ(*nodeOfType(graph(), "sphere")->at, (Position{before[0] + 24, before[1] + 24}));
    editor.keys("ctrl+z ctrl+z shift+Right");
    EXPECT_EQ(editor->canvas.selection.size(), 2u);
    editor.keys("Left F2");
    editor.type("Ball");
    editor.keys("Return");
    EXPECT_TRUE(std::ranges::any_of(graph().nodes, [](const Node& node) { return node.label == "Ball"; }));

    const std::string file = editor.path("by_keys.field.json");
    editor.keys("Escape ctrl+s");
    editor.keys("ctrl+a");
    editor.type(file);
    editor.keys("Return");
    EXPECT_FALSE(editor->document.unsaved());
    const Result<Graph> saved = readGraph(file, nullptr);
    ASSERT_TRUE(saved) << format(saved.error());
    EXPECT_EQ(sourceOf(*saved, "output", "surface"), "union");
}

TEST(KeyboardOnly, ReachesPanelsMenusAndBack) {
    DrivenEditor editor(*readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json", nullptr));
    NEEDS_EDITOR(editor);
    EXPECT_EQ(editor->panels.keyboard, Part::canvas);
    EXPECT_EQ(editor->canvas.active, "");
    editor.keys("Left");
    EXPECT_NE(editor->canvas.active, "");
    // To the panel: there arrows move about in it, and the selection on the canvas stays.
    const std::string active = editor->canvas.active;
    editor.keys("alt+3");
    EXPECT_EQ(editor->panels.keyboard, Part::side);
    const ImGuiID first = ImGui::GetCurrentContext()->NavId;
    EXPECT_NE(first, 0u);
    editor.keys("Down");
    EXPECT_NE(ImGui::GetCurrentContext()->NavId, first);
    EXPECT_EQ(editor->canvas.active, active);
    EXPECT_FALSE(ImGui::GetCurrentContext()->NavWindowingToggleLayer) << "Alt was held for a key";
    // Every panel in turn, and closed and opened by its command.
    std::set<std::string> seen;
    for (std::size_t i = 0; i < sidePanels().size(); ++i) {
        editor.keys("ctrl+Next");
        seen.insert(editor->panels.front);
    }
    EXPECT_EQ(seen.size(), sidePanels().size() - 4)
        << "all but statistics, history, library and probe, which are closed";
    editor.keys("Escape");
    EXPECT_EQ(editor->panels.keyboard, Part::canvas);
    for (const Part part : {Part::viewport, Part::side, Part::canvas}) {
        editor.keys("F6");
        EXPECT_EQ(editor->panels.keyboard, part);
    }
    // Alt goes to the menus; the first has New.
    editor.send("keydown alt");
    editor.send("keyup alt");
    editor.keys("Down");
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
    editor.keys("Escape Escape");
    EXPECT_FALSE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
}

TEST(KeyboardOnly, ThePaletteRunsWhatIsChosen) {
    DrivenEditor editor(*readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json", nullptr));
    NEEDS_EDITOR(editor);
    editor.keys("F3");
    editor.type("select all");
    editor.keys("Return");
    EXPECT_EQ(editor->canvas.selection.size(), editor->document.graph().nodes.size());
    editor.keys("F3");
    editor.type("statistics");
    editor.keys("Return");
    EXPECT_EQ(editor->panels.front, "statistics");
    EXPECT_EQ(editor->panels.keyboard, Part::side);
    // By arrows, past what cannot be done now.
    editor.keys("F3");
    editor.type("undo");
    editor.keys("Down Escape");
    EXPECT_FALSE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
}

TEST(KeyboardOnly, TheStatisticsLeadToTheNodeThatCostsMost) {
    DrivenEditor editor(test::parsed(R"({"fieldwright": 1, "nodes": [
        {"id": "box", "type": "box", "at": [0, 0]},
        {"id": "noise", "type": "noise", "at": [0, 200]},
        {"id": "bumps", "type": "displace", "at": [250, 0],
         "inputs": {"surface": {"from": "box"}, "amount": {"from": "noise"}}},
        {"id": "out", "type": "output", "at": [500, 0], "inputs": {"surface": {"from": "bumps"}, "resolution": 24}}]})"));
    NEEDS_EDITOR(editor);
    editor.waitForPicture();
    const std::vector<NodeEffort>& efforts = editor->viewport.shown.efforts;
    ASSERT_EQ(efforts.size(), 3u);
    EXPECT_EQ(efforts.front().node, "noise");
    EXPECT_TRUE(std::ranges::is_sorted(efforts, std::greater(), &NodeEffort::sample));
    editor.keys("F3");
    editor.type("statistics");
    editor.keys("Return");
    editor.settle();
    editor.keys("Down Up space");
    EXPECT_EQ(editor->canvas.selection, std::set<std::string>{"noise"});
}

TEST(KeyboardOnly, F1OpensThePageOfTheNode) {
    DrivenEditor editor(*readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json", nullptr));
    NEEDS_EDITOR(editor);
    editor->canvas.select({"rooms"});
    editor.keys("F1");
    EXPECT_TRUE(editor->windows.reference.open);
    EXPECT_EQ(editor->windows.reference.type, "repeat");
    editor.keys("Escape");
    EXPECT_FALSE(editor->windows.reference.open);
    editor.moveTo(editor.title("hollow"));
    editor.keys("F1");
    EXPECT_EQ(editor->windows.reference.type, "subtract") << "the node under the mouse comes first";
}

TEST(PreferencesWindow, RebindsAKeyAndResolvesAConflict) {
    DrivenEditor editor(*readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json", nullptr));
    NEEDS_EDITOR(editor);
    editor->canvas.select({"rooms"});
    const auto muted = [&] { return editor->document.graph().node("rooms")->muted; };
    editor.keys("ctrl+comma");
    // As if its button had been pressed: the key is waited for.
    const auto wait = [&] {
        editor->windows.preferences.command = &command("node.mute");
        editor->windows.preferences.key = 0;
    };
    wait();
    editor.keys("F9");
    EXPECT_EQ(editor->windows.preferences.command, nullptr);
    editor.keys("Escape");
    EXPECT_FALSE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup));
    editor.keys("m");
    EXPECT_FALSE(muted());
    editor.keys("F9");
    EXPECT_TRUE(muted());
    std::string problem;
    EXPECT_EQ(readPreferences(preferencesPath(), problem).shortcuts.at("node.mute"), "F9");

    editor.keys("ctrl+comma");
    wait();
    editor.keys("ctrl+d");
    ASSERT_TRUE(editor->windows.preferences.taken);
    editor.keys("Escape");
    EXPECT_EQ(keysOf(command("node.mute"), editor->files.preferences), "F9") << "it was left there";
    wait();
    editor.keys("ctrl+d");
    editor.keys("Return");
    EXPECT_EQ(keysOf(command("node.mute"), editor->files.preferences), "Ctrl+D");
    EXPECT_EQ(keysOf(command("edit.duplicate"), editor->files.preferences), "");
    wait();
    editor.keys("Escape");
    EXPECT_EQ(editor->windows.preferences.command, nullptr) << "Escape is no key";
    editor.keys("Escape");
    const std::size_t nodes = editor->document.graph().nodes.size();
    editor.keys("ctrl+d");
    EXPECT_FALSE(muted());
    EXPECT_EQ(editor->document.graph().nodes.size(), nodes);
}

TEST(PreferencesWindow, TheScaleCountsAtOnce) {
    DrivenEditor editor(*readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json", nullptr));
    NEEDS_EDITOR(editor);
    const float before = ImGui::GetFontSize();
    const float padding = ImGui::GetStyle().FramePadding.x;
    editor->shell.setScale(2.0f);
    editor.settle();
    EXPECT_EQ(editor->shell.scale(), 2.0f);
    EXPECT_EQ(ImGui::GetFontSize(), 2.0f * before);
    EXPECT_EQ(ImGui::GetStyle().FramePadding.x, 2.0f * padding);
    for (const float scale : {0.5f, 4.0f, 1.0f}) {
        const auto start = std::chrono::steady_clock::now();
        editor->shell.setScale(scale);
        editor.settle();
        std::printf(
            "interface at %g times: %.0f ms\n", double(scale),
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    EXPECT_EQ(ImGui::GetFontSize(), before);
    EXPECT_EQ(editor->shell.fonts().of(before)->FontSize, before);
}

TEST(Arrangement, IsKeptFromOneTimeToTheNext) {
    DrivenEditor editor;
    NEEDS_EDITOR(editor);
    editor->panels.scene = false;
    editor->panels.statistics = true;
    editor->panels.timeline = true;
    editor->panels.side = 0.5f;
    editor->panels.top = 0.25f;
    editor->canvas.minimap = false;
    editor.keys("ctrl+Next");
    const std::string front = editor->panels.front;
    const std::string path = editor.path("kept.json");
    keepArrangement(*editor, path);
    std::string problem;
    const Json kept = readPreferences(path, problem).panels;
    EXPECT_EQ(windowSizeOf(kept), (std::pair<int, int>(1280, 800)));

    editor->panels = {};
    editor->canvas.minimap = true;
    arrange(*editor, kept);
    editor.settle();
    EXPECT_FALSE(editor->panels.scene);
    EXPECT_TRUE(editor->panels.statistics);
    EXPECT_TRUE(editor->panels.timeline);
    EXPECT_FALSE(editor->canvas.minimap);
    EXPECT_EQ(editor->panels.side, 0.5f);
    EXPECT_EQ(editor->panels.top, 0.25f);
    EXPECT_EQ(editor->panels.front, front);

    // What is wrong in the file is left as it stands.
    for (const char* text : {"null", "[]", R"({"side": "wide", "top": 7, "scene": 1, "front": "nothing",
                             "window": [1, "x"], "minimap": null})"}) {
        arrange(*editor, Json::parse(text));
        EXPECT_EQ(windowSizeOf(Json::parse(text)), std::nullopt);
    }
    EXPECT_EQ(editor->panels.side, 0.5f);
    EXPECT_EQ(editor->panels.top, kMostPart);
    EXPECT_FALSE(editor->panels.scene);
    EXPECT_EQ(editor->panels.wanted, "");
}

}  // namespace fw::editor::test::keyboard_only_test
