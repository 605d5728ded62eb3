// Moves each particle as its own density and those of its neighbours ask. What two do to each other is equal and opposite.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer weighed;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 2, scalar) readonly buffer Lists { uint lists[]; };
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, rgba32ui) restrict writeonly uniform uimageBuffer guesses;

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec4 own = uintBitsToFloat(imageLoad(weighed, int(index)));
    vec4 plane = uintBitsToFloat(imageLoad(planes, int(index)));
    vec3 shift = own.w * wallsAt(own.xyz, plane).xyz;
    uint count = counts[index], k = 0;
    do {
        uint other = lists[k * push.particles + index];
        vec4 its = uintBitsToFloat(imageLoad(weighed, int(k < count ? other : index)));
        vec3 off = own.xyz - its.xyz;
        shift += k < count ? (own.w + its.w) * slopeAt(length(off)) * off : vec3(0.0);
    } while (++k < count);
    vec3 p = inTank(own.xyz + shift);
    p += max(plane.w - dot(plane.xyz, p), 0.0) * plane.xyz;
    imageStore(guesses, int(index), floatBitsToUint(vec4(inTank(p), 0.0)));
}
