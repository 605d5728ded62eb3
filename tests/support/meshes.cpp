#include "tests/support/meshes.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

namespace fw::test {

Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    return mesh;
}

Mesh cube() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    for (const auto& [a, b, c, d] : {std::array{0u, 4u, 6u, 2u},
                                     {1u, 3u, 7u, 5u},
                                     {0u, 1u, 5u, 4u},
                                     {2u, 6u, 7u, 3u},
                                     {0u, 2u, 3u, 1u},
                                     {4u, 5u, 7u, 6u}})
        mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    return mesh;
}

Mesh torus(int around, int across, double majorRadius, double minorRadius) {
    Mesh mesh;
    const auto n = static_cast<uint32_t>(around), m = static_cast<uint32_t>(across);
    for (uint32_t i = 0; i < n; ++i) {
        for (uint32_t j = 0; j < m; ++j) {
            const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
            const glm::dvec3 normal(std::cos(v) * std::cos(u), std::sin(v), std::cos(v) * std::sin(u));
            const glm::dvec3 ring(std::cos(u), 0.0, std::sin(u));
            mesh.positions.emplace_back(ring * majorRadius + normal * minorRadius);
            mesh.normals.emplace_back(normal);
            const uint32_t next = (i + 1) % n * m, up = (j + 1) % m;
            const uint32_t a = i * m + j, b = next + j, c = next + up, d = i * m + up;
            mesh.indices.insert(mesh.indices.end(), {a, c, b, a, d, c});
        }
    }
    return mesh;
}

void paint(Mesh& mesh) {
    mesh.colors.clear();
    for (const glm::vec3 p : mesh.positions) mesh.colors.push_back(glm::clamp(p * 0.4f + 0.5f, 0.0f, 1.0f));
}

Mesh join(const Mesh& a, const Mesh& b) {
    Mesh mesh;
    mesh.positions = a.positions;
    mesh.positions.insert(mesh.positions.end(), b.positions.begin(), b.positions.end());
    mesh.indices = a.indices;
    for (const uint32_t index : b.indices)
        mesh.indices.push_back(index + static_cast<uint32_t>(a.positions.size()));
    return mesh;
}

Mesh moved(Mesh mesh, glm::vec3 offset) {
    for (glm::vec3& p : mesh.positions) p += offset;
    return mesh;
}

Mesh unshared(const Mesh& mesh) {
    Mesh result;
    for (const uint32_t index : mesh.indices) {
        result.indices.push_back(static_cast<uint32_t>(result.positions.size()));
        result.positions.push_back(mesh.positions[index]);
    }
    return result;
}

void flip(Mesh& mesh, std::size_t triangle) {
    std::swap(mesh.indices[triangle * 3], mesh.indices[triangle * 3 + 1]);
}

}  // namespace fw::test
