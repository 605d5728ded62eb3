// How many edges lead from each vertex to one of a higher number.
#include "mesh/mesh.glsl"

layout(local_size_x = MESH_GROUP) in;
layout(binding = 1, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 2, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 3, scalar) readonly buffer Next { uint next[]; };
layout(binding = 5, scalar) writeonly buffer Edges { uint edges[]; };

void main() {
    uint v = min(item(), push.vertices - 1), count = counts[v], first = starts[v], i = 0, higher = 0;
    do {
        higher += uint(i < count && next[first + min(i, count - 1)] > v);
    } while (subgroupAny(++i < count));
    if (item() < push.vertices) edges[v] = higher;
}
