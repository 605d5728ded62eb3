// docs/editor-tutorial.md, step by step with real keys and mouse events: what it tells to do builds the
// sample, and ends with docs/graphs/tutorial.field.json to the byte. With FIELDWRIGHT_TUTORIAL=FOLDER the
// pictures of the page are saved there (docs/pictures/make).
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cstdlib>

#include "editor/canvas/fields.h"
#include "graph/document/json.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/kept_graph.h"

namespace fw::editor::test::tutorial_test {

struct Lesson {
    DrivenEditor& editor;
    const Graph& graph() const { return editor->document.graph(); }

    /// "Press Shift+A, type and press Enter": the node's corner is where the mouse is.
    std::string add(const std::string& search, ImVec2 at) {
        editor.moveTo(editor->canvas.view.toScreen(at));
        editor.send("key --delay 0 shift+a type --delay 0 --args 1 '" + search + "' key Return");
        return editor->canvas.active;
    }
    void wire(const std::string& from, const std::string& to, const std::string& input) {
        editor.drag(out(from), editor.socket(to, input, false));
    }
    /// "Drag to an empty place and let go; type and press Enter".
    std::string lead(const std::string& from, const std::string& search, ImVec2 at) {
        editor.drag(out(from), editor->canvas.view.toScreen(at));
        editor.send("type --delay 0 --args 1 '" + search + "' key Return");
        return editor->canvas.active;
    }
    ImVec2 out(const std::string& node) {
        const NodeBox* box = editor->boxes->find(node);
        EXPECT_TRUE(box);
        return box ? editor.socket(node, box->rows.at(0).name, true) : ImVec2();
    }
    void set(const std::string& node, const std::string& input, const std::vector<std::string>& texts) {
        for (std::size_t i = 0; i < texts.size(); ++i) {
            editor.click(editor.field(node, input, int(i)));
            editor.send("type --delay 0 --args 1 '" + texts[i] + "' key Return");
        }
    }
    void picture(const std::string& name) {
        const char* folder = std::getenv("FIELDWRIGHT_TUTORIAL");
        if (!folder) return;
        editor.moveAway();
        editor.waitForBestPicture();
        ASSERT_TRUE(savePicture(editor.capture(), std::string(folder) + "/tutorial_" + name + ".png"));
    }
};

/// The field of code in the inspector, in pixels.
Area codeField() {
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
        if (window->WasActive && std::string_view(window->Name).find("##code") != std::string_view::npos)
            return {window->Pos, {window->Pos.x + window->Size.x, window->Pos.y + window->Size.y}};
    return {};
}

/// The numbers and words that a node holds, without its wires.
std::vector<std::pair<std::string, std::string>> valuesOf(const Node& node) {
    std::vector<std::pair<std::string, std::string>> values{{"", node.type + "\n" + node.code}};
    for (const auto& [name, value] : node.inputs) {
        std::string text;
        if (const auto* number = std::get_if<double>(&value.value)) text = numberText(*number);
        if (const auto* flag = std::get_if<bool>(&value.value)) text = *flag ? "true" : "false";
        if (const auto* list = std::get_if<std::vector<double>>(&value.value))
            for (const double number : *list) text += numberText(number) + " ";
        if (std::holds_alternative<Link>(value.value)) text = "a wire";
        values.emplace_back(name, text);
    }
    std::ranges::sort(values);
    return values;
}

TEST(Tutorial, BuildsTheTowerAsThePageTells) {
    DrivenEditor editor;
    ASSERT_TRUE(editor.works()) << "Xvfb or xdotool is not installed: run ./.install test";
    Lesson lesson{editor};
    // A software device takes long for a picture that nobody looks at.
    editor->panels.top = std::getenv("FIELDWRIGHT_TUTORIAL") ? 0.4f : kLeastPart;
    editor.keys("ctrl+n");
    EXPECT_EQ(lesson.graph().nodes.size(), 2u);
    editor.keys("ctrl+a x");
    EXPECT_EQ(lesson.graph().nodes.size(), 0u);
    lookExactly(editor->canvas.view, {0, 0});
    editor.settle();

    // A block.
    editor.moveTo(editor->canvas.view.toScreen(ImVec2(-424, -248)));
    editor.keys("shift+a");
    editor.type("box max");
    lesson.picture("1_add");
    editor.keys("Return");
    const std::string tower = editor->canvas.active;
    const std::string out = lesson.add("output", {360, -248});
    editor.click(editor.field(tower, "half_extents", 1));
    editor.send("type --args 1 2 key Return");
    lesson.wire(tower, out, "surface");
    lesson.picture("2_block");

    // Tubes.
    const std::string tubes = lesson.add("expression", {-424, -88});
    const Area code = codeField();
    ASSERT_GT(code.height(), 0.0f);
    const float em = ImGui::GetFontSize();
    for (const char* name : {"period", "half_width"}) {
        editor.click({code.lo.x + 4.0f * em,
                      code.hi.y + ImGui::GetStyle().ItemSpacing.y + 0.5f * ImGui::GetFrameHeight()});
        editor.send("type --delay 0 --args 1 " + std::string(name) + " key Return");
    }
    editor.click(code.centre());
    ImGui::SetClipboardText(
        "vec3 c = abs(mod(p, period) - period / 2) - half_width;\n"
        "return min(max(c.x, c.y), max(c.y, c.z), max(c.x, c.z));\n");
    editor.keys("ctrl+a");
    editor.keys("ctrl+v");
    editor.keys("ctrl+Return");
    lesson.set(tubes, "period", {"0.5"});
    lesson.set(tubes, "half_width", {"0.15"});
    const std::string pierced = lesson.add("subtract", {-120, -248});
    lesson.wire(tower, pierced, "a");
    lesson.wire(tubes, pierced, "b");
    lesson.wire(pierced, out, "surface");
    editor.click(editor.title(tubes));
    lesson.picture("3_tubes");

    // Rooms.
    const std::string room = lesson.add("box max", {-584, 80});
    lesson.set(room, "half_extents", {"0.45", "0.2", "0.45"});
    const std::string rooms = lesson.lead(room, "repeat", {-360, 80});
    lesson.set(rooms, "period", {"1", "1", "1"});
    editor.click(editor.field(rooms, "neighbours", 0));
    const std::string floors = lesson.lead(rooms, "translate", {-144, 80});
    lesson.set(floors, "offset", {"0.5", "0.25", "0.5"});
    const std::string hollow = lesson.add("subtract", {120, -248});
    lesson.wire(pierced, hollow, "a");
    lesson.wire(floors, hollow, "b");
    lesson.wire(hollow, out, "surface");
    lesson.set(out, "resolution", {"256"});
    lesson.picture("4_rooms");

    // A cut through it, by a node's own field.
    editor.click(editor.title(floors));
    editor.keys("ctrl+shift+p");
    lesson.picture("5_pinned");

    const Result<Graph> sample = readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/tower.field.json", nullptr);
    ASSERT_TRUE(sample);
    ASSERT_EQ(lesson.graph().nodes.size(), sample->nodes.size());
    for (const Node& wanted : sample->nodes)
        EXPECT_TRUE(std::ranges::any_of(lesson.graph().nodes,
                                        [&](const Node& node) { return valuesOf(node) == valuesOf(wanted); }))
            << wanted.id << " is not in\n"
            << writeGraph(lesson.graph());

    const std::string file = editor.path("tower.field.json");
    editor.keys("ctrl+s ctrl+a");
    editor.type(file);
    editor.keys("Return");
    expectKept(fw::test::readText(file), "tutorial.field.json");
}

}  // namespace fw::editor::test::tutorial_test
