#include "runtime/textures/tangents.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/textures/charts.h"

namespace fw {
namespace {

glm::vec3 unit(glm::vec3 v) {
    const float length = glm::length(v);
    return length > 0.0f && std::isfinite(length) ? v / length : glm::vec3(0.0f);
}

/// What of v lies in the plane that n stands upon, of unit length; 0 if nothing does.
glm::vec3 within(glm::vec3 v, glm::vec3 n) { return unit(v - glm::dot(n, v) * n); }

/// The direction in which u grows; 0 if the triangle has no area on the texture.
glm::vec3 alongU(const Mesh& mesh, const uint32_t* corner) {
    const glm::vec3 a = mesh.positions[corner[0]], ab = mesh.positions[corner[1]] - a,
                    ac = mesh.positions[corner[2]] - a;
    const glm::vec2 at = mesh.uvs[corner[0]];
    const float vb = at.y - mesh.uvs[corner[1]].y, vc = at.y - mesh.uvs[corner[2]].y;  // v running up
    const float area = (mesh.uvs[corner[1]].x - at.x) * vc - (mesh.uvs[corner[2]].x - at.x) * vb;
    return area == 0.0f ? glm::vec3(0.0f) : unit((area > 0.0f ? 1.0f : -1.0f) * (vc * ab - vb * ac));
}

}  // namespace

std::vector<glm::vec4> tangentsOf(const Mesh& mesh) {
    std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0.0f));
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const uint32_t* corner = &mesh.indices[i];
        const glm::vec3 along = alongU(mesh, corner);
        if (along == glm::vec3(0.0f)) continue;
        for (int k = 0; k < 3; ++k) {
            const uint32_t v = corner[k];
            const glm::vec3 n = mesh.normals[v], p = mesh.positions[v];
            const glm::vec3 next = within(mesh.positions[corner[(k + 1) % 3]] - p, n),
                            last = within(mesh.positions[corner[(k + 2) % 3]] - p, n);
            const float angle = std::acos(std::clamp(glm::dot(next, last), -1.0f, 1.0f));
            sums[v] += angle * within(along, n);
        }
    }
    std::vector<glm::vec4> tangents;
    tangents.reserve(sums.size());
    for (std::size_t v = 0; v < sums.size(); ++v) {
        glm::vec3 tangent = unit(sums[v]);
        if (tangent == glm::vec3(0.0f)) tangent = unit(planeOf(mesh.normals[v]).right);
        if (tangent == glm::vec3(0.0f)) tangent = {1, 0, 0};  // the field has no normal there
        tangents.emplace_back(tangent, 1.0f);
    }
    return tangents;
}

}  // namespace fw
