// Dual contouring (Ju et al. 2002): places the vertex of each patch of surface where the planes through the points on its
// edges meet best, and hands its number to the quads about these edges.
//
// What is minimised, over places x of the cell, is the sum of (n . (x - p))^2 over the edges' points p and normals n. Along
// directions that the planes leave open (a flat patch, the line of a crease) x stays near the mean of the points:
// Tikhonov's term, small, and applied once more to what it has left, so that it does not pull a crease off its place.
// Where the minimum lies outside of the cell, x is the least within it: each axis is held at the cell's side in turn.
// Deviations: a vertex a patch, not a cell, so that the result is manifold (Schaefer et al. 2007 have it for octrees);
// where a cell has several, they are the means of their points, of which no two coincide. A vertex keeps a distance
// from the sides of its cell, so that none coincides with that of another cell either.
#include "mesher/mesher.glsl"
#include "mesher/links.glsl"
#include "lib/octahedral.glsl"

layout(local_size_x = MESHER_GROUP_VERTICES) in;
layout(binding = MESHER_AT_POINTS, rgba32ui) readonly uniform uimageBuffer points;  // MeshVertex of each active edge
layout(binding = MESHER_AT_MESH, scalar) writeonly buffer Vertices { uvec4 vertices[]; };

layout(binding = MESHER_AT_BRICK_LIST, scalar) readonly buffer BrickList { uint brickList[]; };
#ifdef MESHER_LISTED  // connect.h has written the corners, and the edges of each patch
// Cell (9), slot; the first of its uses; how many; whether it is the cell's only one.
layout(binding = MESHER_AT_PATCH_LIST, rgba32ui) readonly uniform uimageBuffer patchList;
layout(binding = MESHER_AT_CORNERS, scalar) readonly buffer Uses { uint uses[]; };
#else
layout(binding = MESHER_AT_SUMS, scalar) readonly buffer Sums { uvec4 sums[]; };  // edges.glsl
layout(binding = MESHER_AT_EDGES, rgba32ui) readonly uniform uimageBuffer edges;
// Bit of the strip (5), strip (24); polygon (10: packedCellPatches()), whether it is the cell's only one (1).
layout(binding = MESHER_AT_PATCH_LIST, scalar) readonly buffer PatchList { uvec2 patchList[]; };
layout(binding = MESHER_AT_TABLE, scalar) uniform Table { uvec3 table[1024]; };
layout(binding = MESHER_AT_CORNERS, scalar) writeonly buffer Corners { uint corners[]; };  // quads.comp

/// The active edge that a code of the table tells, of the cell at bit `bit` of the strip.
uint edgeOf(uint code, uint slot, uint z, uint side, uint bit) {
    uint at = ((bit & 24) << 2 | bit & 7) + (code & 33);  // x << 5 | y of its start
    uint overX = at >> 7, overY = at >> 2 & 2, up = code & 4, axis = code >> 3 & 3;
    uint to = links[slot * 8 + ((overX & side) | overY | (z == 7 ? up : 0))];
    uvec4 strip = imageLoad(edges, int(to * 16 + (z + (up >> 2) & 7) * 2 + (side ^ overX)));
    uint before = bitCount(axis > 0 ? strip.x : 0) + bitCount(axis > 1 ? strip.y : 0);
    uint own = (at >> 2 & 24) | (at & 7);
    uint line = axis == 0 ? strip.x : axis == 1 ? strip.y : strip.z;
    return sums[to / MESHER_GROUP_BRICKS].x + strip.w + before + bitCount(line & ((1u << own) - 1));
}
#endif

const float kSoftness = 0.002;  // of the planes' whole weight

/// A symmetric matrix: its diagonal, and yz, zx, xy.
struct Symmetric {
    vec3 d, o;
};
vec3 times(Symmetric m, vec3 v) { return m.d * v + m.o.zxy * v.yzx + m.o.yzx * v.zxy; }
/// Solves m x = v, m positive definite, by its cofactors.
vec3 solve(Symmetric m, vec3 v) {
    Symmetric c = Symmetric(m.d.yzx * m.d.zxy - m.o * m.o, m.o.yzx * m.o.zxy - m.d * m.o);
    return times(c, v) / (m.d.x * c.d.x + m.o.z * c.o.z + m.o.y * c.o.y);
}

