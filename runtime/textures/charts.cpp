#include "runtime/textures/charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "runtime/mesh/corners.h"
#include "runtime/textures/raster.h"

namespace fw {
namespace {

constexpr uint32_t kNone = ~0u;
constexpr float kFirstCone = 0.64f;  ///< cosine: 50 degrees
constexpr float kCone = 0.5f;        ///< 60 degrees
constexpr float kAstray = 0.45f;     ///< of a triangle's own normal: 63 degrees from the field's
constexpr int kRounds = 3;
constexpr float kSmall = 1.0f / 4;     ///< of the mean region's area
constexpr float kCrumb = 1.0f / 4096;  ///< of the whole area: some texels of a texture
constexpr int kSteps = 64;             ///< that a cosine is sorted by

glm::vec3 unitOr(glm::vec3 v, glm::vec3 other) {
    const float length = glm::length(v);
    return length > 0.0f && std::isfinite(length) ? v / length : other;
}

class ChartGrowth {
  public:
    explicit ChartGrowth(const Mesh& mesh_) : mesh(mesh_), neighbours(neighboursOf(mesh_)) {
        const std::size_t count = mesh.triangleCount();
        facing.resize(count);
        smooth.resize(count);
        area.resize(count);
        for (std::size_t t = 0; t < count; ++t) {
            const uint32_t* corner = &mesh.indices[3 * t];
            const glm::vec3 a = mesh.positions[corner[0]];
            const glm::vec3 cross = glm::cross(mesh.positions[corner[1]] - a, mesh.positions[corner[2]] - a);
            area[t] = 0.5f * glm::length(cross);
            facing[t] = unitOr(cross, glm::vec3(0.0f));
            glm::vec3 sum(0.0f);
            if (!mesh.normals.empty())
                for (int k = 0; k < 3; ++k) sum += mesh.normals[corner[k]];
            smooth[t] = unitOr(sum, facing[t] == glm::vec3(0.0f) ? glm::vec3(0, 1, 0) : facing[t]);
            // Slivers may face anywhere; what lies across the field's normal is by itself.
            if (facing[t] != glm::vec3(0.0f) && glm::dot(smooth[t], facing[t]) < kAstray)
                smooth[t] = facing[t];
        }
    }

    Charts make() {
        of.assign(mesh.triangleCount(), kNone);
        found(kFirstCone);
        for (int round = 0; round < kRounds; ++round) regrow();
        joinSmall();
        joinCrumbs();
        splitOverlaps();
        return compacted();
    }

  private:
    bool fits(std::size_t triangle, glm::vec3 axis, float cone) const {
        return glm::dot(smooth[triangle], axis) >= cone &&
               (facing[triangle] == glm::vec3(0.0f) || glm::dot(facing[triangle], axis) >= kLeastCosine);
    }

    /// Triangles that wait to join a region, nearest normals first.
    struct Waiting {
        std::array<std::vector<std::pair<uint32_t, uint32_t>>, kSteps> steps;  ///< triangle, region
        int lowest = kSteps;

        void add(uint32_t triangle, uint32_t region, float cosine) {
            const int step = std::clamp(int((1.0f - cosine) * kSteps), 0, kSteps - 1);
            steps[std::size_t(step)].emplace_back(triangle, region);
            lowest = std::min(lowest, step);
        }
        bool take(std::pair<uint32_t, uint32_t>& next) {
            while (lowest < kSteps && steps[std::size_t(lowest)].empty()) ++lowest;
            if (lowest == kSteps) return false;
            next = steps[std::size_t(lowest)].back();
            steps[std::size_t(lowest)].pop_back();
            return true;
        }
    };

    void callNeighbours(uint32_t triangle, uint32_t region, float cone) {
        for (std::size_t k = 0; k < 3; ++k) {
            const uint32_t other = neighbours[3 * triangle + k];
            if (other != kNoTriangle && of[other] == kNone && fits(other, axes[region], cone))
                waiting.add(other, region, glm::dot(smooth[other], axes[region]));
        }
    }

