// The tour: a small panel that walks through adding a row of windows to the sample tower.
//
// Its steps look at the document alone, so that they notice what is done, however it was done, and what is
// taken back.
#pragma once

#include <cstddef>

#include "graph/document/graph.h"

namespace fw::editor {

struct Editor;

inline constexpr std::size_t kTourSteps = 6;

/// How many steps the document has behind it, from the first on: 0 for the sample, kTourSteps at the end.
std::size_t tourStepsDone(const Graph& graph);

/// Opens the sample tower as a document without a name, after a question if changes would be lost.
void startTour(Editor& editor);
/// One frame of it, if it is open.
void showTour(Editor& editor);

}  // namespace fw::editor
