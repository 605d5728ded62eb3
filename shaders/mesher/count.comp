// Counts what each group of eight bricks will emit: vertices, triangles, strips. A lane takes one plane of cells. Also finds
// surface that was closed at the region's boundary, and surface that runs into a brick that was culled.
#define HISTOPYRAMID_LANES (8 * MESHER_GROUP_BRICKS)
#define HISTOPYRAMID_TYPE uvec2
#include "mesher/mesher.glsl"
#include "mesher/strips.glsl"
#include "mesher/links.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = 4, scalar) writeonly buffer Sums { uvec4 sums[]; };
layout(binding = 5, scalar) readonly buffer BrickList { uint brickList[]; };

const uint kRow = 0x01010101u;  // y = 0 of every column

/// Whether an edge that starts or ends in the outside layer is active: there the surface was closed.
bool hasCap(uvec3 first, uint z, uvec3 edges) {
    uvec3 last = push.cells + 1 - first;  // local index of the last sample of the region, huge if it lies before
    uint x = (first.x == 0 ? 255 : 0) | (last.x < 4 ? 255u << last.x * 8 : 0);
    uint y = (first.y == 0 ? kRow : 0) | (last.y < 8 ? kRow << last.y : 0);
    bool rim = first.z + z == 0 || z == last.z;
    return ((edges.x & x) | (edges.y & y) | (rim ? edges.z : 0)) != 0;
}

/// Faces of the brick (bits as in the links) on which an edge of the strip is active.
uint crossedFaces(uint z, uint side, uvec3 a, uvec3 b, uvec3 edges, StripSigns top) {
    uint column = a.z & 511, topColumn = b.z & 511, row = a.z >> (9 + 4 * side), topRow = b.z >> (9 + 4 * side);
    uint columnEdges = side == 1 ? (column ^ column >> 1) & 255 : 0;
    uint topEdges = (top.at ^ top.x) | (top.at ^ top.y) | ((topRow ^ topRow >> 1) & 15) |
                    (side == 1 ? (topColumn ^ topColumn >> 1) & 255 : 0);
    uint rowEdges = (row ^ row >> 1) & 15;
    uint columnUp = side == 1 ? column ^ topColumn : 0, rowUp = (row ^ topRow) & 15;
    uvec3 above = uvec3(columnEdges | columnUp, rowEdges | rowUp, z == 7 ? topEdges : 0);
    uvec3 below = uvec3(side == 0 ? ((edges.y | edges.z) & 255) | (rowUp & 1) : 0,
                        ((edges.x | edges.z) & kRow) | (columnUp & 1),
                        z == 0 ? edges.x | edges.y | columnEdges | rowEdges : 0);
    uvec3 bits = mix(uvec3(0), uvec3(1, 2, 4), notEqual(above, uvec3(0))) |
                 mix(uvec3(0), uvec3(8, 16, 32), notEqual(below, uvec3(0)));
    return bits.x | bits.y | bits.z;
}

void main() {
    uint slot = linearGroup() * MESHER_GROUP_BRICKS + (gl_LocalInvocationIndex >> 3);
    uint z = gl_LocalInvocationIndex & 7;
    bool valid = slot < counts.bricks;
    slot = valid ? slot : 0;
    uvec3 a = planes[slot * 9 + z], b = planes[slot * 9 + z + 1];
    uvec3 first = unpackBrick(brickList[slot]) * 8;
    uint faces = links[slot * 8 + 7];
    uvec2 own = uvec2(0);  // vertices and triangles << 16; strips, lanes with caps << 8, lanes with leaks << 16
    bool cap = false, leak = false;
    uint side = 0;
    [[dont_unroll]] do {
        StripSigns low = stripSigns(a, side), high = stripSigns(b, side);
        uvec3 edges = activeEdges(low, high);
        ivec3 n = bitCount(edges);
        own += uvec2(n.x + n.y + n.z + (triangleCount(low, high) << 16), activeCells(low, high) != 0 ? 1 : 0);
        cap = cap || hasCap(first + uvec3(side * 4, 0, 0), z, edges);
        leak = leak || (crossedFaces(z, side, a, b, edges, high) & ~faces) != 0;
    } while (++side < 2);
    own.y |= (cap ? 0x100 : 0) | (leak ? 0x10000 : 0);
    uvec2 total;
    sumBefore(valid ? own : uvec2(0), total);
    if (gl_LocalInvocationIndex == 0) {
        sums[linearGroup()] = uvec4(total.x & 0xffff, total.x >> 16, total.y & 255, 0);
        if ((total.y & 0xff00) != 0) counts.caps = 1;
        if (total.y >= 0x10000) counts.leaks = 1;
    }
}