    void flood(float cone) {
        for (std::pair<uint32_t, uint32_t> next; waiting.take(next);) {
            if (of[next.first] != kNone) continue;
            of[next.first] = next.second;
            callNeighbours(next.first, next.second, cone);
        }
    }

    void begin(uint32_t triangle, glm::vec3 axis, float cone) {
        axes.push_back(axis);
        of[triangle] = uint32_t(axes.size()) - 1;
        callNeighbours(triangle, of[triangle], cone);
    }

    /// Regions for all triangles that have none.
    void found(float cone) {
        for (uint32_t t = 0; t < of.size(); ++t) {
            if (of[t] != kNone) continue;
            begin(t, smooth[t], cone);
            flood(cone);
        }
    }

    std::vector<float> regionAreas() const {
        std::vector<float> areas(axes.size(), 0.0f);
        for (std::size_t t = 0; t < of.size(); ++t) areas[of[t]] += area[t];
        return areas;
    }

    /// All regions but the small ones again, from their best triangles about their mean normals.
    void regrow() {
        const std::vector<float> areas = regionAreas();
        const float least = kSmall * std::accumulate(areas.begin(), areas.end(), 0.0f) / float(areas.size());
        std::vector<glm::vec3> sums(axes.size(), glm::vec3(0.0f));
        for (std::size_t t = 0; t < of.size(); ++t) sums[of[t]] += area[t] * smooth[t];
        std::vector<uint32_t> best(axes.size(), kNone);
        for (std::size_t r = 0; r < axes.size(); ++r) axes[r] = unitOr(sums[r], axes[r]);
        for (uint32_t t = 0; t < of.size(); ++t) {
            uint32_t& now = best[of[t]];
            const glm::vec3 axis = axes[of[t]];
            if (fits(t, axis, kFirstCone) &&
                (now == kNone || glm::dot(smooth[t], axis) > glm::dot(smooth[now], axis)))
                now = t;
        }
        const std::vector<glm::vec3> before = std::move(axes);
        axes.clear();
        std::ranges::fill(of, kNone);
        for (std::size_t r = 0; r < before.size(); ++r)
            if (areas[r] >= least && best[r] != kNone) begin(best[r], before[r], kCone);
        flood(kCone);
        found(kCone);
    }

    /// Small regions join the neighbour that they share most edges with, of those whose cone they are in.
    void joinSmall() {
        std::vector<std::vector<uint32_t>> members(axes.size());
        for (uint32_t t = 0; t < of.size(); ++t) members[of[t]].push_back(t);
        const std::vector<float> areas = regionAreas();
        const float least = kSmall * std::accumulate(areas.begin(), areas.end(), 0.0f) / float(areas.size());
        std::vector<uint32_t> order(axes.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, {}, [&](uint32_t r) { return areas[r]; });
        std::vector<uint32_t> beside;
        for (const uint32_t region : order) {
            if (areas[region] >= least) break;
            beside.clear();
            for (const uint32_t t : members[region])
                for (std::size_t k = 0; k < 3; ++k)
                    if (const uint32_t other = neighbours[3 * t + k];
                        other != kNoTriangle && of[other] != region)
                        beside.push_back(of[other]);
            std::ranges::sort(beside);
            uint32_t chosen = kNone;
            std::size_t most = 0;
            for (std::size_t first = 0, last = 0; first < beside.size(); first = last) {
                while (last < beside.size() && beside[last] == beside[first]) ++last;
                const glm::vec3 axis = axes[beside[first]];
                if (last - first > most && std::ranges::all_of(members[region], [&](uint32_t t) {
                        return fits(t, axis, kLeastCosine);
                    }))
                    most = last - first, chosen = beside[first];
            }
            if (chosen == kNone) continue;
            for (const uint32_t t : members[region]) of[t] = chosen;
            members[chosen].insert(members[chosen].end(), members[region].begin(), members[region].end());
            members[region].clear();
        }
    }

