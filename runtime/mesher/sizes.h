// What the mesher's buffers hold: first guesses, growth, and what can be numbered and bound (see mesher.h).
#pragma once

#include "runtime/mesher/mesher.h"

namespace fw::mesher {

inline uint32_t chunksOf(uint64_t items, uint64_t each) { return uint32_t((items + each - 1) / each); }

/// Active edges that there is room for: each is a vertex, of dual contouring two triangles.
uint64_t edgeCapacity(const MesherBuffers& buffers, bool dual);

/// Sizes what depends on the grid, and what depends on how much surface is in it.
void reserveAll(const Device& device, MesherBuffers& buffers, glm::uvec3 blockCount, bool dual,
                bool wantColors);

/// Places of the families' lists: all of space, boxes, bricks.
uint64_t placesOf(glm::uvec3 blockCount, uint64_t bricks);

/// Sizes the lists of the families' members.
void reserveBrickLists(const Device& device, MesherBuffers& buffers, glm::uvec3 blockCount,
                       const Families& families);

/// What can be numbered and bound.
struct Limits {
    uint32_t bricks, vertices, triangles;
};
Limits limitsOf(const Device& device, bool dual);

inline constexpr uint64_t kVerticesOfABrick = 72;  // a plane across it and some folds

/// First guesses, from the area of the region's cross sections.
void guessCapacities(const Device& device, MesherBuffers& buffers, glm::uvec3 cells, const Limits& most);

/// Capacity for a count that turned out larger, with some room so that small changes do not grow it each
/// time.
uint32_t grown(uint32_t capacity, uint64_t needed, uint32_t most);

/// The mesh may be larger than one dispatch of the last two kernels can write.
bool isChunked(const gpu::MesherPush& push, bool dual);

}  // namespace fw::mesher
