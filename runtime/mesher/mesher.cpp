#include "runtime/mesher/mesher.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "runtime/mesher/host.h"
#include "runtime/mesher/marching_cubes_table.h"
#include "runtime/mesher/pinches.h"

namespace fw {
namespace {

using gpu::MesherCounts;
using gpu::MesherPush;

enum Kernel {
    prune64,
    prune32,
    prune16,
    blocks,
    cull,
    prune8,
    topBricks,
    compact,
    link,
    sample,
    classify,
    classifyDual,
    topGroups,
    topGroupsChunked,
    topGroupsDual,
    triangles,
    patches,
    vertices,
    contour,
    quads,
    colors,
    kernelCount
};
constexpr const char* kNames[kernelCount] = {
    "mesher/prune.comp",      "mesher/prune.comp",      "mesher/prune.comp",      "mesher/blocks.comp",
    "mesher/cull.comp",       "mesher/prune.comp",      "mesher/top_bricks.comp", "mesher/compact.comp",
    "mesher/link.comp",       "mesher/sample.comp",     "mesher/classify.comp",   "mesher/classify.comp",
    "mesher/top_groups.comp", "mesher/top_groups.comp", "mesher/top_groups.comp", "mesher/triangles.comp",
    "mesher/patches.comp",    "mesher/vertices.comp",   "mesher/contour.comp",    "mesher/quads.comp",
    "mesher/colors.comp"};

/// From here on (cells along the longest side) whole blocks of 64^3 cells are culled before bricks.
constexpr uint32_t kCellsForBlocks = 512;

constexpr uint32_t kMostBricks = 1u << 20;  // twenty bits in the list of vertices
constexpr uint64_t kLookupBytes = 16 * 16;  // of the edge -> vertex lookup, for a brick
constexpr float kLeastNudge = 1e-4f;        // cells
constexpr float kNudgeUlps = 8.0f;          // of the largest coordinate
constexpr float kMostNudge = 0.05f;

std::string brief(float number) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", double(number));
    return text;
}

uint32_t chunksOf(uint64_t items, uint64_t each) { return uint32_t((items + each - 1) / each); }

/// Active edges that there is room for: each is a vertex, of dual contouring two triangles.
uint64_t edgeCapacity(const MesherBuffers& buffers, bool dual) {
    return dual ? buffers.triangleCapacity / 2 : buffers.vertexCapacity;
}

/// Sizes what depends on the grid, and what depends on how much surface is in it.
void reserveAll(const Device& device, MesherBuffers& buffers, glm::uvec3 blockCount, bool dual,
                bool wantColors) {
    uint64_t all = uint64_t(blockCount.x) * blockCount.y * blockCount.z;
    if (reserve(device, buffers.table, sizeof(packedCellPolygons())))
        uploadBytes(device, buffers.table, packedCellPolygons().data(), sizeof(packedCellPolygons()));
    if (dual && reserve(device, buffers.patchTable, sizeof(packedCellPatches())))
        uploadBytes(device, buffers.patchTable, packedCellPatches().data(), sizeof(packedCellPatches()));
    reserve(device, buffers.counts, sizeof(MesherCounts), Memory::device);
    reserve(device, buffers.blockList, all * 4);
    reserve(device, buffers.blockAlive, all * 4);
    reserve(device, buffers.blockSums, all * 16);
    reserve(device, buffers.rows, all * 64 * 8);
    uint64_t bricks = buffers.brickCapacity;
    // Groups of bricks, and as many more as spreading them over two axes may add.
    uint64_t groups = uint64_t(spread(device, chunksOf(bricks, MESHER_GROUP_BRICKS)).x) *
                      spread(device, chunksOf(bricks, MESHER_GROUP_BRICKS)).y;
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
        reserve(device, buffers.patchList, uint64_t(buffers.vertexCapacity) * 8);
    }
    reserve(device, buffers.vertices, uint64_t(buffers.vertexCapacity) * sizeof(gpu::MeshVertex));
    if (wantColors) reserve(device, buffers.colors, uint64_t(buffers.vertexCapacity) * 12);
    reserve(device, buffers.triangles, uint64_t(buffers.triangleCapacity) * 12);
}

/// Places of the families' lists: all of space, boxes, bricks.
uint64_t placesOf(glm::uvec3 blockCount, uint64_t bricks) {
    return 1 + MESHER_PLACES * uint64_t(blockCount.x) * blockCount.y * blockCount.z + bricks;
}