/// The x in the box from low to high of which (x - best) m (x - best) is least.
vec3 leastWithin(vec3 low, vec3 high, vec3 best, Symmetric m) {
    vec3 found = clamp(best, low, high);
    float least = dot(found - best, times(m, found - best));
    uint turn = 0;
    [[dont_unroll]] do {  // x is held, y and z give way; then the axes change places
        vec3 d;
        d.x = clamp(best.x, low.x, high.x) - best.x;
        float yx = -m.o.z * d.x, zx = -m.o.y * d.x, yz = m.o.x, size = m.d.y * m.d.z - yz * yz;
        d.y = clamp(best.y + (m.d.z * yx - yz * zx) / size, low.y, high.y) - best.y;
        d.z = clamp(best.z + (zx - yz * d.y) / m.d.z, low.z, high.z) - best.z;
        d.y = clamp(best.y + (yx - yz * d.z) / m.d.y, low.y, high.y) - best.y;
        float energy = dot(d, times(m, d));
        found = energy < least ? best + d : found;
        least = min(least, energy);
        found = found.yzx, best = best.yzx, low = low.yzx, high = high.yzx;
        m = Symmetric(m.d.yzx, m.o.yzx);
    } while (++turn < 3);
    return found;
}

void main() {
    uint chunkStart = push.chunk * MESHER_VERTEX_CHUNK;
    uint index = linearGroup() * MESHER_GROUP_VERTICES + gl_LocalInvocationIndex;
    bool valid = chunkStart + index < counts.vertices && index < MESHER_VERTEX_CHUNK;
#ifdef MESHER_LISTED
    uvec4 entry = imageLoad(patchList, int(chunkStart + (valid ? index : 0)));
    uint use = entry.y, lastUse = entry.y + entry.z - 1;
    bool alone = entry.w != 0;
    uint cellAt = entry.x & 511;
    uvec3 inBrick = uvec3(cellAt >> 3 & 7, cellAt & 7, cellAt >> 6);
    uint slot = entry.x >> 9;
#else
    uvec2 entry = patchList[chunkStart + (valid ? index : 0)];
    bool alone = (entry.y & 1024) != 0;
    uvec3 codes = table[entry.y & 1023];
    uint bit = entry.x & 31, side = entry.x >> 5 & 1, z = entry.x >> 6 & 7, slot = entry.x >> 9;
    uvec3 inBrick = uvec3(side * 4 + (bit >> 3), bit & 7, z);
#endif
    uvec3 cell = unpackBrick(brickList[slot]) * 8 + inBrick;
    vec3 middle = 0.5 * (samplePosition(cell) + samplePosition(cell + 1));

    // In cells from the cell's middle.
    Symmetric planes = Symmetric(vec3(0), vec3(0));
    vec3 pull = vec3(0), mean = vec3(0), normals = vec3(0), normal = vec3(0);
    float count = 0.0;
    bool open = true;
    do {  // as long as any lane; one that is done adds nothing: Mesa 22.3 lets vectors grow in lanes that left a loop
#ifdef MESHER_LISTED
        uint edge = uses[use];
        bool last = use == lastUse;
        use += last ? 0 : 1;
#else
        uint code = codes.x & 255;
        uint edge = edgeOf(code, slot, z, side, bit);
        bool last = (code & 128) != 0;
#endif
        uvec4 point = imageLoad(points, int(edge));
        vec3 p = (uintBitsToFloat(point.xyz) - middle) / push.cellSize;
        vec3 outwards = unpackOctahedral(point.w);
        vec3 n = open ? normalize(outwards * push.cellSize) : vec3(0);
        planes.d += n * n;
        planes.o += n.yzx * n.zxy;
        pull += n * dot(n, p);
        mean += open ? p : vec3(0);
        normals += open ? outwards : vec3(0);
        normal = open ? outwards : normal;
        count += open ? 1.0 : 0.0;
#ifndef MESHER_LISTED
        uint axis = code >> 3 & 3, x = code >> 5 & 1, y = code & 1, up = code >> 2 & 1;
        uint corner = (axis == 0 ? y : x) | (axis == 2 ? y : up) << 1;
        if (valid && open) corners[edge * 4 + corner] = chunkStart + index | (code & 2) << 29 | (code & 64) << 25;
        codes = uvec3(codes.x >> 8 | codes.y << 24, codes.y >> 8 | codes.z << 24, codes.z >> 8);
#endif
        open = open && !last;
    } while (subgroupAny(open));
    mean /= count;
    Symmetric soft = Symmetric(planes.d + kSoftness * count, planes.o);
    vec3 right = pull - times(planes, mean);
    vec3 step = solve(soft, right);
    step += solve(soft, right - times(planes, step));
    vec3 reach = vec3(0.5 - push.nudge);
    vec3 within = leastWithin(-reach - mean, reach - mean, step, soft);
    vec3 position = middle + (mean + within * (alone ? 1.0 : 0.99)) * push.cellSize;
    // Where the region closes the surface, on its boundary.
    position = clamp(position, samplePosition(uvec3(1)), samplePosition(push.cells + 1));
    float size = length(normals);
    if (valid) vertices[index] = uvec4(floatBitsToUint(position), packOctahedral(size > 1e-3 ? normals / size : normal));
}
