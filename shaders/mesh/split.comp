// Subdivision: a new vertex in the middle of each edge, four triangles of each.
//
// Edges are numbered by their lower vertex, and there by the higher one's rank: how many ends of higher edges come
// before it. The triangle in which an edge leads from its lower vertex to the higher one writes the new vertex. In place
// of a normal that gets the edge's length, which project.comp needs.
#include "mesh/mesh.glsl"
#include "mesh/bucket.glsl"

layout(local_size_x = MESH_GROUP) in;
layout(binding = 0, rgba32ui) readonly uniform uimageBuffer vertices;  // MeshVertex
layout(binding = 1, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 2, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 4, scalar) readonly buffer Edges { uint edgeStarts[]; };
layout(binding = 5, rgba32ui) writeonly uniform uimageBuffer split;  // MeshVertex
layout(binding = 6, scalar) readonly buffer Triangles { uvec3 triangles[]; };
layout(binding = 7, rgba32ui) writeonly uniform uimageBuffer quarters;  // twelve indices in three texels
#ifdef COLORS
layout(binding = 8, scalar) readonly buffer Colors { vec3 colors[]; };
layout(binding = 9, scalar) writeonly buffer SplitColors { vec3 splitColors[]; };
#endif

vec3 positionOf(uint vertex) { return uintBitsToFloat(imageLoad(vertices, int(vertex)).xyz); }

void main() {
    uint t = item();
    bool valid = t < push.triangles;
    uvec3 from = triangles[valid ? t : 0], to = from.yzx;  // of the three edges
    uvec3 low = min(from, to), high = max(from, to), rank = uvec3(0);
    uvec3 first = uvec3(starts[low.x], starts[low.y], starts[low.z]);
    uvec3 last = first + uvec3(counts[low.x], counts[low.y], counts[low.z]), texels = texelsOf(first, last);
    uint i = 0, most = max(texels.x, max(texels.y, texels.z));
    do {  // as long as any lane: one that is done counts nothing
        rank += uvec3(countBetween(first.x, last.x, i, low.x, high.x), countBetween(first.y, last.y, i, low.y, high.y),
                      countBetween(first.z, last.z, i, low.z, high.z));
    } while (subgroupAny(++i < most));
    uvec3 made = push.vertices + uvec3(edgeStarts[low.x], edgeStarts[low.y], edgeStarts[low.z]) + rank;
    if (!valid) return;
    imageStore(quarters, int(t * 3), uvec4(from.x, made.x, made.z, made.x));
    imageStore(quarters, int(t * 3 + 1), uvec4(from.y, made.y, made.z, made.y));
    imageStore(quarters, int(t * 3 + 2), uvec4(from.z, made));
    vec3 a = positionOf(from.x), b = positionOf(from.y), c = positionOf(from.z);
    bvec3 writes = equal(from, low);
    if (writes.x) imageStore(split, int(made.x), floatBitsToUint(vec4(0.5 * (a + b), distance(a, b))));
    if (writes.y) imageStore(split, int(made.y), floatBitsToUint(vec4(0.5 * (b + c), distance(b, c))));
    if (writes.z) imageStore(split, int(made.z), floatBitsToUint(vec4(0.5 * (c + a), distance(c, a))));
#ifdef COLORS
    a = colors[from.x], b = colors[from.y], c = colors[from.z];
    if (writes.x) splitColors[made.x] = 0.5 * (a + b);
    if (writes.y) splitColors[made.y] = 0.5 * (b + c);
    if (writes.z) splitColors[made.z] = 0.5 * (c + a);
#endif
}
