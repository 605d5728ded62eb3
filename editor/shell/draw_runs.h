// Which of a draw command's triangles are opaque: the backgrounds of panels and pictures, most pixels of an
// interface. They need not know what was there before, nor, where they have one colour, the glyphs' texture;
// a software device paints them ten times as fast without. Pure: nothing here draws.
#pragma once

#include <imgui.h>

#include <vector>

namespace fw::editor {

/// Triangles that follow each other.
struct DrawRun {
    unsigned first = 0, count = 0;  ///< indices, of the command's own
    bool opaque = false;
    bool operator==(const DrawRun&) const = default;
};

/// So many pixels of opaque triangles in sequence are worth a run of their own; fewer go with their
/// neighbours.
inline constexpr double kLeastOpaque = 8192.0;

/// Cuts the command where opaque areas begin and end: all its triangles, in their order. Of a texture with
/// glyphs those are opaque that have no texel but the one at `white`; null: of an opaque picture.
void cutIntoRuns(const ImDrawList& list, const ImDrawCmd& command, const ImVec2* white,
                 std::vector<DrawRun>& runs);

}  // namespace fw::editor
