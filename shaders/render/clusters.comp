// The box about each cluster of triangles, and that about their normals; one cluster a lane. As meshes' order follows their bricks,
// clusters are compact without being sorted.
#include "shared.h"
#include "render/render.h"
#include "lib/groups.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32ui) readonly uniform uimageBuffer vertices;  // MeshVertex
layout(binding = 1, scalar) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = 2, scalar) writeonly buffer Clusters { Cluster clusters[]; };
layout(push_constant, scalar) uniform Push { uint count; };  // of triangles

vec3 positionOf(uint vertex) { return uintBitsToFloat(imageLoad(vertices, int(vertex)).xyz); }

void main() {
    uint cluster = linearGroup() * gl_WorkGroupSize.x + gl_LocalInvocationIndex, first = cluster * CLUSTER_TRIANGLES, last = count - 1;
    vec3 lo = vec3(1e30), hi = vec3(-1e30), normalLo = vec3(1e30), normalHi = vec3(-1e30);
    uint i = 0;
    do {
        uvec3 corners = triangles[min(first + i, last)];
        vec3 a = positionOf(corners.x), b = positionOf(corners.y), c = positionOf(corners.z);
        vec3 n = cross(b - a, c - a);
        float size = length(n);
        lo = min(lo, min(a, min(b, c)));
        hi = max(hi, max(a, max(b, c)));
        normalLo = min(normalLo, size > 0.0 ? n / size : vec3(-1.0));
        normalHi = max(normalHi, size > 0.0 ? n / size : vec3(1.0));
    } while (++i < CLUSTER_TRIANGLES);
    if (first <= last) clusters[cluster] = Cluster(lo, hi, normalLo, normalHi);
}
