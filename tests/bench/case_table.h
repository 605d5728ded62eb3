// The 256 cell patterns of marching cubes, derived from a rule for faces, for the baseline and the talk's
// stages.
//
// The rule: on a face cut twice, the inside corners are kept apart. Both cells at a face apply it to the same
// four signs, so their cuts meet and the mesh is closed for every sign field. Cuts of the six faces link into
// loops, and each loop of n edges becomes a fan of n - 2 triangles, none of whose inner sides lies in a face.
#pragma once

#include <array>
#include <cstdint>

namespace fw::bench {

/// A cell's edge: it leaves the corner (x, y, z), each 0 or 1, along an axis on which that corner has 0.
struct CellEdge {
    uint8_t x, y, z, axis;
    bool operator==(const CellEdge&) const = default;
};

/// The edges that hold a pattern's triangles, three a triangle, counter-clockwise seen from outside.
struct Case {
    uint8_t count = 0;  ///< edges in use: three times the number of triangles
    std::array<CellEdge, 15> edges{};
    const CellEdge* begin() const { return edges.data(); }
    const CellEdge* end() const { return edges.data() + count; }
};

/// Bit c of a pattern is set if the corner (c & 1, c >> 1 & 1, c >> 2) is inside. Built on the first call.
const std::array<Case, 256>& caseTable();

}  // namespace fw::bench
