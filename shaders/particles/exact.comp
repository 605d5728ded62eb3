// The density at each sample from the particles in the 27 buckets around it: nine rows of three, each of which lies in one
// piece in the sorted list.
#include "particles/density.glsl"

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer sorted;
layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 2, scalar) writeonly buffer Density { float density[]; };

void main() {
    uint index = item();
    if (index >= sampleCount()) return;
    vec3 p = (push.origin + push.cell * vec3(placeOf(index)) - push.first) / push.radius;
    ivec3 own = clamp(ivec3(p), ivec3(1), push.buckets - 2);  // but for rounding, all are a bucket away from the sides
    float sum = 0.0;
    int row = 0;
    do {
        ivec3 b = own + ivec3(-1, row % 3 - 1, row / 3 - 1);
        int bucket = (b.z * push.buckets.y + b.y) * push.buckets.x + b.x;
        uint i = starts[bucket], last = starts[bucket + 3];
        do {
            vec3 off = p - uintBitsToFloat(imageLoad(sorted, int(min(i, push.particles - 1))).xyz);
            float s = max(1.0 - dot(off, off), 0.0);
            sum += i < last ? s * s * s : 0.0;
        } while (++i < last);
    } while (++row < 9);
    density[index] = sum;
}
