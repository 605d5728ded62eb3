// Writes a volume's samples: values that are near to distances, by what is there of them and its slope, and their gradients; with
// SWEPT the distances to nearest points. Each lane does a block of 4 x 4 x 4 samples, and keeps the least and the greatest of them.
#include "particles/volume.glsl"

layout(local_size_x = VOLUME_GROUP) in;
#ifdef SWEPT
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer state;  // nearest points, of bake/sweep.comp
layout(binding = 1, scalar) readonly buffer Field { float field[]; };        // whose sign it is; rows padded to texels
#else
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer field;  // floats
layout(binding = 1, scalar) readonly buffer Reach { float squares[]; };     // of blocks of 8 x 8 x 8 samples
#endif
layout(binding = 2, scalar) restrict writeonly buffer Volume { uvec2 halves[]; };

#ifdef SWEPT
const float kNowhere = 1e6;
#else
// At the corner of a block, where the distance is none, the mean between the middles of blocks is 4.5.
const float kTooFar = 4.5;

vec4 row(int x, int y, int z) {
    ivec3 at = clamp(ivec3(x, y, z), ivec3(0), texels() - 1);
    return uintBitsToFloat(imageLoad(field, indexIn(texels(), at)));
}
#endif

uint packed(vec3 gradient) {
    ivec3 parts = ivec3(round(511.0 * clamp(gradient, -1.0, 1.0)));
    return uint(parts.x) & 1023u | (uint(parts.y) & 1023u) << 10 | (uint(parts.z) & 1023u) << 20;
}

void main() {
    uint index = item();
    if (index >= countOf(push.blocks)) return;
    ivec3 block = placeIn(push.blocks, index), many = min(push.size - 4 * block, 4);
#ifndef SWEPT
    // Far from the solid: between the middles of the coarse blocks around, all of them the same for all samples of this one.
    ivec3 corner = (block - 1) >> 1;
    float far[8];
    for (int k = 0; k < 8; ++k) {
        ivec3 at = clamp(corner + ivec3(k & 1, k >> 1 & 1, k >> 2), ivec3(0), push.coarse - 1);
        far[k] = sqrt(squares[indexIn(push.coarse, at)]);
    }
#endif
    float lowest = 1e30, highest = -1e30;
    int pass = 0;
    do {
        ivec3 at = ivec3(block.x, 4 * block.y + pass % 4, 4 * block.z + pass / 4);
        bool there = pass % 4 < many.y && pass / 4 < many.z;
        int first = int(push.first) + indexIn(push.size, ivec3(4 * at.x, at.yz));
#ifndef SWEPT
        vec4 f = row(at.x, at.y, at.z);
        float before = row(at.x - 1, at.y, at.z).w, after = row(at.x + 1, at.y, at.z).x;
        if (at.x == 0) before = f.x;
        vec4 gx = 0.5 * (vec4(f.yzw, after) - vec4(before, f.xyz));
        vec4 gy = 0.5 * (row(at.x, at.y + 1, at.z) - row(at.x, at.y - 1, at.z));
        vec4 gz = 0.5 * (row(at.x, at.y, at.z + 1) - row(at.x, at.y, at.z - 1));
        vec2 t = (vec2(at.yz) - 3.5) / 8.0 - vec2(corner.yz);
        vec2 low = mix(mix(vec2(far[0], far[1]), vec2(far[2], far[3]), t.x), mix(vec2(far[4], far[5]), vec2(far[6], far[7]), t.x), t.y);
#endif
        for (int k = 0; k < 4; ++k) {
            bool stored = there && k < many.x;
#ifdef SWEPT
            ivec3 place = ivec3(4 * at.x + k, at.yz);
            ivec3 known = min(place, push.size - 1);
            vec3 off = vec3(place) - uintBitsToFloat(imageLoad(state, indexIn(push.size, known)).xyz);
            float away = min(length(off), kNowhere);
            float side = field[(known.z * push.size.y + known.y) * 4 * texels().x + known.x] < 0.0 ? -1.0 : 1.0;
            float value = side * away;
            vec3 gradient = away < kNowhere ? side * off / max(away, 1e-6) : vec3(0.0);
#else
            vec3 gradient = vec3(gx[k], gy[k], gz[k]);
            float steep = max(length(gradient), push.flattest);
            float reach = mix(low.x, low.y, (float(4 * at.x + k) - 3.5) / 8.0 - float(corner.x)) - kTooFar;
            float value = max(f[k] / steep, reach);
            gradient /= steep;
#endif
            value *= push.cell;
            uvec2 words = uvec2(floatBitsToUint(value), packed(gradient));
            // A texel has its own sample and the next one.
            if (stored) halves[2 * (first + k)] = words;
            if (stored && first + k > int(push.first)) halves[2 * (first + k) - 1] = words;
            lowest = stored ? min(lowest, value) : lowest;
            highest = stored ? max(highest, value) : highest;
        }
    } while (++pass < 16);
    halves[2 * (push.first + countOf(push.size)) + index] = uvec2(floatBitsToUint(lowest), floatBitsToUint(highest));
}
