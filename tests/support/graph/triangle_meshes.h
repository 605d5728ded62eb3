// Meshes as they are read from files, with known volumes.
#pragma once

#include <cmath>
#include <numbers>

#include "graph/assets/triangle_mesh.h"

namespace fw::test {

/// [-1, 1]^3.
inline TriangleMesh cubeFile() {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return mesh;
}

/// Around the y axis.
inline TriangleMesh torusFile(uint32_t around, uint32_t across, double major = 1.0, double minor = 0.4) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i < around; ++i)
        for (uint32_t j = 0; j < across; ++j) {
            const double a = 2.0 * std::numbers::pi * i / around, b = 2.0 * std::numbers::pi * j / across;
            const double r = major + minor * std::cos(b);
            mesh.positions.emplace_back(r * std::cos(a), minor * std::sin(b), -r * std::sin(a));
        }
    for (uint32_t i = 0; i < around; ++i)
        for (uint32_t j = 0; j < across; ++j) {
            const uint32_t k = (i + 1) % around, l = (j + 1) % across;
            const uint32_t a = i * across + j, b = k * across + j, c = k * across + l, d = i * across + l;
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    return mesh;
}

/// Every triangle with three vertices of its own.
inline TriangleMesh unsharedFile(const TriangleMesh& mesh) {
    TriangleMesh own;
    for (const uint32_t index : mesh.indices) {
        own.indices.push_back(uint32_t(own.positions.size()));
        own.positions.push_back(mesh.positions[index]);
    }
    return own;
}

inline TriangleMesh movedFile(TriangleMesh mesh, glm::vec3 offset, float scale = 1.0f) {
    for (glm::vec3& p : mesh.positions) p = scale * p + offset;
    return mesh;
}

/// Both, unconnected.
inline TriangleMesh joinedFile(const TriangleMesh& a, const TriangleMesh& b) {
    TriangleMesh both = a;
    for (const glm::vec3& p : b.positions) both.positions.push_back(p);
    for (const uint32_t index : b.indices) both.indices.push_back(index + uint32_t(a.positions.size()));
    return both;
}

/// As a recipe wants it.
inline TriangleMeshPtr shared(TriangleMesh mesh, const std::string& file = "mesh.obj") {
    mesh.file = file;
    for (const glm::vec3& p : mesh.positions)
        mesh.hash = mesh.hash * 31 + std::hash<float>()(p.x + 3 * p.y + 7 * p.z);
    for (const uint32_t index : mesh.indices) mesh.hash = mesh.hash * 31 + index;
    return std::make_shared<const TriangleMesh>(std::move(mesh));
}

}  // namespace fw::test
