// Lists the surviving bricks of a block, in order, and completes the rows.
#include "mesher/mesher.glsl"
#include "mesher/rows.glsl"

layout(local_size_x = 64) in;
layout(binding = MESHER_AT_BLOCK_LIST, scalar) readonly buffer BlockList { uint blockList[]; };
layout(binding = MESHER_AT_SUMS, scalar) readonly buffer BlockCounts { uvec4 blockCounts[]; };
layout(binding = MESHER_AT_BRICK_LIST, scalar) writeonly buffer BrickList { uint brickList[]; };

void main() {
    uint group = linearGroup();
    bool listed = push.blocksListed != 0;
    bool valid = group < (listed ? counts.blocks : blockCount());
    uint block = listed ? blockList[valid ? group : 0] : valid ? group : 0;
    uvec3 brick = blockAt(block) * 8 + uvec3(0, gl_LocalInvocationIndex & 7, gl_LocalInvocationIndex >> 3);
    uint index = block * 64 + gl_LocalInvocationIndex;
    uvec2 row = rows[index];
    uint slot = row.y + blockCounts[valid ? group : 0].x;
    if (valid) rows[index].y = slot;
    uint bits = valid ? row.x : 0;
    do {
        if (bits != 0) brickList[slot++] = packBrick(brick + uvec3(findLSB(bits), 0, 0));
        bits &= bits - 1;
    } while (bits != 0);
}
