// How far each block of 8 x 8 x 8 samples is from the nearest that holds a part of the solid: squares of the distances between their
// middles and those blocks, along one axis after another.
#include "particles/volume.glsl"

layout(local_size_x = VOLUME_GROUP) in;
layout(binding = 0, scalar) readonly buffer Least { float least[]; };
layout(binding = 1, scalar) readonly buffer From { float from[]; };
layout(binding = 2, scalar) writeonly buffer To { float to[]; };

const float kNone = 1e12;

float squareAt(ivec3 coarse) {
    if (push.axis != 0) return from[indexIn(push.coarse, coarse)];
    float lowest = 1e30;
    for (int k = 0; k < 8; ++k) {
        ivec3 block = min(2 * coarse + ivec3(k & 1, k >> 1 & 1, k >> 2), push.blocks - 1);
        lowest = min(lowest, least[indexIn(push.blocks, block)]);
    }
    return lowest < 0.0 ? 0.0 : kNone;
}

void main() {
    uint index = item();
    if (index >= countOf(push.coarse)) return;
    ivec3 at = placeIn(push.coarse, index);
    float nearest = kNone;
    int i = 0;
    do {
        ivec3 other = at;
        other[push.axis] = i;
        float apart = 8.0 * max(abs(float(i - at[push.axis])) - 0.5, 0.0);
        nearest = min(nearest, squareAt(other) + apart * apart);
    } while (++i < push.coarse[push.axis]);
    to[index] = nearest;
}
