// Many curves as what is seen of them: in each column of cells a curve is the stretch from its least to its
// highest value there, and of what lies on each other only the uppermost is drawn. So a crowd of curves costs
// what its picture has of edges, however many keys there are. Pure: nothing here draws.
//
// Lifetime: Columns are of one frame.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <vector>

#include "editor/timeline/time_view.h"
#include "graph/document/timeline.h"

namespace fw::editor {

struct Columns {
    ImVec2 lo{0, 0};                   ///< pixels, whole ones
    int count = 0, high = 0;           ///< columns, cells of each
    float side = 1.0f;                 ///< of a cell, whole pixels
    std::vector<uint16_t> cells = {};  ///< column by column from the top: which curve, from 1 on; 0: none
};

/// Empty columns over the box, of cells with this side.
Columns emptyColumns(ImVec2 lo, ImVec2 hi, float side);

/// Paints the track's curves over what is there: its components are the curves `first`, `first` + 1, ...
/// `first` is 1 at least.
void paintCurves(Columns& columns, const Track& track, const TimeView& times, const ValueView& values,
                 uint16_t first);

/// A rectangle of one curve.
struct ColumnPiece {
    ImVec2 lo{0, 0}, hi{0, 0};
    uint16_t curve = 0;
};
/// All that was painted; no piece lies on another.
std::vector<ColumnPiece> piecesOf(const Columns& columns);

}  // namespace fw::editor
