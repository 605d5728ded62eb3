// The widget that shows and edits a text: on ImGui's draw lists and input, with line numbers, colours, marks,
// a search, and what the mouse and the keys do to the text. It knows the language's colours and nothing of
// graphs.
//
// The keyboard is its own while it is active, as that of ImGui's text fields is. A caret that blinks asks for
// a frame now and then (nextFrame()), and stays lit after some seconds without input, so that the window
// sleeps.
//
// Lifetime: a View as long as the text is shown; ids are of ImGui's current window.
#pragma once

#include <imgui.h>

#include <functional>
#include <span>

#include "editor/code/colouring.h"
#include "editor/code/edits.h"

namespace fw::editor::code {

/// What is said of a place of the text, and drawn as a wave below it.
struct Mark {
    Range range;
    bool error = true;  ///< else a warning
    std::string message;
};

struct Search {
    bool open = false, focus = false;  ///< focus: its field gets the keyboard in the next frame
    std::string words;
};

struct View {
    ImGuiID id = 0;
    bool inside = false;    ///< the keyboard is here
    bool focus = false;     ///< it is to be in the next frame
    bool hold = false;      ///< it counts as here though something that belongs to it has it
    bool dragging = false;  ///< the mouse selects
    Range taken;            ///< what the press of the mouse selected, which a drag grows
    int clicks = 0;
    bool follow = false;    ///< the cursor is to be seen
    bool scrolled = false;  ///< by the bar in the last frame
    double touched = 0.0;   ///< seconds of now(), when there was input
    Search search;
    uint64_t measured = 0;  ///< the version of which `widest` is
    int widest = 0;         ///< bytes of the longest line
    uint64_t framed = 0;    ///< version and cursor that `pair` is of
    Spot framedAt;
    std::optional<std::pair<Spot, Spot>> pair;  ///< of brackets at the cursor
};

/// What is shown in a frame.
struct Shown {
    Text& text;
    Colouring& colouring;
    const NamesOfText* names = nullptr;
    std::span<const Mark> marks = {};
    ImFont* font = nullptr;
    float scale = 1.0f;
    bool listed = false;                       ///< a list over the text has arrows, Enter, Tab and Escape
    std::function<bool(ImVec2)> covered = {};  ///< whether something over the text has the mouse there
};

/// What the hand asked for in a frame beside edits.
struct Heard {
    bool changed = false;                ///< the text is another
    bool moved = false;                  ///< the cursor is elsewhere, by no typing
    std::string typed;                   ///< characters
    bool entered = false, left = false;  ///< the keyboard came, or went elsewhere
    bool apply = false;                  ///< Ctrl+Enter
    bool escape = false, complete = false, definition = false, rename = false, larger = false;
    std::optional<Spot> hovered;  ///< the character under the mouse
    ImVec2 cursor;                ///< lower left corner of the cursor's place on the screen
    ImVec2 area[2];               ///< where text is on the screen
    ImVec2 cell;                  ///< size of a character
    /// Where a spot's upper left corner is on the screen.
    std::function<ImVec2(Spot)> placeOf;
};

/// The widget, so large, in ImGui's current window. `id` is of that window.
Heard showText(View& view, const Shown& shown, const char* id, ImVec2 size);

/// Seconds of a clock that runs while nothing is drawn.
double now();
/// Seconds until the caret is drawn otherwise; infinite while it does not blink.
double nextBlink(const View& view);

ImU32 inkColor(Ink ink);
ImU32 paperColor();  ///< behind the text

}  // namespace fw::editor::code
