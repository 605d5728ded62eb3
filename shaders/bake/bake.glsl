// Of all kernels that make a mesh a field (graph/assets/mesh_field.h says how). Coordinates are cells of the grid.
#include "shared.h"
#include "bake/bake.h"
#include "lib/groups.glsl"

layout(push_constant, scalar) uniform PushConstants { BakePush push; };

uint item() { return linearGroup() * BAKE_GROUP + gl_LocalInvocationIndex; }
uint sampleCount() { return uint(push.size.x * push.size.y * push.size.z); }
ivec3 placeOf(uint index) {
    uvec2 size = uvec2(push.size.xy);
    return ivec3(index % size.x, index / size.x % size.y, index / (size.x * size.y));
}
int indexOf(ivec3 at) { return (at.z * push.size.y + at.y) * push.size.x + at.x; }
