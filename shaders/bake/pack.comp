// A sample's words from its nearest point: distance and gradient, as graph/assets/volume.h has them, and with COLORS the colour.
// Looks whether signs contradict each other.
#include "bake/bake.glsl"
#ifdef COLORS
#include "bake/triangle.glsl"
layout(binding = 10, rgba32ui) restrict readonly uniform uimageBuffer colors;  // three texels of floats a triangle: linear light
layout(binding = 11, scalar) writeonly buffer ColorWords { uint colorWords[]; };
#endif

layout(local_size_x = BAKE_GROUP) in;
layout(binding = 4, rgba32ui) restrict readonly uniform uimageBuffer state;
layout(binding = 6, scalar) buffer Counts { BakeCounts counts; };
layout(binding = 8, scalar) writeonly buffer Words { uvec2 words[]; };

float distanceAt(ivec3 at, out vec3 off) {
    uvec4 own = imageLoad(state, indexOf(at));
    off = vec3(at) - uintBitsToFloat(own.xyz);
    return (own.w & BAKE_INSIDE) != 0 ? -length(off) : length(off);
}

void main() {
    uint index = item();
    if (index >= sampleCount()) return;
    ivec3 at = placeOf(index);
    vec3 off, unused, slope;
    float here = distanceAt(at, off);
    bool contradicts = false;
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 before = at, next = at;
        before[axis] = max(before[axis] - 1, 0);
        next[axis] = min(next[axis] + 1, push.size[axis] - 1);
        float there = distanceAt(next, unused);
        slope[axis] = (there - distanceAt(before, unused)) / float(next[axis] - before[axis]);
        contradicts = contradicts || (here < 0.0 != there < 0.0 && abs(here) + abs(there) > 1.05);
    }
    if (contradicts) atomicOr(counts.contradictions, 1);
    // A point that was handed on is as far as the nearest, or nearly, but not in the same direction: beyond the band
    // differences are better.
    vec3 away = abs(here) > BAKE_BAND ? slope / max(length(slope), 1.0) : off / (here == 0.0 ? 1.0 : here);
    ivec3 gradient = ivec3(round(511.0 * away)) & 1023;
    words[index] = uvec2(floatBitsToUint(here * push.cell), uint(gradient.x | gradient.y << 10 | gradient.z << 20));
#ifdef COLORS
    uint feature, triangle = imageLoad(state, int(index)).w & ~BAKE_INSIDE;
    vec3 w = nearestWeights(triangleAt(triangle), vec3(at), feature);
    vec3 c = vec3(0.0);
    for (int k = 0; k < 3; ++k) c += w[k] * uintBitsToFloat(imageLoad(colors, 3 * int(triangle) + k).xyz);
    c = clamp(c, 0.0, 1.0);
    c = mix(12.92 * c, 1.055 * pow(max(c, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
    uvec3 codes = uvec3(round(255.0 * c));
    colorWords[index] = codes.x | codes.y << 8 | codes.z << 16;
#endif
}
