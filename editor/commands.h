// Every command of the editor, once: what it is called, where it is in the menus, which key it has, when it
// can be done and what it does. Menus, keys, the palette and the page of shortcuts read this table.
#pragma once

#include <span>

#include "editor/editor.h"
#include "editor/shortcuts.h"

namespace fw::editor {

/// Where the keyboard or the mouse has to be for a command's keys to count.
enum class Heard : unsigned char {
    everywhere,
    canvas,    ///< not in a panel, where they could be meant for what is edited there
    picture,   ///< over the picture, where they come before the canvas's
    timeline,  ///< on the timeline, where they come before all others
};

struct Command {
    const char* id;    ///< as in the preferences: "edit.undo"
    const char* menu;  ///< "File", "Edit", "Node", "View", "Picture", "Timeline", "Help"; empty: in no menu
    const char* label;
    const char* keys;  ///< its shortcut by default, as textOf() has it; further ones after a blank
    Heard heard;
    bool (*can)(const Editor& editor);
    void (*run)(Editor& editor);
    bool separated = false;  ///< a line stands before it in the menu
};

std::span<const Command> commands();
/// The one of this id, which is in the table.
const Command& command(std::string_view id);
/// The command's label with what it would do: "Undo Add Box".
std::string labelOf(const Command& command, const Editor& editor);

/// Runs what was pressed in this frame, unless something else takes the keyboard.
void runShortcuts(Editor& editor);
/// The menus of the table, in ImGui's current menu bar.
void showMenus(Editor& editor);

}  // namespace fw::editor
