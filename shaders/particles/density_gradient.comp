// The gradient of the density at each particle, 1/m, walls too: nothing where fluid is all around, and inwards at its surface.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer lists;
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Gradients { vec4 gradients[]; };

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(guesses, int(index)).xyz), offs = vec3(0.0);
    uint texels = (counts[index] + 3) / 4, turns = subgroupMax(texels), t = 0;  // all lanes end together
    int texel = firstTexel(index);
    do {
        uvec4 four = t < texels ? imageLoad(lists, texel) : uvec4(index);
        for (int k = 0; k < 4; ++k) {
            vec3 off = p - uintBitsToFloat(imageLoad(guesses, int(four[k])).xyz);
            offs += slopeShape(leftOf(dot(off, off))) * off;
        }
        texel += kNextTexel;
    } while (++t < turns);
    vec4 plane = uintBitsToFloat(imageLoad(planes, int(index)));
    gradients[index] = vec4(push.slope * offs + wallsAt(p, plane).xyz, 0.0);
}
