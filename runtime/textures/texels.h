// Which triangle each texel of a texture shows.
#pragma once

#include <vector>

#include "runtime/textures/unwrap.h"

namespace fw {

struct Texels {
    int size = 0;
    std::vector<uint32_t> triangle;  ///< of each, row by row from the top; kNoTriangle
    std::vector<uint8_t> inside;     ///< the texel's middle is in the triangle; else within kMargin of it
};

/// What is looked up within a chart reads texels whose middles are at most so far outside.
inline constexpr float kMargin = 1.5f;

/// Rows of the texture are those of the uvs: v = 0 is the top.
Texels texelsOf(const Unwrapping& unwrapping, int size);

/// The place of a texel's middle in its triangle: the shares of the corners. Of one that is outside, of the
/// nearest place inside, a little off the edge.
glm::vec3 sharesAt(const Mesh& mesh, const Texels& texels, std::size_t texel);

}  // namespace fw
