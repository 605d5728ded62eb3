// The indices of the listed clusters, one after the other; a cluster a work group at a time.
#include "shared.h"
#include "render/render.h"

layout(local_size_x = CLUSTER_TRIANGLES) in;
layout(binding = 0, scalar) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = 1, scalar) readonly buffer Seen { uint seen[]; };
layout(binding = 2, scalar) writeonly buffer Gathered { uvec3 gathered[]; };
layout(binding = 3, scalar) readonly buffer Counts { ClusterCounts counts; };
layout(push_constant, scalar) uniform Push { uint count; };  // of triangles

void main() {
    uint lane = gl_LocalInvocationIndex, at = gl_WorkGroupID.x;
    do {
        uint triangle = seen[at] * CLUSTER_TRIANGLES + lane;
        uvec3 corners = triangles[min(triangle, count - 1)];
        gathered[at * CLUSTER_TRIANGLES + lane] = triangle < count ? corners : uvec3(corners.x);
    } while ((at += gl_NumWorkGroups.x) < counts.clusters);
}
