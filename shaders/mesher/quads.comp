// Dual contouring: about each active edge a quad between the vertices of the four cells there, as two triangles.
//
// Of the two diagonals the one is taken whose triangles pass nearer to the surface's own point on the edge: where a crease
// runs through two of the vertices it is the crease. Triangles without area, and such that face the wrong way,
// count as far.
//
// A face of a cell over which one patch runs twice on either side joins the same two vertices by two edges of the mesh:
// four triangles would share one. Quads at such a face are listed (`pinched`); the host parts them (pinches.cpp).
#include "mesher/mesher.glsl"
#include "lib/octahedral.glsl"

layout(local_size_x = MESHER_GROUP_VERTICES) in;
layout(binding = MESHER_AT_POINTS, rgba32ui) readonly uniform uimageBuffer points;    // MeshVertex of each active edge
layout(binding = MESHER_AT_VERTICES, rgba32ui) readonly uniform uimageBuffer vertices;  // MeshVertex
layout(binding = MESHER_AT_VERTEX_LIST, scalar) readonly buffer VertexList { uint vertexList[]; };  // list_edges.glsl
// Four for each active edge: the vertex of the cell that lies against the first of the other two axes, then against the
// second, then against both. Bits 30 and 31: the patch runs twice over its face across the first, the second axis.
layout(binding = MESHER_AT_CORNERS, scalar) readonly buffer Corners { uvec4 corners[]; };
layout(binding = MESHER_AT_MESH, scalar) writeonly buffer Triangles { uvec3 triangles[]; };
layout(binding = MESHER_AT_PINCHED, scalar) writeonly buffer Pinched { uint pinched[]; };

const float kThin = 1e-4;  // height of a triangle over its longest side, below which it counts as without area

/// Where a vertex is from there, in cells.
vec3 place(uint vertex, vec3 from) {
    return (uintBitsToFloat(imageLoad(vertices, int(vertex)).xyz) - from) / push.cellSize;
}

/// How far the triangles a b c and a c d, counter-clockwise about the surface's point on the edge along `outwards`, pass
/// from it; all from that point, in cells.
float misses(vec3 a, vec3 b, vec3 c, vec3 d, vec3 outwards, vec3 normal, out float thinnest) {
    vec3 diagonal = c - a;
    vec3 first = cross(b - a, diagonal), second = cross(diagonal, d - a);
    bool left = dot(cross(diagonal, -a), outwards) > 0.0;
    vec3 hit = left ? second : first;
    vec2 size = vec2(length(first), length(second));
    float longest = dot(diagonal, diagonal);
    vec2 sides = vec2(max(dot(b - a, b - a), dot(c - b, c - b)),
                      max(dot(d - c, d - c), dot(a - d, a - d)));
    vec2 height = size / max(max(sides, vec2(longest)), 1e-20);
    thinnest = min(height.x, height.y);
    float turned = min(dot(first, normal), dot(second, normal)) < 0.0 ? 10.0 : 0.0;
    float none = thinnest < kThin ? 100.0 : 0.0;
    return abs(dot(hit, a)) / max(length(hit), 1e-20) + turned + none;
}

void main() {
    uint chunkStart = push.chunk * MESHER_QUAD_CHUNK;
    uint index = linearGroup() * MESHER_GROUP_VERTICES + gl_LocalInvocationIndex;
    bool valid = chunkStart + index < counts.edges && index < MESHER_QUAD_CHUNK;
    uint edge = chunkStart + (valid ? index : 0);
    uint word = vertexList[edge];
    uint axis = word >> 5 & 3;
    bool insideAtA = (word >> 31) != 0;
    uvec4 words = corners[edge].wzxy;  // around the edge
    uvec4 across = words & words.yzwx;
    bool twice = ((across.x | across.z) & 1u << 30) != 0 || ((across.y | across.w) & 1u << 31) != 0;
    uvec4 at = words & 0x3fffffffu;
    at = (axis == 1) != insideAtA ? at : at.xwzy;

    uvec4 point = imageLoad(points, int(edge));
    vec3 middle = uintBitsToFloat(point.xyz), normal = unpackOctahedral(point.w);
    vec3 outwards = vec3(equal(uvec3(axis), uvec3(0, 1, 2))) * (insideAtA ? 1.0 : -1.0);
    vec3 a = place(at.x, middle), b = place(at.y, middle), c = place(at.z, middle), d = place(at.w, middle);
    float thinnest, otherThinnest;
    float miss = misses(a, b, c, d, outwards, normal, thinnest);
    float otherMiss = misses(b, c, d, a, outwards, normal, otherThinnest);
    bool turn = abs(miss - otherMiss) < 1e-3 ? otherThinnest > thinnest : otherMiss < miss;
    at = turn ? at.yzwx : at;
    if (valid) {
        triangles[index * 2] = at.xyz;
        triangles[index * 2 + 1] = at.xzw;
    }
    if (valid && twice) pinched[atomicAdd(counts.pinched, 1)] = edge;
}
