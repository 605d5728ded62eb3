// Of all kernels that make particles a density (runtime/particles/density.h says how).
#include "shared.h"
#include "particles/density.h"
#include "lib/groups.glsl"

layout(push_constant, scalar) uniform PushConstants { DensityPush push; };

uint item() { return linearGroup() * DENSITY_GROUP + gl_LocalInvocationIndex; }
// Samples of a row, in memory: four to a texel.
int pitch() { return (push.size.x + 3) / 4 * 4; }
uint sampleCount() { return uint(pitch() * push.size.y * push.size.z); }
ivec3 placeOf(uint index) {
    uvec2 size = uvec2(pitch(), push.size.y);
    return ivec3(index % size.x, index / size.x % size.y, index / (size.x * size.y));
}
int indexOf(ivec3 at) { return (at.z * push.size.y + at.y) * pitch() + at.x; }
