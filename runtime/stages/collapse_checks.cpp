#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/stages/collapse_state.h"

namespace fw {

namespace {

constexpr float kTurned = 0.25f;     // the least cosine between a triangle's normals before and after
constexpr float kThin = 1e-3f;       // the least shape of a triangle, unless one there was as thin
constexpr float kSliver = 0.02f;     // whose own normal says little
constexpr double kOtherLook = 0.02;  // by which a point's colour may differ anyhow
constexpr double kKept = 0.01;       // the least share of its volume that a part of few triangles keeps

using Corners3 = std::array<glm::dvec3, 3>;

/// Whether a value that the corners have, and the points between them by their weights, is `wanted`, or
/// nearly, somewhere in the triangle within a distance of the point with these weights.
bool isNear(double wanted, const glm::dvec3& values, const Corners3& places, const glm::dvec3& weights,
            double distance) {
    double least = glm::dot(values, weights), most = least;
    const auto found = [&] { return wanted >= least - kOtherLook && wanted <= most + kOtherLook; };
    if (found()) return true;
    const auto add = [&](double value) { least = std::min(least, value), most = std::max(most, value); };
    // The extremes are on the sides, or right up and down the slope.
    const glm::dvec3 point = weights.x * places[0] + weights.y * places[1] + weights.z * places[2];
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const glm::dvec3 along = places[std::size_t(j)] - places[std::size_t(i)],
                         off = places[std::size_t(i)] - point;
        const double squared = glm::dot(along, along), middle = -glm::dot(along, off) / squared,
                     rest = middle * middle - (glm::dot(off, off) - distance * distance) / squared;
        if (!(rest >= 0.0)) continue;
        const double half = std::sqrt(rest);
        if (middle + half < 0.0 || middle - half > 1.0) continue;
        for (const double t : {middle - half, middle + half})
            add(values[i] + std::clamp(t, 0.0, 1.0) * (values[j] - values[i]));
    }
    if (found()) return true;
    const glm::dvec3 ab = places[1] - places[0], ac = places[2] - places[0], normal = glm::cross(ab, ac);
    const glm::dvec3 slope =
        (values.y - values.x) * glm::cross(ac, normal) + (values.z - values.x) * glm::cross(normal, ab);
    const double steepness = glm::length(slope), size = glm::dot(normal, normal);
    if (!(steepness > 0.0)) return false;
    const double way = (wanted > most ? distance : -distance) / steepness;
    const glm::dvec3 there = point + way * slope - places[0];
    const double second = glm::dot(glm::cross(there, ac), normal),
                 third = glm::dot(glm::cross(ab, there), normal);
    if (second < 0.0 || third < 0.0 || second + third > size) return false;
    add(values.x + (second * (values.y - values.x) + third * (values.z - values.x)) / size);
    return found();
}

}  // namespace

bool CollapseState::allows(const Collapse& collapse, double distance) const {
    return keepsTopology(collapse) && keepsFaces(collapse) && keepsInside(collapse) &&
           keepsPoints(collapse, distance);
}

bool CollapseState::keepsTopology(const Collapse& collapse) const {
    // The two have those two neighbours in common that are across from their edge, and no other.
    const std::span<const Spoke> star = stars.at(collapse.from), other = stars.at(collapse.to);
    int common = 0;
    for (const Spoke& spoke : star) {
        const uint32_t ring = spoke.next;
        if (ring == collapse.to) continue;
        for (const Spoke& around : other)
            if (around.next == ring || around.previous == ring) {
                ++common;
                break;
            }
    }
    if (common != 2) return false;
    if (star.size() > 3) return true;
    // The triangle that three around a vertex become is not there yet.
    bool there = false;
    forChanged(star, collapse.to, [&](const Spoke& spoke) {
        for (const Spoke& around : other)
            there = there || (around.next == spoke.next && around.previous == spoke.previous) ||
                    (around.next == spoke.previous && around.previous == spoke.next);
    });
    return !there;
}

