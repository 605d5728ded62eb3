// The velocity that led each particle from its place to where it was found to be. Behind it goes the particle's number.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer places;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 2, scalar) writeonly buffer Velocities { uvec4 velocities[]; };  // floats, and the number

void main() {
    uint index = item();
    if (index >= push.particles) return;
    uvec4 place = imageLoad(places, int(index));
    vec3 moved = uintBitsToFloat(imageLoad(guesses, int(index)).xyz) - uintBitsToFloat(place.xyz);
    velocities[index] = uvec4(floatBitsToUint(moved / push.step), place.w);
}
