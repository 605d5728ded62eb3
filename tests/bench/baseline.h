// The plain C++ program that the mesher is measured against: dense field, indexed marching cubes, two
// threads.
//
// Written as a competent programmer would on a first day, and no further: one pass samples the field into a
// dense grid of (N+1)^3 floats; one classifies the cells and makes one vertex per active edge, remembering
// its index per grid edge; one writes the indices through that lookup. No culling, no bit tricks, no
// intrinsics; the compiler has -O3 -march=native and the field inlined. Buffers stay allocated between runs,
// so no run pays for fresh pages.
//
// The same mesh comes out on every run: each thread takes a slab of the grid, and the first slab's vertices
// precede the second's. It leaves out the normals that the GPU mesher writes, which favours the baseline.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/mesh/mesh.h"
#include "tests/bench/fields.h"

namespace fw::bench {

struct BaselineTimes {
    double sampleMs = 0, vertexMs = 0, indexMs = 0;
    double totalMs() const { return sampleMs + vertexMs + indexMs; }
};

/// The baseline with its buffers, for grids of one size. About 4 bytes a sample, and 12 a sample of address
/// space of which only pages near the surface are touched.
class Baseline {
  public:
    /// `cells`: cells along each edge of the field's region, 1 or more.
    explicit Baseline(int cells);

    /// Meshes the field over its cube [-regionHalf, regionHalf]^3; positions and indices are replaced. A
    /// sample >= 0 is outside.
    BaselineTimes run(Field field);

    std::span<const glm::vec3> positions() const { return vertices; }
    std::span<const uint32_t> indices() const { return corners; }
    /// The field's samples of the last run, x fastest, (cells + 1)^3.
    std::span<const float> samples() const { return {grid.get(), side * side * side}; }

  private:
    struct ActiveCell {
        uint32_t point;  ///< index of its lowest corner within its slice z
        uint16_t z;
        uint8_t code;  ///< bit c set: corner (c & 1, c >> 1 & 1, c >> 2) is inside
    };
    /// What one thread finds in its slab.
    struct Slab {
        std::vector<glm::vec3> vertices;
        std::vector<ActiveCell> cells;
        std::size_t triangles = 0;
    };

    template <class F>
    void sample(glm::vec3 origin, float spacing, std::size_t firstZ, std::size_t lastZ);
    void classify(glm::vec3 origin, float spacing, std::size_t firstZ, std::size_t lastZ, Slab& slab);
    void writeIndices(const Slab& slab, std::size_t firstTriangle);

    std::size_t side;  ///< samples along an edge
    std::unique_ptr<float[]> grid;
    std::unique_ptr<uint32_t[]>
        lookup;  ///< vertex of the edge that leaves a point along axis a: [3 * point + a]
    std::array<Slab, 2> slabs;
    std::vector<glm::vec3> vertices;
    std::vector<uint32_t> corners;
};

}  // namespace fw::bench
