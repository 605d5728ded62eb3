// What all mesher kernels share: the push constants, the counts, and how grid points are numbered.
#include "shared.h"
#include "mesher/mesher.h"
#include "lib/groups.glsl"

layout(push_constant, scalar) uniform Push { MesherPush push; };
layout(binding = MESHER_AT_COUNTS, scalar) buffer Counts { MesherCounts counts; };

/// Work groups of a dispatch over many items are spread evenly over two axes: a group too many runs, if to no effect.
const uint kMostGroups = MOST_GROUPS;  // along one axis
DispatchArguments groupsFor(uint items, uint perGroup) {
    uint groups = (items + perGroup - 1) / perGroup;
    uint y = max((groups + kMostGroups - 1) / kMostGroups, 1);
    return DispatchArguments((groups + y - 1) / y, y, 1);
}

uint blockCount() { return push.blocks.x * push.blocks.y * push.blocks.z; }
/// Blocks, bricks and samples are numbered from the region's corner, whichever tile of it is meshed.
uvec3 blockAt(uint block) {
    uint area = push.blocks.x * push.blocks.y;
    return push.begin / 8 + uvec3(block % push.blocks.x, block / push.blocks.x % push.blocks.y, block / area);
}

/// Sample i along an axis stands at origin + (i - 1) cells: samples 0 and cells + 2 are the outside layer around the
/// region, which closes every surface. All kernels must compute a position in this one way, to the same bits.
float samplePosition(int axis, uint i) { return push.origin[axis] + float(int(i) - 1) * push.cellSize[axis]; }
vec3 samplePosition(uvec3 i) { return push.origin + vec3(ivec3(i) - 1) * push.cellSize; }

/// Places of which the field keeps lists: 0 is all of space; then come the boxes of 64^3 cells, of 32^3 and of 16^3, and
/// at last the slots of bricks. `first` is a cell of the box.
uint placeOfBox(uint size, uvec3 first) {
    uvec3 at = (first - push.begin * 8) / size, boxes = push.blocks * (64 / size);
    uint before = blockCount() * (size == 64 ? 0 : size == 32 ? 1 : 1 + 8);
    return push.listStart != 0 ? 1 + before + (at.z * boxes.y + at.y) * boxes.x + at.x : 0;
}
uint placeOfBrick(uint slot) { return push.listStart != 0 ? 1 + blockCount() * MESHER_PLACES + slot : 0; }

/// Whether a brick, along each axis, is beyond the tile: what it has there is the next tile's, but for edges on the face.
bvec3 beyondTile(uvec3 brick) { return greaterThanEqual(brick, push.end); }

uint packBrick(uvec3 brick) { return brick.x | brick.y << 10 | brick.z << 20; }
uvec3 unpackBrick(uint word) { return uvec3(word & 1023, word >> 10 & 1023, word >> 20); }
