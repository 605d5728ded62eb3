// Of kernels of surfaces about particles (runtime/particles/particle_surface.h): the grid's blocks of 4 x 4 x 4 samples, and the buckets
// around. Lengths are sides of a bucket, unless told.
#include "particles/density.glsl"

layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };

const float kReach = float(SURFACE_SIDES);

ivec3 texels() { return ivec3(pitch() / 4, push.size.yz); }
int bucketAt(ivec3 b) { return (b.z * push.buckets.y + b.y) * push.buckets.x + b.x; }

// Whether there are particles everywhere among these buckets, as good as: of two neighbours along x, fewer than one pair in 32 has
// none. Buckets are as wide as a lattice's spacing, and some are empty in any fluid.
bool full(ivec3 first, ivec3 count) {
    int rows = count.y * count.z, row = 0, few = rows * (count.x - 1) / 32, voids = 0;
    do {
        int bucket = bucketAt(first + ivec3(0, row % count.y, row / count.y)), last = bucket + count.x - 2;
        do {
            voids += starts[bucket] == starts[bucket + 2] ? 1 : 0;
        } while (++bucket <= last);
    } while (voids <= few && ++row < rows);
    return voids <= few;
}

struct Block {
    ivec3 first;  // texel of its first four samples
    float cell;
    vec3 lo, hi;  // of its samples
};
uint blockCount() {
    ivec3 blocks = ivec3(texels().x, (push.size.yz + 3) / 4);
    return uint(blocks.x * blocks.y * blocks.z);
}
Block blockOf(uint index) {
    int i = int(index);
    ivec2 blocks = ivec2(texels().x, (push.size.y + 3) / 4);
    ivec3 at = ivec3(i % blocks.x, i / blocks.x % blocks.y, i / (blocks.x * blocks.y));
    float cell = push.cell / push.radius;
    vec3 lo = (push.origin - push.first) / push.radius + cell * vec3(4 * at);
    return Block(at * ivec3(1, 4, 4), cell, lo, lo + 3.0 * cell);
}

// Rows of buckets within reach of a block: the first one, and how many.
struct Rows {
    ivec2 first, count;
};
Rows rowsAround(Block block) {
    ivec2 first = max(ivec2(floor(block.lo.yz - kReach)), ivec2(0));
    return Rows(first, min(ivec2(floor(block.hi.yz + kReach)), push.buckets.yz - 1) - first + 1);
}
// The particles within reach in a row, in the order of buckets: the first, and the first behind them.
uvec2 particlesOf(Block block, Rows rows, int row) {
    int z = int((float(row) + 0.5) / float(rows.count.x));  // a division of whole numbers takes far longer on software devices
    ivec2 b = rows.first + ivec2(row - z * rows.count.x, z);
    vec2 away = max(max(vec2(b) - block.hi.yz, block.lo.yz - vec2(b + 1)), 0.0);
    float left = kReach * kReach - dot(away, away), far = sqrt(max(left, 0.0));
    int from = max(int(floor(block.lo.x - far)), 0), to = min(int(floor(block.hi.x + far)), push.buckets.x - 1);
    int line = bucketAt(ivec3(0, b));
    return left > 0.0 ? uvec2(starts[line + from], starts[line + to + 1]) : uvec2(0);
}
