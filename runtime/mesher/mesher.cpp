#include "runtime/mesher/mesher.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <limits>

#include "graph/base/parallel.h"
#include "runtime/mesh/octahedral.h"
#include "runtime/mesher/connect.h"
#include "runtime/mesher/host.h"
#include "runtime/mesher/kernels.h"
#include "runtime/mesher/pinches.h"
#include "runtime/mesher/record.h"
#include "runtime/mesher/sizes.h"

namespace fw {

using namespace mesher;
using gpu::MesherCounts;
using gpu::MesherPush;

namespace {

/// From here on (cells along the longest side) whole blocks of 64^3 cells are culled before bricks.
constexpr uint32_t kCellsForBlocks = 512;
constexpr uint32_t kBlockBricks = kMesherBlock / kMesherBrick;  // along each side

constexpr float kLeastNudge = 1e-4f;  // cells
constexpr float kNudgeUlps = 8.0f;    // of the largest coordinate
constexpr float kMostNudge = 0.05f;

std::string brief(float number) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", double(number));
    return text;
}

/// An error if there is more surface than can be numbered and bound. It grows with the square of the
/// resolution, about.
std::optional<Error> tooLarge(const MesherCounts& counts, const Limits& most, const MesherConfig& config) {
    struct Counted {
        const char* what;
        uint32_t has, most;
        double share() const { return double(has) / most; }
    };
    const Counted all[] = {{"bricks of 8 x 8 x 8 cells", counts.bricks, most.bricks},
                           {"vertices", counts.vertices, most.vertices},
                           {"triangles", counts.triangles, most.triangles}};
    const Counted& worst =
        *std::ranges::max_element(all, {}, [](const Counted& each) { return each.share(); });
    if (worst.has <= worst.most) return std::nullopt;
    const int longest = std::max({config.cells.x, config.cells.y, config.cells.z});
    const int fits = std::max(int(0.9 * longest / std::sqrt(worst.share())), 1);
    return Error{.message = "the surface needs " + std::to_string(worst.has) + " " + worst.what +
                            " at this resolution, " + std::to_string(worst.most) +
                            " is the most; choose a lower resolution, of about " + std::to_string(fits) +
                            " cells, or a smaller region",
                 .code = Error::Code::tooMuchSurface};
}

float longestCell(const MesherConfig& config) {
    return std::max({config.cellSize.x, config.cellSize.y, config.cellSize.z});
}

/// Least distance of a vertex from the ends of its edge, in cells; an error if the grid cannot be
/// polygonised.
Result<float> nudgeOf(const MesherConfig& config) {
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
    float nudge = std::max(kLeastNudge, kNudgeUlps * ulp / smallest);
    if (!(smallest > 0) || !(nudge <= kMostNudge))
        return Error{.message =
                         "cells of " + brief(smallest) + " m are too small for coordinates up to " +
                         brief(largest) +
                         " m in single precision; choose a lower resolution or move the model to the origin"};
    return nudge;
}

/// Bricks of the tile, blocks in which they and those beyond are, and the tile's cells.
struct Extent {
    glm::uvec3 firstBlock, blocks, first, end, cells;
};
Extent extentOf(const MesherConfig& config) {
    const uint32_t around = config.method == MeshMethod::dualContouring ? 1 : 0;
    const glm::uvec3 cells(config.cells),
        gridBlocks = (cells + (2u + kMesherBlock - 1u)) / uint32_t(kMesherBlock);
    Extent extent{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto begin = uint32_t(config.tile.begin[axis]), end = uint32_t(config.tile.end[axis]);
        extent.first[axis] = begin > 0 ? begin * kBlockBricks - around : 0;
        extent.end[axis] = end > 0 ? end * kBlockBricks + around : gridBlocks[axis] * kBlockBricks;
        extent.firstBlock[axis] = extent.first[axis] / kBlockBricks;
        extent.blocks[axis] =
            std::min(extent.end[axis] / kBlockBricks + 1, gridBlocks[axis]) - extent.firstBlock[axis];
    }
    extent.cells = glm::min(cells, (extent.end - extent.first) * uint32_t(kMesherBrick));
    return extent;
}

/// Makes sure of the kernels, and tells what they are told but for the capacities.
MesherPush prepare(const Device& device, MesherPipelines& pipelines, const MesherConfig& config, float nudge,
                   const Limits& most) {
    const Extent extent = extentOf(config);
    const bool dual = config.method == MeshMethod::dualContouring;
    MesherPush push{};
    push.origin = config.origin;
    push.cellSize = config.cellSize;
    push.cells = glm::uvec3(config.cells);
    push.blocks = extent.blocks;
    push.nudge = nudge;
    push.margin = config.sparse ? 0 : std::numeric_limits<float>::infinity();
    push.begin = extent.firstBlock * kBlockBricks;
    push.first = extent.first;
    push.end = extent.end;
    if (config.host) build(device, pipelines, {topBricks, compact});
    if (dual) build(device, pipelines, {quads});
    if (connectsOnHost(device, config)) {
        if (dual) build(device, pipelines, {contourListed});
    } else {
        build(device, pipelines, {link});
        if (dual)
            build(device, pipelines, {classifyDual, topGroupsDual, patches, contour});
        else
            build(device, pipelines, {classify, topGroups, triangles});
    }
    push.blocksListed =
        std::max({extent.cells.x, extent.cells.y, extent.cells.z}) >= kCellsForBlocks && !config.host;
    if (push.blocksListed) build(device, pipelines, {blocks});
    if (hasColors(config) && !config.host) build(device, pipelines, {colors});
    const bool families = config.families && config.families->listed > 0 && !config.host;
    // On the longest grids the heads cannot be bound: every brick then evaluates all members.
    if (families && config.pruned &&
        headBytes(*config.families, placesOf(extent.blocks, most.bricks)) <= device.limits.storageRange) {
        build(device, pipelines, {prune64, prune32, prune16, prune8});
        push.listStart = longestList(*config.families);
    }
    return push;
}

/// Whether the mesh found room; else the capacities grow.
bool madeRoom(MesherBuffers& buffers, const MesherCounts& counts, const Limits& most) {
    const Addition parting = mostOfPinches(counts.pinched);
    const uint64_t vertexCount = uint64_t(counts.vertices) + parting.vertices,
                   triangleCount = uint64_t(counts.triangles) + parting.triangles;
    if (counts.bricks <= buffers.brickCapacity && vertexCount <= buffers.vertexCapacity &&
        triangleCount <= buffers.triangleCapacity)
        return true;
    // Too many bricks: nothing else was counted yet, so it is estimated.
    uint64_t perBrick = counts.vertices ? 0 : kVerticesOfABrick * counts.bricks;
    buffers.brickCapacity = grown(buffers.brickCapacity, counts.bricks, most.bricks);
    buffers.vertexCapacity = grown(buffers.vertexCapacity, vertexCount + perBrick, most.vertices);
    buffers.triangleCapacity = grown(buffers.triangleCapacity, triangleCount + 2 * perBrick, most.triangles);
    return false;
}

/// Whether a pass over the surface in so many cells may take a tenth of a second, or more, on a weak device.
bool isLong(const MesherConfig& config, glm::uvec3 cells) {
    constexpr double kSamples = 137.0;  // evaluated for each square of cells: bricks about a surface that
                                        // is folded twice, and edges
    constexpr double kMostAdditions = 2e9;
    const double longest = std::max({cells.x, cells.y, cells.z});
    return kSamples * longest * longest * config.weight > kMostAdditions;
}

/// The interval of some brick missed surface that is there (rounding, or a field at fault). The mesh has a
/// hole, so cull less: each time with a wider margin, in the end not at all.
float widerMargin(float margin, const MesherConfig& config) {
    const float widest = longestCell(config),
                longest = float(std::max({config.cells.x, config.cells.y, config.cells.z}));
    if (!std::isinf(margin)) margin = margin == 0 ? widest / 8 : margin * 16;
    return margin > 16 * longest * widest ? std::numeric_limits<float>::infinity() : margin;
}

}  // namespace

