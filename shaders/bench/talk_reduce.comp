// One step of building a histopyramid: each node of a level becomes the sum of its eight children.
#include "bench/talk.glsl"

layout(binding = 2, scalar) buffer Pyramid { uint counts[]; };

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    uvec3 node = gl_GlobalInvocationID;
    if (any(greaterThanEqual(node, uvec3(1u << grid.level)))) return;
    uint sum = 0;
    for (uint i = 0; i < 8; i++) sum += counts[nodeIndex(2 * node + childOffset(i), grid.level + 1)];
    counts[nodeIndex(node, grid.level)] = sum;
}
