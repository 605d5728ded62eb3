// The limit to be near: what a C++ program written for one field, one method and one processor takes.
//
// Nothing is stored but what the next plane needs: two planes of samples stream through the cache, their
// signs as bits, so that 32 cells without surface are passed over at once, and an edge's vertex is looked up
// in arrays of two planes. The field is compiled in with -O3 -march=native -ffast-math, by which its loop
// becomes AVX2 code, sines included. Two threads take half of the planes each; the second one's vertices and
// triangles are moved behind the first one's at the end. Vertices are interpolated between samples; there are
// no normals, which favours this program. Buffers stay allocated between runs.
//
// The mesh is that of the baseline, but for the order of vertices and samples of which the last bit decides.
#pragma once

#include <span>
#include <vector>

#include "runtime/mesh/mesh.h"
#include "tests/bench/fields.h"

namespace fw::bench {

/// The program with its buffers, for grids of one size.
class Tuned {
  public:
    /// `cells`: cells along each edge of the field's region, 1 or more.
    explicit Tuned(int cells);

    /// Meshes the field over its cube [-regionHalf, regionHalf]^3; positions and indices are replaced.
    /// Returns the time in ms.
    double run(Field field);

    std::span<const glm::vec3> positions() const { return {vertices.data(), vertexCount}; }
    std::span<const uint32_t> indices() const { return {corners.data(), cornerCount}; }

  private:
    /// What one thread holds: planes z and z + 1, and the vertices on their edges.
    struct Half {
        std::vector<float> samples[2];
        std::vector<uint8_t> signs[2];  ///< a bit each, rows padded to whole words and one more
        std::vector<uint32_t> lookup;   ///< x and y edges of either plane, z edges between them
        std::vector<glm::vec3> vertices;
        std::vector<uint32_t> corners;
        std::size_t vertexCount = 0, cornerCount = 0;
        std::size_t borrowed = 0;  ///< vertices at the start that are the other half's last ones
    };

    template <class F>
    void samplePlane(Half& half, std::size_t z) const;
    void placeInPlane(Half& half, std::size_t z) const;
    void placeBetween(Half& half, std::size_t z) const;
    void writeLayer(Half& half, std::size_t z) const;
    template <class F>
    void meshHalf(Half& half, std::size_t firstZ, std::size_t lastZ) const;

    std::size_t cells, side, rowBytes;
    float origin = 0, spacing = 0;
    std::vector<float> xs;  ///< of the samples
    std::array<Half, 2> halves;
    std::vector<glm::vec3> vertices;
    std::vector<uint32_t> corners;
    std::size_t vertexCount = 0, cornerCount = 0;
};

}  // namespace fw::bench
