// Lists the active edges and the patches of surface of a group of bricks, a strip of cells a lane: of dual contouring,
// each patch gets a vertex.
#include "mesher/mesher.glsl"
#include "mesher/strips.glsl"
#include "mesher/edges.glsl"
#include "mesher/list_edges.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 32;
layout(binding = MESHER_AT_PATCH_LIST, scalar) writeonly buffer PatchList { uvec2 patchList[]; };  // contour.comp says what it holds
layout(binding = MESHER_AT_TABLE, scalar) uniform Table { uvec3 table[1024]; };              // packedCellPatches()
layout(binding = MESHER_AT_STRIP_LIST, scalar) readonly buffer StripList { uint stripList[]; };

void main() {
    uint group = counts.groupStart[0] + linearGroup();
    bool groupValid = group < counts.groupStart[1];
    group = groupValid ? group : 0;
    uvec4 base = sums[group];
    uint item = gl_LocalInvocationIndex;
    [[dont_unroll]] do {
        bool valid = groupValid && item < base.w;
        uint word = stripList[group * MESHER_GROUP_STRIPS + (item < base.w ? item : 0)];
        uint own = group * MESHER_GROUP_STRIPS + (word & 127);
        uint side = own & 1, z = own >> 1 & 7, slot = own >> 4;
        StripSigns low = stripSigns(planes[slot * 9 + z], side), high = stripSigns(planes[slot * 9 + z + 1], side);
        uint cells = activeCells(low, high);
        uint place = base.y + (word >> 7);
        do {
            uint bit = findLSB(cells);
            cells &= cells - 1;
            uint pattern = cornerPattern(low, high, bit);
            bool alone = table[4 * pattern + 1].x == 0;
            uint polygon = 4 * pattern;
            uint end = polygon + 4;
            do {
                if (valid) patchList[place] = uvec2(own << 5 | bit, polygon | (alone ? 1024 : 0));
                ++place;
                ++polygon;
            } while (polygon < end && table[min(polygon, 1023)].x != 0);
        } while (cells != 0);
        uvec4 strip = edges[own];
        strip.w += base.x;
        listEdges(own, strip, low.at, valid);
    } while ((item += kLanes) < base.w);
}
