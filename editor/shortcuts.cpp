#include "editor/shortcuts.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace fw::editor {

namespace {

struct KeyName {
    int key;
    const char* name;
};

constexpr KeyName kNamed[] = {{GLFW_KEY_SPACE, "Space"},
                              {GLFW_KEY_TAB, "Tab"},
                              {GLFW_KEY_ENTER, "Enter"},
                              {GLFW_KEY_ESCAPE, "Escape"},
                              {GLFW_KEY_DELETE, "Delete"},
                              {GLFW_KEY_BACKSPACE, "Backspace"},
                              {GLFW_KEY_INSERT, "Insert"},
                              {GLFW_KEY_HOME, "Home"},
                              {GLFW_KEY_END, "End"},
                              {GLFW_KEY_PAGE_UP, "PageUp"},
                              {GLFW_KEY_PAGE_DOWN, "PageDown"},
                              {GLFW_KEY_LEFT, "Left"},
                              {GLFW_KEY_RIGHT, "Right"},
                              {GLFW_KEY_UP, "Up"},
                              {GLFW_KEY_DOWN, "Down"},
                              {GLFW_KEY_MINUS, "Minus"},
                              {GLFW_KEY_EQUAL, "Equal"},
                              {GLFW_KEY_COMMA, "Comma"},
                              {GLFW_KEY_PERIOD, "Period"},
                              {GLFW_KEY_SLASH, "Slash"},
                              {GLFW_KEY_KP_ADD, "PadPlus"},
                              {GLFW_KEY_KP_SUBTRACT, "PadMinus"},
                              {GLFW_KEY_KP_DIVIDE, "PadSlash"},
                              {GLFW_KEY_KP_DECIMAL, "PadPeriod"},
                              {GLFW_KEY_KP_ENTER, "PadEnter"}};
constexpr int kFunctionKeys = 12;

std::string nameOf(int key) {
    if ((key >= GLFW_KEY_A && key <= GLFW_KEY_Z) || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9))
        return std::string(1, char(key));
    if (key >= GLFW_KEY_F1 && key < GLFW_KEY_F1 + kFunctionKeys)
        return "F" + std::to_string(key - GLFW_KEY_F1 + 1);
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return "Pad" + std::to_string(key - GLFW_KEY_KP_0);
    for (const KeyName& each : kNamed)
        if (each.key == key) return each.name;
    return {};
}

/// Undo goes on while its key is held, and so does what moves by arrows.
bool repeats(int key) { return key == GLFW_KEY_Z || (key >= GLFW_KEY_RIGHT && key <= GLFW_KEY_UP); }

bool sameLetters(std::string_view a, std::string_view b) {
    return std::ranges::equal(
        a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Every key that has a name.
const std::vector<int>& namedKeys() {
    static const std::vector<int> keys = [] {
        std::vector<int> all;
        for (int key = GLFW_KEY_SPACE; key <= GLFW_KEY_LAST; ++key)
            if (!nameOf(key).empty()) all.push_back(key);
        return all;
    }();
    return keys;
}

}  // namespace

std::string textOf(const Shortcut& shortcut) {
    if (shortcut.key == 0) return {};
    return std::string(shortcut.ctrl ? "Ctrl+" : "") + (shortcut.shift ? "Shift+" : "") +
           (shortcut.alt ? "Alt+" : "") + nameOf(shortcut.key);
}

std::optional<Shortcut> shortcutOf(std::string_view text) {
    Shortcut shortcut;
    for (std::size_t plus = text.find('+'); plus != std::string_view::npos; plus = text.find('+')) {
        const std::string_view word = text.substr(0, plus);
        bool& modifier = sameLetters(word, "ctrl")    ? shortcut.ctrl
                         : sameLetters(word, "shift") ? shortcut.shift
                                                      : shortcut.alt;
        if (modifier || (&modifier == &shortcut.alt && !sameLetters(word, "alt"))) return std::nullopt;
        modifier = true;
        text.remove_prefix(plus + 1);
    }
    for (int key : namedKeys())
        if (sameLetters(nameOf(key), text)) {
            shortcut.key = key;
            return shortcut;
        }
    return std::nullopt;
}

bool pressed(const Shortcut& shortcut) {
    const ImGuiIO& io = ImGui::GetIO();
    return shortcut.key != 0 && shortcut.ctrl == io.KeyCtrl && shortcut.shift == io.KeyShift &&
           shortcut.alt == io.KeyAlt && ImGui::IsKeyPressed(shortcut.key, repeats(shortcut.key));
}

std::optional<Shortcut> pressedNow() {
    const ImGuiIO& io = ImGui::GetIO();
    for (int key : namedKeys())
        if (ImGui::IsKeyPressed(key, false)) return Shortcut{key, io.KeyCtrl, io.KeyShift, io.KeyAlt};
    return std::nullopt;
}

bool steersPanels(const Shortcut& shortcut) {
    constexpr int kSteering[] = {GLFW_KEY_LEFT,    GLFW_KEY_RIGHT,     GLFW_KEY_UP,   GLFW_KEY_DOWN,
                                 GLFW_KEY_TAB,     GLFW_KEY_ENTER,     GLFW_KEY_HOME, GLFW_KEY_END,
                                 GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN, GLFW_KEY_SPACE};
    return !shortcut.ctrl && !shortcut.alt && std::ranges::count(kSteering, shortcut.key) > 0;
}

}  // namespace fw::editor
