// How many edges lead from each vertex to one of a higher number.
#include "mesh/mesh.glsl"
#include "mesh/bucket.glsl"

layout(local_size_x = MESH_GROUP) in;
layout(binding = 1, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 2, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 5, scalar) writeonly buffer Edges { uint edges[]; };

void main() {
    uint v = min(item(), push.vertices - 1), first = starts[v], last = first + counts[v], i = 0, higher = 0;
    uint most = texelsOf(uvec3(first), uvec3(last)).x;
    do {  // as long as any lane: one that is done counts nothing
        higher += countBetween(first, last, i, v, 0xffffffff);
    } while (subgroupAny(++i < most));
    if (item() < push.vertices) edges[v] = higher;
}
