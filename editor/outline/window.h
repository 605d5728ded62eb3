// The window in which a flat outline is drawn by hand: the points of a node's input, on a grid, over a
// picture if one likes.
//
//     mouse                          does
//     left on a point                selects it (Shift, Ctrl: also) and moves what is selected
//     left on nothing                selects what is in a rectangle
//     double click                   a point there on the nearest side; on a point removes it
//     middle or right drag, wheel    pan, zoom
//
// A drag is one step of undo, Escape takes it back. Lifetime: part of the Editor; it closes with its node.
#pragma once

#include <imgui.h>

#include <string>

#include "editor/canvas/view.h"
#include "editor/document/document.h"
#include "editor/files/browser.h"
#include "editor/outline/edits.h"

namespace fw::editor {

struct Editor;

namespace outline {

struct Window {
    bool open = false, opened = false;  ///< opened: to come to the front in this frame
    bool focused = false;               ///< it had the keyboard in the last frame
    std::string scope, node, input;     ///< whose points they are

    Selection selected;
    Position middle = {0.0, 0.0};  ///< of what is seen, metres
    double zoom = 0.0;             ///< pixels a metre; 0: all is to be seen
    bool snaps = true;
    double step = 0.1;  ///< of the grid, metres

    enum class Does : unsigned char { nothing, press, move, box, pan } does = Does::nothing;
    Hand hand = Hand::none;  ///< of the document, while it moves points
    Points before = {};      ///< when the drag began
    ImVec2 from = {0, 0};    ///< where, pixels
    Selection kept = {};     ///< what a rectangle adds to
    int button = 0;

    /// The picture behind, in its own pixels.
    FileBrowser browser;
    ImTextureID picture = nullptr;
    double pictureAspect = 1.0;    ///< width by height
    double pictureWidth = 2.0;     ///< metres
    float pictureStrength = 0.5f;  ///< 0: not seen

    bool shows(const std::string& scope_, const std::string& node_, const std::string& input_) const {
        return open && scope == scope_ && node == node_ && input == input_;
    }
};

}  // namespace outline

/// Shows the outline of this input.
void openOutline(Editor& editor, const std::string& node, const std::string& input);
/// One frame of it, if it is open.
void showOutline(Editor& editor);

}  // namespace fw::editor