/// Sizes the lists of the families' members.
void reserveBrickLists(const Device& device, MesherBuffers& buffers, glm::uvec3 blockCount,
                       const Families& families) {
    constexpr uint64_t kEntriesOfABrick = 48;  // a guess
    const uint64_t blocks = uint64_t(blockCount.x) * blockCount.y * blockCount.z;
    uint64_t entries = kEntriesOfABrick * buffers.brickCapacity * families.listed;
    for (uint32_t f = 0; f < families.listed; ++f)
        entries += blocks * (3 * families.all[f].members + 64 * kEntriesOfABrick);
    reserveLists(device, buffers.field, families, placesOf(blockCount, buffers.brickCapacity), entries);
}

/// What can be numbered and bound.
struct Limits {
    uint32_t bricks, vertices, triangles;
};
Limits limitsOf(const Device& device, bool dual) {
    uint64_t range = device.limits.storageRange;
    uint64_t texels = device.limits.texels();  // the lookup is read as texels
    // Bound as a whole: the list of edges; of dual contouring that of patches, and each edge's four corners.
    uint64_t listed = dual ? std::min(range / 8, texels) : range / 4;
    uint64_t quads = dual ? std::min(range / 16, texels) : UINT32_MAX;
    return {uint32_t(std::min<uint64_t>({kMostBricks, range / kLookupBytes, texels * 16 / kLookupBytes})),
            uint32_t(std::min<uint64_t>(uint64_t(MESHER_VERTEX_CHUNK) * MESHER_CHUNKS, listed)),
            uint32_t(std::min<uint64_t>(uint64_t(MESHER_TRIANGLE_CHUNK) * MESHER_CHUNKS, 2 * quads))};
}

constexpr uint64_t kVerticesOfABrick = 72;  // a plane across it and some folds

/// First guesses, from the area of the region's cross sections. Memory of a software device costs nothing
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

/// Capacity for a count that turned out larger, with some room so that small changes do not grow it each
/// time.
uint32_t grown(uint32_t capacity, uint64_t needed, uint32_t most) {
    return needed <= capacity ? capacity : uint32_t(std::min<uint64_t>(needed + needed / 8 + 256, most));
}

Error tooLarge(const char* what, uint64_t has, uint64_t most) {
    return {.message = "the surface needs " + std::to_string(has) + " " + what + " at this resolution, " +
                       std::to_string(most) + " is the most; choose a lower resolution or a smaller region",
            .code = Error::Code::tooMuchSurface};
}

/// A range of a buffer that a binding can hold: chunk `index` of `stride` bytes and up to the limit behind
/// its start.
Descriptor chunkOf(const Device& device, uint32_t binding, const Buffer& buffer, uint32_t index,
                   uint64_t stride) {
    uint64_t offset = std::min<uint64_t>(index * stride, buffer.size - 4) / stride * stride;
    return {binding, buffer, offset, std::min<uint64_t>(buffer.size - offset, device.limits.storageRange)};
}

/// The mesh may be larger than one dispatch of the last two kernels can write.
bool isChunked(const MesherPush& push, bool dual) {
    if (dual) return false;  // its chunks are of edges and patches
    return push.vertexCapacity > MESHER_VERTEX_CHUNK || push.triangleCapacity > MESHER_TRIANGLE_CHUNK;
}

bool hasColors(const MesherConfig& config) {
    return config.colors && (!config.host || config.host->hasColors());
}

