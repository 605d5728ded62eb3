// Indexed triangles on the host: what stages, exporters and reports exchange.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
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

/// Pictures that lie on a mesh by its uvs: `size` x `size` texels, rows from the top, three bytes a texel.
struct MeshTextures {
    int size = 0;
    std::vector<uint8_t> baseColor = {};  ///< sRGB
    std::vector<uint8_t> surface = {};    ///< how much of the sky is seen, roughness, metallic
    std::vector<uint8_t> normal = {};     ///< in the frame of tangent, bitangent and normal: -1..1 as 0..255
    std::vector<uint8_t> emission =
        {};  ///< sRGB, shares of the strength; empty where nothing gives off light
    float emissionStrength = 0;
};

/// A triangle mesh. Right-handed, +Y up, metres; triangles wind counter-clockwise seen from outside.
/// The optional arrays are empty or hold one entry a vertex.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;   ///< unit length
    std::vector<glm::vec3> colors;    ///< base colour, linear sRGB, 0..1
    std::vector<glm::vec2> uvs;       ///< where the textures show it: 0..1, v running down
    std::vector<glm::vec4> tangents;  ///< xyz of unit length; cross(normal, tangent) * w is the bitangent
    std::vector<uint32_t> indices;    ///< three a triangle

    glm::vec3 baseColor{0.8f};  ///< where `colors` is empty
    Material material;          ///< of the whole mesh, if it has no parts
    std::string materialName;   ///< its name; empty: none
    /// Empty, or two at least: all triangles in order, those of one part behind those of the part before.
    std::vector<MeshPart> parts;

    /// With uvs and tangents: what the surface is like, in place of base colour, roughness, metallic and
    /// emission of mesh and parts.
    std::shared_ptr<const MeshTextures> textures;

    std::size_t triangleCount() const { return indices.size() / 3; }
};

}  // namespace fw
