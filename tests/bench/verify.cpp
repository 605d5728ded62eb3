#include "tests/bench/verify.h"

#include <algorithm>
#include <vector>

namespace fw::bench {

std::string faultOf(std::span<const uint32_t> indices, std::size_t vertexCount) {
    if (indices.empty()) return "the mesh is empty";
    if (indices.size() % 3 != 0) return "the indices are no multiple of three";
    // Directed edges bucketed by their lower vertex: a counting sort, since millions of edges are usual.
    std::vector<uint32_t> first(vertexCount + 1);
    std::vector<bool> used(vertexCount);
    for (std::size_t i = 0; i < indices.size(); i++) {
        if (indices[i] >= vertexCount) return "an index names no vertex: " + std::to_string(indices[i]);
        used[indices[i]] = true;
        const uint32_t next = indices[i % 3 == 2 ? i - 2 : i + 1];
        if (next >= vertexCount) return "an index names no vertex: " + std::to_string(next);
        if (next == indices[i]) return "a triangle names a vertex twice: " + std::to_string(next);
        first[std::min(indices[i], next) + 1]++;
    }
    for (std::size_t v = 0; v < vertexCount; v++) {
        if (!used[v]) return "no triangle uses vertex " + std::to_string(v);
        first[v + 1] += first[v];
    }
    // Of an edge, twice the higher vertex, plus 1 if it runs downwards.
    std::vector<uint64_t> edges(indices.size());
    std::vector<uint32_t> end(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < indices.size(); i++) {
        const uint32_t a = indices[i], b = indices[i % 3 == 2 ? i - 2 : i + 1];
        edges[end[std::min(a, b)]++] = 2 * uint64_t(std::max(a, b)) + (a > b);
    }
    for (std::size_t v = 0; v < vertexCount; v++) {
        std::sort(edges.begin() + first[v], edges.begin() + first[v + 1]);
        for (uint32_t i = first[v]; i < first[v + 1]; i += 2) {
            const bool pair = i + 1 < first[v + 1] && edges[i] % 2 == 0 && edges[i + 1] == edges[i] + 1;
            const bool again = pair && i + 2 < first[v + 1] && edges[i + 2] / 2 == edges[i] / 2;
            if (!pair || again)
                return "the edge between vertices " + std::to_string(v) + " and " +
                       std::to_string(edges[i] / 2) +
                       " is not shared by two triangles in opposite directions";
        }
    }
    return {};
}

}  // namespace fw::bench
