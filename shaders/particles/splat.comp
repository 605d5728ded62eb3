// Adds each particle to the grid, in whole numbers, so that the order does not matter. With PROXIES to its own cell: its
// place in there and a count of one; else its weight to the eight samples around it.
#include "particles/density.glsl"

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer particles;
layout(binding = 1, scalar) buffer Grid { uint grid[]; };  // with PROXIES four words a cell, else one a sample

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 at = (uintBitsToFloat(imageLoad(particles, int(index)).xyz) - push.origin) / push.cell;
#ifdef PROXIES
    at += 0.5;  // a cell is what is nearer to its sample than to another
    bool within = all(greaterThanEqual(at, vec3(0.0))) && all(lessThan(at, vec3(push.size)));
    ivec3 cell = ivec3(within ? at : vec3(0.0));
    uvec4 added = uvec4((at - vec3(cell)) * push.unit, 1);
    if (within)
        for (int k = 0; k < 4; ++k) atomicAdd(grid[4 * indexOf(cell) + k], added[k]);
#else
    bool within = all(greaterThan(at, vec3(-1.0))) && all(lessThan(at, vec3(push.size)));
    vec3 low = floor(within ? at : vec3(-2.0)), t = at - low;
    // Atomics wait for memory one by one, loads do so together: these have it fetched. They decide nothing, since no sum has all
    // its bits set, as push.unit is.
    uint fetched = 0;
    for (int row = 0; row < 4; ++row)
        fetched = max(fetched, grid[indexOf(clamp(ivec3(low) + ivec3(0, row & 1, row >> 1), ivec3(0), push.size - 1))]);
    within = within && fetched != 0xffffffffu;
    for (int k = 0; k < 8; ++k) {
        ivec3 corner = ivec3(k & 1, k >> 1 & 1, k >> 2), cell = ivec3(low) + corner;
        vec3 weights = mix(1.0 - t, t, vec3(corner));
        bool stored = within && all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, push.size));
        if (stored) atomicAdd(grid[indexOf(cell)], uint(weights.x * weights.y * weights.z * push.unit + 0.5));
    }
#endif
}
