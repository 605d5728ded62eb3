// What a document's numbers mean outside: the unit of its lengths, and the density of what it makes.
#pragma once

namespace fw::editor {

struct Editor;

/// The rows, in ImGui's current window. Another unit is asked for with what is to stay, the sizes or the
/// numbers; either is one step of undo.
void showUnit(Editor& editor);

}  // namespace fw::editor
