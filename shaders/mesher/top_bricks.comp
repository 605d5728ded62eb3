// Sums the survivors of all blocks and sets up the kernels over bricks, or stops them if there is not enough room.
#include "mesher/mesher.glsl"
#define TOP_SUMS MESHER_AT_SUMS
#include "lib/top.glsl"

void main() {
    uint blocks = push.blocksListed != 0 ? counts.blocks : blockCount();
    uint bricks = sumUp(blocks).x;
    bool fits = bricks <= push.brickCapacity;
    uint lane = gl_LocalInvocationIndex;
    if (lane == 0) counts.bricks = bricks;
    // Three lanes write the arguments of three kernels.
    uint items = lane == 0 ? blocks : bricks;
    uint perGroup = lane == 0 ? 1 : lane == 1 ? MESHER_GROUP_LINKS : MESHER_GROUP_BRICKS;
    if (lane < 3) counts.groups[MESHER_COMPACT + lane] = groupsFor(fits ? items : 0, perGroup);
}