bool CollapseState::keepsFaces(const Collapse& collapse) const {
    const std::span<const Spoke> star = stars.at(collapse.from);
    float worst = kThin;
    glm::vec3 sum(0.0f);
    for (const Spoke& spoke : star) {
        const CollapseFace& face = faces[spoke.triangle()];
        worst = std::min(worst, face.shape);
        sum += face.area * face.normal;
    }
    bool kept = true;
    forChanged(star, collapse.to, [&](const Spoke& spoke) {
        if (!kept) return;
        const CollapseFace &before = faces[spoke.triangle()],
                           after = faceOf(positions[collapse.to], positions[spoke.next],
                                          positions[spoke.previous]);
        const float turn = before.shape > kSliver ? glm::dot(after.normal, before.normal) - kTurned
                                                  : glm::dot(after.normal, sum);
        kept = after.area > 0.0f && after.shape >= worst && turn > 0.0f;
    });
    return kept;
}

FewFaces CollapseState::fewFaces(const Collapse& collapse) const {
    FewFaces part;
    if (!closed || partTriangles[parts[collapse.from]] > part.triangles.size()) return part;
    const auto add = [&](uint32_t vertex) {
        for (const Spoke& spoke : stars.at(vertex)) {
            if (std::ranges::find(part.all(), spoke.triangle()) != part.all().end()) continue;
            if (part.count == part.triangles.size()) return false;
            part.triangles[part.count++] = spoke.triangle();
        }
        return true;
    };
    bool few = add(collapse.from) && add(collapse.to);
    for (std::size_t i = 0; few && i < 3 * part.count; ++i)
        few = add(indices[3 * std::size_t(part.triangles[i / 3]) + i % 3]);
    return few ? part : FewFaces{};
}

bool CollapseState::keepsInside(const Collapse& collapse) const {
    const FewFaces part = fewFaces(collapse);
    double before = 0.0, after = 0.0;
    for (const uint32_t triangle : part.all()) {
        std::array<glm::dvec3, 3> old{}, made{};
        for (std::size_t k = 0; k < 3; ++k) {
            const uint32_t corner = indices[3 * std::size_t(triangle) + k];
            old[k] = placeOf(corner) - placeOf(collapse.to);
            if (corner != collapse.from) made[k] = old[k];
        }
        before += glm::dot(old[0], glm::cross(old[1], old[2]));
        after += glm::dot(made[0], glm::cross(made[1], made[2]));
    }
    return part.count == 0 || after * before > kKept * before * before;
}

bool CollapseState::keepsLook(const CarriedPoints::Point& point, std::span<const uint32_t, 3> corners,
                              const glm::dvec3& weights, double distance) const {
    if (point.vertex == CarriedPoints::kNone) return true;
    const std::array<glm::dvec3, 3> places{placeOf(corners[0]), placeOf(corners[1]), placeOf(corners[2])};
    for (int k = 0; k < 3 && !colors.empty(); ++k)
        if (!isNear(colors[point.vertex][k],
                    {colors[corners[0]][k], colors[corners[1]][k], colors[corners[2]][k]}, places, weights,
                    distance))
            return false;
    const auto same = [&](std::size_t i) { return labels[corners[i]] == labels[point.vertex] ? 1.0 : 0.0; };
    return labels.empty() || isNear(1.0, {same(0), same(1), same(2)}, places, weights, distance);
}

bool CollapseState::keepsPoints(const Collapse& collapse, double distance) const {
    const std::span<const Spoke> star = stars.at(collapse.from);
    const bool looks = features && (!colors.empty() || !labels.empty());
    const glm::dvec3 apex = placeOf(collapse.to);
    const auto kept = [&](const CarriedPoints::Point& point) {
        const double within = std::min(distance, double(point.allowance));
        const double squared = within * within;
        const glm::dvec3 place = glm::dvec3(point.place) - middle;
        NearestWeights nearest{std::numeric_limits<double>::infinity(), {}};
        const Spoke* at = nullptr;
        forChanged(star, collapse.to, [&](const Spoke& spoke) {
            if (at && !looks && nearest.squared <= squared) return;
            const NearestWeights on =
                nearestWeights(place, apex, placeOf(spoke.next), placeOf(spoke.previous));
            if (!at || on.squared < nearest.squared) nearest = on, at = &spoke;
        });
        if (!at || !(nearest.squared <= squared)) return false;
        return !looks ||
               keepsLook(point, std::array{collapse.to, at->next, at->previous}, nearest.weights, distance);
    };
    return std::ranges::all_of(star, [&](const Spoke& spoke) { return carried.all(spoke.triangle(), kept); });
}

}  // namespace fw
