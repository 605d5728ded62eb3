// The curl of the velocities at each particle, 1/s, by the differences to its neighbours.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer velocities;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer lists;
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Curls { vec4 curls[]; };  // and their length

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(guesses, int(index)).xyz), v = uintBitsToFloat(imageLoad(velocities, int(index)).xyz);
    vec3 curl = vec3(0.0);
    uint texels = (counts[index] + 3) / 4, turns = subgroupMax(texels), t = 0;  // all lanes end together
    int texel = firstTexel(index);
    do {
        uvec4 four = t < texels ? imageLoad(lists, texel) : uvec4(index);
        for (int k = 0; k < 4; ++k) {
            int other = int(four[k]);
            vec3 off = p - uintBitsToFloat(imageLoad(guesses, other).xyz);
            vec3 faster = uintBitsToFloat(imageLoad(velocities, other).xyz) - v;
            curl += slopeShape(leftOf(dot(off, off))) * cross(off, faster);
        }
        texel += kNextTexel;
    } while (++t < turns);
    curl *= push.slope;
    curls[index] = vec4(curl, length(curl));
}
