// Values and nodes in few keys: a digit begins a number, Ctrl+Enter gives it to a whole vector, Shift+Enter
// goes on to the next node, and Tab in the menu adds one node behind the other.
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include "graph/document/json.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::test::quick_values_test {

const char* const kNodes = R"({"id": "box", "type": "box", "at": [0, 0]},
    {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "box"}, "resolution": 16}})";

struct QuickValues : testing::Test {
    void SetUp() override {
        NEEDS_EDITOR(editor);
        editor.click(editor.title("box"));
    }
    const Graph& graph() { return editor->document.graph(); }
    const Node* only(const std::string& type) {
        const Node* found = nullptr;
        for (const Node& node : graph().nodes)
            if (node.type == type) found = &node;
        return found;
    }
    std::vector<double> extents(const std::string& node) {
        const InputValue* value = graph().node(node)->input("half_extents");
        const auto* numbers = value ? std::get_if<std::vector<double>>(&value->value) : nullptr;
        return numbers ? *numbers : std::vector<double>();
    }
    std::string source(const Node* node, const std::string& input) {
        const InputValue* value = node ? node->input(input) : nullptr;
        const Link* link = value ? std::get_if<Link>(&value->value) : nullptr;
        return link ? link->node : "";
    }
    bool menuIsOpen() { return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup); }

    DrivenEditor editor{graphOf(kNodes), 900, 600};
};

TEST_F(QuickValues, ADigitBeginsTheFirstNumber) {
    const Graph before = graph();
    editor.send("type --delay 0 --args 1 0.25 key Tab type --delay 0 --args 1 2*3 key Return");
    EXPECT_EQ(extents("box").at(0), 0.25);
    EXPECT_EQ(extents("box").at(1), 6.0);
    editor.keys("ctrl+z");
    editor.keys("ctrl+z");
    EXPECT_EQ(writeGraph(graph()), writeGraph(before));
    // Escape takes it back, and nothing is begun where nothing is selected, or in a field.
    editor.send("type --delay 0 --args 1 7 key Escape");
    EXPECT_EQ(writeGraph(graph()), writeGraph(before));
    EXPECT_EQ(editor->canvas.number.state, NumberHand::State::none);
    editor.keys("Return");
    editor.send("type --delay 0 --args 1 1.5 key Return");
    EXPECT_EQ(extents("box").at(0), 1.5);
    // From far off the canvas comes nearer for it.
    CanvasView& view = editor->canvas.view;
    view.zoomTo(0.3f, view.panel.centre());
    editor.settle();
    editor.send("type --delay 0 --args 1 2.5 key Return");
    EXPECT_EQ(extents("box").at(0), 2.5);
    EXPECT_TRUE(showsFields(view));
    editor.keys("ctrl+z");
    editor->canvas.select({});
    editor.send("type --delay 0 --args 1 8");
    EXPECT_EQ(editor->canvas.number.state, NumberHand::State::none);
    EXPECT_EQ(extents("box").at(0), 1.5);
}

TEST_F(QuickValues, CtrlEnterIsForAllNumbersOfAVector) {
    const Graph before = graph();
    editor.send("type --delay 0 --args 1 0.1 key ctrl+Return");
    EXPECT_EQ(extents("box"), (std::vector<double>{0.1, 0.1, 0.1}));
    EXPECT_EQ(editor->canvas.number.state, NumberHand::State::none);
    editor.keys("ctrl+z");
    EXPECT_EQ(graph(), before) << "one step";
}

TEST_F(QuickValues, ShiftEnterGoesOnToTheNextNode) {
    editor.send("type --delay 0 --args 1 0.3 key shift+Return");
    EXPECT_EQ(extents("box").at(0), 0.3);
    ASSERT_TRUE(menuIsOpen());
    // Tab adds what is found, wired, and the menu is there again for what comes next.
    editor.send("type --delay 0 --args 1 sub key Tab");
    ASSERT_TRUE(menuIsOpen());
    const Node* cut = only("subtract");
    ASSERT_TRUE(cut);
    EXPECT_EQ(source(cut, "a"), "box");
    EXPECT_EQ(source(only("output"), "surface"), cut->id);
    EXPECT_EQ(editor->add.search[0], 0);
    editor.keys("Tab");
    EXPECT_EQ(graph().nodes.size(), 3u) << "nothing was searched for";
    editor.send("type --delay 0 --args 1 cyl key shift+Return");
    EXPECT_FALSE(menuIsOpen());
    ASSERT_TRUE(only("cylinder"));
    EXPECT_EQ(source(only("subtract"), "b"), only("cylinder")->id);
    EXPECT_EQ(editor->document.undoName(), "Add Cylinder");
    editor.keys("ctrl+z");
    EXPECT_EQ(editor->document.undoName(), "Add Subtract");
    editor.keys("ctrl+z");
    editor.keys("ctrl+z");
    EXPECT_EQ(editor->document.step(), 0u);
}

/// What the hand has let go of is not repeated, however long the frames are and whatever waits for the
/// keyboard.
TEST_F(QuickValues, AKeyThatWasPressedOnceCountsOnce) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyRepeatDelay = io.KeyRepeatRate = 1e-6f;
    editor.send("key Return type --delay 0 --args 1 0.4 key Return");
    EXPECT_EQ(extents("box").at(0), 0.4);
    EXPECT_EQ(editor->canvas.number.state, NumberHand::State::none) << "Enter came twice";
    editor.send("key --delay 0 F2 type --delay 0 --args 1 Lid key Return");
    EXPECT_EQ(graph().node("box")->label, "Lid");
    EXPECT_EQ(editor->document.step(), 2u);
}

}  // namespace fw::editor::test::quick_values_test
