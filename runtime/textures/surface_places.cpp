#include "runtime/textures/surface_places.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/mesh/field_values.h"

namespace fw {
namespace {

constexpr int kMostSteps = 5;

/// The mean of what the triangle's corners have.
template <class T>
T meanAt(const std::vector<T>& values, const uint32_t* corner, glm::vec3 shares) {
    return shares.x * values[corner[0]] + shares.y * values[corner[1]] + shares.z * values[corner[2]];
}

}  // namespace

SurfaceSeeker::SurfaceSeeker(const Mesh& mesh_, const Texels& texels_, const Tape& distance_, float reach_,
                             float near_)
    : mesh(mesh_), texels(texels_), distance(distance_), reach(reach_), near(near_) {}

std::vector<SurfacePlace> SurfaceSeeker::find(TapeMachine<float>& machine,
                                              std::span<const std::size_t> of) const {
    constexpr std::size_t kBatch = TapeMachine<float>::kGradientPoints;
    std::vector<SurfacePlace> places;
    std::vector<glm::vec3> points, normals;
    for (const std::size_t texel : of) {
        const uint32_t triangle = texels.triangle[texel];
        const uint32_t* corner = &mesh.indices[3 * std::size_t(triangle)];
        const glm::vec3 shares = sharesAt(mesh, texels, texel);
        points.push_back(meanAt(mesh.positions, corner, shares));
        normals.push_back(glm::normalize(meanAt(mesh.normals, corner, shares)));
        places.push_back({triangle, shares, points.back(), normals.back(), 0.0f});
    }
    for (int step = 0; step < kMostSteps; ++step) {
        const Tape tape = tapeFor(machine, distance, boxOf(points));
        bool there = true;
        for (std::size_t first = 0; first < points.size(); first += kBatch) {
            const std::size_t count = std::min(kBatch, points.size() - first);
            for (int axis = 0; axis < 3; ++axis)
                for (std::size_t i = 0; i < count; ++i) machine.position(axis)[i] = points[first + i][axis];
            const auto [values, gradients] = machine.gradient(tape, count);
            for (std::size_t i = 0; i < count; ++i) {
                SurfacePlace& place = places[first + i];
                glm::vec3& point = points[first + i];
                const glm::vec3 gradient(gradients[0][i], gradients[1][i], gradients[2][i]);
                const float slope = glm::length(gradient);
                place.slope = slope > 0.0f && std::isfinite(slope) ? slope : 0.0f;
                place.position = point;
                if (place.slope == 0.0f) continue;
                place.normal = gradient / slope;
                const float way = values[i] / slope;
                if (!(std::abs(way) > near) || !std::isfinite(way)) continue;
                point -= std::clamp(way, -reach, reach) * place.normal;
                there = false;
            }
        }
        if (there) break;
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        SurfacePlace& place = places[i];
        const uint32_t* corner = &mesh.indices[3 * std::size_t(place.triangle)];
        const glm::vec3 start = meanAt(mesh.positions, corner, place.shares);
        if (place.slope > 0.0f && glm::distance(place.position, start) <= reach &&
            glm::dot(place.normal, normals[i]) > 0.0f)
            continue;
        place.position = start;
        place.normal = normals[i];
        place.slope = 0.0f;
    }
    return places;
}

}  // namespace fw