Result<MesherResult> runMesher(const Device& device, MesherPipelines& pipelines, MesherBuffers& buffers,
                               const MesherConfig& config) {
    const Result<float> nudge = nudgeOf(config);
    if (!nudge) return nudge.error();
    const bool dual = config.method == MeshMethod::dualContouring, wantColors = hasColors(config);
    const Limits most = limitsOf(device, dual);
    guessCapacities(device, buffers, extentOf(config).cells, most);
    MesherPush push = prepare(device, pipelines, config, *nudge, most);
    MesherResult result;
    for (result.runs = 1;; ++result.runs) {
        reserveAll(device, buffers, push.blocks, dual, wantColors);
        if (config.families && config.families->listed > 0 && !config.host)
            reserveBrickLists(device, buffers, push.blocks, *config.families);
        push.brickCapacity = buffers.brickCapacity;
        push.vertexCapacity = buffers.vertexCapacity;
        push.triangleCapacity = buffers.triangleCapacity;
        if (isChunked(push, dual)) build(device, pipelines, {topGroupsChunked});
        Commands commands(device, config.timed);
        commands.parted = !config.timed && isLong(config, extentOf(config).cells);
        record(commands, pipelines, buffers, config, push);
        // Where the host has made the triangles it knows the counts, and nobody waits for the vertices yet.
        const bool counted = connectsOnHost(device, config) && !dual && !config.host;
        const Buffer& seen = buffers.counts.mapped ? buffers.counts : buffers.seen;
        MesherCounts counts{};
        if (counted) counts = seen.as<MesherCounts>()[0];
        if (!buffers.counts.mapped) copy(commands, buffers.counts, 0, seen, 0, sizeof counts);
        counted ? send(commands) : submit(commands);
        result.stages = commands.stages;
        if (!counted) counts = seen.as<MesherCounts>()[0];
        if (std::optional<Error> refused = tooLarge(counts, most, config)) return std::move(*refused);
        if (!madeRoom(buffers, counts, most)) continue;
        if (counts.leaks) {
            push.margin = widerMargin(push.margin, config);
            continue;
        }
        result.quads = dual ? counts.edges : 0;
        if (counts.pinched > 0) {
            Parting parted = partPinches(device, buffers, counts);
            result.pinches = parted.vertices;
            result.addedTo = std::move(parted.quads);
            counts.vertices += parted.vertices;
            counts.triangles += uint32_t(result.addedTo.size());
            counts.draw[0] = 3 * counts.triangles;
            uploadBytes(device, buffers.counts, &counts, sizeof counts);
        }
        result.vertices = counts.vertices;
        result.triangles = counts.triangles;
        result.bricks = counts.bricks;
        result.capped = counts.caps != 0;
        result.rim = *nudge * longestCell(config);
        result.method = config.method;
        result.colors = wantColors;
        result.creases = dual;
        return result;
    }
}

Mesh downloadMesh(const Device& device, const MesherBuffers& buffers, const MesherResult& result) {
    Mesh mesh;
    std::vector<gpu::MeshVertex> copies;
    const std::span<const gpu::MeshVertex> packed = look(device, buffers.vertices, result.vertices, copies);
    const auto rest = [&] {
        mesh.indices = download<uint32_t>(device, buffers.triangles, std::size_t(result.triangles) * 3);
        if (result.colors) mesh.colors = download<glm::vec3>(device, buffers.colors, result.vertices);
    };
    // Where the host does not see them, one thread at a time has the queue.
    const std::launch when = buffers.vertices.mapped ? std::launch::async : std::launch::deferred;
    std::future<void> beside = std::async(when, rest);
    resizeInLargePages(mesh.positions, result.vertices);
    resizeInLargePages(mesh.normals, result.vertices);
    constexpr std::size_t kBlock = 16384;
    forBlocks(result.vertices, kBlock, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) mesh.positions[i] = packed[i].position;
        unpackNormals(packed.subspan(first, last - first), std::span(mesh.normals).subspan(first));
    });
    beside.get();
    return mesh;
}

}  // namespace fw
