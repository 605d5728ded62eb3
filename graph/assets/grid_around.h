// The grid on which distances to a solid are measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "graph/assets/volume.h"

namespace fw {

/// Cells between the solid's box and the grid's end. No whole number, so that the sides of a box do not go
/// through samples, where the edges between them would have no gradient.
inline constexpr double kPadding = 2.37;

/// Below, or above, squares of lengths leave the range of single precision.
inline bool hasUsableCells(const VolumeGrid& grid) { return grid.cell >= 1e-15 && grid.cell <= 1e14; }

/// The grid around the box from `lo` to `hi`, and so many metres more on each side, with `resolution` samples
/// along its longest side, at least 8. Without samples if its cells are not usable.
inline VolumeGrid gridAround(const glm::dvec3& lo, const glm::dvec3& hi, int resolution, double margin) {
    const glm::dvec3 size = hi - lo + 2.0 * margin;
    VolumeGrid grid;
    grid.cell = std::max({size.x, size.y, size.z}) / (resolution - 1 - 2 * kPadding);
    if (!hasUsableCells(grid)) return grid;
    for (int axis = 0; axis < 3; ++axis) {
        const int cells = int(std::ceil(size[axis] / grid.cell + 2.0 * kPadding - 1e-9));
        grid.size[axis] = std::min(cells + 1, resolution);
        grid.origin[axis] = 0.5 * (lo[axis] + hi[axis]) - 0.5 * grid.cell * (grid.size[axis] - 1);
        grid.inset[axis] = 0.5 * (grid.cell * (grid.size[axis] - 1) - (hi[axis] - lo[axis]));
    }
    return grid;
}

}  // namespace fw
