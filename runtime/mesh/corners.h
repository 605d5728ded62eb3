// Which triangles meet at a vertex.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fw {

/// Whether two corners of a triangle are one vertex.
inline bool collapsed(const uint32_t* triangle) {
    return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
}

/// The corners at each vertex: corner 3 t + k is entry k of triangle t; collapsed triangles have none. Those
/// of a vertex are in the order of their triangles.
struct Corners {
    std::vector<uint32_t> start;  ///< one more than vertices
    std::vector<uint32_t> corner;
    uint32_t degree(std::size_t vertex) const { return start[vertex + 1] - start[vertex]; }
    std::span<const uint32_t> at(std::size_t vertex) const {
        return std::span(corner).subspan(start[vertex], degree(vertex));
    }
};

/// Of triangles over so many vertices; a counting sort.
Corners cornersOf(std::span<const uint32_t> indices, std::size_t vertices);

}  // namespace fw
