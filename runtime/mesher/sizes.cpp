#include "runtime/mesher/sizes.h"

#include <algorithm>

#include "runtime/mesher/marching_cubes_table.h"

namespace fw::mesher {

using gpu::MesherCounts;

namespace {

constexpr uint32_t kMostBricks = 1u << 20;  // twenty bits in the list of vertices
constexpr uint64_t kLookupBytes = 16 * 16;  // of the edge -> vertex lookup, for a brick
constexpr uint64_t kChunkBytes = 1 << 27;   // of the longest chunk of a mesh, and what spills from it
static_assert(MESHER_VERTEX_CHUNK * sizeof(gpu::MeshVertex) <= kChunkBytes &&
              MESHER_TRIANGLE_CHUNK * 12 <= kChunkBytes && MESHER_QUAD_CHUNK * 24 <= kChunkBytes);

}  // namespace

uint64_t edgeCapacity(const MesherBuffers& buffers, bool dual) {
    return dual ? buffers.triangleCapacity / 2 : buffers.vertexCapacity;
}

void reserveAll(const Device& device, MesherBuffers& buffers, glm::uvec3 blockCount, bool dual,
                bool wantColors) {
    uint64_t all = uint64_t(blockCount.x) * blockCount.y * blockCount.z;
    if (reserve(device, buffers.table, sizeof(packedCellPolygons())))
        uploadBytes(device, buffers.table, packedCellPolygons().data(), sizeof(packedCellPolygons()));
    if (dual && reserve(device, buffers.patchTable, sizeof(packedCellPatches())))
        uploadBytes(device, buffers.patchTable, packedCellPatches().data(), sizeof(packedCellPatches()));
    reserve(device, buffers.counts, sizeof(MesherCounts), Memory::device);
    if (!buffers.counts.mapped) reserve(device, buffers.seen, sizeof(MesherCounts), Memory::readback);
    reserve(device, buffers.blockList, all * 4);
    reserve(device, buffers.blockAlive, all * 4);
    reserve(device, buffers.blockSums, all * 16);
    reserve(device, buffers.rows, all * 64 * 8);
    uint64_t bricks = buffers.brickCapacity;
    // Groups of bricks, and as many more as spreading them over two axes or parting them may add.
    const glm::uvec3 spreadGroups = spread(device, chunksOf(bricks, MESHER_GROUP_BRICKS));
    const uint64_t groups = uint64_t(spreadGroups.x) * spreadGroups.y + kPartedRow;
    reserve(device, buffers.brickList, bricks * 4);
    reserve(device, buffers.links, bricks * 32);
    reserve(device, buffers.planes, bricks * 9 * 12);
    reserve(device, buffers.sums, groups * 16);
    reserve(device, buffers.edges, bricks * kLookupBytes);
    reserve(device, buffers.stripList, groups * MESHER_GROUP_STRIPS * 4);
    const uint64_t edges = edgeCapacity(buffers, dual);
    reserve(device, buffers.vertexList, edges * 4);
    if (dual) {
        reserve(device, buffers.points, edges * sizeof(gpu::MeshVertex));
        reserve(device, buffers.corners, edges * 16);
        reserve(device, buffers.pinched, edges * 4);
        // What connect() tells of a patch takes twice the room.
        reserve(device, buffers.patchList, uint64_t(buffers.vertexCapacity) * (device.software ? 16 : 8));
        if (device.software) reserve(device, buffers.uses, edges * 16);
    }
    reserve(device, buffers.vertices, uint64_t(buffers.vertexCapacity) * sizeof(gpu::MeshVertex));
    if (wantColors) reserve(device, buffers.colors, uint64_t(buffers.vertexCapacity) * 12);
    reserve(device, buffers.triangles, uint64_t(buffers.triangleCapacity) * 12);
}

uint64_t placesOf(glm::uvec3 blockCount, uint64_t bricks) {
    return 1 + MESHER_PLACES * uint64_t(blockCount.x) * blockCount.y * blockCount.z + bricks;
}

void reserveBrickLists(const Device& device, MesherBuffers& buffers, glm::uvec3 blockCount,
                       const Families& families) {
    constexpr uint64_t kEntriesOfABrick = 48;  // a guess
    const uint64_t blocks = uint64_t(blockCount.x) * blockCount.y * blockCount.z;
    uint64_t entries = kEntriesOfABrick * buffers.brickCapacity * families.listed;
    for (uint32_t f = 0; f < families.listed; ++f)
        entries += blocks * (3 * families.all[f].members + 64 * kEntriesOfABrick);
    reserveLists(device, buffers.field, families, placesOf(blockCount, buffers.brickCapacity), entries);
}

Limits limitsOf(const Device& device, bool dual) {
    uint64_t range = device.limits.storageRange;
    uint64_t texels = device.limits.texels();  // the lookup is read as texels
    // Bound as a whole: the list of edges; of dual contouring that of patches, and each edge's four corners.
    uint64_t listed = dual ? std::min(range / 8, texels) : range / 4;
    uint64_t quads = dual ? std::min(range / 16, texels) : UINT32_MAX;
    // The mesh is written by chunks; where a kernel sees less of it than one, that is all it can write.
    const auto written = [&](uint64_t chunk, uint64_t bytes) {
        return range < kChunkBytes ? range / bytes : chunk * MESHER_CHUNKS;
    };
    return {uint32_t(std::min<uint64_t>({kMostBricks, range / kLookupBytes, texels * 16 / kLookupBytes})),
            uint32_t(std::min<uint64_t>(written(MESHER_VERTEX_CHUNK, sizeof(gpu::MeshVertex)), listed)),
            uint32_t(std::min<uint64_t>(written(MESHER_TRIANGLE_CHUNK, 12), 2 * quads))};
}

/// Memory of a software device costs nothing
/// until it is written, so there the guess is for a surface folded as densely as a Menger sponge.
void guessCapacities(const Device& device, MesherBuffers& buffers, glm::uvec3 cells, const Limits& most) {
    uint64_t section =
        (uint64_t(cells.x) * cells.y + uint64_t(cells.y) * cells.z + uint64_t(cells.z) * cells.x) / 3;
    uint64_t vertices = section * (device.software ? 24 : 8) + 8192;
    // What the other method left may be more than this one can number.
    auto set = [](uint32_t& capacity, uint64_t guess, uint32_t limit) {
        capacity = uint32_t(std::min<uint64_t>(std::max<uint64_t>(capacity, guess), limit));
    };
    set(buffers.brickCapacity, vertices / 48 + 512, most.bricks);
    set(buffers.vertexCapacity, vertices, most.vertices);
    set(buffers.triangleCapacity, 2 * vertices, most.triangles);
}

uint32_t grown(uint32_t capacity, uint64_t needed, uint32_t most) {
    return needed <= capacity ? capacity : uint32_t(std::min<uint64_t>(needed + needed / 8 + 256, most));
}

bool isChunked(const gpu::MesherPush& push, bool dual) {
    if (dual) return false;  // its chunks are of edges and patches
    return push.vertexCapacity > MESHER_VERTEX_CHUNK || push.triangleCapacity > MESHER_TRIANGLE_CHUNK;
}

}  // namespace fw::mesher
