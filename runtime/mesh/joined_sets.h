// Which vertices of a mesh hang together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numeric>
#include <span>
#include <vector>

namespace fw {

/// Sets of numbers that are joined: each has the least of it as its root (Tarjan 1975, with path halving).
struct JoinedSets {
    std::vector<uint32_t> above;

    explicit JoinedSets(std::size_t count) : above(count) { std::iota(above.begin(), above.end(), 0u); }
    uint32_t root(uint32_t of) {
        while (above[of] != of) of = above[of] = above[above[of]];
        return of;
    }
    void join(uint32_t a, uint32_t b) {
        a = root(a), b = root(b);
        above[std::max(a, b)] = std::min(a, b);
    }
};

/// Joins the vertices that lie at one place.
inline void joinPlaces(std::span<const glm::vec3> positions, JoinedSets& sets) {
    std::vector<uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto before = [&](uint32_t a, uint32_t b) {
        const glm::vec3 p = positions[a], q = positions[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    std::sort(order.begin(), order.end(), before);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (positions[order[i - 1]] == positions[order[i]]) sets.join(order[i - 1], order[i]);
}

}  // namespace fw
