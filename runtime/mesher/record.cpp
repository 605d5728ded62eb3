#include "runtime/mesher/record.h"

#include <algorithm>
#include <cstddef>

#include "runtime/mesher/connect.h"
#include "runtime/mesher/host.h"
#include "runtime/mesher/kernels.h"
#include "runtime/mesher/sizes.h"
#include "runtime/system/clock.h"

namespace fw::mesher {

using gpu::MesherCounts;
using gpu::MesherPush;

namespace {

/// A range of a buffer that a binding can hold: chunk `index` of `stride` bytes and up to the limit behind
/// its start.
Descriptor chunkOf(const Device& device, uint32_t binding, const Buffer& buffer, uint32_t index,
                   uint64_t stride) {
    uint64_t offset = std::min<uint64_t>(index * stride, buffer.size - 4) / stride * stride;
    return {binding, buffer, offset, std::min<uint64_t>(buffer.size - offset, device.limits.storageRange)};
}

/// A run while it is recorded.
struct Recording {
    Commands& commands;
    const MesherPipelines& pipelines;
    const MesherBuffers& b;
    const MesherConfig& config;
    MesherPush push;
    const Device& device = commands.device;
    bool dual = config.method == MeshMethod::dualContouring;
    bool pruned = push.listStart != 0;
    bool byHost = connectsOnHost(device, config);
    std::vector<uint32_t> brickList = {};  // with a host for the field

    void indirect(Kernel kernel, uint32_t arguments, const std::vector<Descriptor>& more) {
        if (commands.parted) {  // then the host asks how much there is to do
            flush(commands);
            const gpu::DispatchArguments groups = counts().groups[arguments];
            return direct(kernel, uint64_t(groups.x) * groups.y, more);
        }
        VkDeviceSize offset = offsetof(MesherCounts, groups) + arguments * sizeof(gpu::DispatchArguments);
        dispatchIndirect(commands, *pipelines.all[kernel], b.counts, offset, push, with(more));
        barrier(commands);
    }
    void direct(Kernel kernel, uint64_t groups, const std::vector<Descriptor>& more) {
        dispatchGroups(commands, *pipelines.all[kernel], groups, push, with(more));
        barrier(commands);
    }
    std::vector<Descriptor> with(const std::vector<Descriptor>& more) const {
        std::vector<Descriptor> list = {{MESHER_AT_COUNTS, b.counts}};
        addField(list, config.field);
        list.insert(list.end(), more.begin(), more.end());
        return list;
    }
    /// With the lists of the families' members.
    std::vector<Descriptor> listed(std::vector<Descriptor> list) const {
        if (config.families && config.families->listed > 0) addField(list, {.lists = &b.field});
        return list;
    }
    Descriptor verticesOf(const Buffer& buffer) const {
        return chunkOf(device, MESHER_AT_MESH, buffer, push.chunk,
                       uint64_t(MESHER_VERTEX_CHUNK) * sizeof(gpu::MeshVertex));
    }
    Descriptor patchList() const {
        return {MESHER_AT_PATCH_LIST, b.patchList, 0, uint64_t(push.vertexCapacity) * 8};
    }
    MesherCounts counts() const { return download<MesherCounts>(device, b.counts, 1)[0]; }
};

void recordCull(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, "cull");
    fill(r.commands, b.counts, 0);
    if (r.config.host) {
        const MesherHost::Culled culled = r.config.host->cull(r.push);
        upload(r.device, b.rows, culled.rows);
        upload(r.device, b.blockSums, culled.blockCounts);
    }
    if (r.push.blocksListed) fill(r.commands, b.rows, 0);
    // At a tile's rim quads are not whole: what they lack must be vertices all the same.
    if (r.dual && !r.byHost && r.config.tile.begin + r.config.tile.end != glm::ivec3(0))
        fill(r.commands, b.corners, 0);
    barrier(r.commands);
    if (r.pruned) {
        const uint64_t all = uint64_t(r.push.blocks.x) * r.push.blocks.y * r.push.blocks.z;
        for (const auto& [kernel, boxes] : {std::pair(prune64, all), {prune32, 8 * all}, {prune16, 64 * all}})
            r.direct(kernel, chunksOf(boxes, MESHER_GROUP_LINKS),
                     r.listed({{MESHER_AT_BRICK_LIST, b.brickList}}));
    }
    const std::vector<Descriptor> buffers = r.listed(
        {{MESHER_AT_BLOCK_LIST, b.blockList}, {MESHER_AT_ROWS, b.rows}, {MESHER_AT_SUMS, b.blockSums}});
    if (r.push.blocksListed) {
        r.direct(blocks, 1,
                 r.listed({{MESHER_AT_BLOCK_LIST, b.blockList}, {MESHER_AT_BLOCK_ALIVE, b.blockAlive}}));
        r.indirect(cull, MESHER_BLOCKS, buffers);
    } else if (!r.config.host) {
        r.direct(cull, r.push.blocks.x * r.push.blocks.y * r.push.blocks.z, buffers);
    }
}

void recordCompact(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, "compact");
    r.direct(topBricks, 1, {{MESHER_AT_SUMS, b.blockSums}});
    r.indirect(compact, MESHER_COMPACT,
               {{MESHER_AT_BLOCK_LIST, b.blockList},
                {MESHER_AT_ROWS, b.rows},
                {MESHER_AT_SUMS, b.blockSums},
                {MESHER_AT_BRICK_LIST, b.brickList}});
    if (!r.byHost)
        r.indirect(
            link, MESHER_LINKS,
            {{MESHER_AT_ROWS, b.rows}, {MESHER_AT_BRICK_LIST, b.brickList}, {MESHER_AT_LINKS, b.links}});
    if (r.pruned) {
        beginStage(r.commands, "prune");
        r.indirect(prune8, MESHER_LINKS, r.listed({{MESHER_AT_BRICK_LIST, b.brickList}}));
    }
}

