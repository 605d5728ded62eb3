// A spline over the picture while its node is selected: the curve, its points, and where the mouse is on it.
//
//     mouse                          does
//     left drag on a point           moves it; of a bezier one with its handles
//     left drag on the curve         pulls a new point out of it
//     Ctrl and left drag on an end   adds a point beyond it
//     double click on a point        removes it
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "editor/splines/edits.h"
#include "editor/viewport/placement.h"

namespace fw::editor {

struct Lens;

namespace splines {

struct Shown {
    std::string node, input;
    Knots knots;
    SplinePtr spline;     ///< null if there is none through its knots
    Placement placement;  ///< of the spline in the picture
};

/// That of a node that has knots; none of any other.
std::optional<Shown> shownOf(const Node& node, const Placement& placement);

/// The metres of the curve up to where it is under the mouse, at most so many pixels away.
std::optional<double> alongAt(const Shown& shown, const Lens& lens, ImVec2 mouse, double reach);

void draw(const Shown& shown, const Lens& lens, ImDrawList& list, float scale);

}  // namespace splines
}  // namespace fw::editor
