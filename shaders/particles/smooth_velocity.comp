// Viscosity and surface tension: each pair's velocities come nearer to each other, and the pair itself does, by equal and
// opposite amounts.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer velocities;
layout(binding = 2, scalar) readonly buffer Lists { uint lists[]; };
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, rgba32ui) restrict writeonly uniform uimageBuffer smoothed;

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(guesses, int(index)).xyz), v = uintBitsToFloat(imageLoad(velocities, int(index)).xyz);
    vec3 change = vec3(0.0);
    uint count = counts[index], k = 0;
    do {
        int other = int(k < count ? lists[k * push.particles + index] : index);
        vec3 off = p - uintBitsToFloat(imageLoad(guesses, other).xyz);
        float w = k < count ? weightAt(length(off)) : 0.0;
        change += w * (push.viscosity * (uintBitsToFloat(imageLoad(velocities, other).xyz) - v) - push.step * push.tension * off);
    } while (++k < count);
    imageStore(smoothed, int(index), floatBitsToUint(vec4(v + change, 0.0)));
}
