#include "runtime/stages/decimate.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace fw {

namespace {

constexpr int kMostDoublings = 8, kMostHalvings = 12, kTriesBetween = 4;

/// Drops vertices that no triangle uses; the others keep their order.
void dropUnused(Mesh& mesh) {
    std::vector<uint32_t> place(mesh.positions.size(), 0);
    for (const uint32_t index : mesh.indices) place[index] = 1;
    uint32_t kept = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] == 0) continue;
        mesh.positions[kept] = mesh.positions[v];
        mesh.normals[kept] = mesh.normals[v];
        if (!mesh.colors.empty()) mesh.colors[kept] = mesh.colors[v];
        place[v] = kept++;
    }
    mesh.positions.resize(kept);
    mesh.normals.resize(kept);
    if (!mesh.colors.empty()) mesh.colors.resize(kept);
    for (uint32_t& index : mesh.indices) index = place[index];
}

/// Drops triangles that have the same corners as another: what is left of a part that has become flat.
void dropFlat(std::vector<uint32_t>& indices) {
    using Corners = std::array<uint32_t, 3>;
    const auto cornersAt = [&](std::size_t i) {
        Corners corners{indices[i], indices[i + 1], indices[i + 2]};
        std::ranges::sort(corners);
        return corners;
    };
    std::vector<Corners> all;
    for (std::size_t i = 0; i < indices.size(); i += 3) all.push_back(cornersAt(i));
    std::ranges::sort(all);
    if (std::ranges::adjacent_find(all) == all.end()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const auto [first, last] = std::equal_range(all.begin(), all.end(), cornersAt(i));
        if (last - first > 1) continue;
        std::copy_n(&indices[i], 3, &indices[kept]);
        kept += 3;
    }
    indices.resize(kept);
}

}  // namespace

double farthest(const Report& report) {
    double most = report.maxError.value_or(0.0);
    for (const std::optional<SampledDistance>& sampled : {report.meshToSurface, report.surfaceToMesh})
        if (sampled) most = std::max(most, sampled->max);
    return most;
}

bool decimate(Mesh& mesh, double error, const MeasureOptions& measure) {
    const std::size_t corners = mesh.indices.size();
    if (corners == 0) return false;
    const float* const positions = &mesh.positions[0].x;
    const double scale = meshopt_simplifyScale(positions, mesh.positions.size(), sizeof mesh.positions[0]);
    const bool sound = reportOnMesh(mesh.positions, mesh.indices).closedManifold();
    std::vector<uint32_t> best;
    // Whether the result of a collapse within `bound` metres holds; the least that does is kept.
    const auto holds = [&](double bound) {
        std::vector<uint32_t> indices(corners);
        indices.resize(meshopt_simplify(indices.data(), mesh.indices.data(), corners, positions,
                                        mesh.positions.size(), sizeof mesh.positions[0], 0,
                                        float(bound / scale)));
        dropFlat(indices);
        if (indices.empty()) return false;
        const Report report = reportOnMesh(mesh.positions, indices, measure);
        if (!(farthest(report) <= error) || (sound && !report.closedManifold())) return false;
        if (indices.size() < (best.empty() ? corners : best.size())) best = std::move(indices);
        return true;
    };
    double good = 0.0, bad = 0.0, bound = std::min(error, scale);
    if (holds(bound)) {
        for (int i = 0; i < kMostDoublings && bad == 0.0; ++i) {
            good = bound;
            bound *= 2.0;
            if (!holds(bound)) bad = bound;
        }
    } else {
        for (int i = 0; i < kMostHalvings && good == 0.0; ++i) {
            bad = bound;
            bound *= 0.5;
            if (holds(bound)) good = bound;
        }
    }
    for (int i = 0; i < kTriesBetween && good > 0.0 && bad > 0.0; ++i) {
        const double middle = std::sqrt(good * bad);
        (holds(middle) ? good : bad) = middle;
    }
    if (best.empty()) return false;
    mesh.indices = std::move(best);
    dropUnused(mesh);
    return true;
}

}  // namespace fw
