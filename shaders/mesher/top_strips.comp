// Sums what all groups will emit, checks it against the room there is, and sets up the kernels that emit.
#include "mesher/mesher.glsl"
#include "mesher/top.glsl"

layout(constant_id = 1) const uint kChunks = 1;  // of vertices and of triangles that the buffers have room for

shared uint chunkStart[MESHER_CHUNKS + 1];

void main() {
    uint groups = counts.brickGroups.x * counts.brickGroups.y * counts.brickGroups.z;
    uint needed = (min(counts.bricks, push.brickCapacity) + MESHER_GROUP_BRICKS - 1) / MESHER_GROUP_BRICKS;
    needed = min(groups, needed);
    uvec4 total = sumUp(needed);
    bool fits = counts.bricks <= push.brickCapacity && total.x <= push.vertexCapacity && total.y <= push.triangleCapacity;
    memoryBarrierBuffer();
    barrier();
    // A chunk of triangles starts with the first group whose first triangle is not before it.
    if (gl_LocalInvocationIndex <= kChunks) {
        uint first = gl_LocalInvocationIndex * MESHER_TRIANGLE_CHUNK;
        uint low = 0, high = needed;
        do {
            uint middle = (low + high) / 2;
            bool before = low < high && sums[min(middle, max(needed, 1) - 1)].y < first;
            low = before ? middle + 1 : low;
            high = before ? high : middle;
        } while (low < high);
        chunkStart[gl_LocalInvocationIndex] = low < needed && gl_LocalInvocationIndex < kChunks ? sums[low].z : total.z;
    }
    barrier();
    if (gl_LocalInvocationIndex < kChunks) {
        uint chunk = gl_LocalInvocationIndex;
        uint vertexStart = chunk * MESHER_VERTEX_CHUNK;
        uint vertices = fits && total.x > vertexStart ? min(total.x - vertexStart, MESHER_VERTEX_CHUNK) : 0;
        counts.vertexGroups[chunk] = groupsFor(vertices, MESHER_GROUP_VERTICES);
        counts.stripStart[chunk] = chunkStart[chunk];
        counts.stripGroups[chunk] = groupsFor(fits ? chunkStart[chunk + 1] - chunkStart[chunk] : 0, MESHER_GROUP_STRIPS);
    }
    if (gl_LocalInvocationIndex == 0) {
        counts.stripStart[kChunks] = total.z;
        counts.vertices = total.x;
        counts.triangles = total.y;
        counts.strips = total.z;
        counts.emitGroups = counts.brickGroups;
        if (!fits) counts.emitGroups = DispatchArguments(0, 0, 0);
        counts.draw = DrawIndexedArguments(fits ? total.y * 3 : 0, 1, 0, 0, 0);
    }
}
