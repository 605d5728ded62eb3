// Counts what each group of eight bricks will emit: vertices, triangles, strips. A lane takes one plane of cells. Also finds
// surface that was closed at the region's boundary, and surface that runs into a brick that was culled.
#define HISTOPYRAMID_LANES (8 * MESHER_GROUP_BRICKS)
#include "mesher/mesher.glsl"
#include "mesher/strips.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = 4, scalar) writeonly buffer Sums { uvec4 sums[]; };
layout(binding = 5, scalar) readonly buffer BrickList { uint brickList[]; };
layout(binding = 6, scalar) readonly buffer Links { uvec4 links[]; };

bool any2(uvec2 bits) { return (bits.x | bits.y) != 0; }

/// Whether an edge that starts or ends in the outside layer is active: there the surface was closed.
bool hasCap(uvec3 first, uint z, ActiveEdges edges) {
    const uint kRow = 0x01010101u;  // y = 0 of every column
    uvec3 last = push.cells + 1 - first;  // local index of the last sample of the region, huge if it lies before
    uvec2 x = uvec2(first.x == 0 ? 255 : 0, 0), y = uvec2(first.y == 0 ? kRow : 0);
    x |= uvec2(last.x < 4 ? 255u << last.x * 8 : 0, last.x >= 4 && last.x < 8 ? 255u << (last.x - 4) * 8 : 0);
    y |= uvec2(last.y < 8 ? kRow << last.y : 0);
    bool rim = first.z + z == 0 || z == last.z;
    return any2(edges.x & x) || any2(edges.y & y) || (rim && any2(edges.z));
}

/// Whether an edge on a face of the brick is active although no brick lies beyond that face.
bool hasLeak(uint faces, uint z, uvec3 a, uvec3 b, ActiveEdges edges, PlaneSigns top) {
    uint column = a.z & 511, row = a.z >> 9, rimZ = a.z ^ b.z;
    uint columnEdges = (column ^ column >> 1) & 255, rowEdges = (row ^ row >> 1) & 255;
    uint topColumn = b.z & 511, topRow = b.z >> 9;
    const uvec2 kRow = uvec2(0x01010101u);
    uint crossed = (columnEdges | (rimZ & 511)) != 0 ? 1 : 0;
    crossed |= (rowEdges | rimZ >> 9) != 0 ? 2 : 0;
    bool topEdges = any2((top.at ^ top.x) | (top.at ^ top.y)) || ((topColumn ^ topColumn >> 1) & 255) != 0 ||
                    ((topRow ^ topRow >> 1) & 255) != 0;
    crossed |= z == 7 && topEdges ? 4 : 0;
    crossed |= ((edges.y.x | edges.z.x) & 255) != 0 || (rimZ >> 9 & 1) != 0 ? 8 : 0;
    crossed |= any2((edges.x | edges.z) & kRow) || (rimZ & 1) != 0 ? 16 : 0;
    crossed |= z == 0 && (any2(edges.x | edges.y) || columnEdges != 0 || rowEdges != 0) ? 32 : 0;
    return (crossed & ~faces) != 0;
}

void main() {
    uint slot = linearGroup() * MESHER_GROUP_BRICKS + (gl_LocalInvocationIndex >> 3);
    uint z = gl_LocalInvocationIndex & 7;
    bool valid = slot < counts.bricks;
    slot = valid ? slot : 0;
    uvec3 a = planes[slot * 9 + z], b = planes[slot * 9 + z + 1];
    PlaneSigns low = planeSigns(a), high = planeSigns(b);
    ActiveEdges edges = activeEdges(low, high);
    uvec2 triangles = triangleCount(low, high);
    uvec2 cells = activeCells(low, high);
    uint vertices = bitCount(edges.x.x) + bitCount(edges.x.y) + bitCount(edges.y.x) + bitCount(edges.y.y) +
                    bitCount(edges.z.x) + bitCount(edges.z.y);
    uint strips = (cells.x != 0 ? 1 : 0) + (cells.y != 0 ? 1 : 0);
    uint flags = hasCap(unpackBrick(brickList[slot]) * 8, z, edges) ? 1 : 0;
    flags += hasLeak(links[slot * 2].w, z, a, b, edges, high) ? 0x10000 : 0;
    uvec4 total;
    sumBefore(valid ? uvec4(vertices, triangles.x + triangles.y, strips, flags) : uvec4(0), total);
    if (gl_LocalInvocationIndex == 0) {
        sums[linearGroup()] = uvec4(total.xyz, 0);
        if ((total.w & 0xffff) != 0) counts.caps = 1;
        if (total.w >= 0x10000) counts.leaks = 1;
    }
}
