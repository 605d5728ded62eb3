// Sums the vertices and triangles of all groups of bricks, checks them against the room there is, and sets up the kernels
// that write them.
#include "mesher/mesher.glsl"
#include "mesher/top.glsl"

layout(constant_id = 0) const bool kChunked = false;  // the buffers have room for more than one chunk

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
    uvec2 total = sumUp(groups);  // vertices, triangles
    bool fits = bricksFit && total.x <= push.vertexCapacity && total.y <= push.triangleCapacity;
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

    // One lane for each set of arguments: the chunks of vertices, the chunks of triangles.
    uint chunk = lane % MESHER_CHUNKS;
    uint vertices = min(total.x - min(total.x, chunk * MESHER_VERTEX_CHUNK), MESHER_VERTEX_CHUNK);
    bool overVertices = lane < MESHER_CHUNKS;
    uint items = overVertices ? vertices : chunkStart[chunk + 1] - chunkStart[chunk];
    if (lane < 2 * MESHER_CHUNKS)
        counts.groups[MESHER_VERTICES + lane] = groupsFor(fits ? items : 0, overVertices ? MESHER_GROUP_VERTICES : 1);
    if (lane < 5) counts.draw[lane] = lane == 0 && fits ? total.y * 3 : lane == 1 ? 1 : 0;
    if (lane == 0) {
        counts.vertices = total.x;
        counts.triangles = total.y;
    }
}
