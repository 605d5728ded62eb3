#include "tests/bench/verify.h"

#include <algorithm>
#include <cmath>

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

std::vector<std::array<uint64_t, 3>> trianglesByEdge(std::span<const glm::vec3> positions,
                                                     std::span<const uint32_t> indices,
                                                     const GridEdges& grid) {
    const auto edgeOf = [&](glm::vec3 p) {
        const glm::vec3 at = (p - grid.origin) / grid.spacing;
        uint64_t axis = 0, key = 0;
        float farthest = 0;
        for (int i = 0; i < 3; i++) {
            const float off = std::abs(at[i] - std::round(at[i]));
            if (off > farthest) farthest = off, axis = i;
        }
        for (int i = 0; i < 3; i++)
            key = key << 20 | uint64_t(uint64_t(i) == axis ? std::floor(at[i]) : std::round(at[i]));
        return key << 2 | axis;
    };
    std::vector<uint64_t> edges(positions.size());
    std::transform(positions.begin(), positions.end(), edges.begin(), edgeOf);
    std::vector<std::array<uint64_t, 3>> triangles(indices.size() / 3);
    for (std::size_t t = 0; t < triangles.size(); t++) {
        auto& triangle = triangles[t];
        for (int i = 0; i < 3; i++) triangle[i] = edges[indices[3 * t + i]];
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

}  // namespace fw::bench
