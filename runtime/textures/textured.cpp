#include "runtime/textures/textured.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>

#include "runtime/textures/bake.h"
#include "runtime/textures/tangents.h"

namespace fw {

namespace {

constexpr float kReach = 1.0f / 32;  ///< of the mesh's diagonal
constexpr float kRadius = 1.0f / 8;  ///< ditto

}  // namespace

Result<Mesh> textured(Mesh mesh, const Program& program, int size, const TextureStage& starts) {
    if (mesh.indices.empty())
        return Error{.message = "nothing to bake textures of: the mesh has no triangle"};
    if (starts) starts("unwrap");
    glm::vec3 low = mesh.positions[0], high = low;
    for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
    const float diagonal = glm::distance(low, high);
    Result<Unwrapping> unwrapped = unwrap(std::move(mesh), size);
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

}  // namespace fw
