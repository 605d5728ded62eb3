// Indexed triangles on the host: what stages, exporters and reports exchange.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace fw {

/// A triangle mesh. Right-handed, +Y up, metres; triangles wind counter-clockwise seen from outside.
/// The optional arrays are empty or hold one entry a vertex.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  ///< unit length
    std::vector<glm::vec3> colors;   ///< base colour, linear sRGB, 0..1
    std::vector<uint32_t> indices;   ///< three a triangle

    /// Material of the whole mesh. `baseColor` holds where `colors` is empty.
    glm::vec3 baseColor{0.8f};
    float roughness = 0.5f, metallic = 0.0f;
    glm::vec3 emission{0.0f};

    std::size_t triangleCount() const { return indices.size() / 3; }
};

}  // namespace fw
