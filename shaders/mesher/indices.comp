// Writes the triangles of a strip of cells a lane. All that the cells of the strip need of the edge -> vertex lookup is
// loaded once, twelve words; an edge's vertex is then arithmetic. The table lists the polygons of a cell's pattern, which
// become fans: each vertex is looked up once, however many triangles share it.
#include "mesher/mesher.glsl"
#include "mesher/strips.glsl"
#include "mesher/edges.glsl"

layout(local_size_x = MESHER_GROUP_STRIPS) in;
layout(binding = 6, scalar) readonly buffer Links { uvec4 links[]; };
layout(binding = 11, scalar) readonly buffer Table { uvec2 table[]; };  // marching_cubes_table.h
layout(binding = 12, scalar) readonly buffer StripList { uvec2 stripList[]; };
layout(binding = 13, scalar) writeonly buffer Triangles { uvec3 triangles[]; };

// Active edges and first vertex, by edge: along x (y, z), along y (x, z), along z (x, y), the offset in the first
// coordinate being lowest. Within the strip, or in the next one along that offset.
uvec2 lookup[12];

/// Vertex on edge `e` of the cell at bit column x (0..3), y of the strip.
uint vertexOn(uint e, uint x, uint y) {
    x += 0xAA0u >> e & 1;  // offsets of edge e along each axis, as bits by edge
    y += 0xC0Au >> e & 1;
    uint dz = 0x0CCu >> e & 1;
    uint beyondX = x >> 2, beyondY = y >> 3;
    uint word = e < 4 ? beyondY + 2 * dz : e < 8 ? 4 + beyondX + 2 * dz : 8 + beyondX + 2 * beyondY;
    uvec2 entry = lookup[word];
    uint bit = (x & 3) * 8 + (y & 7);
    return entry.y + bitCount(entry.x & ((1u << bit) - 1));
}

void main() {
    uint start = counts.stripStart[push.chunk], end = counts.stripStart[push.chunk + 1];
    uint index = start + linearGroup() * MESHER_GROUP_STRIPS + gl_LocalInvocationIndex;
    bool valid = index < end;
    uvec2 item = stripList[valid ? index : start];
    uint upper = item.x & 1, z = item.x >> 1 & 7, slot = item.x >> 4;

    PlaneSigns planeLow = planeSigns(planes[slot * 9 + z]), planeHigh = planeSigns(planes[slot * 9 + z + 1]);
    uvec2 crossed = activeCells(planeLow, planeHigh);
    uint cells = upper == 0 ? crossed.x : crossed.y;
    uint c0 = upper == 0 ? planeLow.at.x : planeLow.at.y, c1 = upper == 0 ? planeLow.x.x : planeLow.x.y;
    uint c2 = upper == 0 ? planeLow.y.x : planeLow.y.y, c3 = upper == 0 ? planeLow.xy.x : planeLow.xy.y;
    uint c4 = upper == 0 ? planeHigh.at.x : planeHigh.at.y, c5 = upper == 0 ? planeHigh.x.x : planeHigh.x.y;
    uint c6 = upper == 0 ? planeHigh.y.x : planeHigh.y.y, c7 = upper == 0 ? planeHigh.xy.x : planeHigh.xy.y;

    uvec4 next = links[slot * 2], diagonal = links[slot * 2 + 1];  // x, y, z; xy, xz, yz
    uint here = slot * 8 + z;
    uint above = z == 7 ? next.z * 8 : here + 1;
    uint yHere = next.y * 8 + z, yAbove = z == 7 ? diagonal.z * 8 : yHere + 1;
    uint xHere = upper == 0 ? here : next.x * 8 + z;
    uint xAbove = upper == 0 ? above : z == 7 ? diagonal.y * 8 : xHere + 1;
    uint xyHere = upper == 0 ? yHere : diagonal.x * 8 + z;
    uvec4 e;
    e = edgesX[here], lookup[0] = upper == 0 ? e.xy : e.zw;
    e = edgesX[yHere], lookup[1] = upper == 0 ? e.xy : e.zw;
    e = edgesX[above], lookup[2] = upper == 0 ? e.xy : e.zw;
    e = edgesX[yAbove], lookup[3] = upper == 0 ? e.xy : e.zw;
    e = edgesY[here], lookup[4] = upper == 0 ? e.xy : e.zw;
    e = edgesY[xHere], lookup[5] = upper == 0 ? e.zw : e.xy;
    e = edgesY[above], lookup[6] = upper == 0 ? e.xy : e.zw;
    e = edgesY[xAbove], lookup[7] = upper == 0 ? e.zw : e.xy;
    e = edgesZ[here], lookup[8] = upper == 0 ? e.xy : e.zw;
    e = edgesZ[xHere], lookup[9] = upper == 0 ? e.zw : e.xy;
    e = edgesZ[yHere], lookup[10] = upper == 0 ? e.xy : e.zw;
    e = edgesZ[xyHere], lookup[11] = upper == 0 ? e.zw : e.xy;

    uint place = item.y - push.chunk * MESHER_TRIANGLE_CHUNK;
    do {
        uint bit = findLSB(cells);
        cells &= cells - 1;
        uint pattern = (c0 >> bit & 1) | (c1 >> bit & 1) << 1 | (c2 >> bit & 1) << 2 | (c3 >> bit & 1) << 3 |
                       (c4 >> bit & 1) << 4 | (c5 >> bit & 1) << 5 | (c6 >> bit & 1) << 6 | (c7 >> bit & 1) << 7;
        uvec2 code = table[pattern];
        uint edges = code.x >> 30 | (code.y >> 30) << 2;
        code &= 0x3fffffffu;
        uint x = bit >> 3, y = bit & 7;
        uint first = vertexOn(code.x & 15, x, y);
        uint before = vertexOn(code.x >> 5 & 15, x, y);
        code = uvec2(code.x >> 10 | (code.y & 1023) << 20, code.y >> 10);
        bool open = true;  // two vertices of the current fan are known
        uint i = 2;
        do {
            uint vertex = vertexOn(code.x & 15, x, y);
            bool starts = (code.x & 16) != 0;
            if (!starts && open && valid) triangles[place] = uvec3(first, before, vertex);
            place += !starts && open ? 1 : 0;
            first = starts ? vertex : first;
            open = !starts;
            before = vertex;
            code = uvec2(code.x >> 5 | (code.y & 31) << 25, code.y >> 5);
        } while (++i < edges);
    } while (cells != 0);
}
