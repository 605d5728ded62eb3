// Which vertices of a mesh hang together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
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

}  // namespace fw
