// Random hands: keys, the mouse, another program that writes the file, other documents, all at any moment.
// What must hold after each: the editor lives, the document is sound, nothing that was begun on one document
// goes on over another, and undo leads back to where each began.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <set>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include "graph/document/json.h"
#include "tests/support/editor/driven_editor.h"
#include "tests/support/editor/random_edits.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::random_hands_test {

/// Hands the window's own callbacks what a hand does, so that it takes no process and no wait.
struct RandomHands {
    test::DrivenEditor& editor;
    std::mt19937 random;
    GLFWwindow* window = editor->shell.window();
    GLFWkeyfun keyed = glfwSetKeyCallback(window, nullptr);
    GLFWcharfun typed = glfwSetCharCallback(window, nullptr);
    GLFWmousebuttonfun pressed = glfwSetMouseButtonCallback(window, nullptr);
    GLFWcursorposfun moved = glfwSetCursorPosCallback(window, nullptr);
    GLFWscrollfun scrolled = glfwSetScrollCallback(window, nullptr);
    std::array<bool, 3> down = {};
    std::vector<std::string> texts;  ///< of documents, to be opened or written over the open one
    std::string last = {};           ///< what was done last
    FileWatch::Clock::time_point started = FileWatch::Clock::now();
    double opened = glfwGetTime() + 1.0;

    RandomHands(test::DrivenEditor& editor_, uint32_t seed) : editor(editor_), random(seed) {}

    std::size_t below(std::size_t n) { return random() % n; }
    bool chance(double p) { return std::uniform_real_distribution<double>()(random) < p; }

    /// A frame, and what goes on between frames. Few are drawn, fewer with a new picture. Time goes by the
    /// steps, not by how long they take.
    void frame(int step) {
        if (step % 500 == 0) exchange(*editor);
        const auto show = [&] { showEditor(*editor); };
        const int most = 1 + int(below(8));  // now and then not all is heard yet when the next is done
        for (int i = 0; i < most && (editor->shell.waitEvents(0.0) || i == 0); ++i) {
            constexpr std::chrono::milliseconds kFrame(30);
            started += kFrame;
            watchFile(*editor, started);
            opened = std::max(opened, glfwGetTime()) + std::chrono::duration<double>(kFrame).count();
            glfwSetTime(opened);
            if (step % 50 == 0)
                editor->shell.frame(show);
            else
                editor->shell.answer(show);
            editor->quit = false;
        }
    }

    /// In the window that waits for an answer, if one does.
    ImVec2 inPopup() {
        const ImGuiWindow* popup = ImGui::GetCurrentContext()->OpenPopupStack.back().Window;
        if (!popup) return somewhere();
        return {popup->Pos.x + float(random() % unsigned(std::max(popup->Size.x, 1.0f))),
                popup->Pos.y + float(random() % unsigned(std::max(popup->Size.y, 1.0f)))};
    }

    /// None right after another document was opened: the next frame makes their boxes.
    const std::vector<NodeBox>& nodes() const {
        static const std::vector<NodeBox> none;
        return editor->boxes ? editor->boxes->nodes : none;
    }

    ImVec2 somewhere() {
        const ImVec2 size = ImGui::GetIO().DisplaySize;
        const std::vector<NodeBox>& all = nodes();
        if (all.empty() || chance(0.4))
            return {float(below(unsigned(size.x))), float(below(unsigned(size.y)))};
        const NodeBox& box = all[below(all.size())];
        const CanvasView& view = editor->canvas.view;
        if (box.rows.empty() || chance(0.3))
            return view.toScreen(ImVec2(box.area.centre().x, box.area.lo.y + 8));
        const Row& row = box.rows[below(box.rows.size())];
        if (row.fields > 0 && chance(0.5))
            return view.toScreen(box.field(row, int(below(unsigned(row.fields)))).centre());
        return view.toScreen(box.socket(row));
    }

    void move(ImVec2 to) { moved(window, double(to.x), double(to.y)); }
    void press(int button, bool now) {
        down[std::size_t(button)] = now;
        pressed(window, button, now ? GLFW_PRESS : GLFW_RELEASE, 0);
    }

