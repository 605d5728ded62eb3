// The density at each sample from kernels that were shaped (shape.comp), as the distance from one particle alone that has it.
#include "particles/around_block.glsl"

layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer shapes;  // floats, three texels each
layout(binding = 3, scalar) readonly buffer Order { uint order[]; };

mat2x4 density;

void nothing() { density = mat2x4(0.0); }

uint particleAt(uint i) { return order[i]; }
vec3 centreOf(uint particle) { return uintBitsToFloat(imageLoad(shapes, 3 * int(particle)).xyz); }

mat2x4 densityOf(uint particle) {
    int texel = 3 * int(particle);
    vec4 centre = uintBitsToFloat(imageLoad(shapes, texel));
    vec3 along = uintBitsToFloat(imageLoad(shapes, texel + 1).xyz), across = uintBitsToFloat(imageLoad(shapes, texel + 2).xyz);
    vec4 x = px - centre.x, xx = along.x * x * x;
    float y = py - centre.y;
    mat2x4 density;
    for (int layer = 0; layer < 2; ++layer) {
        float z = pz[layer] - centre.z;
        // x^T G x, the terms with x apart.
        float rest = along.y * y * y + along.z * z * z + across.z * y * z, slope = across.x * y + across.y * z;
        vec4 s = max(1.0 - (xx + slope * x + rest), 0.0);
        density[layer] = centre.w * s * s * s;
    }
    return density;
}

void add(uint a, uint b, bool both) { density += densityOf(a) + (both ? 1.0 : 0.0) * densityOf(b); }

vec4 lengths(int layer) { return push.none * sqrt(max(1.0 - pow(max(density[layer], 1e-30), vec4(1.0 / 3.0)), 0.0)); }
