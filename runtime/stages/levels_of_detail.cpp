#include "runtime/stages/levels_of_detail.h"

#include <glm/geometric.hpp>
#include <utility>

#include "runtime/measure/read_back.h"
#include "runtime/stages/decimate.h"

namespace fw {

namespace {

/// Vertices at one place as one, with the mean of their normals.
Mesh withoutDoubles(const Mesh& mesh) {
    Welder welder(mesh.positions.size());
    Mesh made;
    std::vector<uint32_t> place;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const uint32_t at = place.emplace_back(welder.add(mesh.positions[v]));
        const bool fresh = at == made.normals.size();
        if (!mesh.colors.empty() && fresh) made.colors.push_back(mesh.colors[v]);
        if (fresh)
            made.normals.push_back(mesh.normals[v]);
        else
            made.normals[at] += mesh.normals[v];
    }
    made.positions = welder.take();
    for (glm::vec3& normal : made.normals)
        if (const float length = glm::length(normal); length > 0.0f) normal /= length;
    for (const uint32_t index : mesh.indices) made.indices.push_back(place[index]);
    return made;
}

}  // namespace

std::vector<Mesh> coarserLevels(const Mesh& finest, std::size_t count,
                                const std::function<std::vector<uint32_t>(const Mesh&)>& labels) {
    std::vector<Mesh> levels;
    Mesh level = withoutDoubles(finest);
    while (levels.size() < count) {
        const std::size_t before = level.triangleCount(), wanted = before / kLevelQuotient;
        if (wanted == 0 || !decimate(level, {.triangles = wanted}, {}, labels(level))) break;
        if (level.triangleCount() > before / 2) break;
        levels.push_back(level);
    }
    return levels;
}

}  // namespace fw
