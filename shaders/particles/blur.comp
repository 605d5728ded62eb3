// One blur of three, along AXIS (0, 1, 2 for x, y, z): each lane goes along a piece of a line with the values around it in
// registers. The first blur is along x, of whole rows, reads whole numbers and goes by four samples; the others go by eight
// in x, and the last writes floats. Pieces are short so that lanes after one another write next to one another: with whole
// lines software devices take about twice as long. REACH is the number of weights beyond the middle one.
#include "particles/density.glsl"

#ifndef REACH
#define REACH 4
#endif
#ifndef AXIS
#define AXIS 1
#endif

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer from;
layout(binding = 2, scalar) readonly buffer Weights { float weights[]; };
#if AXIS == 0
#define SAMPLES vec4
layout(binding = 1, scalar) writeonly buffer To { uvec2 to[]; };
#else
#define SAMPLES mat2x4
layout(binding = 1, scalar) writeonly buffer To { uvec4 to[]; };
#endif

// Samples between blurs, eight to a texel: floats without sign, of 5 bits of exponent and 11, from 2^-14, which stands for 0,
// to 2^18, where they end: farther than half floats.
const uint kLeast = 113 << 23;
uvec2 shorten(vec4 v) {
    uvec4 bits = min((floatBitsToUint(v + uintBitsToFloat(kLeast)) - kLeast + 0x800) >> 12, uvec4(0xffff));
    return bits.xz | bits.yw << 16;
}
vec4 lengthen(uvec2 words) {
    uvec4 bits = words.xxyy >> uvec4(0, 16, 0, 16) & 0xffff;
    return uintBitsToFloat((bits << 12) + kLeast) - uintBitsToFloat(kLeast);
}

SAMPLES read(int texel, bool within) {
    uvec4 words = imageLoad(from, within ? texel : 0);
    words = within ? words : uvec4(0);
#if AXIS == 0
    return vec4(words) * (1.0 / push.unit);
#else
    return mat2x4(lengthen(words.xy), lengthen(words.zw));
#endif
}

void main() {
    const int reach = AXIS == 0 ? (REACH + 3) / 4 : REACH;
    int fours = pitch() / 4;
    ivec3 texels = ivec3((fours + 1) / 2, push.size.yz), pieces = texels;
    int count = texels[AXIS], most = AXIS == 0 ? count : DENSITY_PIECE(REACH);
    pieces[AXIS] = (count + most - 1) / most;
    int lane = int(item());
    ivec3 at = ivec3(lane % pieces.x, lane / pieces.x % pieces.y, lane / (pieces.x * pieces.y));
    if (at.z >= pieces.z) return;
    int i = at[AXIS] * most, end = min(i + most, count);
    at[AXIS] = 0;
    int line = at.z * texels.y + at.y, first = line * texels.x + at.x, stride = AXIS == 1 ? texels.x : texels.x * texels.y;
#if AXIS == 0
    first = line * fours, stride = 1, count = fours, end *= 2;
#endif
    float w[REACH + 1];
    for (int k = 0; k <= REACH; ++k) w[k] = weights[k];
    SAMPLES around[2 * reach + 1];
    for (int k = 0; k < 2 * reach; ++k) {
        int other = i + k - reach;
        around[k + 1] = read(first + other * stride, other >= 0 && other < count);
    }
    do {
        for (int k = 0; k < 2 * reach; ++k) around[k] = around[k + 1];
        around[2 * reach] = read(first + (i + reach) * stride, i + reach < count);
#if AXIS == 0
        vec4 sum = vec4(0.0);
        for (int c = 0; c < 4; ++c)
            for (int k = -REACH; k <= REACH; ++k) {
                int other = 4 * reach + c + k;
                sum[c] += w[abs(k)] * around[other / 4][other % 4];
            }
        to[line * 2 * texels.x + i] = shorten(sum);
#else
        mat2x4 sum = w[0] * around[reach];
        for (int k = 1; k <= REACH; ++k) sum += w[k] * (around[reach - k] + around[reach + k]);
#if AXIS == 1
        to[first + i * stride] = uvec4(shorten(sum[0]), shorten(sum[1]));
#else
        int four = (i * texels.y + at.y) * fours + 2 * at.x;
        to[four] = floatBitsToUint(sum[0]);
        if (2 * at.x + 1 < fours) to[four + 1] = floatBitsToUint(sum[1]);
#endif
#endif
    } while (++i < end);
}
