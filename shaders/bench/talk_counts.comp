// Fills the lowest levels of two histopyramids: a cell's triangles, and the vertices on the edges it owns (those that
// leave its lowest corner). The grid's far faces own no cells: the surface must not reach them.
#include "bench/talk.glsl"

layout(binding = 2, scalar) buffer CellPyramid { uint cellCounts[]; };
layout(binding = 3, scalar) buffer VertexPyramid { uint vertexCounts[]; };

layout(local_size_x = 64, local_size_y = 4) in;

void main() {
    uvec3 cell = gl_GlobalInvocationID;
    uint pattern = patternOf(cell), node = nodeIndex(cell, grid.levels);
    cellCounts[node] = cases[pattern * 16] / 3;
    vertexCounts[node] = bitCount(activeEdges(pattern));
}
