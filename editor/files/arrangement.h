// How window and panels stand, from one time to the next: `panels` of the preferences.
#pragma once

#include <optional>
#include <utility>

#include "editor/files/preferences.h"

namespace fw::editor {

struct Editor;

/// An object: which panels are open and how large, the minimap, the window's size.
Json arrangementOf(const Editor& editor);
/// As arrangementOf() gave it; what is missing or wrong is left as it stands.
void arrange(Editor& editor, const Json& panels);
/// Of the window, in its system's units.
std::optional<std::pair<int, int>> windowSizeOf(const Json& panels);

/// Adds it to the file of preferences, of which nothing else changes: another editor may have written it.
void keepArrangement(const Editor& editor, const std::string& path);

}  // namespace fw::editor
