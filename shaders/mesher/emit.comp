// Writes the edge -> vertex lookup, the list of edges that get a vertex and the list of strips that get triangles. A
// lane takes one plane of cells, as in the count.
//
// The strips of a group are listed by their number of active cells, in four classes: the lanes of a subgroup run
// as long as the longest among them when they write the triangles.
#define HISTOPYRAMID_LANES (8 * MESHER_GROUP_BRICKS)
#define HISTOPYRAMID_TYPE uvec2
#include "mesher/mesher.glsl"
#include "mesher/strips.glsl"
#include "mesher/edges.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = 4, scalar) readonly buffer Sums { uvec4 sums[]; };
layout(binding = 11, scalar) writeonly buffer VertexList { uint vertexList[]; };  // strip, axis, bit
layout(binding = 12, scalar) writeonly buffer StripList { uvec2 stripList[]; };   // strip, first triangle

/// Where the strips of a class are counted: a byte for each class, that of most cells lowest. (128 strips at most in a group.)
uint classShift(uint cells) { return cells > 16 ? 0 : cells > 8 ? 8 : cells > 4 ? 16 : 24; }

void main() {
    uint slot = linearGroup() * MESHER_GROUP_BRICKS + (gl_LocalInvocationIndex >> 3);
    uint z = gl_LocalInvocationIndex & 7;
    bool valid = slot < counts.bricks;
    uint plane = (valid ? slot : 0) * 9 + z;
    uvec3 a = planes[plane], b = planes[plane + 1];
    uvec3 crossed[2];
    uint cells[2], triangles[2];
    uvec2 own = uvec2(0);  // vertices and triangles << 16; strips by class
    [[unroll]] for (int side = 0; side < 2; ++side) {
        StripSigns low = stripSigns(a, side), high = stripSigns(b, side);
        crossed[side] = valid ? activeEdges(low, high) : uvec3(0);
        cells[side] = valid ? bitCount(activeCells(low, high)) : 0;
        triangles[side] = valid ? triangleCount(low, high) : 0;
        ivec3 n = bitCount(crossed[side]);
        own.x += n.x + n.y + n.z + (triangles[side] << 16);
        own.y += cells[side] != 0 ? 1u << classShift(cells[side]) : 0;
    }
    uvec2 total;
    uvec2 before = sumBefore(own, total);
    uvec4 base = sums[linearGroup()];
    uint ofLarger = total.y << 8;  // in each byte the count of the classes before
    ofLarger += ofLarger << 8;
    ofLarger += ofLarger << 16;
    uint first = base.x + (before.x & 0xffff), triangle = base.y + (before.x >> 16);
    uint k = first, end = first + (own.x & 0xffff);
    uint strip = slot * 16 + z * 2;
    [[unroll]] for (int side = 0; side < 2; ++side) {
        ivec3 n = bitCount(crossed[side]);
        if (valid) edges[strip + side] = uvec4(crossed[side], first);
        uint shift = classShift(cells[side]);
        uint place = base.z + (ofLarger >> shift & 255) + (before.y >> shift & 255);
        if (cells[side] != 0) stripList[place] = uvec2(strip + side, triangle);
        before.y += cells[side] != 0 ? 1u << shift : 0;
        first += n.x + n.y + n.z;
        triangle += triangles[side];
    }

    uint word = strip << 7;
    do {
        bool next = crossed[0].x == 0;
        crossed[0].x = next ? crossed[0].y : crossed[0].x;
        crossed[0].y = next ? crossed[0].z : crossed[0].y;
        crossed[0].z = next ? crossed[1].x : crossed[0].z;
        crossed[1].x = next ? crossed[1].y : crossed[1].x;
        crossed[1].y = next ? crossed[1].z : crossed[1].y;
        crossed[1].z = next ? 0 : crossed[1].z;
        word += next ? ((word & 96) == 64 ? 64 : 32) : 0;  // after axis 2, axis 0 of the other side
        if (crossed[0].x != 0) vertexList[k++] = word | findLSB(crossed[0].x);
        crossed[0].x &= crossed[0].x - 1;
    } while (k < end);
}