    /// Triangles of regions that are small still, slivers along sharp edges mostly, join one by one.
    void joinCrumbs() {
        for (int round = 0; round < kRounds; ++round) {
            const std::vector<float> areas = regionAreas();
            const float least = kCrumb * std::accumulate(areas.begin(), areas.end(), 0.0f);
            for (uint32_t t = 0; t < of.size(); ++t) {
                if (areas[of[t]] >= least) continue;
                float nearest = -1.0f;
                for (std::size_t k = 0; k < 3; ++k) {
                    const uint32_t other = neighbours[3 * std::size_t(t) + k];
                    if (other == kNoTriangle || areas[of[other]] <= areas[of[t]]) continue;
                    const glm::vec3 axis = axes[of[other]];
                    if (!fits(t, axis, kLeastCosine) || glm::dot(smooth[t], axis) <= nearest) continue;
                    nearest = glm::dot(smooth[t], axis);
                    of[t] = of[other];
                }
            }
        }
    }

    /// Triangles that cover what others of their region cover found regions of their own, with the same axis.
    void splitOverlaps() {
        const float whole = std::accumulate(area.begin(), area.end(), 0.0f);
        const float density = float(kOverlapRaster) / std::sqrt(std::max(whole, 1e-30f));
        std::vector<std::vector<uint32_t>> members(axes.size());
        for (uint32_t t = 0; t < of.size(); ++t) members[of[t]].push_back(t);
        std::vector<uint8_t> covered;
        for (std::size_t region = 0; region < members.size(); ++region) {
            const std::vector<uint32_t> all = std::move(members[region]);
            if (all.empty()) continue;
            const ChartPlane plane = planeOf(axes[region]);
            const auto flat = [&](uint32_t vertex) {
                return glm::vec2(glm::dot(mesh.positions[vertex], plane.right),
                                 glm::dot(mesh.positions[vertex], plane.up));
            };
            glm::vec2 low(1e30f), high(-1e30f);
            for (const uint32_t t : all)
                for (std::size_t k = 0; k < 3; ++k) {
                    low = glm::min(low, flat(mesh.indices[3 * t + k]));
                    high = glm::max(high, flat(mesh.indices[3 * t + k]));
                }
            // What is thin and wide has a coarser raster, for want of memory.
            const glm::vec2 extent = glm::max(high - low, glm::vec2(1e-20f));
            const float fine =
                std::min(density, std::sqrt(2.0f / (extent.x * extent.y)) * float(kOverlapRaster));
            const auto side = [&](float along) {
                return int(std::min(along * fine + 1.0f, 16.0f * kOverlapRaster));
            };
            const int width = side(extent.x), height = side(extent.y);
            covered.assign(std::size_t(width) * std::size_t(height), 0);
            std::vector<uint32_t> over;
            for (const uint32_t t : inOrder(all)) {
                const uint32_t* corner = &mesh.indices[3 * t];
                const glm::vec2 a = fine * (flat(corner[0]) - low), b = fine * (flat(corner[1]) - low),
                                c = fine * (flat(corner[2]) - low);
                const auto place = [&](int x, int y) -> uint8_t& {
                    return covered[std::size_t(y) * std::size_t(width) + std::size_t(x)];
                };
                uint8_t most = 0;
                forTexels(a, b, c, width, height,
                          [&](int x, int y) { most = std::max(most, ++place(x, y)); });
                if (most < 2) continue;
                over.push_back(t);
                forTexels(a, b, c, width, height, [&](int x, int y) { --place(x, y); });
            }
            if (over.empty()) continue;
            for (const uint32_t t : over) of[t] = kNone;
            for (const uint32_t t : over) {
                if (of[t] != kNone) continue;
                begin(t, axes[region], kLeastCosine);
                flood(kLeastCosine);
                members.emplace_back();
            }
            for (const uint32_t t : over) members[of[t]].push_back(t);
        }
    }