void record(Commands& commands, const MesherPipelines& pipelines, const MesherBuffers& b,
            const MesherConfig& config, MesherPush push) {
    const Device& device = commands.device;
    std::vector<Descriptor> common = {{0, b.counts}};
    addField(common, config.field);
    const auto listed = [&](std::vector<Descriptor> list) {
        if (config.families && config.families->listed > 0) addField(list, {.lists = &b.field});
        return list;
    };
    auto with = [&](const std::vector<Descriptor>& more) {
        std::vector<Descriptor> list = common;
        list.insert(list.end(), more.begin(), more.end());
        return list;
    };
    auto indirect = [&](Kernel kernel, uint32_t arguments, const std::vector<Descriptor>& more) {
        VkDeviceSize offset = offsetof(MesherCounts, groups) + arguments * sizeof(gpu::DispatchArguments);
        dispatchIndirect(commands, *pipelines.all[kernel], b.counts, offset, push, with(more));
        barrier(commands);
    };
    auto direct = [&](Kernel kernel, uint32_t groups, const std::vector<Descriptor>& more) {
        dispatch(commands, *pipelines.all[kernel], spread(device, groups), push, with(more));
        barrier(commands);
    };
    const bool dual = config.method == MeshMethod::dualContouring;
    const uint32_t edgeChunks = chunksOf(edgeCapacity(b, dual), MESHER_VERTEX_CHUNK),
                   vertexChunks = chunksOf(push.vertexCapacity, MESHER_VERTEX_CHUNK),
                   triangleChunks = chunksOf(push.triangleCapacity, MESHER_TRIANGLE_CHUNK),
                   quadChunks = chunksOf(edgeCapacity(b, dual), MESHER_QUAD_CHUNK);

    beginStage(commands, "cull");
    fill(commands, b.counts, 0);
    if (config.host) {
        const MesherHost::Culled culled = config.host->cull(push);
        upload(device, b.rows, culled.rows);
        upload(device, b.blockSums, culled.blockCounts);
    }
    if (push.blocksListed) fill(commands, b.rows, 0);
    barrier(commands);
    const bool pruned = push.listStart != 0;
    if (pruned) {
        const uint64_t all = uint64_t(push.blocks.x) * push.blocks.y * push.blocks.z;
        for (const auto& [kernel, boxes] : {std::pair(prune64, all), {prune32, 8 * all}, {prune16, 64 * all}})
            direct(kernel, chunksOf(boxes, MESHER_GROUP_LINKS), listed({{5, b.brickList}}));
    }
    std::vector<Descriptor> cullBuffers = listed({{1, b.blockList}, {3, b.rows}, {4, b.blockSums}});
    if (push.blocksListed) {
        direct(blocks, 1, listed({{1, b.blockList}, {2, b.blockAlive}}));
        indirect(cull, MESHER_BLOCKS, cullBuffers);
    } else if (!config.host) {
        direct(cull, push.blocks.x * push.blocks.y * push.blocks.z, cullBuffers);
    }
    beginStage(commands, "compact");
    direct(topBricks, 1, {{4, b.blockSums}});
    indirect(compact, MESHER_COMPACT, {{1, b.blockList}, {3, b.rows}, {4, b.blockSums}, {5, b.brickList}});
    indirect(link, MESHER_LINKS, {{3, b.rows}, {5, b.brickList}, {6, b.links}});
    if (pruned) {
        beginStage(commands, "prune");
        indirect(prune8, MESHER_LINKS, listed({{5, b.brickList}}));
    }
    beginStage(commands, "sample");
    std::vector<uint32_t> brickList;
    if (config.host) {
        flush(commands);
        const uint32_t bricks = download<MesherCounts>(device, b.counts, 1)[0].bricks;
        if (bricks <= push.brickCapacity) brickList = download<uint32_t>(device, b.brickList, bricks);
        upload(device, b.planes, config.host->sample(push, brickList));
    } else {
        indirect(sample, MESHER_BRICKS, listed({{5, b.brickList}, {7, b.planes}}));
    }
    beginStage(commands, "classify");
    indirect(dual ? classifyDual : classify, MESHER_BRICKS,
             {{4, b.sums}, {5, b.brickList}, {6, b.links}, {7, b.planes}, {8, b.edges}, {12, b.stripList}});
    direct(dual ? topGroupsDual : isChunked(push, dual) ? topGroupsChunked : topGroups, 1, {{4, b.sums}});
    beginStage(commands, dual ? "patches" : "triangles");
    if (dual)
        indirect(patches, MESHER_TRIANGLES,
                 {{4, b.sums},
                  {7, b.planes},
                  {8, b.edges},
                  {9, b.patchList},
                  {10, b.vertexList},
                  {11, b.patchTable},
                  {12, b.stripList}});
    for (push.chunk = 0; !dual && push.chunk < triangleChunks; ++push.chunk) {
        indirect(triangles, MESHER_TRIANGLES + push.chunk,
                 {{4, b.sums},
                  {6, b.links},
                  {7, b.planes},
                  {8, b.edges},
                  {10, b.vertexList},
                  {11, b.table},
                  {12, b.stripList},
                  chunkOf(device, 13, b.triangles, push.chunk, uint64_t(MESHER_TRIANGLE_CHUNK) * 12)});
    }
    beginStage(commands, dual ? "points" : "vertices");
    const Buffer& points = dual ? b.points : b.vertices;
    const auto chunkOfVertices = [&](const Buffer& buffer) {
        return chunkOf(device, 13, buffer, push.chunk,
                       uint64_t(MESHER_VERTEX_CHUNK) * sizeof(gpu::MeshVertex));
    };
    if (config.host) {
        flush(commands);
        const MesherCounts counts = download<MesherCounts>(device, b.counts, 1)[0];
        if (counts.groups[MESHER_EDGES].x == 0) return;  // there was not enough room
        const auto vertexList = download<uint32_t>(device, b.vertexList, counts.edges);
        upload(device, points, config.host->vertices(push, brickList, vertexList));
    } else {
        for (push.chunk = 0; push.chunk < edgeChunks; ++push.chunk)
            indirect(vertices, MESHER_EDGES + push.chunk,
                     listed({{5, b.brickList}, {10, b.vertexList}, chunkOfVertices(points)}));
    }
    if (dual) {
        beginStage(commands, "contour");
        for (push.chunk = 0; push.chunk < vertexChunks; ++push.chunk)
            indirect(contour, MESHER_VERTICES + push.chunk,
                     {{3, b.points},
                      {4, b.sums},
                      {5, b.brickList},
                      {6, b.links},
                      {8, b.edges},
                      {9, b.patchList},
                      {11, b.patchTable},
                      {12, b.corners},
                      chunkOfVertices(b.vertices)});
        beginStage(commands, "quads");
        for (push.chunk = 0; push.chunk < quadChunks; ++push.chunk)
            indirect(quads, MESHER_QUADS + push.chunk,
                     {{3, b.points},
                      {7, b.vertices},
                      {9, b.pinched},
                      {10, b.vertexList},
                      {12, b.corners},
                      chunkOf(device, 13, b.triangles, push.chunk, uint64_t(MESHER_QUAD_CHUNK) * 24)});
    }
    if (!hasColors(config)) return;
    beginStage(commands, "colors");
    if (config.host) {
        flush(commands);
        const uint32_t count = download<MesherCounts>(device, b.counts, 1)[0].vertices;
        const auto at = download<gpu::MeshVertex>(device, b.vertices, std::min(count, push.vertexCapacity));
        upload(device, b.colors, config.host->colors(at));
        return;
    }
    for (push.chunk = 0; push.chunk < vertexChunks; ++push.chunk)
        indirect(colors, MESHER_VERTICES + push.chunk,
                 {chunkOfVertices(b.vertices),
                  chunkOf(device, 12, b.colors, push.chunk, uint64_t(MESHER_VERTEX_CHUNK) * 12)});
}

