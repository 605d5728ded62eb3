// Indexed triangles on the host: what stages, exporters and reports exchange.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace fw {

/// What a surface does with light, beside its base colour.
struct Material {
    float roughness = 0.5f, metallic = 0.0f;  ///< 0..1
    glm::vec3 emission{0.0f};
    float transmission = 0.0f;  ///< 0..1; at 0 the two below are without effect
    float ior = 1.5f;
    glm::vec3 absorption{0.0f};  ///< 1/m

    bool operator==(const Material&) const = default;
};

/// Triangles of one material.
struct MeshPart {
    Material material;
    std::size_t triangles = 0;
    std::string name = {};  ///< of the material, which no other part has; empty: none
};

/// A triangle mesh. Right-handed, +Y up, metres; triangles wind counter-clockwise seen from outside.
/// The optional arrays are empty or hold one entry a vertex.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  ///< unit length
    std::vector<glm::vec3> colors;   ///< base colour, linear sRGB, 0..1
    std::vector<uint32_t> indices;   ///< three a triangle

    glm::vec3 baseColor{0.8f};  ///< where `colors` is empty
    Material material;          ///< of the whole mesh, if it has no parts
    std::string materialName;   ///< its name; empty: none
    /// Empty, or two at least: all triangles in order, those of one part behind those of the part before.
    std::vector<MeshPart> parts;

    std::size_t triangleCount() const { return indices.size() / 3; }
};

}  // namespace fw
