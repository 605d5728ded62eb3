// The indices of the listed clusters, one after the other; one cluster a work group.
#include "shared.h"
#include "render/render.h"

layout(local_size_x = CLUSTER_TRIANGLES) in;
layout(binding = 0, scalar) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = 1, scalar) readonly buffer Seen { uint seen[]; };
layout(binding = 2, scalar) writeonly buffer Gathered { uvec3 gathered[]; };
layout(push_constant, scalar) uniform Push { uint count; };  // of triangles

void main() {
    uint lane = gl_LocalInvocationIndex, triangle = seen[gl_WorkGroupID.x] * CLUSTER_TRIANGLES + lane;
    uvec3 corners = triangles[min(triangle, count - 1)];
    gathered[gl_WorkGroupID.x * CLUSTER_TRIANGLES + lane] = triangle < count ? corners : uvec3(corners.x);
}
