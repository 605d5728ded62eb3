// One vertex per active edge; the vertex numbers of a cell's edges go into the lookup volume.
#include "bench/talk.glsl"

layout(binding = 3, scalar) readonly buffer VertexPyramid { uint vertexCounts[]; };
layout(binding = 5, scalar) writeonly buffer Lookup { uint lookup[]; };  // per cell: first vertex << 3 | active edges
layout(binding = 6, scalar) buffer Vertices { vec3 vertices[]; };

DEFINE_DESCENT(cellOfVertex, vertexCounts)

layout(local_size_x = 256) in;

void main() {
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= min(vertexCounts[0], vertices.length())) return;
    uvec4 found = cellOfVertex(vertex);
    uint edges = activeEdges(patternOf(found.xyz)), rest = edges;
    rest = found.w > 0 ? rest & (rest - 1) : rest;
    rest = found.w > 1 ? rest & (rest - 1) : rest;
    vertices[vertex] = crossing(found.xyz, findLSB(rest));
    if (found.w == 0) lookup[cellIndex(found.xyz)] = vertex << 3 | edges;
}
