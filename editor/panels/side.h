// The panels at the side, as tabs, and which part of the window has the keyboard.
//
// ImGui moves about in a panel by arrows and Tab; the canvas has keys of its own (canvas/keyboard.h).
#pragma once

#include <span>

#include "editor/editor.h"

namespace fw::editor {

struct SidePanel {
    const char* id;  ///< as in the preferences
    const char* label;
    bool Panels::*open;
    void (*show)(Editor& editor);
};
/// In their order.
std::span<const SidePanel> sidePanels();

/// The tabs, in the rest of ImGui's current window.
void showSidePanels(Editor& editor);
/// Opens the panel, brings it to the front and gives it the keyboard.
void showPanel(Editor& editor, std::string_view id);
/// The same; closes it if it has all that.
void togglePanel(Editor& editor, std::string_view id);
/// The next open one comes to the front; the one before for -1.
void turnPanels(Editor& editor, int by);

/// The next part of the window gets the keyboard; the one before for -1.
void turnParts(Editor& editor, int by);
/// Called in the ImGui window of the part: it takes the keyboard if that is wished.
void takeKeyboard(Editor& editor, Part part);
/// Called in the canvas' window: as the mouse comes there, the keyboard follows, unless something is typed.
void followMouse(Editor& editor);
/// Escape gives the keyboard back to the canvas, once it has ended what was being done in the panel.
void leavePanels(Editor& editor);
/// Whether ImGui moves about with this key, so that it is no command's.
bool panelsSteer(const Shortcut& key);

}  // namespace fw::editor
