// From particles to a density: density(P) = sum over particles of (1 - r^2 / R^2)^3, r the distance to P,
// nothing beyond R.
//
// The three ways of Matt Swoboda's "Advanced Procedural Rendering in DirectX 11" (GDC 2012), "SDFs From
// Particle Systems":
//
// Exact: particles sorted into buckets, all in the buckets around a sample summed. Here buckets are as large
// as R, so that 27 of them matter, not 729 cells; three in a row lie in one piece.
//
// Proxies: each particle adds its place and a count to its cell of the grid; then each sample sums over the
// cells around it, taking each for its particles' mean. Off where a cell's particles are apart.
//
// Blur: each particle adds its weight to the eight samples around it, and three blurs, one along each axis,
// spread it. A product of three weights is not the density's formula: the weights are those whose products
// are nearest to it, as the power method finds them (the best separable one in the sense of least squares).
//
// How far off the two are, is measured by the tests and the benchmark.
//
// Deviations: sums in the grid are of whole numbers, so that the same particles give the same bytes on every
// run; and between the blurs samples are of 16 bits, at most a 4,096th off.
//
// Lifetime: kernels serve all densities; buffers grow.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <vector>

#include "graph/compile/particle_recipe.h"
#include "runtime/gpu/counting_sort.h"

namespace fw {

namespace gpu {
struct DensityPush;
}

struct DensityKernels {
    CountingSort sort;
    Pipeline bucket, gather, exact, splatProxies, proxies, splat;
    std::map<int, std::array<Pipeline, 3>> blurs;  ///< by the reach in cells, made when first used; x, y, z
};
DensityKernels createDensityKernels(const Device& device);

struct DensityBuffers {
    CountingSortBuffers buckets;
    Buffer keys, order, sorted;
    Buffer grid, blurredX, blurredY, weights;
    Buffer density;  ///< the result: a float a sample, rows padded to four
};

/// Samples at origin + cell * (i, j, k).
struct DensityGrid {
    glm::vec3 origin{0.0f};  ///< metres
    float cell = 1.0f;
    glm::ivec3 size{1};
};

struct DensityConfig {
    DensityGrid grid;
    float radius = 1.0f;  ///< R, metres
    DensityMethod method = DensityMethod::blur;
};

/// Records the density of so many particles at each sample, into buffers.density. `particles` has four floats
/// each, of which the first three are the place; those that are not numbers are left out. Errors: a radius of
/// 0 or without end, of more than 12 cells by blur or 20 by proxies; a grid that is more than the device can
/// bind.
Done recordDensity(Commands& commands, DensityKernels& kernels, DensityBuffers& buffers,
                   const DensityConfig& config, const Buffer& particles, uint32_t count);

/// Records the particles by the buckets of the push constants: buffers.sorted has the places in sides of a
/// bucket, buckets.starts the first of each bucket, the last of which has all that are in none.
void recordSorted(Commands& commands, const DensityKernels& kernels, DensityBuffers& buffers,
                  const gpu::DensityPush& push, const Buffer& particles);

/// Samples of a grid in buffers, with rows padded to four.
uint32_t paddedSamples(const DensityGrid& grid);

/// Weights of a blur, from the middle on, whose products are nearest to the density of a particle `radius`
/// cells wide.
std::vector<float> blurWeights(double radius);

}  // namespace fw