void recordSample(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, "sample");
    if (r.config.host) {
        flush(r.commands);
        const uint32_t bricks = r.counts().bricks;
        if (bricks <= r.push.brickCapacity) r.brickList = download<uint32_t>(r.device, b.brickList, bricks);
        upload(r.device, b.planes, r.config.host->sample(r.push, r.brickList));
    } else {
        r.indirect(sample, MESHER_BRICKS,
                   r.listed({{MESHER_AT_BRICK_LIST, b.brickList}, {MESHER_AT_PLANES, b.planes}}));
    }
}

void recordClassify(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, "classify");
    r.indirect(r.dual ? classifyDual : classify, MESHER_BRICKS,
               {{MESHER_AT_SUMS, b.sums},
                {MESHER_AT_BRICK_LIST, b.brickList},
                {MESHER_AT_LINKS, b.links},
                {MESHER_AT_PLANES, b.planes},
                {MESHER_AT_EDGES, b.edges},
                {MESHER_AT_STRIP_LIST, b.stripList}});
    r.direct(r.dual                      ? topGroupsDual
             : isChunked(r.push, r.dual) ? topGroupsChunked
                                         : topGroups,
             1, {{MESHER_AT_SUMS, b.sums}});
}

void recordTriangles(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, "triangles");
    const uint32_t chunks = chunksOf(r.push.triangleCapacity, MESHER_TRIANGLE_CHUNK);
    for (r.push.chunk = 0; r.push.chunk < chunks; ++r.push.chunk)
        r.indirect(triangles, MESHER_TRIANGLES + r.push.chunk,
                   {{MESHER_AT_SUMS, b.sums},
                    {MESHER_AT_LINKS, b.links},
                    {MESHER_AT_PLANES, b.planes},
                    {MESHER_AT_EDGES, b.edges},
                    {MESHER_AT_VERTEX_LIST, b.vertexList},
                    {MESHER_AT_TABLE, b.table},
                    {MESHER_AT_STRIP_LIST, b.stripList},
                    chunkOf(r.device, MESHER_AT_MESH, b.triangles, r.push.chunk,
                            uint64_t(MESHER_TRIANGLE_CHUNK) * 12)});
}

/// Classifies and writes triangles, or patches, on the host.
void recordConnect(Recording& r) {
    beginStage(r.commands, "connect");
    if (!r.commands.timed) flush(r.commands);
    const auto start = Clock::now();
    connect(r.device, r.b, r.push, r.dual);
    if (r.commands.timed) r.commands.stages.back().milliseconds += millisecondsSince(start);
}

void recordPatches(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, "patches");
    r.push.chunk = 0;
    r.indirect(patches, MESHER_TRIANGLES,
               {{MESHER_AT_SUMS, b.sums},
                {MESHER_AT_PLANES, b.planes},
                {MESHER_AT_EDGES, b.edges},
                r.patchList(),
                {MESHER_AT_VERTEX_LIST, b.vertexList},
                {MESHER_AT_TABLE, b.patchTable},
                {MESHER_AT_STRIP_LIST, b.stripList}});
}