/// Builds those of `kernels` that are not built yet.
void build(const Device& device, MesherPipelines& pipelines, std::initializer_list<Kernel> kernels,
           CompileTimes* times = nullptr, Compile when = Compile::now) {
    pipelines.all.resize(kernelCount);
    std::vector<ShaderOptions> shaders;
    std::vector<Kernel> missing;
    for (Kernel kernel : kernels) {
        if (pipelines.all[kernel] || std::find(missing.begin(), missing.end(), kernel) != missing.end())
            continue;
        ShaderOptions options{.name = kNames[kernel], .field = pipelines.field};
        if (kernel == prune64) options.constants = {64};
        if (kernel == prune32) options.constants = {32};
        if (kernel == prune16) options.constants = {16};
        if (kernel == classifyDual) options.constants = {true};
        if (kernel == topGroupsChunked) options.constants = {true};
        if (kernel == topGroupsDual) options.constants = {false, true};
        if (kernel == triangles || kernel == patches)
            options.constants = {std::clamp(device.limits.subgroupSize, 16u, 64u)};
        shaders.push_back(std::move(options));
        missing.push_back(kernel);
    }
    if (missing.empty()) return;
    std::vector<Pipeline> built = createComputePipelines(device, shaders, times, when);
    for (std::size_t i = 0; i < missing.size(); ++i)
        pipelines.all[missing[i]] = std::make_shared<Pipeline>(std::move(built[i]));
}

}  // namespace

void prepareMesher(const std::string& field) { (void)compileShader({.name = kNames[cull], .field = field}); }

