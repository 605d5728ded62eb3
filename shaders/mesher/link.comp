// Finds each brick's neighbours: the slots that the triangles of its upper faces need (X, Y, Z, XY, XZ, YZ), its own
// where there is no brick, and which of the six faces have a neighbour.
#include "mesher/mesher.glsl"
#include "mesher/rows.glsl"

layout(local_size_x = 64) in;
layout(binding = 5, scalar) readonly buffer BrickList { uint brickList[]; };
layout(binding = 6, scalar) writeonly buffer Links { uvec4 links[]; };  // two a brick

void main() {
    uint slot = linearGroup() * 64 + gl_LocalInvocationIndex;
    bool valid = slot < counts.bricks;
    uvec3 brick = unpackBrick(brickList[valid ? slot : 0]);
    const uint kNone = ~0u;
    uint x = slotOf(brick + uvec3(1, 0, 0), kNone), y = slotOf(brick + uvec3(0, 1, 0), kNone);
    uint z = slotOf(brick + uvec3(0, 0, 1), kNone), xy = slotOf(brick + uvec3(1, 1, 0), slot);
    uint xz = slotOf(brick + uvec3(1, 0, 1), slot), yz = slotOf(brick + uvec3(0, 1, 1), slot);
    // Subtracting from 0 wraps to a huge number, which is not of the grid.
    uint faces = (x != kNone ? 1 : 0) | (y != kNone ? 2 : 0) | (z != kNone ? 4 : 0) |
                 (slotOf(brick - uvec3(1, 0, 0), kNone) != kNone ? 8 : 0) |
                 (slotOf(brick - uvec3(0, 1, 0), kNone) != kNone ? 16 : 0) |
                 (slotOf(brick - uvec3(0, 0, 1), kNone) != kNone ? 32 : 0);
    if (valid) {
        links[slot * 2] = uvec4(x == kNone ? slot : x, y == kNone ? slot : y, z == kNone ? slot : z, faces);
        links[slot * 2 + 1] = uvec4(xy, xz, yz, 0);
    }
}
