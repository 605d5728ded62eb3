#include "runtime/textures/textured.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>

#include "runtime/textures/bake.h"
#include "runtime/textures/tangents.h"

namespace fw {

namespace {

constexpr float kReach = 1.0f / 32;  ///< of the mesh's diagonal
constexpr float kRadius = 1.0f / 8;  ///< ditto

Result<Mesh> texturedAt(Mesh mesh, const Program& program, int size, std::span<const float> scales,
                        const TextureStage& starts) {
    if (mesh.indices.empty())
        return Error{.message = "nothing to bake textures of: the mesh has no triangle"};
    if (starts) starts("unwrap");
    glm::vec3 low = mesh.positions[0], high = low;
    for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
    const float diagonal = glm::distance(low, high);
    Result<Unwrapping> unwrapped = unwrap(std::move(mesh), size, scales);
    if (!unwrapped) return unwrapped.error();
    unwrapped->mesh.tangents = tangentsOf(unwrapped->mesh);
    const Texels texels = texelsOf(*unwrapped, size);
    if (starts) starts("bake");
    auto textures = std::make_shared<MeshTextures>(bakeTextures(
        *unwrapped, texels, program, {.reach = kReach * diagonal, .radius = kRadius * diagonal}));
    Mesh made = std::move(unwrapped->mesh);
    made.textures = std::move(textures);
    made.colors.clear();
    return made;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// The triangles of `all` from one to before another, as `level` was, with what they have got.
Mesh levelOf(const Mesh& all, Mesh level, std::size_t first, std::size_t last) {
    constexpr uint32_t kUnplaced = ~0u;
    std::vector<uint32_t> place(all.positions.size(), kUnplaced);
    Mesh made;
    made.baseColor = level.baseColor;
    made.material = level.material;
    made.materialName = std::move(level.materialName);
    made.parts = std::move(level.parts);
    made.textures = all.textures;
    for (std::size_t i = 3 * first; i < 3 * last; ++i) {
        const uint32_t vertex = all.indices[i];
        if (place[vertex] == kUnplaced) {
            place[vertex] = uint32_t(made.positions.size());
            made.positions.push_back(all.positions[vertex]);
            made.normals.push_back(all.normals[vertex]);
            made.uvs.push_back(all.uvs[vertex]);
            made.tangents.push_back(all.tangents[vertex]);
        }
        made.indices.push_back(place[vertex]);
    }
    return made;
}

}  // namespace

Result<Mesh> textured(Mesh mesh, const Program& program, int size, const TextureStage& starts) {
    return texturedAt(std::move(mesh), program, size, {}, starts);
}

Result<std::vector<Mesh>> texturedLevels(std::vector<Mesh> levels, const Program& program, int size,
                                         const TextureStage& starts) {
    Mesh all;
    std::vector<float> scales;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const auto before = uint32_t(all.positions.size());
        append(all.positions, levels[i].positions);
        append(all.normals, levels[i].normals);
        for (const uint32_t index : levels[i].indices) all.indices.push_back(before + index);
        scales.resize(all.triangleCount(), std::ldexp(1.0f, -int(i)));
    }
    Result<Mesh> made = texturedAt(std::move(all), program, size, scales, starts);
    if (!made) return made.error();
    std::size_t first = 0;
    for (Mesh& level : levels) {
        const std::size_t last = first + level.triangleCount();
        level = levelOf(*made, std::move(level), first, last);
        first = last;
    }
    return levels;
}

}  // namespace fw
