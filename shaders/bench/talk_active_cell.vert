// A point per active cell, whose place the histopyramid tells.
#include "bench/talk.glsl"

layout(binding = 2, scalar) readonly buffer CellPyramid { uint cellCounts[]; };

DEFINE_DESCENT(activeCell, cellCounts)

layout(location = 0) flat out uvec3 cell;

void main() { cell = activeCell(gl_VertexIndex).xyz; }
