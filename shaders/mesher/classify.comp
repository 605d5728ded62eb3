// From signs to what will be written: the edge -> vertex lookup, the strips with active cells, and how many active edges
// and triangles (of dual contouring: patches) each group of eight bricks has. A lane takes one plane of cells; places are counted from the first of the
// group, the level above (top_groups.comp) sums up the groups. Also finds surface that was closed at the region's
// boundary, and surface that runs into a brick that was culled.
//
// The strips of a group are listed by their number of active cells, in four classes: the lanes of a subgroup run
// as long as the longest among them when they write the triangles.
#define HISTOPYRAMID_LANES (8 * MESHER_GROUP_BRICKS)
#define HISTOPYRAMID_TYPE uvec2
#include "mesher/mesher.glsl"
#include "mesher/strips.glsl"
#include "mesher/edges.glsl"
#include "mesher/links.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(constant_id = 0) const bool kDual = false;
layout(binding = MESHER_AT_BRICK_LIST, scalar) readonly buffer BrickList { uint brickList[]; };
layout(binding = MESHER_AT_STRIP_LIST, scalar) writeonly buffer StripList { uint stripList[]; };  // strip of the group, its first triangle or patch << 7, beyond the tile << 31

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

/// Those of a strip's active edges that are the tile's: in bricks beyond it the ones that lie in its far faces.
uvec3 edgesOfTile(uvec3 crossed, bvec3 beyond, uint z, uint side) {
    uint inFaces = (!beyond.x ? ~0u : side == 0 ? 255 : 0) & (beyond.y ? kRow : ~0u) & (beyond.z && z != 0 ? 0 : ~0u);
    return crossed & mix(uvec3(inFaces), uvec3(0), beyond);
}

/// Faces of a brick that must have a brick beyond them if surface crosses them. Those between tiles are looked at by the
/// tile that is before them, once in each of the two bricks.
uint checkedFaces(uvec3 brick, bvec3 beyond) {
    uvec3 low = mix(uvec3(0), uvec3(8, 16, 32), any(beyond) ? beyond : equal(brick, push.first));
    uint faces = low.x | low.y | low.z;
    return any(beyond) ? faces : 63 - faces;
}

/// Where the strips of a class are counted: a byte for each class, that of most cells lowest.
uint classShift(uint cells) { return cells > 16 ? 0 : cells > 8 ? 8 : cells > 4 ? 16 : 24; }

/// What is kept of a strip while the group sums up.
struct Strip {
    uvec3 crossed;
    uint cells, parts;  // parts: triangles or patches
};

void main() {
    uint group = linearGroup();
    uint slot = group * MESHER_GROUP_BRICKS + (gl_LocalInvocationIndex >> 3);
    uint z = gl_LocalInvocationIndex & 7;
    bool valid = slot < counts.bricks;
    slot = valid ? slot : 0;
    uvec3 a = planes[slot * 9 + z], b = planes[slot * 9 + z + 1];
    a = valid ? a : uvec3(0);
    b = valid ? b : uvec3(0);
    uvec3 brick = unpackBrick(brickList[slot]), first = brick * 8;
    bvec3 beyond = beyondTile(brick);
    uint leaky = checkedFaces(brick, beyond) & ~links[slot * 8 + 7];
    Strip strips[2];
    uvec2 own = uvec2(0);  // active edges and parts << 16; strips by class
    bool cap = false, leak = false;
    uint side = 0;
    [[dont_unroll]] do {  // a loop, so that it is translated once
        StripSigns low = stripSigns(a, side), high = stripSigns(b, side);
        Strip strip = Strip(activeEdges(low, high), bitCount(activeCells(low, high)),
                            kDual ? loopCount(low, high) : triangleCount(low, high));
        cap = cap || hasCap(first + uvec3(side * 4, 0, 0), z, strip.crossed);
        leak = leak || (crossedFaces(z, side, a, b, strip.crossed, high) & leaky) != 0;
        strip.crossed = edgesOfTile(strip.crossed, beyond, z, side);
        strip.parts = any(beyond) ? 0 : strip.parts;
        strip.cells = any(beyond) ? (strip.crossed != uvec3(0) ? 1 : 0) : strip.cells;
        ivec3 n = bitCount(strip.crossed);
        own.x += n.x + n.y + n.z + (strip.parts << 16);
        own.y += strip.cells != 0 ? 1u << classShift(strip.cells) : 0;
        strips[0].crossed = side == 0 ? strip.crossed : strips[0].crossed;
        strips[0].cells = side == 0 ? strip.cells : strips[0].cells;
        strips[0].parts = side == 0 ? strip.parts : strips[0].parts;
        strips[1] = strip;
    } while (++side < 2);
    uvec2 total;
    uvec2 before = sumBefore(own, total);
    uint ofLarger = total.y << 8;  // in each byte the count of the classes before; 128 strips at most in all
    ofLarger += ofLarger << 8;
    ofLarger += ofLarger << 16;
    uint vertex = before.x & 0xffff, part = before.x >> 16;
    [[unroll]] for (int i = 0; i < 2; ++i) {
        Strip strip = strips[i];
        ivec3 n = bitCount(strip.crossed);
        if (valid) edges[slot * 16 + z * 2 + i] = uvec4(strip.crossed, vertex);
        uint shift = classShift(strip.cells);
        uint place = (ofLarger >> shift & 255) + (before.y >> shift & 255);
        uint word = gl_LocalInvocationIndex << 1 | i | part << 7 | (any(beyond) ? 1u << 31 : 0);
        if (strip.cells != 0) stripList[group * MESHER_GROUP_STRIPS + place] = word;
        before.y += strip.cells != 0 ? 1u << shift : 0;
        vertex += n.x + n.y + n.z;
        part += strip.parts;
    }
    if (gl_LocalInvocationIndex == 0) {
        uint strips = (ofLarger >> 24) + (total.y >> 24);
        if (strips == 0) stripList[group * MESHER_GROUP_STRIPS] = 0;  // read all the same, by lanes without a strip
        sums[group] = uvec4(total.x & 0xffff, total.x >> 16, 0, strips);
    }
    if (cap) counts.caps = 1;
    if (leak) counts.leaks = 1;
}
