// Strokes: a line as wide as a pen, as what is filled of it.
//
// Each arc swept across its width is bounded by two arcs about the same centre and by two straight ends; what
// is swept on the far side of a centre that lies within the width is a sector of its own. Joins and caps are
// pieces by themselves. All are wound to the left, so that together they fill what any of them covers. (SVG
// 2, 13.5)
#pragma once

#include <vector>

#include "graph/outlines/path.h"

namespace fw {

struct StrokeStyle {
    enum class Join : unsigned char { miter, round, bevel };
    enum class Cap : unsigned char { butt, round, square };
    double width = 1;  ///< above 0
    Join join = Join::miter;
    Cap cap = Cap::butt;
    double miterLimit = 4;            ///< a longer miter, in widths, is a bevel
    std::vector<double> dashes = {};  ///< lengths of dash and gap by turns, above 0 in sum; none: no gaps
    double dashOffset = 0;
};

/// Closed contours, to be filled by winding. A contour without length has caps, unless these are butt.
std::vector<Contour> strokeOf(const std::vector<Contour>& contours, const StrokeStyle& style);

}  // namespace fw
