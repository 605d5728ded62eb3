// Counting sort of corners by vertex, its first pass: how many there are at each vertex. What the atomic addition
// returns is the corner's place among them, in an order that may be another in each run.
#include "mesh/mesh.glsl"

layout(local_size_x = MESH_GROUP) in;
layout(binding = 0, scalar) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = 1, scalar) buffer Counts { uint counts[]; };
layout(binding = 2, scalar) writeonly buffer Ranks { uvec3 ranks[]; };

void main() {
    uint t = item();
    if (t >= push.triangles) return;
    uvec3 corners = triangles[t];
    ranks[t] = uvec3(atomicAdd(counts[corners.x], 1), atomicAdd(counts[corners.y], 1), atomicAdd(counts[corners.z], 1));
}
