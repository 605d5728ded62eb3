// Particles in the order of their buckets, in units of the radius from the first bucket's corner.
#include "particles/density.glsl"

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer particles;
layout(binding = 1, scalar) readonly buffer Order { uint order[]; };
layout(binding = 2, scalar) writeonly buffer Sorted { vec4 sorted[]; };

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 place = uintBitsToFloat(imageLoad(particles, int(order[index])).xyz);
    sorted[index] = vec4((place - push.first) / push.radius, 0.0);
}
