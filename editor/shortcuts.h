// Keys as people press them: "Ctrl+Shift+D". One press is one Shortcut; commands.h says what it does.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fw::editor {

struct Shortcut {
    int key = 0;  ///< GLFW's; 0: none
    bool ctrl = false, shift = false, alt = false;
    bool operator==(const Shortcut&) const = default;
};

/// "Ctrl+Shift+D"; empty for none.
std::string textOf(const Shortcut& shortcut);
/// What the text says, whatever its case; none if it names no key.
std::optional<Shortcut> shortcutOf(std::string_view text);

/// Whether it was pressed in this frame, with just these modifiers.
bool pressed(const Shortcut& shortcut);
/// What was pressed in this frame, of the keys that have a name.
std::optional<Shortcut> pressedNow();
/// Whether the keyboard moves about in panels with it: arrows, Tab, Enter, Space and the like.
bool steersPanels(const Shortcut& shortcut);

}  // namespace fw::editor
