#include "editor/code/view_keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

namespace fw::editor::code {

namespace {

struct Pressed {
    bool ctrl, shift, alt;
    bool operator()(int key, bool repeats = true) const { return ImGui::IsKeyPressed(key, repeats); }
};

void moveBy(View& view, Text& text, Heard& heard, Move by, bool selecting, int page) {
    move(text, by, selecting, page);
    view.follow = heard.moved = true;
}

/// Arrows, Home, End, pages; whether it was one of them.
bool hearMoves(View& view, const Shown& shown, const Pressed& key, int page, Heard& heard) {
    struct Way {
        int key;
        Move plain, ctrl;
    };
    constexpr Way kWays[] = {
        {GLFW_KEY_LEFT, Move::left, Move::wordLeft},
        {GLFW_KEY_RIGHT, Move::right, Move::wordRight},
        {GLFW_KEY_UP, Move::up, Move::up},
        {GLFW_KEY_DOWN, Move::down, Move::down},
        {GLFW_KEY_HOME, Move::lineStart, Move::textStart},
        {GLFW_KEY_END, Move::lineEnd, Move::textEnd},
        {GLFW_KEY_PAGE_UP, Move::pageUp, Move::pageUp},
        {GLFW_KEY_PAGE_DOWN, Move::pageDown, Move::pageDown},
    };
    if (key.alt) return false;
    for (const Way& way : kWays) {
        const bool vertical = way.plain == way.ctrl;
        if (!key(way.key) || (shown.listed && vertical && !key.shift)) continue;
        moveBy(view, shown.text, heard, key.ctrl ? way.ctrl : way.plain, key.shift, page);
        return true;
    }
    return false;
}

void toClipboard(const std::string& words) { ImGui::SetClipboardText(words.c_str()); }

void hearLetters(View& view, const Shown& shown, const Pressed& key, Heard& heard) {
    Text& text = shown.text;
    if (key(GLFW_KEY_A, false)) selectAll(text), heard.moved = true;
    if (key(GLFW_KEY_C, false)) toClipboard(copied(text));
    if (key(GLFW_KEY_X, false)) toClipboard(cut(text));
    if (key(GLFW_KEY_V))
        if (const char* pasted = ImGui::GetClipboardText()) paste(text, pasted);
    if (key(GLFW_KEY_Z)) key.shift ? redo(text) : undo(text), heard.moved = true;
    if (key(GLFW_KEY_Y)) redo(text), heard.moved = true;
    if (key(GLFW_KEY_D)) duplicate(text);
    if (key(GLFW_KEY_SLASH)) toggleComment(text);
    if (key(GLFW_KEY_SPACE, false)) heard.complete = true;
    if (key(GLFW_KEY_F, false)) {
        view.search.open = view.search.focus = true;
        if (text.selects() && text.cursor.line == text.anchor.line)
            view.search.words = stringOf(text, text.selection());
    }
}

void searchAgain(View& view, Text& text, bool backward) {
    if (view.search.words.empty()) return;
    if (const auto found = find(text, view.search.words, backward)) select(text, *found);
    view.follow = true;
}

}  // namespace

void hearKeys(View& view, const Shown& shown, int page, Heard& heard) {
    Text& text = shown.text;
    ImGuiIO& io = ImGui::GetIO();
    const Pressed key{io.KeyCtrl, io.KeyShift, io.KeyAlt};
    const bool enter = key(GLFW_KEY_ENTER) || key(GLFW_KEY_KP_ENTER);
    if (hearMoves(view, shown, key, page, heard)) return;
    if (key.alt && !key.ctrl) {
        if (key(GLFW_KEY_UP)) moveLines(text, -1);
        if (key(GLFW_KEY_DOWN)) moveLines(text, 1);
    }
    if (key.ctrl && !key.alt) hearLetters(view, shown, key, heard);
    if (key.ctrl && enter) heard.apply = true;
    if (!key.alt && key(GLFW_KEY_BACKSPACE)) eraseBack(text, key.ctrl, now());
    if (!key.alt && key(GLFW_KEY_DELETE)) eraseForward(text, key.ctrl, now());
    if (!key.ctrl && !key.alt) {
        if (enter && !shown.listed) breakLine(text), heard.moved = true;
        if (key(GLFW_KEY_TAB) && !shown.listed) key.shift ? outdent(text) : indent(text);
        if (key(GLFW_KEY_ESCAPE, false)) {
            if (!shown.listed && view.search.open)
                view.search.open = false;
            else
                heard.escape = true;
        }
        if (key(GLFW_KEY_F3)) searchAgain(view, text, key.shift);
        if (key(GLFW_KEY_F12, false)) heard.definition = true;
        if (key(GLFW_KEY_F2, false)) heard.rename = true;
        if (key(GLFW_KEY_F4, false)) heard.larger = true;
    }
    // AltGr counts as both on some systems, and types.
    if (key.ctrl != key.alt) return;
    for (const ImWchar c : io.InputQueueCharacters) {
        if (c < 32 || c == 127) continue;
        char bytes[5] = {};
        ImTextCharToUtf8(bytes, c);
        heard.typed += bytes;
    }
    if (!heard.typed.empty()) type(text, heard.typed, now());
}

}  // namespace fw::editor::code
