// The fluid's normals, outwards, and how steeply its density falls there, in densities at rest a spacing: about a half at a surface.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer places;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer lists;
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Normals { vec4 normals[]; };

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(places, int(index)).xyz), offs = vec3(0.0);
    uint texels = (counts[index] + 3) / 4, turns = subgroupMax(texels), t = 0;  // all lanes end together
    int texel = firstTexel(index);
    do {
        uvec4 four = t < texels ? imageLoad(lists, texel) : uvec4(index);
        for (int k = 0; k < 4; ++k) {
            vec3 off = p - uintBitsToFloat(imageLoad(places, int(four[k])).xyz);
            offs += slopeShape(leftOf(dot(off, off))) * off;
        }
        texel += kNextTexel;
    } while (++t < turns);
    vec3 fall = -push.slope * offs - wallsAt(p, uintBitsToFloat(imageLoad(planes, int(index)))).xyz;
    float steep = length(fall);
    normals[index] = vec4(fall / max(steep, 1e-6), 0.5 * push.support * steep);
}