    void tap(int code, int mods = 0) {
        keyed(window, code, 0, GLFW_PRESS, mods);
        keyed(window, code, 0, GLFW_RELEASE, mods);
    }

    void key() {
        static constexpr int kKeys[] = {
            GLFW_KEY_ENTER,     GLFW_KEY_ESCAPE, GLFW_KEY_TAB, GLFW_KEY_DELETE, GLFW_KEY_SPACE,
            GLFW_KEY_LEFT,      GLFW_KEY_RIGHT,  GLFW_KEY_UP,  GLFW_KEY_DOWN,   GLFW_KEY_HOME,
            GLFW_KEY_BACKSPACE, GLFW_KEY_F2,     GLFW_KEY_F3,  GLFW_KEY_F6,     GLFW_KEY_PAGE_UP,
            GLFW_KEY_1,         GLFW_KEY_A,      GLFW_KEY_C,   GLFW_KEY_D,      GLFW_KEY_F,
            GLFW_KEY_G,         GLFW_KEY_H,      GLFW_KEY_I,   GLFW_KEY_J,      GLFW_KEY_L,
            GLFW_KEY_M,         GLFW_KEY_N,      GLFW_KEY_P,   GLFW_KEY_S,      GLFW_KEY_T,
            GLFW_KEY_V,         GLFW_KEY_X,      GLFW_KEY_Y,   GLFW_KEY_Z};
        static constexpr std::pair<int, int> kModifiers[] = {{GLFW_KEY_LEFT_CONTROL, GLFW_MOD_CONTROL},
                                                             {GLFW_KEY_LEFT_SHIFT, GLFW_MOD_SHIFT},
                                                             {GLFW_KEY_LEFT_ALT, GLFW_MOD_ALT}};
        const int code = kKeys[below(std::size(kKeys))];
        std::vector<int> held;
        int mods = 0;
        for (const auto& [modifier, mask] : kModifiers)
            if (chance(0.25)) held.push_back(modifier), mods |= mask;
        for (const int modifier : held) keyed(window, modifier, 0, GLFW_PRESS, mods);
        tap(code, mods);
        for (const int modifier : held) keyed(window, modifier, 0, GLFW_RELEASE, 0);
        last = "key " + std::to_string(code) + " with " + std::to_string(mods);
    }

    void type() {
        static constexpr std::string_view kTyped[] = {"1",  "0.5", "-3", "sphere", "twist",
                                                      "2*", "x",   ")",  "é"};
        for (const char character : kTyped[below(std::size(kTyped))])
            typed(window, unsigned(static_cast<unsigned char>(character)));
        last = "type";
    }

    void click(ImVec2 at, int button, int times) {
        move(at);
        for (int i = 0; i < times; ++i) press(button, true), press(button, false);
        last = "click " + std::to_string(button);
    }

    /// A number of a node, typed over.
    void typeNumber() {
        const std::vector<NodeBox>& all = nodes();
        for (int tries = 0; tries < 20 && !all.empty(); ++tries) {
            const NodeBox& box = all[below(all.size())];
            for (const Row& row : box.rows) {
                if (!row.typed() || !chance(0.5)) continue;
                click(editor->canvas.view.toScreen(box.field(row, 0)).centre(), 0, 1);
                for (const char character : std::string_view("0.75")) typed(window, unsigned(character));
                last = "number";
                if (chance(0.7)) tap(chance(0.5) ? GLFW_KEY_ENTER : GLFW_KEY_TAB);
                return;
            }
        }
    }

