// The 256 cell patterns of marching cubes as flat lists of triangle corners, for the baseline and the talk's
// stages.
//
// The polygons are those of the mesher (runtime/mesher/marching_cubes_table.h), cut into fans, so that every
// program that is compared makes the same triangles.
#pragma once

#include <array>
#include <cstdint>

namespace fw::bench {

/// A cell's edge: it leaves the corner (x, y, z), each 0 or 1, along an axis on which that corner has 0.
struct CaseEdge {
    uint8_t x, y, z, axis;
};

/// The edges that hold a pattern's triangles, three a triangle, counter-clockwise seen from outside.
struct Case {
    uint8_t count = 0;  ///< edges in use: three times the number of triangles
    std::array<CaseEdge, 15> edges{};
    const CaseEdge* begin() const { return edges.data(); }
    const CaseEdge* end() const { return edges.data() + count; }
};

/// Bit c of a pattern is set if the corner (c & 1, c >> 1 & 1, c >> 2) is inside. Built on the first call.
const std::array<Case, 256>& caseTable();

}  // namespace fw::bench
