// The views of how thick walls are and how wide gaps: the width that they are to have, and what the colours
// of the picture mean. Units: the document's.
#pragma once

namespace fw::editor {

struct Editor;
struct Viewport;

/// Below this a wall or a gap is red: what was asked for, else the usual of what is shown. 0 in other views.
float leastWidth(const Viewport& viewport);

/// The number, in ImGui's present line.
void chooseLeastWidth(Editor& editor);
/// The scale of colours, over the picture.
void showWidthScale(const Editor& editor);

}  // namespace fw::editor
