// The ramp's bar and the curve's box: what the mouse and the keyboard do to the entries of a list.
//
//     mouse, keys                     do
//     left on an entry                selects it, and moves it
//     left on nothing                 an entry there, which goes on to be moved
//     drag away, Delete, Backspace    remove it
//     arrows (Shift: finer)           move the selected one
//     Tab, Shift+Tab, Home, End       select the next, the one before, the first, the last
//     Insert                          an entry half way to the next
//     Escape                          takes back what is under the hand; then leaves the keyboard
//
// From press to release is one hand of the document, each key one step of undo. Lifetime: RampHand lives with
// what shows the lists, from frame to frame; one entry of one list is selected at a time.
#pragma once

#include <imgui.h>

#include <set>
#include <string>

#include "editor/document/document.h"
#include "editor/ramps/edits.h"

namespace fw::editor {

struct Editor;

struct RampHand {
    std::string input;         ///< "group/node.input" whose entry is selected
    std::size_t selected = 0;  ///< it may be gone by now

    enum class Does : unsigned char { nothing, press, move } does = Does::nothing;
    Hand hand = Hand::none;
    ImVec2 from = {0, 0};         ///< where the mouse went down, pixels
    bool added = false;           ///< by this press
    bool away = false;            ///< the entry is gone if it is let go of here
    ramps::List before = {};      ///< when the hand began, with what it added
    std::size_t entry = 0;        ///< of `before`
    ramps::Range x = {}, y = {};  ///< what was seen then

    /// The input under the hand, which the preview then keeps live.
    std::set<std::string> held() const;
    /// Forgets what the document has ended. Once a frame.
    void follow(const Document& document);
};

namespace ramps {

/// What is shown of a list.
struct Shown {
    Editor& editor;
    std::string scope, node, input;
    List list;
    std::string interpolation, ends;  ///< the words of the node's other inputs
    float width;                      ///< pixels

    std::string path() const;
    /// The document's graph with another list.
    Graph with(const List& other) const;
    /// One step of undo; the entry is selected.
    void apply(const char* name, const List& other, std::size_t selected) const;
};

/// A ramp with all that can be done to it, at ImGui's cursor. Of this and the next the list has no
/// orderProblem.
void showRamp(const Shown& shown);
/// A curve likewise.
void showCurve(const Shown& shown);
/// A ramp's colours, `pieces` between two stops; nothing of more than kMostStops.
void drawRamp(ImDrawList* list, ImVec2 lo, ImVec2 hi, const List& stops, std::string_view interpolation,
              const Range& range, int pieces);

}  // namespace ramps
}  // namespace fw::editor
