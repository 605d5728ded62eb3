// Writes the triangles of a group of bricks, a strip of cells a lane, and the list of edges that get a vertex.
//
// All that the cells of the strip need of the edge -> vertex lookup is loaded once, from seven strips; an edge's vertex is
// then arithmetic. The table lists the polygons of a cell's pattern, which become fans: each vertex is looked up once,
// however many triangles share it.
#include "mesher/mesher.glsl"
#include "mesher/strips.glsl"
#include "mesher/links.glsl"
#include "mesher/list_edges.glsl"
// edges.glsl says what these hold. As texels they come in one load each, without a branch a lane on software devices.
layout(binding = MESHER_AT_EDGES, rgba32ui) readonly uniform uimageBuffer edges;
layout(binding = MESHER_AT_SUMS, scalar) buffer Sums { uvec4 sums[]; };

// A group has some eighty strips; small work groups leave few lanes without one.
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 32;
layout(binding = MESHER_AT_TABLE, scalar) uniform Table { uvec3 table[256]; };                 // marching_cubes_table.h
layout(binding = MESHER_AT_STRIP_LIST, scalar) readonly buffer StripList { uint stripList[]; };
layout(binding = MESHER_AT_MESH, scalar) writeonly buffer Triangles { uvec3 triangles[]; };

// Active edges and first vertex, by axis * 8 + where the strip is: x | y << 1 | z << 2, one further along these axes.
uvec2 lookup[24];

/// Vertex on the edge that a code of the table tells, of the cell at `cell` = x << 5 | y (x from 0 to 3).
uint vertexOn(uint code, uint cell) {
    uint at = cell + (code & 33);  // the edge starts at an offset along x and y
    // Past the last column or row the edge belongs to the strip there.
    uvec2 entry = lookup[(code & 28) + (at >> 7) + (at >> 2 & 2)];
    uint bit = (at >> 2 & 24) | (at & 7);
    return entry.y + bitCount(entry.x & ((1u << bit) - 1));
}

void main() {
    uint group = counts.groupStart[push.chunk] + linearGroup();
    bool groupValid = group < counts.groupStart[push.chunk + 1];
    group = groupValid ? group : 0;
    uvec4 base = sums[group];
    uint item = gl_LocalInvocationIndex;
    [[dont_unroll]] do {
        bool valid = groupValid && item < base.w;
        uint word = stripList[group * MESHER_GROUP_STRIPS + (item < base.w ? item : 0)];
        word = base.w > 0 ? word : 0;  // a group without surface has no list: the group's first strip, of which nothing is kept
        uint own = group * MESHER_GROUP_STRIPS + (word & 127);
        uint side = own & 1, z = own >> 1 & 7, slot = own >> 4;
        StripSigns low = stripSigns(planes[slot * 9 + z], side), high = stripSigns(planes[slot * 9 + z + 1], side);

        uint n = 0;
        uvec4 strip;
        [[dont_unroll]] do {
            n = n == 0 ? 6 : n - 1;  // the strip itself comes last
            uint nextX = n & 1 & side, nextY = n & 2, nextZ = z == 7 ? n & 4 : 0;
            uint to = links[slot * 8 + (nextX | nextY | nextZ)];
            strip = imageLoad(edges, int(to * 16 + (z + (n >> 2) & 7) * 2 + (side ^ n & 1)));
            strip.w += sums[to / MESHER_GROUP_BRICKS].x;
            uint firstY = strip.w + bitCount(strip.x);
            lookup[n] = strip.xw;
            lookup[8 + n] = uvec2(strip.y, firstY);
            lookup[16 + n] = uvec2(strip.z, firstY + bitCount(strip.y));
        } while (n != 0);

        uint cells = activeCells(low, high);
        bool beyond = (word >> 31) != 0;  // the tile: only edges are asked for
        cells = beyond ? cells & -cells : cells;
        uint place = base.y + (word >> 7 & 0xffffff) - push.chunk * MESHER_TRIANGLE_CHUNK;
        do {
            uint bit = findLSB(cells);
            cells &= cells - 1;
            uvec3 codes = table[cornerPattern(low, high, bit)];
            uint cell = (bit & 24) << 2 | bit & 7;
            uint first = vertexOn(codes.x, cell);
            uint before = vertexOn(codes.x >> 8, cell);
            codes = uvec3(codes.x >> 16 | codes.y << 16, codes.y >> 16 | codes.z << 16, codes.z >> 16);
            bool open = true;  // two vertices of the current fan are known
            bool last;
            do {
                uint vertex = vertexOn(codes.x, cell);
                bool starts = (codes.x & 64) != 0;
                last = (codes.x & 128) != 0;
                if (!starts && open && valid && !beyond) triangles[place] = uvec3(first, before, vertex);
                place += !starts && open ? 1 : 0;
                first = starts ? vertex : first;
                open = !starts;
                before = vertex;
                codes = uvec3(codes.x >> 8 | codes.y << 24, codes.y >> 8 | codes.z << 24, codes.z >> 8);
            } while (!last);
        } while (cells != 0);

        listEdges(own, strip, low.at, valid);
    } while ((item += kLanes) < base.w);
}
