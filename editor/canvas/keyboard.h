// The canvas without a mouse: which node lies in a direction, and how what is not seen comes into sight.
#pragma once

#include "editor/canvas/canvas.h"

namespace fw::editor {

/// The nearest node from this one in the direction of (x, y), one of them 0: what lies straight ahead counts
/// as nearer than what lies aside. nullptr if there is none that way.
const NodeBox* neighbour(const Boxes& boxes, std::string_view from, ImVec2 direction);
/// The node whose middle is nearest to the place; nullptr on an empty canvas.
const NodeBox* nearestNode(const Boxes& boxes, ImVec2 place);

/// Makes the neighbour of the active node the active one; without an active node, that in the middle of what
/// is seen. `adds`: the selection stays.
void step(Canvas& canvas, const Boxes& boxes, ImVec2 direction, bool adds);
/// Moves what is seen as little as it takes to see the area.
void bringIntoSight(CanvasView& view, const Area& area);

/// The place itself, or the next one below it where no node has its corner: nodes added one after the other
/// would hide each other.
ImVec2 freePlace(const Boxes& boxes, ImVec2 place);

/// Begins to type the first number of the active node; false if it has none that could be seen.
bool typeFirstValue(Canvas& canvas, Document& document, const Boxes& boxes);

}  // namespace fw::editor
