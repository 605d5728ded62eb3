// The list of active edges, each at its place. An entry holds, from the lowest bit: bit of the strip (5), axis (2), strip
// (24: side, z, slot), whether the edge's start is inside (1).
layout(binding = MESHER_AT_VERTEX_LIST, scalar) writeonly buffer VertexList { uint vertexList[]; };

/// Lists those of a strip: `strip` is its entry of the edge -> vertex lookup, with the place of its first edge among all.
void listEdges(uint own, uvec4 strip, uint insideAtStart, bool valid) {
    uvec3 crossed = valid ? strip.xyz : uvec3(0);
    uint k = strip.w, end = k + bitCount(crossed.x) + bitCount(crossed.y) + bitCount(crossed.z);
    uint entry = own << 7;
    do {
        bool next = crossed.x == 0;
        crossed = next ? uvec3(crossed.yz, 0) : crossed;
        entry += next ? 32 : 0;
        uint bit = findLSB(crossed.x);
        if (crossed.x != 0) vertexList[k++] = entry | bit | (insideAtStart >> (bit & 31)) << 31;
        crossed.x &= crossed.x - 1;
    } while (k < end);
}
