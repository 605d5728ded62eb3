#include "runtime/textures/unwrap.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <span>

#include "runtime/mesh/corners.h"
#include "runtime/textures/pack.h"
#include "runtime/textures/raster.h"

namespace fw {
namespace {

constexpr int kRoundsOfOverlap = 4;

/// In its plane, as large as it is in space, times `larger`.
FlatChart flatChart(const Mesh& mesh, glm::vec3 axis, std::span<const uint32_t> triangles, float larger) {
    const auto [right, up] = planeOf(axis);
    FlatChart flat;
    double area = 0, projected = 0;
    for (const uint32_t t : triangles) {
        const uint32_t* corner = &mesh.indices[3 * std::size_t(t)];
        const glm::dvec3 a = mesh.positions[corner[0]];
        const glm::dvec3 cross =
            glm::cross(glm::dvec3(mesh.positions[corner[1]]) - a, glm::dvec3(mesh.positions[corner[2]]) - a);
        area += glm::length(cross);
        projected += std::abs(glm::dot(cross, glm::dvec3(axis)));
    }
    const float scale = larger * (projected > 0 ? float(std::sqrt(area / projected)) : 1.0f);
    for (const uint32_t t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3 p = mesh.positions[mesh.indices[3 * std::size_t(t) + k]];
            flat.corners.push_back(scale * glm::vec2(glm::dot(p, right), glm::dot(p, up)));
        }
    return flat;
}

/// Doubles vertices so that each belongs to one fan of one chart.
void splitFans(Mesh& mesh, const std::vector<uint32_t>& chartOf) {
    const std::size_t vertices = mesh.positions.size();
    const Corners corners = cornersOf(mesh.indices, vertices);
    const std::vector<uint32_t> indices = mesh.indices;
    const auto next = [&](uint32_t corner) { return indices[corner % 3 == 2 ? corner - 2 : corner + 1]; };
    const auto before = [&](uint32_t corner) { return indices[corner % 3 == 0 ? corner + 2 : corner - 1]; };
    std::vector<uint32_t> fan;
    for (std::size_t v = 0; v < vertices; ++v) {
        const std::span<const uint32_t> around = corners.at(v);
        fan.resize(around.size());
        std::iota(fan.begin(), fan.end(), 0u);
        for (std::size_t i = 0; i < around.size(); ++i)
            for (std::size_t j = 0; j < around.size(); ++j) {
                if (i == j || chartOf[around[i] / 3] != chartOf[around[j] / 3]) continue;
                if (before(around[i]) != next(around[j])) continue;
                const uint32_t from = std::max(fan[i], fan[j]), to = std::min(fan[i], fan[j]);
                std::ranges::replace(fan, from, to);
            }
        for (std::size_t first = 1; first < around.size(); ++first) {
            if (fan[first] != first) continue;
            const auto copy = uint32_t(mesh.positions.size());
            mesh.positions.push_back(mesh.positions[v]);
            if (!mesh.normals.empty()) mesh.normals.push_back(mesh.normals[v]);
            if (!mesh.colors.empty()) mesh.colors.push_back(mesh.colors[v]);
            for (std::size_t i = first; i < around.size(); ++i)
                if (fan[i] == first) mesh.indices[around[i]] = copy;
        }
    }
}

}  // namespace

namespace {

/// Where each chart's triangles lie in the square, in texels.
struct Layout {
    std::vector<std::vector<uint32_t>> triangles;  ///< of each chart
    Packing packing;
};

std::optional<Layout> layOut(const Mesh& mesh, const Charts& charts, int size,
                             std::span<const float> scales) {
    Layout layout{.triangles = std::vector<std::vector<uint32_t>>(charts.count()), .packing = {}};
    for (uint32_t t = 0; t < charts.ofTriangle.size(); ++t)
        layout.triangles[charts.ofTriangle[t]].push_back(t);
    std::vector<FlatChart> flat;
    for (std::size_t i = 0; i < charts.count(); ++i) {
        const float larger = scales.empty() ? 1.0f : scales[layout.triangles[i].front()];
        flat.push_back(flatChart(mesh, charts.axes[i], layout.triangles[i], larger));
    }
    std::optional<Packing> packing = pack(flat, size);
    if (!packing) return std::nullopt;
    layout.packing = std::move(*packing);
    return layout;
}

/// Triangles that cover middles of texels which others cover.
std::vector<uint32_t> overlapping(const Layout& layout, int size) {
    constexpr auto kSide = std::size_t(kFinestRaster);
    const float finer = float(kFinestRaster) / float(size);
    std::vector<uint8_t> covered(kSide * kSide, 0);
    std::vector<uint32_t> over;
    for (std::size_t i = 0; i < layout.triangles.size(); ++i)
        for (std::size_t j = 0; j < layout.triangles[i].size(); ++j) {
            const glm::vec2* corner = &layout.packing.corners[i][3 * j];
            const glm::vec2 a = finer * corner[0], b = finer * corner[1], c = finer * corner[2];
            uint8_t most = 0;
            forTexels(a, b, c, kFinestRaster, kFinestRaster, [&](int x, int y) {
                uint8_t& times = covered[std::size_t(y) * kSide + std::size_t(x)];
                most = std::max(most, ++times);
            });
            if (most < 2) continue;
            over.push_back(layout.triangles[i][j]);
            forTexels(a, b, c, kFinestRaster, kFinestRaster,
                      [&](int x, int y) { --covered[std::size_t(y) * kSide + std::size_t(x)]; });
        }
    return over;
}

}  // namespace

Result<Unwrapping> unwrap(Mesh mesh, int size, std::span<const float> scales) {
    Unwrapping made{.charts = chartsOf(mesh)};
    std::optional<Layout> layout = layOut(mesh, made.charts, size, scales);
    for (int round = 0; layout && round < kRoundsOfOverlap; ++round) {
        const std::vector<uint32_t> over = overlapping(*layout, size);
        if (over.empty()) break;
        splitOff(made.charts, mesh, over);
        layout = layOut(mesh, made.charts, size, scales);
    }
    if (!layout)
        return Error{.message = "the mesh falls into " + std::to_string(made.charts.count()) +
                                " charts, too many for " + std::to_string(size) + " x " +
                                std::to_string(size) +
                                " texels: ask for larger textures, a lower resolution, or fewer triangles"};
    made.gutter = layout->packing.gutter;
    made.covered = layout->packing.covered;
    splitFans(mesh, made.charts.ofTriangle);
    mesh.uvs.assign(mesh.positions.size(), glm::vec2(0.0f));
    for (std::size_t i = 0; i < layout->triangles.size(); ++i)
        for (std::size_t j = 0; j < layout->triangles[i].size(); ++j) {
            const uint32_t* corner = &mesh.indices[3 * std::size_t(layout->triangles[i][j])];
            if (collapsed(corner)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::vec2 texel = layout->packing.corners[i][3 * j + k];
                mesh.uvs[corner[k]] = {texel.x / float(size), 1.0f - texel.y / float(size)};
            }
        }
    made.mesh = std::move(mesh);
    return made;
}

}  // namespace fw
