#include "runtime/mesh/creases.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <span>

#include "graph/base/parallel.h"
#include "runtime/mesh/corners.h"

namespace fw {

namespace {

uint32_t next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
uint32_t previous(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

/// Not a number where the triangle has no area.
glm::vec3 normalOf(const Mesh& mesh, uint32_t corner) {
    const uint32_t* triangle = &mesh.indices[corner / 3 * 3];
    const glm::vec3 a = mesh.positions[triangle[0]];
    return glm::normalize(glm::cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a));
}

float angleAt(const Mesh& mesh, uint32_t corner) {
    const glm::vec3 here = mesh.positions[mesh.indices[corner]];
    const glm::vec3 a = mesh.positions[mesh.indices[next(corner)]] - here,
                    b = mesh.positions[mesh.indices[previous(corner)]] - here;
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

void splitCreases(Mesh& mesh, float degrees) {
    const float least = std::cos(degrees * std::numbers::pi_v<float> / 180.0f);
    const std::size_t vertices = mesh.positions.size();
    const Corners corners = cornersOf(mesh.indices, vertices);
    std::vector<char> smooth(vertices);
    constexpr std::size_t kVertices = 16384;
    forBlocks(vertices, kVertices, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t v = first; v < last; ++v)
            // Written so that a triangle without area is no reason to split.
            smooth[v] = std::ranges::none_of(corners.at(v), [&](uint32_t corner) {
                return glm::dot(normalOf(mesh, corner), mesh.normals[v]) < least;
            });
    });
    std::vector<glm::vec3> normals;
    std::vector<uint32_t> side;
    for (std::size_t v = 0; v < vertices; ++v) {
        if (smooth[v]) continue;
        const std::span<const uint32_t> around = corners.at(v);
        normals.clear();
        for (const uint32_t corner : around) normals.push_back(normalOf(mesh, corner));
        side.resize(around.size());
        std::iota(side.begin(), side.end(), 0u);
        for (std::size_t i = 0; i < around.size(); ++i)
            for (std::size_t j = 0; j < around.size(); ++j) {
                // j follows i about the vertex: they share the edge to what is before i's corner.
                if (mesh.indices[previous(around[i])] != mesh.indices[next(around[j])]) continue;
                if (glm::dot(normals[i], normals[j]) < least) continue;
                const uint32_t from = std::max(side[i], side[j]), to = std::min(side[i], side[j]);
                std::ranges::replace(side, from, to);
            }
        for (std::size_t first = 0; first < around.size(); ++first) {
            if (side[first] != first) continue;
            glm::vec3 sum(0.0f);
            for (std::size_t i = first; i < around.size(); ++i)
                if (side[i] == first && normals[i] == normals[i])
                    sum += angleAt(mesh, around[i]) * normals[i];
            const float length = glm::length(sum);
            uint32_t vertex = uint32_t(v);
            if (first > 0) {
                vertex = uint32_t(mesh.positions.size());
                mesh.positions.push_back(mesh.positions[v]);
                mesh.normals.push_back(mesh.normals[v]);
                if (!mesh.colors.empty()) mesh.colors.push_back(mesh.colors[v]);
                for (std::size_t i = first; i < around.size(); ++i)
                    if (side[i] == first) mesh.indices[around[i]] = vertex;
            }
            if (length > 0.0f) mesh.normals[vertex] = sum / length;
        }
    }
}

}  // namespace fw
