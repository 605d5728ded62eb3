#include "runtime/mesh/edges.h"

#include <algorithm>

namespace fw {

Edges edgesOf(std::span<const uint32_t> indices, std::size_t vertices) {
    constexpr uint32_t kNone = ~0u;
    Edges edges;
    edges.ends.reserve(indices.size() / 2);  // of a closed solid
    edges.ofCorner.resize(indices.size());
    // Lists of those that have the same lower vertex, the newest first.
    std::vector<uint32_t> newest(vertices, kNone), older;
    older.reserve(indices.size() / 2);
    for (std::size_t corner = 0; corner < indices.size(); ++corner) {
        const auto [lower, upper] =
            std::minmax(indices[corner], indices[corner % 3 == 2 ? corner - 2 : corner + 1]);
        uint32_t edge = newest[lower];
        while (edge != kNone && edges.ends[edge].y != upper) edge = older[edge];
        if (edge == kNone) {
            edge = uint32_t(edges.ends.size());
            edges.ends.push_back({lower, upper});
            older.push_back(newest[lower]);
            newest[lower] = edge;
        }
        edges.ofCorner[corner] = edge;
    }
    return edges;
}

}  // namespace fw
