// The least and the greatest sample of blocks twice as large as those before.
#include "particles/volume.glsl"

layout(local_size_x = VOLUME_GROUP) in;
layout(binding = 0, scalar) restrict buffer Volume { uvec2 halves[]; };

void main() {
    uint index = item();
    ivec3 larger = (push.blocks + 1) / 2;
    if (index >= countOf(larger)) return;
    ivec3 at = placeIn(larger, index);
    uint first = 2 * (push.first + countOf(push.size));
    vec2 range = vec2(1e30, -1e30);
    for (int k = 0; k < 8; ++k) {
        ivec3 block = min(2 * at + ivec3(k & 1, k >> 1 & 1, k >> 2), push.blocks - 1);
        vec2 own = uintBitsToFloat(halves[first + push.from + indexIn(push.blocks, block)]);
        range = vec2(min(range.x, own.x), max(range.y, own.y));
    }
    halves[first + push.to + index] = floatBitsToUint(range);
}