    /// Triangles of one region so that each but the first of a piece follows one beside it.
    std::vector<uint32_t> inOrder(const std::vector<uint32_t>& triangles) {
        seen.resize(of.size(), 0);
        std::vector<uint32_t> order;
        order.reserve(triangles.size());
        for (const uint32_t start : triangles) {
            if (seen[start]) continue;
            std::size_t next = order.size();
            order.push_back(start);
            for (seen[start] = 1; next < order.size(); ++next)
                for (std::size_t k = 0; k < 3; ++k) {
                    const uint32_t other = neighbours[3 * order[next] + k];
                    if (other == kNoTriangle || of[other] != of[start] || seen[other]) continue;
                    seen[other] = 1;
                    order.push_back(other);
                }
        }
        for (const uint32_t t : triangles) seen[t] = 0;
        return order;
    }

    Charts compacted() const {
        Charts charts;
        std::vector<uint32_t> number(axes.size(), kNone);
        charts.ofTriangle.reserve(of.size());
        for (const uint32_t region : of) {
            if (number[region] == kNone) {
                number[region] = uint32_t(charts.axes.size());
                charts.axes.push_back(axes[region]);
            }
            charts.ofTriangle.push_back(number[region]);
        }
        return charts;
    }

    const Mesh& mesh;
    std::vector<uint32_t> neighbours;
    std::vector<glm::vec3> facing;  ///< by the corners; zero without an area
    std::vector<glm::vec3> smooth;  ///< by the field
    std::vector<float> area;
    std::vector<uint32_t> of;  ///< region of each triangle
    std::vector<glm::vec3> axes;
    Waiting waiting;
    std::vector<char> seen;
};

}  // namespace

ChartPlane planeOf(glm::vec3 axis) {
    const glm::vec3 aside = std::abs(axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    const glm::vec3 right = glm::normalize(glm::cross(aside, axis));
    return {right, glm::cross(axis, right)};
}

std::vector<uint32_t> neighboursOf(const Mesh& mesh) {
    const Corners corners = cornersOf(mesh.indices, mesh.positions.size());
    std::vector<uint32_t> neighbours(mesh.indices.size(), kNoTriangle);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const uint32_t from = mesh.indices[i], to = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
        if (from == to) continue;
        for (const uint32_t corner : corners.at(from)) {
            const uint32_t before = corner % 3 == 0 ? corner + 2 : corner - 1;
            if (mesh.indices[before] == to) neighbours[i] = corner / 3;
        }
    }
    return neighbours;
}

void splitOff(Charts& charts, const Mesh& mesh, const std::vector<uint32_t>& triangles) {
    const std::vector<uint32_t> neighbours = neighboursOf(mesh);
    std::vector<char> waits(charts.ofTriangle.size(), 0);
    for (const uint32_t t : triangles) waits[t] = 1;
    for (const uint32_t start : triangles) {
        if (!waits[start]) continue;
        const uint32_t before = charts.ofTriangle[start];
        const glm::vec3 axis = charts.axes[before];
        charts.axes.push_back(axis);
        std::vector<uint32_t> open{start};
        waits[start] = 0;
        while (!open.empty()) {
            const uint32_t t = open.back();
            open.pop_back();
            charts.ofTriangle[t] = uint32_t(charts.axes.size()) - 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const uint32_t other = neighbours[3 * std::size_t(t) + k];
                if (other == kNoTriangle || !waits[other] || charts.ofTriangle[other] != before) continue;
                waits[other] = 0;
                open.push_back(other);
            }
        }
    }
}

Charts chartsOf(const Mesh& mesh) { return ChartGrowth(mesh).make(); }

}  // namespace fw
