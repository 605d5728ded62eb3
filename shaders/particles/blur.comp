// One blur of three, along push.axis: each lane goes along a line of texels, of four samples in x each, with the values around
// it in registers, so that each is read once. The first is along x, with ALONG_X, and reads whole numbers. REACH is the
// number of weights beyond the middle one.
#include "particles/density.glsl"

#ifndef REACH
#define REACH 4
#endif

layout(local_size_x = DENSITY_LINES) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer from;
layout(binding = 1, rgba32ui) restrict writeonly uniform uimageBuffer to;
layout(binding = 2, scalar) readonly buffer Weights { float weights[]; };

vec4 read(int texel, bool within) {
    uvec4 words = imageLoad(from, within ? texel : 0);
#ifdef ALONG_X
    vec4 values = vec4(words) * (1.0 / DENSITY_UNIT);
#else
    vec4 values = uintBitsToFloat(words);
#endif
    return within ? values : vec4(0.0);
}

void main() {
    ivec3 texels = ivec3(pitch() / 4, push.size.yz);
    int line = int(gl_WorkGroupID.x * DENSITY_LINES + gl_LocalInvocationIndex);
#ifdef ALONG_X
    const int reach = (REACH + 3) / 4;
    if (line >= texels.y * texels.z) return;
    int first = line * texels.x, stride = 1, count = texels.x;
#else
    const int reach = REACH;
    int other = push.axis == 1 ? texels.z : texels.y;
    if (line >= texels.x * other) return;
    int stride = push.axis == 1 ? texels.x : texels.x * texels.y;
    int first = line % texels.x + line / texels.x * (push.axis == 1 ? texels.x * texels.y : texels.x);
    int count = push.axis == 1 ? texels.y : texels.z;
#endif
    float w[REACH + 1];
    for (int k = 0; k <= REACH; ++k) w[k] = weights[k];
    vec4 around[2 * reach + 1];
    for (int k = 0; k < 2 * reach; ++k) around[k + 1] = k < reach ? vec4(0.0) : read(first + (k - reach) * stride, k - reach < count);
    int i = 0;
    do {
        for (int k = 0; k < 2 * reach; ++k) around[k] = around[k + 1];
        around[2 * reach] = read(first + (i + reach) * stride, i + reach < count);
        vec4 sum = vec4(0.0);
#ifdef ALONG_X
        for (int c = 0; c < 4; ++c)
            for (int k = -REACH; k <= REACH; ++k) sum[c] += w[abs(k)] * around[(4 * reach + c + k) / 4][(4 * reach + c + k) % 4];
#else
        sum = w[0] * around[reach];
        for (int k = 1; k <= REACH; ++k) sum += w[k] * (around[reach - k] + around[reach + k]);
#endif
        imageStore(to, first + i * stride, floatBitsToUint(sum));
    } while (++i < count);
}
