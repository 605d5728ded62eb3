// What all mesher kernels share: the push constants, the counts, and how grid points are numbered.
#include "shared.h"

layout(push_constant, scalar) uniform Push { MesherPush push; };
layout(binding = 0, scalar) buffer Counts { MesherCounts counts; };

/// Work groups of an indirect dispatch over many items are spread over two axes.
const uint kGroupsAlongX = 32768;
uint linearGroup() { return gl_WorkGroupID.y * kGroupsAlongX + gl_WorkGroupID.x; }
DispatchArguments groupsFor(uint items, uint perGroup) {
    uint groups = (items + perGroup - 1) / perGroup;
    return DispatchArguments(min(groups, kGroupsAlongX), (groups + kGroupsAlongX - 1) / kGroupsAlongX, 1);
}

uint blockCount() { return push.blocks.x * push.blocks.y * push.blocks.z; }
uvec3 blockAt(uint block) {
    uint area = push.blocks.x * push.blocks.y;
    return uvec3(block % push.blocks.x, block / push.blocks.x % push.blocks.y, block / area);
}

/// Sample i along an axis stands at origin + (i - 1) cells: samples 0 and cells + 2 are the outside layer around the
/// region, which closes every surface. All kernels must compute a position in this one way, to the same bits.
float samplePosition(int axis, uint i) { return push.origin[axis] + float(int(i) - 1) * push.cellSize; }
vec3 samplePosition(uvec3 i) { return push.origin + vec3(ivec3(i) - 1) * push.cellSize; }

uint packBrick(uvec3 brick) { return brick.x | brick.y << 10 | brick.z << 20; }
uvec3 unpackBrick(uint word) { return uvec3(word & 1023, word >> 10 & 1023, word >> 20); }
