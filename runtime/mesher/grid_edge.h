// Active edges and bricks as the kernels list them (shaders/mesher/list_edges.glsl, mesher.glsl).
#pragma once

#include <glm/vec3.hpp>

#include "shaders/shared.h"

namespace fw {

/// The brick's place in the grid of bricks.
inline gpu::uvec3 unpackBrick(uint32_t word) { return {word & 1023, word >> 10 & 1023, word >> 20}; }

/// The place of the edge's brick in the list of bricks.
inline uint32_t slotOfEdge(uint32_t word) { return word >> 11 & 0xfffff; }

/// An edge of the grid that crosses the surface.
struct GridEdge {
    gpu::uvec3 start;  ///< sample
    uint32_t axis;
    bool insideAtStart;
};
inline GridEdge unpackEdge(uint32_t word, gpu::uvec3 brick) {
    const uint32_t bit = word & 31, side = word >> 7 & 1, z = word >> 8 & 7;
    return {brick * 8u + gpu::uvec3(side * 4 + (bit >> 3), bit & 7, z), word >> 5 & 3, word >> 31 != 0};
}

}  // namespace fw
