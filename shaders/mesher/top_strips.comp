// Sums what all groups will emit, checks it against the room there is, and sets up the kernels that emit.
#include "mesher/mesher.glsl"
#include "mesher/top.glsl"

layout(constant_id = 0) const bool kChunked = false;  // the buffers have room for more than one chunk

shared uint chunkStart[MESHER_CHUNKS + 1];

/// First strip of a chunk of triangles: the first of the first group whose first triangle is not before the chunk.
uint firstStrip(uint chunk, uint groups, uint strips) {
    uint low = 0, high = groups;
    do {
        uint middle = (low + high) / 2;
        bool before = low < high && sums[min(middle, max(groups, 1) - 1)].y < chunk * MESHER_TRIANGLE_CHUNK;
        low = before ? middle + 1 : low;
        high = before ? high : middle;
    } while (low < high);
    return low < groups ? sums[low].z : strips;
}

void main() {
    bool bricksFit = counts.bricks <= push.brickCapacity;
    uint groups = bricksFit ? (counts.bricks + MESHER_GROUP_BRICKS - 1) / MESHER_GROUP_BRICKS : 0;
    uvec3 total = sumUp(groups);  // vertices, triangles, strips
    bool fits = bricksFit && total.x <= push.vertexCapacity && total.y <= push.triangleCapacity;
    uint lane = gl_LocalInvocationIndex;
    uint start = lane == 0 ? 0 : total.z;
    if (kChunked) {
        memoryBarrierBuffer();
        barrier();
        start = lane < MESHER_CHUNKS ? firstStrip(lane, groups, total.z) : total.z;
    }
    if (lane <= MESHER_CHUNKS) {
        chunkStart[lane] = start;
        counts.stripStart[lane] = start;
    }
    barrier();

    // One lane for each set of arguments: emit, the chunks of vertices, the chunks of triangles.
    uint chunk = (lane - 1) % MESHER_CHUNKS;
    uint items = groups * MESHER_GROUP_BRICKS, perGroup = MESHER_GROUP_BRICKS;
    if (lane >= 1) {
        bool overStrips = lane > MESHER_CHUNKS;
        uint vertices = min(total.x - min(total.x, chunk * MESHER_VERTEX_CHUNK), MESHER_VERTEX_CHUNK);
        items = overStrips ? chunkStart[chunk + 1] - chunkStart[chunk] : vertices;
        perGroup = overStrips ? MESHER_GROUP_STRIPS : MESHER_GROUP_VERTICES;
    }
    if (lane < 1 + 2 * MESHER_CHUNKS) counts.groups[MESHER_EMIT + lane] = groupsFor(fits ? items : 0, perGroup);
    if (lane < 5) counts.draw[lane] = lane == 0 && fits ? total.y * 3 : lane == 1 ? 1 : 0;
    if (lane == 0) counts.emitted = total;
}
