#include "runtime/stages/stars.h"

#include <algorithm>

#include "graph/base/parallel.h"

namespace fw {

namespace {

/// Brings the triangles of a vertex into their order; whether they go all around it.
bool orderAround(std::span<Spoke> star) {
    if (star.size() < 3) return false;
    for (std::size_t i = 0; i + 1 < star.size(); ++i) {
        std::size_t follows = star.size();
        for (std::size_t j = i + 1; j < star.size(); ++j)
            if (star[j].next == star[i].previous) {
                if (follows < star.size()) return false;
                follows = j;
            }
        if (follows == star.size()) return false;
        std::swap(star[i + 1], star[follows]);
    }
    return star.back().previous == star.front().next;
}

}  // namespace

void Stars::find(std::span<const uint32_t> indices, std::size_t vertices) {
    starts.assign(vertices + 1, 0);
    for (const uint32_t index : indices) ++starts[index];
    uint32_t sum = 0;
    for (uint32_t& start : starts) sum += start, start = sum;  // the ends, which filling moves to the starts
    spokes.resize(indices.size());
    for (std::size_t i = indices.size(); i >= 3; i -= 3) {
        const uint32_t* const triangle = &indices[i - 3];
        for (std::size_t k = 3; k-- > 0;)
            spokes[--starts[triangle[k]]] = {uint32_t(i - 3 + k), triangle[(k + 1) % 3],
                                             triangle[(k + 2) % 3]};
    }
    around.resize(vertices);
    forBlocks(vertices, 16384, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t v = first; v < last; ++v)
            around[v] = orderAround({spokes.data() + starts[v], starts[v + 1] - starts[v]});
    });
}

}  // namespace fw
