#include "runtime/stages/decimate.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "graph/assets/triangle_tree.h"
#include "graph/base/parallel.h"
#include "runtime/stages/collapse.h"

namespace fw {

namespace {

constexpr int kTries = 4;
constexpr double kLess = 0.9;   // of the bound, when it is tried again
constexpr float kLeast = 0.1f;  // of the bound: what each place of the mesh may move
constexpr std::size_t kPoints = 2048;

/// Drops vertices that no triangle uses; the others keep their order.
void dropUnused(Mesh& mesh) {
    std::vector<uint32_t> place(mesh.positions.size(), 0);
    for (const uint32_t index : mesh.indices) place[index] = 1;
    uint32_t kept = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] == 0) continue;
        mesh.positions[kept] = mesh.positions[v];
        if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[v];
        if (!mesh.colors.empty()) mesh.colors[kept] = mesh.colors[v];
        place[v] = kept++;
    }
    mesh.positions.resize(kept);
    if (!mesh.normals.empty()) mesh.normals.resize(kept);
    if (!mesh.colors.empty()) mesh.colors.resize(kept);
    for (uint32_t& index : mesh.indices) index = place[index];
}

/// How far each vertex is away from the surface.
std::vector<float> distancesOf(const Mesh& mesh, const FieldError& fromSurface) {
    std::vector<float> distances(mesh.positions.size());
    if (!fromSurface) return distances;
    forBlocks(distances.size(), kPoints, [&](std::size_t, std::size_t first, std::size_t last) {
        std::vector<glm::dvec3> points;
        for (std::size_t v = first; v < last; ++v) points.emplace_back(mesh.positions[v]);
        std::vector<double> found(points.size());
        fromSurface(points, found);
        std::ranges::copy(found, distances.begin() + std::ptrdiff_t(first));
    });
    return distances;
}

/// Points of the surface by their nearest triangles.
std::vector<CollapseLimits::Further> pointsOnSurface(const Mesh& mesh,
                                                     const std::vector<SurfacePoint>& surface, double error) {
    std::vector<CollapseLimits::Further> points(surface.size());
    if (points.empty()) return points;
    const TriangleTree tree(mesh.positions, mesh.indices, TriangleTree::Purpose::distances);
    if (tree.empty()) return {};
    forBlocks(points.size(), 256, [&](std::size_t, std::size_t first, std::size_t last) {
        uint32_t near = TriangleTree::kNoGuess;
        for (std::size_t i = first; i < last; ++i) {
            NearestPoint on;
            near = tree.nearest(surface[i].position, near, on);
            points[i] = {glm::vec3(surface[i].position),
                         float(std::max(error, 1.000001 * std::sqrt(on.squared))), near};
        }
    });
    return points;
}

}  // namespace

bool decimate(Mesh& mesh, const DecimateWish& wish, const MeasureOptions& measure,
              std::span<const uint32_t> labels) {
    if (mesh.indices.empty() || (wish.error <= 0.0 && wish.triangles == 0)) return false;
    CollapseLimits limits{.triangles = wish.triangles, .labels = labels};
    std::vector<float> away;
    std::vector<CollapseLimits::Further> further;
    if (wish.error > 0.0) {
        limits.fromSurface = measure.errorNote.empty() ? measure.error : measure.distance;
        away = distancesOf(mesh, limits.fromSurface);
        further = pointsOnSurface(mesh, measure.surface, wish.error);
    }
    std::vector<uint32_t> indices;
    std::optional<double> before;  // how far away the mesh was
    for (double bound = wish.error, tries = 0; tries < kTries; bound *= kLess, ++tries) {
        std::vector<float> allowances;
        if (bound > 0.0) {
            limits.distance = bound;
            for (const float one : away)
                allowances.push_back(std::max(float(bound) - one, kLeast * float(bound)));
            for (CollapseLimits::Further& point : further)
                if (point.allowance <= float(wish.error)) point.allowance = float(bound);
            limits.allowances = allowances;
            limits.further = further;
        }
        indices = collapse(mesh, limits);
        if (indices.size() == mesh.indices.size()) return false;
        if (bound <= 0.0 || !measure.error) break;
        const double after = farthest(reportOnMesh(mesh.positions, indices, measure));
        if (after <= wish.error) break;
        if (!before) before = farthest(reportOnMesh(mesh.positions, mesh.indices, measure));
        if (after <= 1.0001 * *before) break;
        if (tries + 1 == kTries) return false;
    }
    mesh.indices = std::move(indices);
    dropUnused(mesh);
    return true;
}

}  // namespace fw
