// Writes the edge -> vertex lookup, the list of edges that get a vertex and the list of strips that get triangles. A
// lane takes one plane of cells, as in the count.
#define HISTOPYRAMID_LANES (8 * MESHER_GROUP_BRICKS)
#include "mesher/mesher.glsl"
#include "mesher/strips.glsl"
#include "mesher/edges.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = 4, scalar) readonly buffer Sums { uvec4 sums[]; };
layout(binding = 11, scalar) writeonly buffer VertexList { uint vertexList[]; };  // brick, strip, z, bit
layout(binding = 12, scalar) writeonly buffer StripList { uvec2 stripList[]; };   // strip, first triangle

void main() {
    uint slot = linearGroup() * MESHER_GROUP_BRICKS + (gl_LocalInvocationIndex >> 3);
    uint z = gl_LocalInvocationIndex & 7;
    bool valid = slot < counts.bricks;
    uint from = valid ? slot : 0;
    PlaneSigns low = planeSigns(planes[from * 9 + z]), high = planeSigns(planes[from * 9 + z + 1]);
    ActiveEdges edges = activeEdges(low, high);
    uvec2 triangles = triangleCount(low, high);
    uvec2 cells = activeCells(low, high);
    uvec2 nx = uvec2(bitCount(edges.x)), ny = uvec2(bitCount(edges.y)), nz = uvec2(bitCount(edges.z));
    uint vertices = nx.x + nx.y + ny.x + ny.y + nz.x + nz.y;
    uint strips = (cells.x != 0 ? 1 : 0) + (cells.y != 0 ? 1 : 0);
    uvec4 total;
    uvec4 before = sumBefore(valid ? uvec4(vertices, triangles.x + triangles.y, strips, 0) : uvec4(0), total);
    before += sums[linearGroup()];

    uint first = before.x;
    if (valid) {
        uvec2 x = uvec2(first, first + nx.x);
        uvec2 y = uvec2(x.y + nx.y, x.y + nx.y + ny.x);
        uvec2 w = uvec2(y.y + ny.y, y.y + ny.y + nz.x);
        uint plane = slot * 8 + z;
        edgesX[plane] = uvec4(edges.x.x, x.x, edges.x.y, x.y);
        edgesY[plane] = uvec4(edges.y.x, y.x, edges.y.y, y.y);
        edgesZ[plane] = uvec4(edges.z.x, w.x, edges.z.y, w.y);
        uint strip = plane * 2;
        if (cells.x != 0) stripList[before.z] = uvec2(strip, before.y);
        if (cells.y != 0) stripList[before.z + (cells.x != 0 ? 1 : 0)] = uvec2(strip + 1, before.y + triangles.x);
    }
    // One loop over the six strips of edges: the lanes of a subgroup then wait for the longest plane, not for the longest strip.
    uint end = valid ? first + vertices : first;
    uint word = slot << 11 | z << 5;
    uint current = edges.x.x;
    uint k = first;
    do {
        bool next = current == 0;
        current = next ? edges.x.y : current;
        edges.x.y = next ? edges.y.x : edges.x.y;
        edges.y.x = next ? edges.y.y : edges.y.x;
        edges.y.y = next ? edges.z.x : edges.y.y;
        edges.z.x = next ? edges.z.y : edges.z.x;
        edges.z.y = next ? 0 : edges.z.y;
        word += next ? 256 : 0;
        if (current != 0 && k < end) vertexList[k++] = word | findLSB(current);
        current &= current - 1;
    } while (k < end);
}
