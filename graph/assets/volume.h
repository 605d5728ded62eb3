// Distances on a grid: a field that was measured once, read as a function of (x, y, z).
//
// A field volume has samples at the corners of cubic cells. Each sample has a distance and the distance's
// gradient, the direction away from the nearest point of the surface. Between samples the distance is
// *tricubic*: the product of cubic Hermite polynomials along the axes through the eight samples around, their
// slopes being the stored gradients and their mixed derivatives zero. It is smooth (C1), passes through every
// sample and is exact for a plane. Eight loads are an eighth of what a Catmull-Rom spline needs, and slopes
// that were measured follow edges better than differences of samples. The *trilinear* layer ignores the
// gradients.
//
// Beyond the grid, at a point p, the value is sqrt(|p - q|^2 + d(q)^2), q being the nearest point of the
// grid, or the distance to the solid's box if that is more. The solid lies within the grid, whose box is
// convex, so that the angle at q is not acute: the value is never more than the distance. It is continuous
// and, as is the distance, 1-Lipschitz.
//
// The volume of *particles* (compile/particle_recipe.h) has other samples at every time. A program knows its
// grid alone; whoever plays the program makes the samples. Until then the solid may be anywhere in the grid.
// Its samples are near to distances, but by no rule, so that the bounds of values come from the least and the
// greatest samples of blocks: of four samples along each axis, of eight, and so on.
//
// The double functions here are the reference of shaders/lib/volume.glsl, which reads the same words.
//
// Lifetime: volumes are shared and never change; an Ir keeps those that its operations sample.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "graph/base/interval.h"

namespace fw {

/// Samples at `origin` + `cell` * (i, j, k); metres.
struct VolumeGrid {
    glm::dvec3 origin{0.0};
    double cell = 1.0;
    glm::ivec3 size{2};     ///< samples along each axis, at least 2
    glm::dvec3 inset{0.0};  ///< metres between each end of the grid and the solid's box

    std::size_t samples() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
    glm::dvec3 place(const glm::ivec3& at) const { return origin + cell * glm::dvec3(at); }
    std::size_t index(int x, int y, int z) const {
        return (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) + std::size_t(x);
    }
};

/// What the sampled distance to a mesh is taken for by whoever steps through it: the greatest length of the
/// gradient that was measured, 1.7, and some.
inline constexpr double kSampledLipschitz = 1.75;

/// What can be read of a volume. Colours, linear light from 0 to 1, are trilinear, and those of the grid's
/// border beyond it.
enum VolumeChannel { tricubicChannel, trilinearChannel, redChannel, greenChannel, blueChannel };
inline constexpr int kVolumeLayers = 5;

struct FieldVolume;
struct ParticleField;
struct TriangleMesh;

/// One function of (x, y, z), with what bounds it.
struct VolumeLayer {
    const FieldVolume* volume = nullptr;
    int channel = tricubicChannel;
    double least = 0.0, most = 1.0;  ///< within the grid
    // Of distances only, metres. Two values are apart by `slope` times the distance of their places at most;
    // a value r away from a place of known distance is off that by sqrt((r + shift)^2 + scatter^2) + rise.
    double slope = 0.0, shift = 0.0, scatter = 0.0, rise = 0.0;
};

struct VolumeSample {
    double value;
    glm::dvec3 gradient;
};

struct FieldVolume {
    /// `distances` and `gradients` (of length 1, or zero where there is none) in the order of
    /// VolumeGrid::index(); `colors` one for each sample, 8 bits each of red, green and blue as sRGB, or
    /// none.
    FieldVolume(const VolumeGrid& grid, std::span<const float> distances,
                std::span<const glm::vec3> gradients, std::span<const uint32_t> colors = {});
    FieldVolume(const VolumeGrid& grid, std::vector<uint32_t> words);
    /// Of particles, without samples; `hash` is that of what makes them.
    FieldVolume(const VolumeGrid& grid, std::shared_ptr<const ParticleField> particles, uint64_t hash);
    /// The same with samples, at some time: distances and gradients, then blockRanges().
    FieldVolume(const FieldVolume& unmade, std::vector<uint32_t> words);
    FieldVolume(const FieldVolume&) = delete;  // layers point here
    FieldVolume& operator=(const FieldVolume&) = delete;

    bool colored() const { return !particles && words.size() > 2 * grid.samples(); }
    bool made() const { return !words.empty(); }

    VolumeGrid grid;
    /// Two words a sample, along x, then y, then z: the distance's bits, and the gradient as three whole
    /// numbers of ten bits, 511 for 1. Then, if there are colours, one word a sample; an even number in all.
    std::vector<uint32_t> words;
    uint64_t hash;  ///< of grid and words
    std::array<VolumeLayer, kVolumeLayers> layers;

    std::shared_ptr<const ParticleField> particles = {};  ///< what makes the samples, if particles do
    std::shared_ptr<const TriangleMesh> mesh = {};        ///< that it was made of, if of one
    std::vector<std::string> notes = {};  ///< what its user should know of the mesh: "has 3 open edges"
    bool standIn = false;                 ///< something coarser, for whoever need not wait
};
using FieldVolumePtr = std::shared_ptr<const FieldVolume>;

VolumeSample sampleVolume(const VolumeLayer& layer, const glm::dvec3& place);
/// Contains every sample whose coordinates lie in the three intervals.
Interval sampleVolume(const VolumeLayer& layer, const Interval* place);
/// A Lipschitz constant of the layer over the box; infinity where none is known.
double lipschitzConstant(const VolumeLayer& layer, const Interval* place);

/// The second word of a sample: a vector of length at most 1.
uint32_t packGradient(const glm::vec3& gradient);

/// Samples along an axis of the smallest blocks.
inline constexpr int kBlockSamples = 4;
/// How many blocks there are along each axis: the smallest, then those of twice as many samples, until at
/// most two are left.
std::vector<glm::ivec3> blockLevels(const VolumeGrid& grid);
/// Two words a block, level after level, along x, then y, then z: the least and the greatest distance, as
/// bits. Then nothing, or two words more, so that they are whole texels.
std::vector<uint32_t> blockRanges(const VolumeGrid& grid, std::span<const uint32_t> words);

/// What the device reads: texels of four words. A volume has one for each sample, of that sample and the next
/// one in their order, so that four loads get a cell; then one for each four colours, or for each two blocks.
/// All volumes, one after the other; never empty.
std::vector<uint32_t> volumeTexels(const std::vector<FieldVolumePtr>& volumes);
/// The texels of one.
std::size_t texelCount(const FieldVolume& volume);

inline constexpr std::size_t kTexelBytes = 16;
inline constexpr std::size_t kMostVolumeBytes = 1024u
                                                << 20;  ///< the texels of all volumes of a graph take less

}  // namespace fw
