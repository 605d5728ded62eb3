// Every command of the editor, once: what it is called, where it is in the menus, which key it has, when it
// can be done and what it does. Menus, keys, the palette and the page of shortcuts read this table.
#pragma once

#include <span>

#include "editor/editor.h"
#include "editor/shortcuts.h"

namespace fw::editor {

struct Command {
    const char* id;    ///< as in the preferences: "edit.undo"
    const char* menu;  ///< "File", "Edit", "Node", "View", "Picture"; empty: in no menu
    const char* label;
    const char* keys;  ///< its shortcut by default; further ones after a blank
    bool (*can)(const Editor& editor);
    void (*run)(Editor& editor);
    bool separated = false;    ///< a line stands before it in the menu
    bool overPicture = false;  ///< its keys count only while the mouse is over the viewport's picture
};

std::span<const Command> commands();

/// Runs what was pressed in this frame, unless something else takes the keyboard.
void runShortcuts(Editor& editor);
/// The menus of the table, in ImGui's current menu bar.
void showMenus(Editor& editor);

}  // namespace fw::editor
