// Which polygons the surface makes in a cell, for each of the 256 patterns of inside and outside corners.
//
// Derived at start, not typed in, from one rule that looks at a single face: going around a face, every run
// of inside corners is cut off from the rest by one segment. Both cells that share a face see the same signs
// and so draw the same segments, in opposite directions: whatever the field, the surface is closed and
// oriented. Each cell's segments link up to closed loops, one polygon each. On a face with two inside corners
// across a diagonal the rule parts them; the complement then joins the outside, so no pattern may be replaced
// by its complement (the fault of Lorensen and Cline's table of 1987). Polygons become fans from a vertex
// from which no diagonal lies in a face of the cell, where a neighbour might draw the same line again.
//
// Corner i of a cell is at (i & 1, i >> 1 & 1, i >> 2). Edge 4 a + b + 2 c lies along axis a; b and c are its
// offsets along the other two axes, in order. Bit i of a pattern is set if corner i is inside.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fw {

/// Edges of one polygon, counter-clockwise seen from outside; the first is the centre of its fan.
using CellPolygon = std::vector<uint8_t>;

/// The polygons of a pattern (0..255); none for 0 and 255. The table is made at the first call.
const std::vector<CellPolygon>& cellPolygons(int pattern);

/// Corner at which an edge starts, and the axis along which it runs.
struct CellEdge {
    glm::uvec3 corner;
    int axis;
};
CellEdge cellEdge(int edge);

/// The most polygons of one cell.
inline constexpr int kMostCellPolygons = 4;

/// The table as the index kernel reads it: up to twelve bytes from the lowest bit, one for each edge. Of a
/// byte, bits 5 and 0 are the offsets of the edge along x and y, bit 2 that along z, bits 3 and 4 the axis;
/// bit 6 marks the first edge of a polygon, bit 7 the last edge of all.
const std::array<glm::uvec3, 256>& packedCellPolygons();

/// The same for dual contouring, each polygon by itself: entry 4 * pattern + n is its n-th, all zero if it
/// has fewer. Bit 7 marks the last edge of the polygon. Of the two faces of the cell at the edge, bit 1 marks
/// the one that stands across the first of the other two axes, bit 6 the other one, if the polygon runs over
/// that face twice.
const std::array<glm::uvec3, 256 * kMostCellPolygons>& packedCellPatches();

}  // namespace fw
