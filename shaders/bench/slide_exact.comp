// The slide's exact way: the particles of the cells around each sample, which are one sample wide: 9^3 of them for particles
// four cells wide. Those of a row lie in one piece.
#include "particles/density.glsl"

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer sorted;  // floats: the place, in cells
layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 2, scalar) writeonly buffer Density { float density[]; };

void main() {
    uint index = item();
    if (index >= sampleCount()) return;
    ivec3 low = placeOf(index);
    vec3 p = (push.origin - push.first) / push.cell + vec3(low);
    int across = 2 * push.reach + 1, row = 0;
    float sum = 0.0;
    do {
        int cell = ((low.z + row / across) * push.buckets.y + low.y + row % across) * push.buckets.x + low.x;
        uint i = starts[cell], last = starts[cell + across];
        do {
            vec3 off = (p - uintBitsToFloat(imageLoad(sorted, int(min(i, push.particles - 1))).xyz)) / float(push.reach);
            float s = max(1.0 - dot(off, off), 0.0);
            sum += i < last ? s * s * s : 0.0;
        } while (++i < last);
    } while (++row < across * across);
    density[index] = sum;
}
