// Sums the survivors of all blocks and sets up the kernels over bricks, or stops them if there is not enough room.
#include "mesher/mesher.glsl"
#include "mesher/top.glsl"

layout(constant_id = 0) const bool kListed = true;  // blocks were culled and listed; else all are meant

void main() {
    uint blocks = kListed ? counts.blocks : push.blocks.x * push.blocks.y * push.blocks.z;
    uvec4 total = sumUp(blocks);
    if (gl_LocalInvocationIndex == 0) {
        uint bricks = total.x;
        bool fits = bricks <= push.brickCapacity;
        counts.bricks = bricks;
        counts.compactGroups = groupsFor(fits ? blocks : 0, 1);
        counts.linkGroups = groupsFor(fits ? bricks : 0, 64);
        counts.brickGroups = groupsFor(fits ? bricks : 0, MESHER_GROUP_BRICKS);
    }
}
