// The gestures that bar and box share (hand.h). Not for use outside editor/ramps/.
#pragma once

#include "editor/canvas/view.h"
#include "editor/ramps/hand.h"

namespace fw::editor::ramps {

/// Where a list is seen.
struct Sheet {
    Area place;   ///< pixels, in which the ranges are seen
    Range x, y;   ///< y of a curve only
    bool planar;  ///< a curve: entries have a height too

    ImVec2 toScreen(double at, double height = 0.0) const;
    double xAt(float pixel) const;
    double yAt(float pixel) const;
};

/// Whether this list's entry is selected, and which.
std::optional<std::size_t> selectedOf(const Shown& shown);
/// The words for one entry, "Stop" or "Point", behind those of what was done.
std::string step(const Shown& shown, const char* done);

/// An item as large as `whole` that takes the mouse and the keyboard; what they did. `near` are the pixels
/// that a press may be off an entry. Whether it has the keyboard.
bool followHand(const Shown& shown, const Sheet& sheet, const Area& whole, float near);
/// + and × for the selected entry.
void showAddAndRemove(const Shown& shown);

}  // namespace fw::editor::ramps
