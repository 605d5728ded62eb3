// Fills the lowest level of the histopyramid of active cells: 0 for an empty cell, 1 for an active one.
#include "bench/talk.glsl"

layout(binding = 2, scalar) buffer CellPyramid { uint cellCounts[]; };

layout(local_size_x = 64, local_size_y = 4) in;

void main() {
    uvec3 cell = gl_GlobalInvocationID;
    uint pattern = patternOf(cell);
    cellCounts[nodeIndex(cell, grid.levels)] = uint(pattern != 0 && pattern != 255);
}
