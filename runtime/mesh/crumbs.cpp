#include "runtime/mesh/crumbs.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "graph/assets/triangle_tree.h"
#include "runtime/mesh/joined_sets.h"

namespace fw {

namespace {

/// What hangs together: a closed sheet of triangles.
struct Sheet {
    double volume = 0.0;  ///< below 0 of a void
    glm::vec3 lo{std::numeric_limits<float>::infinity()}, hi{-std::numeric_limits<float>::infinity()};
    std::vector<uint32_t> triangles = {};
    bool dropped = false;

    bool surrounds(const Sheet& other) const {
        return glm::all(glm::lessThan(lo, other.lo)) && glm::all(glm::greaterThan(hi, other.hi));
    }
};

/// Whether a sheet goes around a place, by its solid angle there.
bool encloses(const Mesh& mesh, const Sheet& sheet, const glm::dvec3& place) {
    double share = 0.0;
    for (const uint32_t triangle : sheet.triangles) {
        const auto corner = [&](std::size_t k) {
            return glm::dvec3(mesh.positions[mesh.indices[3 * std::size_t(triangle) + k]]) - place;
        };
        share += solidAngle(corner(0), corner(1), corner(2));
    }
    return std::abs(share) > 0.5;
}

/// Those of a mesh whose vertices at one place are one, or doubled at creases.
std::vector<Sheet> sheetsOf(const Mesh& mesh) {
    JoinedSets sets(mesh.positions.size());
    joinPlaces(mesh.positions, sets);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) sets.join(mesh.indices[i], mesh.indices[i - i % 3]);
    std::map<uint32_t, std::size_t> numbers;
    std::vector<Sheet> sheets;
    for (uint32_t triangle = 0; triangle < mesh.triangleCount(); ++triangle) {
        const uint32_t* corners = &mesh.indices[3 * std::size_t(triangle)];
        const auto [number, fresh] = numbers.try_emplace(sets.root(corners[0]), sheets.size());
        if (fresh) sheets.emplace_back();
        Sheet& sheet = sheets[number->second];
        sheet.triangles.push_back(triangle);
        std::array<glm::dvec3, 3> a;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3& p = mesh.positions[corners[k]];
            sheet.lo = glm::min(sheet.lo, p), sheet.hi = glm::max(sheet.hi, p);
            a[k] = p;
        }
        sheet.volume += glm::dot(a[0], glm::cross(a[1], a[2])) / 6.0;
    }
    return sheets;
}

/// Only the triangles for which `kept` is set, and their vertices.
void keepOnly(Mesh& mesh, const std::vector<bool>& kept) {
    constexpr uint32_t kNone = ~0u;
    std::vector<uint32_t> place(mesh.positions.size(), kNone), order;
    std::vector<uint32_t> indices;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (kept[i / 3]) place[mesh.indices[i]] = 0;
    for (uint32_t vertex = 0; vertex < place.size(); ++vertex)
        if (place[vertex] != kNone) place[vertex] = uint32_t(order.size()), order.push_back(vertex);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (kept[i / 3]) indices.push_back(place[mesh.indices[i]]);
    mesh.indices = std::move(indices);
    const auto pick = [&](auto& all) {
        if (all.empty()) return;
        auto some = std::remove_reference_t<decltype(all)>();
        for (const uint32_t vertex : order) some.push_back(all[vertex]);
        all = std::move(some);
    };
    pick(mesh.positions), pick(mesh.normals), pick(mesh.colors), pick(mesh.uvs), pick(mesh.tangents);
}

}  // namespace

bool leaveOutCrumbs(Mesh& mesh, double least) {
    assert(mesh.parts.empty());
    std::vector<Sheet> sheets = sheetsOf(mesh);
    double largest = 0.0;
    for (const Sheet& sheet : sheets) largest = std::max(largest, sheet.volume);
    std::size_t dropped = 0;
    for (Sheet& sheet : sheets)
        dropped += sheet.dropped = sheet.volume >= 0.0 && sheet.volume < std::min(least, 1.0) * largest;
    if (dropped == 0) return false;
    const std::vector<Sheet> all = sheets;
    for (Sheet& sheet : sheets) {
        if (sheet.volume >= 0.0) continue;
        // The smallest solid that goes around a void is the one that it is in.
        const Sheet* around = nullptr;
        for (const Sheet& other : all)
            if (other.volume >= 0.0 && other.surrounds(sheet) && (!around || other.volume < around->volume) &&
                encloses(mesh, other, mesh.positions[mesh.indices[3 * std::size_t(sheet.triangles[0])]]))
                around = &other;
        sheet.dropped = around && around->dropped;
    }
    std::vector<bool> kept(mesh.triangleCount());
    for (const Sheet& sheet : sheets)
        for (const uint32_t triangle : sheet.triangles) kept[triangle] = !sheet.dropped;
    keepOnly(mesh, kept);
    return true;
}

}  // namespace fw
