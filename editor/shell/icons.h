// Small signs for the categories of nodes, drawn from lines: legible from 10 pixels on.
#pragma once

#include <imgui.h>

#include "graph/library/node_type.h"

namespace fw::editor {

/// Within a square of this side about the centre, pixels.
void drawIcon(ImDrawList& list, Category category, ImVec2 centre, float side, ImU32 ink);
/// The same in light on a plate of the category's colour.
void drawBadge(ImDrawList& list, Category category, ImVec2 centre, float side);

}  // namespace fw::editor
