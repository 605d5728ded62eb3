// Of all kernels that make densities a volume (runtime/particles/particle_volume.h says how). Lengths are cells, unless told.
#include "shared.h"
#include "particles/volume.h"
#include "lib/groups.glsl"

layout(push_constant, scalar) uniform PushConstants { ParticleVolumePush push; };

uint item() { return linearGroup() * VOLUME_GROUP + gl_LocalInvocationIndex; }
uint countOf(ivec3 size) { return uint(size.x * size.y * size.z); }
ivec3 placeIn(ivec3 size, uint index) { return ivec3(index % size.x, index / size.x % size.y, index / (size.x * size.y)); }
int indexIn(ivec3 size, ivec3 at) { return (at.z * size.y + at.y) * size.x + at.x; }
// Rows of densities are padded to texels of four samples.
ivec3 texels() { return ivec3((push.size.x + 3) / 4, push.size.yz); }