/// The points on active edges: of marching cubes the vertices. False if there was not enough room.
bool recordPoints(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, r.dual ? "points" : "vertices");
    const Buffer& points = r.dual ? b.points : b.vertices;
    if (r.config.host) {
        flush(r.commands);
        const MesherCounts counts = r.counts();
        if (counts.groups[MESHER_EDGES].x == 0) return false;
        const auto vertexList = download<uint32_t>(r.device, b.vertexList, counts.edges);
        upload(r.device, points, r.config.host->vertices(r.push, r.brickList, vertexList));
        return true;
    }
    const uint32_t chunks = chunksOf(edgeCapacity(b, r.dual), MESHER_VERTEX_CHUNK);
    for (r.push.chunk = 0; r.push.chunk < chunks; ++r.push.chunk)
        r.indirect(vertices, MESHER_EDGES + r.push.chunk,
                   r.listed({{MESHER_AT_BRICK_LIST, b.brickList},
                             {MESHER_AT_VERTEX_LIST, b.vertexList},
                             r.verticesOf(points)}));
    return true;
}

void recordContour(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, "contour");
    const uint32_t vertexChunks = chunksOf(r.push.vertexCapacity, MESHER_VERTEX_CHUNK);
    for (r.push.chunk = 0; r.push.chunk < vertexChunks; ++r.push.chunk)
        r.indirect(r.byHost ? contourListed : contour, MESHER_VERTICES + r.push.chunk,
                   {{MESHER_AT_POINTS, b.points},
                    {MESHER_AT_SUMS, b.sums},
                    {MESHER_AT_BRICK_LIST, b.brickList},
                    {MESHER_AT_LINKS, b.links},
                    {MESHER_AT_EDGES, b.edges},
                    r.patchList(),
                    {MESHER_AT_TABLE, b.patchTable},
                    {MESHER_AT_CORNERS, r.byHost ? b.uses : b.corners},
                    r.verticesOf(b.vertices)});
    beginStage(r.commands, "quads");
    const uint32_t quadChunks = chunksOf(edgeCapacity(b, r.dual), MESHER_QUAD_CHUNK);
    for (r.push.chunk = 0; r.push.chunk < quadChunks; ++r.push.chunk)
        r.indirect(
            quads, MESHER_QUADS + r.push.chunk,
            {{MESHER_AT_POINTS, b.points},
             {MESHER_AT_VERTICES, b.vertices},
             {MESHER_AT_PINCHED, b.pinched},
             {MESHER_AT_VERTEX_LIST, b.vertexList},
             {MESHER_AT_CORNERS, b.corners},
             chunkOf(r.device, MESHER_AT_MESH, b.triangles, r.push.chunk, uint64_t(MESHER_QUAD_CHUNK) * 24)});
}

void recordColors(Recording& r) {
    const MesherBuffers& b = r.b;
    beginStage(r.commands, "colors");
    if (r.config.host) {
        flush(r.commands);
        const uint32_t count = std::min(r.counts().vertices, r.push.vertexCapacity);
        upload(r.device, b.colors,
               r.config.host->colors(download<gpu::MeshVertex>(r.device, b.vertices, count)));
        return;
    }
    const uint32_t chunks = chunksOf(r.push.vertexCapacity, MESHER_VERTEX_CHUNK);
    for (r.push.chunk = 0; r.push.chunk < chunks; ++r.push.chunk)
        r.indirect(colors, MESHER_VERTICES + r.push.chunk,
                   {r.verticesOf(b.vertices), chunkOf(r.device, MESHER_AT_COLORS, b.colors, r.push.chunk,
                                                      uint64_t(MESHER_VERTEX_CHUNK) * 12)});
}

}  // namespace

bool hasColors(const MesherConfig& config) {
    return config.colors && (!config.host || config.host->hasColors());
}

void record(Commands& commands, const MesherPipelines& pipelines, const MesherBuffers& buffers,
            const MesherConfig& config, const MesherPush& push) {
    Recording r{commands, pipelines, buffers, config, push};
    recordCull(r);
    recordCompact(r);
    recordSample(r);
    if (r.byHost) {
        recordConnect(r);
    } else {
        recordClassify(r);
        if (r.dual)
            recordPatches(r);
        else
            recordTriangles(r);
    }
    if (!recordPoints(r)) return;
    if (r.dual) recordContour(r);
    if (hasColors(config)) recordColors(r);
}

}  // namespace fw::mesher
