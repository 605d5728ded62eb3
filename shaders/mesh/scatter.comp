// Counting sort of corners by vertex, its last pass: each to its place, as the vertices after and before it in its
// triangle.
#include "mesh/mesh.glsl"

layout(local_size_x = MESH_GROUP) in;
layout(binding = 0, scalar) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 2, scalar) readonly buffer Ranks { uvec3 ranks[]; };
layout(binding = 3, scalar) writeonly buffer Next { uint next[]; };
layout(binding = 4, scalar) writeonly buffer Previous { uint previous[]; };

void main() {
    uint t = item();
    if (t >= push.triangles) return;
    uvec3 corners = triangles[t];
    uvec3 places = ranks[t] + uvec3(starts[corners.x], starts[corners.y], starts[corners.z]);
    next[places.x] = corners.y, previous[places.x] = corners.z;
    next[places.y] = corners.z, previous[places.y] = corners.x;
    next[places.z] = corners.x, previous[places.z] = corners.y;
}
