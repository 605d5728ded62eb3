// What is drawn over the picture to tell places and sizes by: a grid, a bar of a known length, and words that
// say from where it is looked.
//
// The grid lies on the ground, y = 0; seen orthographically from a side, on the plane through the origin that
// is looked at. Its spacing is 1, 2 or 5 times a power of ten. It is drawn over the solid, which does
// not hide it: so it is off until it is asked for.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "editor/viewport/gizmo.h"
#include "editor/viewport/orbit.h"
#include "graph/library/units.h"

namespace fw::editor {

struct GridLine {
    glm::dvec3 from, to;
    int along = 0;        ///< 0: x, 1: y, 2: z
    bool axis = false;    ///< it goes through the origin
    bool strong = false;  ///< every tenth
    double shown = 1.0;   ///< 1: wholly, 0: not at all, as it is far away
};

struct Grid {
    double spacing = 1.0;
    std::vector<GridLine> lines;
};

/// `side`: the plane that is seen from there; none: the ground. `target` is what the lens looks at.
Grid gridOf(const Lens& lens, const glm::dvec3& target, std::optional<Side> side);

/// "2 m", "5 cm", "0.1 mm", of a length in that unit; where it is inches "2 in".
std::string lengthWords(double length, const LengthUnit& unit);

struct Editor;
/// All of it, over the picture that is there.
void showGround(Editor& editor);

}  // namespace fw::editor
