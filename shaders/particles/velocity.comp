// The velocity that led each particle from its place to where it was found to be.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer places;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 2, scalar) writeonly buffer Velocities { vec4 velocities[]; };

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 moved = uintBitsToFloat(imageLoad(guesses, int(index)).xyz) - uintBitsToFloat(imageLoad(places, int(index)).xyz);
    velocities[index] = vec4(moved / push.step, 0.0);
}
