// The bucket of each particle; the last one is that of all which no sample can feel.
#include "particles/density.glsl"

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer particles;  // floats: the place, metres
layout(binding = 1, scalar) writeonly buffer Keys { uint keys[]; };

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 at = (uintBitsToFloat(imageLoad(particles, int(index)).xyz) - push.first) / push.radius;
    bool within = all(greaterThanEqual(at, vec3(0.0))) && all(lessThan(at, vec3(push.buckets)));  // not where it is no number
    ivec3 b = ivec3(within ? at : vec3(0.0));
    uint key = uint((b.z * push.buckets.y + b.y) * push.buckets.x + b.x);
    keys[index] = within ? key : uint(push.buckets.x * push.buckets.y * push.buckets.z);
}