MesherPipelines createMesherPipelines(const Device& device, std::string field, bool wantColors,
                                      const MesherPipelines& previous, CompileTimes* times, Compile when) {
    MesherPipelines pipelines{previous.all, std::move(field)};
    pipelines.all.resize(kernelCount);
    const bool pruned = hasFamilies(pipelines.field);
    for (Kernel kernel : {prune64, prune32, prune16, blocks, cull, prune8, sample, vertices, colors})
        pipelines.all[kernel] = nullptr;
    build(device, pipelines,
          {cull, sample, vertices, topBricks, compact, link, classify, topGroups, triangles,
           wantColors ? colors : vertices, pruned ? prune64 : cull, pruned ? prune32 : cull,
           pruned ? prune16 : cull, pruned ? prune8 : cull},
          times, when);
    return pipelines;
}

Result<MesherResult> runMesher(const Device& device, MesherPipelines& pipelines, MesherBuffers& buffers,
                               const MesherConfig& config) {
    int longest = std::max({config.cells.x, config.cells.y, config.cells.z});
    if (std::min({config.cells.x, config.cells.y, config.cells.z}) < 1 || longest > kMostMesherCells)
        return Error{.message = "a grid of " + std::to_string(config.cells.x) + " x " +
                                std::to_string(config.cells.y) + " x " + std::to_string(config.cells.z) +
                                " cells cannot be polygonised: each side needs 1 to " +
                                std::to_string(kMostMesherCells) + " cells"};
    glm::vec3 farCorner = config.origin + glm::vec3(config.cells) * config.cellSize;
    glm::vec3 reach = glm::max(glm::abs(config.origin), glm::abs(farCorner));
    float largest = std::max({reach.x, reach.y, reach.z});
    float ulp = std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest;
    float smallest = std::min({config.cellSize.x, config.cellSize.y, config.cellSize.z});
    float widest = std::max({config.cellSize.x, config.cellSize.y, config.cellSize.z});
    float nudge = std::max(kLeastNudge, kNudgeUlps * ulp / smallest);
    if (!(smallest > 0) || !(nudge <= kMostNudge))
        return Error{.message =
                         "cells of " + brief(smallest) + " m are too small for coordinates up to " +
                         brief(largest) +
                         " m in single precision; choose a lower resolution or move the model to the origin"};

    glm::uvec3 cells(config.cells);
    const glm::uvec3 gridBlocks = (cells + 2u + 63u) / 64u, first(config.tile.begin);
    glm::uvec3 end(config.tile.end);
    for (int axis = 0; axis < 3; ++axis) end[axis] = end[axis] == 0 ? gridBlocks[axis] : end[axis];
    const glm::uvec3 blockCount = glm::min(end + 1u, gridBlocks) - first;
    const glm::uvec3 tileCells = glm::min(cells, (end - first) * 64u);
    const bool dual = config.method == MeshMethod::dualContouring;
    assert(!dual || (first == glm::uvec3(0) && end == gridBlocks));
    const Limits most = limitsOf(device, dual);
    guessCapacities(device, buffers, tileCells, most);
    MesherPush push{};
    push.origin = config.origin;
    push.cellSize = config.cellSize;
    push.cells = cells;
    push.blocks = blockCount;
    push.nudge = nudge;
    push.margin = config.sparse ? 0 : std::numeric_limits<float>::infinity();
    push.begin = first * 8u;
    push.end = end * 8u;
    if (config.host) build(device, pipelines, {topBricks, compact, link, classify, topGroups, triangles});
    if (dual) build(device, pipelines, {classifyDual, topGroupsDual, patches, contour, quads});
    push.blocksListed = std::max({tileCells.x, tileCells.y, tileCells.z}) >= kCellsForBlocks && !config.host;
    if (push.blocksListed) build(device, pipelines, {blocks});
    const bool wantColors = hasColors(config);
    if (wantColors && !config.host) build(device, pipelines, {colors});
    const bool families = config.families && config.families->listed > 0 && !config.host;
    // On the longest grids the heads cannot be bound: every brick then evaluates all members.
    if (families && config.pruned &&
        headBytes(*config.families, placesOf(blockCount, most.bricks)) <= device.limits.storageRange) {
        build(device, pipelines, {prune64, prune32, prune16, prune8});
        push.listStart = longestList(*config.families);
    }
    MesherResult result;
    for (result.runs = 1;; ++result.runs) {
        reserveAll(device, buffers, blockCount, dual, wantColors);
        if (families) reserveBrickLists(device, buffers, blockCount, *config.families);
        push.brickCapacity = buffers.brickCapacity;
        push.vertexCapacity = buffers.vertexCapacity;
        push.triangleCapacity = buffers.triangleCapacity;
        if (isChunked(push, dual)) build(device, pipelines, {topGroupsChunked});
        Commands commands(device, config.timed);
        record(commands, pipelines, buffers, config, push);
        submit(commands);
        result.stages = commands.stages;
        MesherCounts counts = download<MesherCounts>(device, buffers.counts, 1)[0];
        if (counts.bricks > most.bricks)
            return tooLarge("bricks of 8 x 8 x 8 cells", counts.bricks, most.bricks);
        if (counts.vertices > most.vertices) return tooLarge("vertices", counts.vertices, most.vertices);
        if (counts.triangles > most.triangles) return tooLarge("triangles", counts.triangles, most.triangles);
        const Addition parting = mostOfPinches(counts.pinched);
        const uint64_t vertexCount = uint64_t(counts.vertices) + parting.vertices,
                       triangleCount = uint64_t(counts.triangles) + parting.triangles;
        bool fits = counts.bricks <= buffers.brickCapacity && vertexCount <= buffers.vertexCapacity &&
                    triangleCount <= buffers.triangleCapacity;
        if (!fits) {
            // Too many bricks: nothing else was counted yet, so it is estimated.
            uint64_t perBrick = counts.vertices ? 0 : kVerticesOfABrick * counts.bricks;
            buffers.brickCapacity = grown(buffers.brickCapacity, counts.bricks, most.bricks);
            buffers.vertexCapacity = grown(buffers.vertexCapacity, vertexCount + perBrick, most.vertices);
            buffers.triangleCapacity =
                grown(buffers.triangleCapacity, triangleCount + 2 * perBrick, most.triangles);
            continue;
        }
        if (counts.leaks) {
            // The interval of some brick missed surface that is there (rounding, or a field at fault). The
            // mesh has a hole, so cull less: each time with a wider margin, in the end not at all.
            push.margin = std::isinf(push.margin) ? push.margin
                          : push.margin == 0      ? widest / 8
                                                  : push.margin * 16;
            if (push.margin > 16 * longest * widest) push.margin = std::numeric_limits<float>::infinity();
            continue;
        }
        if (counts.pinched > 0) {
            const Addition added = partPinches(device, buffers, counts);
            result.pinches = added.vertices;
            counts.vertices += added.vertices;
            counts.triangles += added.triangles;
            counts.draw[0] = 3 * counts.triangles;
            uploadBytes(device, buffers.counts, &counts, sizeof counts);
        }
        result.vertices = counts.vertices;
        result.triangles = counts.triangles;
        result.bricks = counts.bricks;
        result.capped = counts.caps != 0;
        result.method = config.method;
        result.colors = wantColors;
        result.creases = dual;
        return result;
    }
}

