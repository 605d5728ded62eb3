// Moves each particle as its own density and those of its neighbours ask. What two do to each other is equal and opposite.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer weighed;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer lists;
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, rgba32ui) readonly uniform uimageBuffer guesses;
layout(binding = 5, scalar) writeonly buffer Moved { vec4 moved[]; };  // the same

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec4 own = uintBitsToFloat(imageLoad(weighed, int(index)));
    vec4 plane = uintBitsToFloat(imageLoad(planes, int(index)));
    vec4 guess = uintBitsToFloat(imageLoad(guesses, int(index)));
    vec3 p = guess.xyz, shift = vec3(0.0);
    uint texels = (counts[index] + 3) / 4, turns = subgroupMax(texels), t = 0;  // all lanes end together
    int texel = firstTexel(index);
    do {
        uvec4 four = t < texels ? imageLoad(lists, texel) : uvec4(index);
        for (int k = 0; k < 4; ++k) {
            vec4 its = uintBitsToFloat(imageLoad(weighed, int(four[k])));
            vec3 off = own.xyz - its.xyz;
            shift += (own.w + its.w) * slopeShape(leftOf(dot(off, off))) * off;
        }
        texel += kNextTexel;
    } while (++t < turns);
    p = inTank(p + push.slope * shift + own.w * wallsAt(p, plane).xyz);
    p += max(plane.w - dot(plane.xyz, p), 0.0) * plane.xyz;
    moved[index] = vec4(inTank(p), guess.w);
}
