// A plot of a field along a line, drawn in the rest of a panel's width.
#pragma once

#include "editor/probe/along.h"

namespace fw::editor {

/// Values against lengths, both in `unit`, the zero line with its crossings, walls with their thickness;
/// below it how far the gradient's length is from 1. Under the mouse the numbers at a place. `scale` is the
/// interface's.
void showPlot(const Plot& plot, const char* unit, float scale);

}  // namespace fw::editor
