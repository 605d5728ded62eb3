// The indices of one triangle, found through the lookup volume.
#include "bench/talk.glsl"

layout(binding = 2, scalar) readonly buffer CellPyramid { uint cellCounts[]; };
layout(binding = 5, scalar) readonly buffer Lookup { uint lookup[]; };
layout(binding = 7, scalar) buffer Indices { uint indices[]; };

DEFINE_DESCENT(cellOfTriangle, cellCounts)

layout(local_size_x = 256) in;

void main() {
    uint triangle = gl_GlobalInvocationID.x;
    if (triangle >= min(cellCounts[0], indices.length() / 3)) return;
    uvec4 found = cellOfTriangle(triangle);
    uint first = patternOf(found.xyz) * 16 + 1 + 3 * found.w;
    for (uint i = 0; i < 3; i++) {
        uint edge = cases[first + i];
        uint entry = lookup[cellIndex(found.xyz + childOffset(edge & 7u))];
        uint before = entry & ((1u << (edge >> 3)) - 1u);
        indices[3 * triangle + i] = (entry >> 3) + bitCount(before & 7u);
    }
}
