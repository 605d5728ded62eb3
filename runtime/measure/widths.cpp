#include "runtime/measure/widths.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "graph/base/parallel.h"

namespace fw {

namespace {

constexpr double kFaces = -0.5;   // cosine between normals of what faces each other, at most
constexpr double kSliver = 1e-4;  // height of a triangle by its longest side: its normal says nothing
constexpr std::size_t kTogether = 512;

struct Side {
    glm::dvec3 middle, normal;  ///< the latter 0 of a sliver
};
Side sideOf(std::span<const glm::vec3> positions, const uint32_t* triangle) {
    const glm::dvec3 a(positions[triangle[0]]), b(positions[triangle[1]]), c(positions[triangle[2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)}),
                 size = glm::length(normal);
    return {(a + b + c) / 3.0, size > kSliver * longest ? normal / size : glm::dvec3(0.0)};
}

}  // namespace

std::vector<float> widthsOf(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                            const TriangleTree& tree, Across across) {
    const std::size_t count = indices.size() / 3;
    std::vector<float> widths(count, std::numeric_limits<float>::quiet_NaN());
    forBlocks(count, kTogether, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t t = first; t < last; ++t) {
            const Side side = sideOf(positions, &indices[3 * t]);
            if (side.normal == glm::dvec3(0.0)) continue;
            const auto hit = tree.firstHit(side.middle, across == Across::wall ? -side.normal : side.normal,
                                           std::numeric_limits<double>::infinity(), uint32_t(t));
            if (!hit) continue;
            const Side other = sideOf(positions, &indices[3 * std::size_t(hit->triangle)]);
            if (glm::dot(other.normal, side.normal) <= kFaces) widths[t] = float(hit->distance);
        }
    });
    return widths;
}

Widths leastWidths(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                   const TriangleTree& tree) {
    const auto least = [&](Across across) -> std::optional<LeastWidth> {
        const std::vector<float> widths = widthsOf(positions, indices, tree, across);
        std::size_t at = widths.size();
        for (std::size_t t = 0; t < widths.size(); ++t)
            if (!std::isnan(widths[t]) && (at == widths.size() || widths[t] < widths[at])) at = t;
        if (at == widths.size()) return std::nullopt;
        const glm::dvec3 place = sideOf(positions, &indices[3 * at]).middle;
        return LeastWidth{double(widths[at]), {place.x, place.y, place.z}};
    };
    return {least(Across::wall), least(Across::gap)};
}

}  // namespace fw
