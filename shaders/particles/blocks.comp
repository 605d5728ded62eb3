// Lists the blocks that have particles around, but not everywhere; writes the samples of the others.
#include "particles/surface.glsl"

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 2, scalar) writeonly buffer Distance { vec4 distances[]; };  // cells; rows padded to texels
layout(binding = 4, scalar) buffer Blocks { uvec3 groups; uint count, blocks[]; };  // how many, and which

// Whether it is far from the surface.
bool deep(Block block) {
    const vec3 around = vec3(2.5, 1.5, 1.5);
    ivec3 first = max(ivec3(floor(block.lo - around)), ivec3(0));
    return full(first, min(ivec3(floor(block.hi + around)), push.buckets - 1) - first + 1);
}

bool alone(Block block) {
    Rows rows = rowsAround(block);
    int row = 0;
    bool none = true;
    do {
        uvec2 range = particlesOf(block, rows, row);
        none = range.x >= range.y;
    } while (none && ++row < rows.count.x * rows.count.y);
    return none;
}

void main() {
    uint index = item();
    if (index >= blockCount()) return;
    Block block = blockOf(index);
    bool empty = alone(block);
    if (!empty && !deep(block)) {
        uint place = atomicAdd(count, 1);
        blocks[place] = index;
        atomicMax(groups.x, min(place + 1, MOST_GROUPS));
        atomicMax(groups.y, place / MOST_GROUPS + 1);
        return;
    }
    float value = ((empty ? push.none : 0.0) - push.drop) / block.cell;
    ivec3 size = texels(), end = min(block.first + ivec3(1, 4, 4), size);
    for (int z = block.first.z; z < end.z; ++z)
        for (int y = block.first.y; y < end.y; ++y) distances[(z * size.y + y) * size.x + block.first.x] = vec4(value);
}
