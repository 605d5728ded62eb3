#include "editor/preview/detail.h"

#include <algorithm>
#include <cmath>

namespace fw::editor {

namespace {

constexpr double kMostHeld = 38.0, kFewHeld = 22.0;  // milliseconds
constexpr double kStep = 0.85, kLeastScale = 0.5;    // of a picture's sides
constexpr int kLeastCells = 48;
/// Seconds of what is feared, which is several times what it takes.
constexpr double kMostFirst = 0.4;

}  // namespace

HeldDetail adapted(HeldDetail now, double took, int full) {
    const int cells = now.cells > 0 ? now.cells : full;
    if (took > kMostHeld) {
        if (now.scale > kLeastScale)
            now.scale = std::max(kLeastScale, kStep * now.scale);
        else if (cells > kLeastCells)
            now.cells = std::max(kLeastCells, cells * 3 / 4);
    } else if (took < kFewHeld) {
        if (cells < full)
            now.cells = std::min(full, cells * 4 / 3 + 1);
        else
            now.scale = std::min(1.0, now.scale / kStep);
    }
    return now;
}

int firstCells(int cells, double seconds) {
    if (seconds <= 2.0 * kMostFirst) return cells;
    return std::max(int(cells * std::sqrt(kMostFirst / seconds)), std::min(cells, kLeastCells));
}

}  // namespace fw::editor
