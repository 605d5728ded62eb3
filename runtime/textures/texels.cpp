#include "runtime/textures/texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/textures/raster.h"

namespace fw {
namespace {

constexpr float kInward = 1e-3f;  ///< that a place on an edge is moved towards the triangle's middle

std::array<glm::vec2, 3> cornersIn(const Mesh& mesh, uint32_t triangle, float size) {
    const uint32_t* corner = &mesh.indices[3 * std::size_t(triangle)];
    return {size * mesh.uvs[corner[0]], size * mesh.uvs[corner[1]], size * mesh.uvs[corner[2]]};
}

float crossOf(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

glm::vec2 nearestOn(glm::vec2 a, glm::vec2 b, glm::vec2 p) {
    const glm::vec2 along = b - a;
    const float squared = glm::dot(along, along);
    return squared > 0 ? a + std::clamp(glm::dot(p - a, along) / squared, 0.0f, 1.0f) * along : a;
}

/// The nearest place of the triangle's rim.
glm::vec2 nearestOnRim(const std::array<glm::vec2, 3>& corners, glm::vec2 p) {
    glm::vec2 best = corners[0];
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec2 near = nearestOn(corners[i], corners[(i + 1) % 3], p);
        if (glm::distance(near, p) < glm::distance(best, p)) best = near;
    }
    return best;
}

}  // namespace

Texels texelsOf(const Unwrapping& unwrapping, int size) {
    const Mesh& mesh = unwrapping.mesh;
    const std::size_t count = std::size_t(size) * std::size_t(size);
    Texels texels{size, std::vector<uint32_t>(count, kNoTriangle), std::vector<uint8_t>(count, 0)};
    const auto place = [&](int x, int y) { return std::size_t(y) * std::size_t(size) + std::size_t(x); };
    for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        const auto [a, b, c] = cornersIn(mesh, t, float(size));
        forTexels(a, b, c, size, size, [&, triangle = t](int x, int y) {
            texels.triangle[place(x, y)] = triangle;
            texels.inside[place(x, y)] = 1;
        });
    }
    // The margin, the nearer half of it first.
    const std::vector<uint32_t> neighbours = neighboursOf(mesh);
    for (const float reach : {kMargin / 2, kMargin})
        for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
            const uint32_t* beyond = &neighbours[3 * std::size_t(t)];
            if (beyond[0] != kNoTriangle && beyond[1] != kNoTriangle && beyond[2] != kNoTriangle) continue;
            const std::array<glm::vec2, 3> corners = cornersIn(mesh, t, float(size));
            glm::vec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]) - reach,
                      high = glm::max(glm::max(corners[0], corners[1]), corners[2]) + reach;
            low = glm::clamp(low, 0.0f, float(size - 1));
            high = glm::clamp(high, 0.0f, float(size - 1));
            for (int y = int(low.y); y <= int(high.y); ++y)
                for (int x = int(low.x); x <= int(high.x); ++x) {
                    if (texels.triangle[place(x, y)] != kNoTriangle) continue;
                    const glm::vec2 p(float(x) + 0.5f, float(y) + 0.5f);
                    if (glm::distance(nearestOnRim(corners, p), p) <= reach) texels.triangle[place(x, y)] = t;
                }
        }
    return texels;
}

glm::vec3 sharesAt(const Mesh& mesh, const Texels& texels, std::size_t texel) {
    const auto size = std::size_t(texels.size);
    const std::array<glm::vec2, 3> corners = cornersIn(mesh, texels.triangle[texel], float(size));
    glm::vec2 p(float(texel % size) + 0.5f, float(texel / size) + 0.5f);
    if (!texels.inside[texel])
        p = glm::mix(nearestOnRim(corners, p), (corners[0] + corners[1] + corners[2]) / 3.0f, kInward);
    const float whole = crossOf(corners[1] - corners[0], corners[2] - corners[0]);
    if (whole == 0.0f) return glm::vec3(1.0f / 3.0f);
    const glm::vec3 shares =
        glm::clamp(glm::vec3(crossOf(corners[1] - p, corners[2] - p), crossOf(corners[2] - p, corners[0] - p),
                             crossOf(corners[0] - p, corners[1] - p)) /
                       whole,
                   0.0f, 1.0f);
    return shares / (shares.x + shares.y + shares.z);
}

}  // namespace fw
