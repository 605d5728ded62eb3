// Vorticity confinement: what swirls is turned on about the place where it swirls most, against what the solver loses of it.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer curls;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer lists;
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) buffer Velocities { vec4 velocities[]; };

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(guesses, int(index)).xyz);
    vec4 curl = uintBitsToFloat(imageLoad(curls, int(index)));
    vec3 rise = vec3(0.0);  // of the curl's length
    uint texels = (counts[index] + 3) / 4, turns = subgroupMax(texels), t = 0;  // all lanes end together
    int texel = firstTexel(index);
    do {
        uvec4 four = t < texels ? imageLoad(lists, texel) : uvec4(index);
        for (int k = 0; k < 4; ++k) {
            int other = int(four[k]);
            vec3 off = p - uintBitsToFloat(imageLoad(guesses, other).xyz);
            rise += slopeShape(leftOf(dot(off, off))) * (uintBitsToFloat(imageLoad(curls, other).w) - curl.w) * off;
        }
        texel += kNextTexel;
    } while (++t < turns);
    rise *= push.slope;
    float steep = length(rise);
    velocities[index].xyz += push.vorticity * cross(rise / max(steep, 1e-6), curl.xyz);
}
