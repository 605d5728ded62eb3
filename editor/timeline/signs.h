// The signs of many keys: where they lie closer than they can be told apart, one stands for a bunch of them.
// What is under the mouse goes by the keys themselves (strip.h). Pure: nothing here draws.
#pragma once

#include <imgui.h>

#include <span>
#include <vector>

namespace fw::editor {

/// A key of a row.
struct KeyMark {
    float x = 0.0f;       ///< pixels
    bool chosen = false;  ///< selected
};

/// The keys between two places.
struct KeySign {
    float first = 0.0f, last = 0.0f;  ///< pixels, of a key each; equal for one alone
    bool chosen = false;
    bool operator==(const KeySign&) const = default;
};

/// The signs of a row, from the left, which is the order of the marks. Keys that are nearer than `apart` to
/// the one before become one sign; one that is not selected is passed over where a selected one before is
/// nearer than half of that, and never the other way round.
std::vector<KeySign> signsOf(std::span<const KeyMark> marks, float apart);

/// A key of a curve.
struct PointMark {
    ImVec2 at{0, 0};  ///< pixels
    bool chosen = false;
};

/// Of the marks within the box those that are drawn, one in each square of this side, as ascending indices: a
/// selected one before others, then the last.
std::vector<std::size_t> thinned(std::span<const PointMark> marks, ImVec2 lo, ImVec2 hi, float side);

}  // namespace fw::editor
