// Finds each brick's neighbours, in one loop over nine of them: the look-up is then compiled once.
#include "mesher/mesher.glsl"
#include "mesher/rows.glsl"
#include "mesher/links.glsl"

layout(local_size_x = MESHER_GROUP_LINKS) in;
layout(binding = MESHER_AT_BRICK_LIST, scalar) readonly buffer BrickList { uint brickList[]; };

void main() {
    uint slot = linearGroup() * MESHER_GROUP_LINKS + gl_LocalInvocationIndex;
    bool valid = slot < counts.bricks;
    uvec3 brick = unpackBrick(brickList[valid ? slot : 0]);
    const uint kNone = ~0u;
    uint faces = 0;
    uint i = 0;
    [[dont_unroll]] do {
        // 0 to 6: along the axes of its bits. 7 to 9: back along x, y, z; 0 - 1 wraps to what is not of the grid.
        uvec3 forward = uvec3(i & 1, i >> 1 & 1, i >> 2);
        uvec3 back = uvec3(equal(uvec3(i), uvec3(7, 8, 9)));
        uint found = slotOf(i < 7 ? brick + forward : brick - back, kNone);
        uint bit = i == 1 || i == 2 ? i : i == 4 ? 4 : i >= 7 ? 8u << (i - 7) : 0;
        faces |= found != kNone ? bit : 0;
        if (valid) links[slot * 8 + min(i, 7)] = i >= 7 ? faces : found == kNone ? slot : found;
    } while (++i < 10);
}
