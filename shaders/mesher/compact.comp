// Lists the surviving bricks of a block, in order, and completes the rows.
#include "mesher/mesher.glsl"
#include "mesher/rows.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool kListed = true;
layout(binding = 1, scalar) readonly buffer BlockList { uint blockList[]; };
layout(binding = 4, scalar) readonly buffer BlockCounts { uvec4 blockCounts[]; };
layout(binding = 5, scalar) writeonly buffer BrickList { uint brickList[]; };

void main() {
    uint group = linearGroup();
    bool valid = group < (kListed ? counts.blocks : push.blocks.x * push.blocks.y * push.blocks.z);
    uint block = !valid ? 0 : kListed ? blockList[group] : group;
    uvec3 at = uvec3(block % push.blocks.x, block / push.blocks.x % push.blocks.y, block / (push.blocks.x * push.blocks.y));
    uvec3 brick = at * 8 + uvec3(0, gl_LocalInvocationIndex & 7, gl_LocalInvocationIndex >> 3);
    uint index = block * 64 + gl_LocalInvocationIndex;
    uvec2 row = rows[index];
    uint slot = row.y + blockCounts[group].x;
    if (valid) rows[index].y = slot;
    uint bits = valid ? row.x : 0;
    do {
        if (bits != 0) brickList[slot++] = packBrick(brick + uvec3(findLSB(bits), 0, 0));
        bits &= bits - 1;
    } while (bits != 0);
}
