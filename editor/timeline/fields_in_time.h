// What the timeline does to the numbers on the canvas: their values and keys at the time shown, and the menu
// of their keys.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "editor/editor.h"

namespace fw::editor {

/// As CanvasMarks::animated. In a group nothing is moved by itself.
std::map<std::string, MovedField, std::less<>> movedFields(Editor& editor);
/// The menu of an input's keys, opened for `asked`. In ImGui's current window.
void showFieldMenu(Editor& editor, const std::optional<Plug>& asked);
/// Its entries, in whatever menu is open: insert or remove the key at the time shown, remove the animation.
void showKeyEntries(Editor& editor, const Plug& input);

}  // namespace fw::editor