    void step() {
        if (!ImGui::GetCurrentContext()->OpenPopupStack.empty() && chance(0.5)) {
            if (chance(0.6)) return click(inPopup(), 0, 1);
            last = "Escape";
            return tap(GLFW_KEY_ESCAPE);
        }
        const std::string path = editor->document.graph().path;
        switch (below(40)) {
            case 0:  // another program
                if (!path.empty() && path.starts_with(editor.path("")))
                    fw::test::writeText(path, texts[below(texts.size())]);
                last = "write " + path;
                return;
            case 1:  // as dropped on the window, or from the menu
                if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return;
                openFile(*editor, editor.path("other" + std::to_string(below(texts.size())) + ".field.json"));
                last = "open";
                return;
            case 2:
            case 3: return scrolled(window, 0.0, chance(0.5) ? 1.0 : -1.0);
            case 4: return type();
            case 5:
            case 20: return typeNumber();
            case 21:
            case 22: {  // as far as a frame goes; what follows happens in the midst of it
                move(somewhere());
                press(0, true);
                move(somewhere());
                last = "drag";
                return;
            }
            case 23:
                if (const auto& all = nodes(); !all.empty())
                    click(editor->canvas.view.toScreen(all[below(all.size())].area.centre()), 0, 1);
                return;
            case 6:
            case 7:
            case 8:
            case 9:
            case 10: return key();
            case 11:
            case 12:
            case 13: {  // a click, or two
                return click(somewhere(), chance(0.8) ? 0 : int(below(3)), chance(0.3) ? 2 : 1);
            }
            case 14:
            case 15:
            case 16:
            case 17:
            case 18:
            case 19: {
                const int button = chance(0.8) ? 0 : int(below(3));
                press(button, !down[std::size_t(button)]);
                last = "button " + std::to_string(button);
                return;
            }
            default:
                move(somewhere());
                last = "move";
                return;
        }
    }
};

TEST(RandomHands, LeaveASoundEditor) {
#ifdef __SANITIZE_ADDRESS__
    const int steps = 100'000;
#else
    const int steps = std::getenv("FIELDWRIGHT_LONG") ? 20'000 : 2'000;
#endif
    // One of many nodes, one of groups, one that moves, one that is nothing yet.
    std::vector<std::string> texts;
    for (const char* name : {"table_and_stool", "moving_booleans", "csg_part"})
        texts.push_back(
            fw::test::readText(std::string(FIELDWRIGHT_SOURCE_DIR "/samples/") + name + ".field.json"));
    texts.push_back(R"({"fieldwright": 1, "nodes": []})");
    texts.push_back("{\"fieldwright\": 1, \"nodes\": [{\"id\": ");  // not all of it is written yet
    test::DrivenEditor editor({}, 800, 600);
    NEEDS_EDITOR(editor);
    for (std::size_t i = 0; i < texts.size(); ++i)
        fw::test::writeText(editor.path("other" + std::to_string(i) + ".field.json"), texts[i]);
    openFile(*editor, editor.path("other0.field.json"));
    editor.settle();
    RandomHands hands(editor, 27);
    hands.texts = texts;
    std::set<uint64_t> documents;
    std::map<std::string, int> undone;
    std::size_t changes = 0, held = 0;
    for (int i = 0; i < steps; ++i) {
        const uint64_t before = editor->document.revision();
        hands.step();
        ASSERT_NO_THROW(hands.frame(i)) << i << ": " << hands.last;
        const CanvasView& view = editor->canvas.view;
        ASSERT_TRUE(std::isfinite(view.middle.x + view.middle.y) && view.zoom >= kLeastZoom &&
                    view.zoom <= kMostZoom)
            << i << ": " << hands.last << ": " << view.middle.x << " " << view.middle.y << " " << view.zoom
            << " gesture " << int(editor->canvas.gesture.kind);
        changes += editor->document.revision() != before;
        held += editor->document.held();
        documents.insert(editor->viewport.document);
        if (editor->document.revision() != before) ++undone[editor->document.undoName()];
        if (i % 25 != 0) continue;
        ASSERT_EQ(test::structuralErrors(editor->document.graph()), std::vector<std::string>())
            << i << ": " << hands.last;
    }
    std::string names;
    for (const auto& [name, count] : undone) names += " " + name + ":" + std::to_string(count);
    std::printf("%zu documents, %zu changes, something begun after %zu of %d steps;%s\n", documents.size(),
                changes, held, steps, names.c_str());
    // All that was begun ends, and the way back is open.
    for (int button = 0; button < 3; ++button) hands.press(button, false);
    for (int i = 1; i < 20; ++i) hands.frame(steps + i);
    editor->document.settle();
    const std::string now = writeGraph(editor->document.graph());
    int back = 0;
    while (editor->document.undo()) ++back;
    for (; back > 0; --back) EXPECT_TRUE(editor->document.redo());
    EXPECT_EQ(writeGraph(editor->document.graph()), now);
}

}  // namespace fw::editor::random_hands_test
