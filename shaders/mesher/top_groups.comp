// Sums the active edges, and triangles or patches, of all groups of bricks, checks them against the room there is, and sets up the kernels
// that write them.
#include "mesher/mesher.glsl"
#define TOP_SUMS MESHER_AT_SUMS
#include "lib/top.glsl"

layout(constant_id = 0) const bool kChunked = false;  // the buffers have room for more than one chunk of triangles
layout(constant_id = 1) const bool kDual = false;     // a vertex for each patch, two triangles for each active edge

shared uint chunkStart[MESHER_CHUNKS + 1];

/// First group of a chunk of triangles: the first whose first triangle is not before the chunk.
uint firstGroup(uint chunk, uint groups) {
    uint low = 0, high = groups;
    do {
        uint middle = (low + high) / 2;
        bool before = low < high && sums[min(middle, max(groups, 1) - 1)].y < chunk * MESHER_TRIANGLE_CHUNK;
        low = before ? middle + 1 : low;
        high = before ? high : middle;
    } while (low < high);
    return low;
}

void main() {
    bool bricksFit = counts.bricks <= push.brickCapacity;
    uint groups = bricksFit ? (counts.bricks + MESHER_GROUP_BRICKS - 1) / MESHER_GROUP_BRICKS : 0;
    uvec2 total = sumUp(groups);
    uint vertexCount = kDual ? total.y : total.x, triangleCount = kDual ? 2 * total.x : total.y;
    bool fits = bricksFit && vertexCount <= push.vertexCapacity && triangleCount <= push.triangleCapacity;
    uint lane = gl_LocalInvocationIndex;
    uint start = lane == 0 ? 0 : groups;
    if (kChunked) {
        memoryBarrierBuffer();
        barrier();
        start = lane < MESHER_CHUNKS ? firstGroup(lane, groups) : groups;
    }
    if (lane <= MESHER_CHUNKS) {
        chunkStart[lane] = start;
        counts.groupStart[lane] = start;
    }
    barrier();

    // One lane for each set of arguments: the chunks of edges, of groups of bricks, of vertices, of quads.
    uint set = lane / MESHER_CHUNKS, chunk = lane % MESHER_CHUNKS;
    uint all = set == 2 ? vertexCount : total.x, each = set == 3 ? MESHER_QUAD_CHUNK : MESHER_VERTEX_CHUNK;
    uint items = min(all - min(all, chunk * each), each);
    items = set == 1 ? chunkStart[chunk + 1] - chunkStart[chunk] : items;
    if (lane < 4 * MESHER_CHUNKS)
        counts.groups[MESHER_EDGES + lane] = groupsFor(fits ? items : 0, set == 1 ? 1 : MESHER_GROUP_VERTICES);
    if (lane < 5) counts.draw[lane] = lane == 0 && fits ? triangleCount * 3 : lane == 1 ? 1 : 0;
    if (lane == 0) {
        counts.edges = total.x;
        counts.vertices = vertexCount;
        counts.triangles = triangleCount;
    }
}