uint32_t packOctahedral(glm::dvec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    const glm::dvec2 folded(n.z >= 0 ? n.x : std::copysign(1 - std::abs(n.y), n.x),
                            n.z >= 0 ? n.y : std::copysign(1 - std::abs(n.x), n.y));
    const auto fraction = [](double x) { return uint32_t(uint16_t(int16_t(std::lround(x * 32767)))); };
    return fraction(folded.x) | fraction(folded.y) << 16;
}

glm::vec3 unpackOctahedral(uint32_t word) {
    auto fraction = [](uint32_t bits) { return std::max(float(int16_t(bits & 0xffff)) / 32767.0f, -1.0f); };
    glm::vec3 n(fraction(word), fraction(word >> 16), 0.0f);
    n.z = 1.0f - std::abs(n.x) - std::abs(n.y);
    float fold = std::max(-n.z, 0.0f);
    n.x += n.x < 0 ? fold : -fold;
    n.y += n.y < 0 ? fold : -fold;
    return n / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

Mesh downloadMesh(const Device& device, const MesherBuffers& buffers, const MesherResult& result) {
    Mesh mesh;
    mesh.indices.resize(std::size_t(result.triangles) * 3);
    downloadBytes(device, buffers.triangles, mesh.indices.data(), mesh.indices.size() * 4);
    std::vector<gpu::MeshVertex> packed =
        download<gpu::MeshVertex>(device, buffers.vertices, result.vertices);
    mesh.positions.resize(packed.size());
    mesh.normals.resize(packed.size());
    for (std::size_t i = 0; i < packed.size(); ++i) {
        mesh.positions[i] = packed[i].position;
        mesh.normals[i] = unpackOctahedral(packed[i].normal);
    }
    if (result.colors) mesh.colors = download<glm::vec3>(device, buffers.colors, result.vertices);
    return mesh;
}

}  // namespace fw
