// Lists the samples of the band, and begins all others with nothing known.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "bake/bake.glsl"

layout(local_size_x = BAKE_GROUP) in;
layout(binding = 3, scalar) readonly buffer NearestWords { uint nearestWords[]; };
layout(binding = 4, rgba32ui) restrict writeonly uniform uimageBuffer state;
layout(binding = 5, scalar) writeonly buffer Band { uint band[]; };
layout(binding = 6, scalar) buffer Counts { BakeCounts counts; };

void main() {
    uint index = item();
    bool mine = index < sampleCount(), listed = mine && nearestWords[2 * index + 1] != ~0u;
    if (mine) imageStore(state, int(index), uvec4(floatBitsToUint(BAKE_UNREACHED), 0, 0, 0));
    uvec4 ballot = subgroupBallot(listed);
    uint count = subgroupBallotBitCount(ballot), first = 0;
    if (subgroupElect()) first = atomicAdd(counts.listed, count);
    first = subgroupBroadcastFirst(first);
    if (listed) band[first + subgroupBallotExclusiveBitCount(ballot)] = index;
    // Whoever adds the last ones also knows of how many groups they are.
    if (subgroupElect()) atomicMax(counts.groups[0], (first + count + BAKE_GROUP - 1) / BAKE_GROUP);
}
