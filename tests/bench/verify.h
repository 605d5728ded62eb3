// Checks of a mesh that a benchmark timed: a wrong mesh is quick to make.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace fw::bench {

/// Empty if every index names a vertex, every vertex is used, and every directed edge occurs once and is
/// paired with its reverse, so that the surface is closed and oriented; else what is wrong, as a sentence.
std::string faultOf(std::span<const uint32_t> indices, std::size_t vertexCount);

/// A grid whose edges the vertices of marching cubes lie on.
struct GridEdges {
    glm::vec3 origin;  ///< a grid point, metres
    float spacing;     ///< metres
};

/// The triangles, each vertex replaced by the number of the grid edge that it lies on, smallest number first
/// with the turning sense kept, sorted: equal for two meshes whose topology is the same, wherever on their
/// edges the vertices are. A vertex that lies within a thousandth of a cell of a grid point has no certain
/// edge and must not occur.
std::vector<std::array<uint64_t, 3>> trianglesByEdge(std::span<const glm::vec3> positions,
                                                     std::span<const uint32_t> indices,
                                                     const GridEdges& grid);

}  // namespace fw::bench
