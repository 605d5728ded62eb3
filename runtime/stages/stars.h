// The triangles around each vertex, in the order in which they follow one another.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fw {

/// A triangle at a vertex.
struct Spoke {
    uint32_t corner;          ///< the vertex's, of all corners: triangle corner / 3
    uint32_t next, previous;  ///< vertices behind and before it in the triangle
    uint32_t triangle() const { return corner / 3; }
};

class Stars {
  public:
    /// Of triangles over so many vertices. None of the triangles is to have two equal corners.
    void find(std::span<const uint32_t> indices, std::size_t vertices);

    /// Where the star is closed, the previous vertex of each is the next of the one behind it, all around.
    std::span<const Spoke> at(std::size_t vertex) const {
        return std::span(spokes).subspan(starts[vertex], starts[vertex + 1] - starts[vertex]);
    }
    /// Whether the triangles at a vertex are one fan that goes all around it: not on a border, nor where more
    /// than two triangles meet at an edge, or fans at a point.
    bool closed(std::size_t vertex) const { return around[vertex] != 0; }

  private:
    std::vector<uint32_t> starts;  ///< one more than vertices
    std::vector<Spoke> spokes;
    std::vector<char> around;
};

}  // namespace fw
