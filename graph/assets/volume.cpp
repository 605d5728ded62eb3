#include "graph/assets/volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "graph/assets/image.h"
#include "graph/base/hash.h"

namespace fw {

namespace {

// How far values are from distances, in cells. A value at x is a mean of the cell's samples s, and with
// tricubic sampling a sum of their slopes as well:
//     f(x) = sum w_s d_s + sum v_s . g_s
// Where the distance at a place a is known, that at s is off it by |s - a| at most. The mean of |s - a| is at
// most the root of the mean of its square, which is |m - a|^2 and the variance of s, at most 1/4 along each
// axis; m is x itself, or with the weights of cubic polynomials off it by at most sqrt(3)/18 along each axis.
// And the sum of |v_s| is at most sqrt(3)/4: the root of the mean of |v_s / w_s|^2, which is at most 1/16
// along each axis.
constexpr double kScatter = 0.5 * std::numbers::sqrt3;
constexpr double kCubicShift = 1.0 / 6.0, kCubicRise = 0.435;  // and some, for gradients have ten bits
constexpr double kSwept = 0.25;  // what distances are off that were handed on from sample to sample
// The greatest gradients. Trilinear: differences are at most 1 along each axis. Tricubic: by search, 2.62
// where each corner of a cell has a nearest point of its own; meshes of all kinds have up to 1.7.
constexpr double kFlatSlope = std::numbers::sqrt3, kCubicSlope = 3.0;
// Of samples that are not distances: along an axis the derivative is at most 1.5 times the samples'
// difference, and what their slopes add: 1, and twice 0.75 where those across differ by 2.
constexpr double kRoughSlope = 1.5 * std::numbers::sqrt3, kRoughRest = 2.5 * std::numbers::sqrt3;

glm::dvec3 unpackGradient(uint32_t word) {
    const auto part = [&](int shift) { return (int32_t(word << (22 - shift)) >> 22) / 511.0; };
    return {part(0), part(10), part(20)};
}

double channelOf(const FieldVolume& volume, std::size_t index, int channel) {
    const uint32_t word = volume.words[2 * volume.grid.samples() + index];
    return linearOfByte(int(word >> (8 * (channel - redChannel)) & 255u));
}

/// A coordinate among samples: the nearest within the grid, the cell that it is in, and how far along.
struct Axis {
    int cell;
    double t, beyond;  ///< `beyond` in metres
};

Axis along(double place, double origin, double cell, int size) {
    const double u = (place - origin) / cell;
    const double at = u > 0.0 ? std::min(u, double(size - 1)) : 0.0;  // also where u is no number
    const int first = std::min(int(at), size - 2);
    return {first, at - first, u == at || std::isnan(u) ? 0.0 : (u - at) * cell};
}

/// Cubic Hermite polynomials on the unit interval at t, and their derivatives: of the values at both ends,
/// and of the slopes.
struct Hermite {
    double value[2], slope[2], valueDerivative[2], slopeDerivative[2];
    explicit Hermite(double t)
        : value{(1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t), t * t * (3.0 - 2.0 * t)},
          slope{t * (1.0 - t) * (1.0 - t), t * t * (t - 1.0)},
          valueDerivative{6.0 * t * (t - 1.0), 6.0 * t * (1.0 - t)},
          slopeDerivative{(1.0 - t) * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)} {}
};

VolumeSample tricubic(const FieldVolume& volume, const Axis* axes) {
    const Hermite x(axes[0].t), y(axes[1].t), z(axes[2].t);
    const double cell = volume.grid.cell;
    VolumeSample sum{0.0, glm::dvec3(0.0)};
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const uint32_t* words =
                    &volume
                         .words[2 * volume.grid.index(axes[0].cell + i, axes[1].cell + j, axes[2].cell + k)];
                const double f = std::bit_cast<float>(words[0]);
                const glm::dvec3 g = cell * unpackGradient(words[1]);
                sum.value +=
                    f * x.value[i] * y.value[j] * z.value[k] + g.x * x.slope[i] * y.value[j] * z.value[k] +
                    g.y * x.value[i] * y.slope[j] * z.value[k] + g.z * x.value[i] * y.value[j] * z.slope[k];
                sum.gradient.x += f * x.valueDerivative[i] * y.value[j] * z.value[k] +
                                  g.x * x.slopeDerivative[i] * y.value[j] * z.value[k] +
                                  g.y * x.valueDerivative[i] * y.slope[j] * z.value[k] +
                                  g.z * x.valueDerivative[i] * y.value[j] * z.slope[k];
                sum.gradient.y += f * x.value[i] * y.valueDerivative[j] * z.value[k] +
                                  g.x * x.slope[i] * y.valueDerivative[j] * z.value[k] +
                                  g.y * x.value[i] * y.slopeDerivative[j] * z.value[k] +
                                  g.z * x.value[i] * y.valueDerivative[j] * z.slope[k];
                sum.gradient.z += f * x.value[i] * y.value[j] * z.valueDerivative[k] +
                                  g.x * x.slope[i] * y.value[j] * z.valueDerivative[k] +
                                  g.y * x.value[i] * y.slope[j] * z.valueDerivative[k] +
                                  g.z * x.value[i] * y.value[j] * z.slopeDerivative[k];
            }
    sum.gradient /= cell;
    return sum;
}

VolumeSample trilinear(const FieldVolume& volume, const Axis* axes, int channel) {
    double value[2][2][2];
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const std::size_t index =
                    volume.grid.index(axes[0].cell + i, axes[1].cell + j, axes[2].cell + k);
                value[i][j][k] = channel == trilinearChannel ? std::bit_cast<float>(volume.words[2 * index])
                                                             : channelOf(volume, index, channel);
            }
    const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
    const double x = axes[0].t, y = axes[1].t, z = axes[2].t;
    double alongX[2][2], alongY[2];
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j) alongX[j][k] = mix(value[0][j][k], value[1][j][k], x);
    for (int k = 0; k < 2; ++k) alongY[k] = mix(alongX[0][k], alongX[1][k], y);
    const auto dx = [&](int j, int k) { return value[1][j][k] - value[0][j][k]; };
    const glm::dvec3 gradient(mix(mix(dx(0, 0), dx(1, 0), y), mix(dx(0, 1), dx(1, 1), y), z),
                              mix(alongX[1][0] - alongX[0][0], alongX[1][1] - alongX[0][1], z),
                              alongY[1] - alongY[0]);
    return {mix(alongY[0], alongY[1], z), gradient / volume.grid.cell};
}

/// What the distance at a place of the grid can be by the samples around it; anything, beyond.
Interval distanceAt(const FieldVolume& volume, const glm::dvec3& place) {
    const VolumeGrid& grid = volume.grid;
    Axis axes[3];
    for (int axis = 0; axis < 3; ++axis) {
        axes[axis] = along(place[axis], grid.origin[axis], grid.cell, grid.size[axis]);
        if (axes[axis].beyond != 0.0) return {-kHuge, kHuge};
    }
    Interval distance{-kHuge, kHuge};
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const std::size_t index = grid.index(axes[0].cell + i, axes[1].cell + j, axes[2].cell + k);
                const double f = std::bit_cast<float>(volume.words[2 * index]);
                const double far =
                    grid.cell * glm::length(glm::dvec3(i - axes[0].t, j - axes[1].t, k - axes[2].t));
                distance = {std::max(distance.lo, f - far), std::min(distance.hi, f + far)};
            }
    return distance;
}

std::vector<uint32_t> pack(const VolumeGrid& grid, std::span<const float> distances,
                           std::span<const glm::vec3> gradients, std::span<const uint32_t> colors) {
    std::vector<uint32_t> words;
    words.reserve(2 * grid.samples() + colors.size() + 1);
    for (std::size_t i = 0; i < grid.samples(); ++i) {
        words.push_back(std::bit_cast<uint32_t>(distances[i]));
        words.push_back(packGradient(gradients[i]));
    }
    words.insert(words.end(), colors.begin(), colors.end());
    if (words.size() % 2 != 0) words.push_back(0);
    return words;
}

}  // namespace

uint32_t packGradient(const glm::vec3& gradient) {
    const auto part = [](float x) {
        return uint32_t(int32_t(std::lround(511.0f * std::clamp(x, -1.0f, 1.0f)))) & 1023u;
    };
    return part(gradient.x) | part(gradient.y) << 10 | part(gradient.z) << 20;
}

FieldVolume::FieldVolume(const VolumeGrid& grid_, std::span<const float> distances,
                         std::span<const glm::vec3> gradients, std::span<const uint32_t> colors)
    : FieldVolume(grid_, pack(grid_, distances, gradients, colors)) {}

FieldVolume::FieldVolume(const VolumeGrid& grid_, std::shared_ptr<const ParticleField> particles_,
                         uint64_t hash_)
    : grid(grid_), hash(hash_), particles(std::move(particles_)) {
    const double rise = kCubicRise * grid.cell;
    layers = {{{.volume = this, .channel = tricubicChannel, .rise = rise},
               {.volume = this, .channel = trilinearChannel},
               {this, redChannel},
               {this, greenChannel},
               {this, blueChannel}}};
}

FieldVolume::FieldVolume(const FieldVolume& unmade, std::vector<uint32_t> words_)
    : FieldVolume(unmade.grid, unmade.particles, unmade.hash) {
    words = std::move(words_);
}

FieldVolume::FieldVolume(const VolumeGrid& grid_, std::vector<uint32_t> words_)
    : grid(grid_), words(std::move(words_)) {
    hash = 0xcbf29ce484222325u;
    const auto mix = [&](uint64_t word) { hash = mixed(hash, word); };
    for (int axis = 0; axis < 3; ++axis) mix(std::bit_cast<uint64_t>(grid.origin[axis]));
    for (int axis = 0; axis < 3; ++axis) mix(std::bit_cast<uint64_t>(grid.inset[axis]));
    for (int axis = 0; axis < 3; ++axis) mix(uint64_t(grid.size[axis]));
    mix(std::bit_cast<uint64_t>(grid.cell));
    for (std::size_t i = 0; i < words.size(); i += 2) mix(uint64_t(words[i + 1]) << 32 | words[i]);
    hash ^= hash >> 32;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t i = 0; i < grid.samples(); ++i) {
        const double f = std::bit_cast<float>(words[2 * i]);
        least = std::min(least, f), most = std::max(most, f);
    }
    const double cell = grid.cell, rise = kCubicRise * cell, swept = kSwept * cell, scatter = kScatter * cell;
    layers = {{{this, tricubicChannel, least - rise, most + rise, kCubicSlope, kCubicShift * cell, scatter,
                rise + swept},
               {this, trilinearChannel, least, most, kFlatSlope, 0.0, scatter, swept},
               {this, redChannel},
               {this, greenChannel},
               {this, blueChannel}}};
}

namespace {

/// Within the grid, the box of a volume whose samples are not made.
VolumeSample insideBox(const VolumeGrid& grid, const glm::dvec3& place) {
    VolumeSample nearest{-kHuge, glm::dvec3(0.0)};
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const double face = grid.origin[axis] + (side > 0.0 ? grid.cell * (grid.size[axis] - 1) : 0.0);
            const double value = side * (place[axis] - face);
            if (value <= nearest.value) continue;
            nearest = {value, glm::dvec3(0.0)};
            nearest.gradient[axis] = side;
        }
    return nearest;
}

/// Contains the values of a layer of particles over a box.
Interval particleRange(const VolumeLayer& layer, const Interval* place) {
    const FieldVolume& volume = *layer.volume;
    const VolumeGrid& grid = volume.grid;
    bool within = true;
    double far = 0.0, apart = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double least = grid.origin[axis], most = least + grid.cell * (grid.size[axis] - 1);
        within &= place[axis].lo >= least && place[axis].hi <= most;
        far = std::max({far, std::abs(place[axis].lo), std::abs(place[axis].hi)});
        apart = std::hypot(apart, std::max({least - place[axis].hi, place[axis].lo - most, 0.0}));
    }
    const double more = 1e-12 * (1.0 + far + grid.cell);
    glm::ivec3 lo, hi;  // samples
    for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = along(place[axis].lo - more, grid.origin[axis], grid.cell, grid.size[axis]).cell;
        hi[axis] = along(place[axis].hi + more, grid.origin[axis], grid.cell, grid.size[axis]).cell + 1;
    }
    Interval range{kHuge, -kHuge};
    if (volume.made()) {
        std::size_t first = 0;  // in pairs of words: the samples themselves, or a level of blocks
        glm::ivec3 many = grid.size;
        int side = 1;
        const glm::ivec3 extent = hi - lo;
        const int longest = std::max({extent.x, extent.y, extent.z});
        for (const glm::ivec3& blocks : blockLevels(grid)) {
            if (longest <= 2 * side) break;
            first += std::size_t(many.x) * std::size_t(many.y) * std::size_t(many.z);
            side = side == 1 ? kBlockSamples : 2 * side;
            many = blocks;
        }
        for (int z = lo.z / side; z <= hi.z / side; ++z)
            for (int y = lo.y / side; y <= hi.y / side; ++y)
                for (int x = lo.x / side; x <= hi.x / side; ++x) {
                    const std::size_t at =
                        first +
                        (std::size_t(z) * std::size_t(many.y) + std::size_t(y)) * std::size_t(many.x) +
                        std::size_t(x);
                    const uint32_t* words = &volume.words[2 * at];
                    range.lo = std::min(range.lo, double(std::bit_cast<float>(words[0])));
                    range.hi = std::max(range.hi, double(std::bit_cast<float>(words[side == 1 ? 0 : 1])));
                }
    } else {
        const double reach = grid.cell * std::max({grid.size.x, grid.size.y, grid.size.z});
        range = {-reach, reach};
    }
    const double slope = kRoughSlope * (range.hi - range.lo) / grid.cell + kRoughRest;
    range = {range.lo - layer.rise, within ? range.hi + layer.rise : kHuge};
    if (apart > 0.0) range.lo = std::max(range.lo, apart);
    if (volume.made() && within) {
        glm::dvec3 centre, half;
        for (int axis = 0; axis < 3; ++axis) {
            centre[axis] = 0.5 * (place[axis].lo + place[axis].hi);
            half[axis] = 0.5 * (place[axis].hi - place[axis].lo);
        }
        const double value = sampleVolume(layer, centre).value, off = slope * (glm::length(half) + more);
        range = {std::max(range.lo, value - off), std::min(range.hi, value + off)};
    }
    return outward(range.lo - more, range.hi + more);
}

}  // namespace

std::vector<glm::ivec3> blockLevels(const VolumeGrid& grid) {
    std::vector<glm::ivec3> levels{(grid.size + kBlockSamples - 1) / kBlockSamples};
    while (std::max({levels.back().x, levels.back().y, levels.back().z}) > 2)
        levels.push_back((levels.back() + 1) / 2);
    return levels;
}

std::vector<uint32_t> blockRanges(const VolumeGrid& grid, std::span<const uint32_t> words) {
    std::vector<uint32_t> ranges;
    int side = kBlockSamples;
    for (const glm::ivec3& blocks : blockLevels(grid)) {
        for (int z = 0; z < blocks.z; ++z)
            for (int y = 0; y < blocks.y; ++y)
                for (int x = 0; x < blocks.x; ++x) {
                    const glm::ivec3 lo = side * glm::ivec3(x, y, z), hi = glm::min(lo + side, grid.size);
                    float least = std::numeric_limits<float>::max(), most = -least;
                    for (int k = lo.z; k < hi.z; ++k)
                        for (int j = lo.y; j < hi.y; ++j)
                            for (int i = lo.x; i < hi.x; ++i) {
                                const float f = std::bit_cast<float>(words[2 * grid.index(i, j, k)]);
                                least = std::min(least, f), most = std::max(most, f);
                            }
                    ranges.push_back(std::bit_cast<uint32_t>(least));
                    ranges.push_back(std::bit_cast<uint32_t>(most));
                }
        side *= 2;
    }
    ranges.resize((ranges.size() + 3) / 4 * 4);
    return ranges;
}

VolumeSample sampleVolume(const VolumeLayer& layer, const glm::dvec3& place) {
    const FieldVolume& volume = *layer.volume;
    Axis axes[3];
    glm::dvec3 beyond;
    for (int axis = 0; axis < 3; ++axis) {
        axes[axis] = along(place[axis], volume.grid.origin[axis], volume.grid.cell, volume.grid.size[axis]);
        beyond[axis] = axes[axis].beyond;
    }
    VolumeSample sample = !volume.made()                     ? insideBox(volume.grid, place - beyond)
                          : layer.channel == tricubicChannel ? tricubic(volume, axes)
                                                             : trilinear(volume, axes, layer.channel);
    if (beyond == glm::dvec3(0.0)) return sample;
    for (int axis = 0; axis < 3; ++axis)
        if (beyond[axis] != 0.0) sample.gradient[axis] = 0.0;
    if (layer.channel >= redChannel) return sample;
    const double distance = std::max(sample.value, 0.0);
    const double value = std::hypot(glm::length(beyond), distance);
    const VolumeGrid& grid = volume.grid;
    const glm::dvec3 half = 0.5 * grid.cell * glm::dvec3(grid.size - 1), off = place - (grid.origin + half);
    const glm::dvec3 fromBox = glm::sign(off) * glm::max(glm::abs(off) - (half - grid.inset), 0.0);
    if (glm::length(fromBox) > value) return {glm::length(fromBox), glm::normalize(fromBox)};
    return {value, (beyond + distance * sample.gradient) / value};
}

Interval sampleVolume(const VolumeLayer& layer, const Interval* place) {
    if (layer.volume->particles) return particleRange(layer, place);
    const VolumeGrid& grid = layer.volume->grid;
    glm::dvec3 centre, half;
    bool within = true;
    double far = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        centre[axis] = 0.5 * (place[axis].lo + place[axis].hi);
        half[axis] = 0.5 * (place[axis].hi - place[axis].lo);
        const double least = grid.origin[axis], most = least + grid.cell * (grid.size[axis] - 1);
        within &= place[axis].lo >= least && place[axis].hi <= most;
        far = std::max({far, std::abs(place[axis].lo), std::abs(place[axis].hi)});
    }
    if (layer.channel >= redChannel) return {layer.least - 1e-12, layer.most + 1e-12};
    // A coordinate is known up to its rounding.
    const double radius = glm::length(half) + 1e-15 * (1.0 + far);
    const auto off = [&](double r) { return std::hypot(r + layer.shift, layer.scatter) + layer.rise; };
    const double value = sampleVolume(layer, centre).value;
    Interval distance = distanceAt(*layer.volume, centre);  // at the centre
    if (distance.lo == -kHuge) distance = {value - off(0.0), value + off(0.0)};
    if (!within) distance.hi = std::max(distance.hi, 0.0);
    const double lo = std::max(distance.lo - off(radius), value - layer.slope * radius);
    const double hi = std::min(distance.hi + off(radius), value + layer.slope * radius);
    const double more = 1e-12 * (1.0 + grid.cell), most = within ? layer.most : kHuge;
    return outward(std::clamp(lo, layer.least, most) - more, std::clamp(hi, layer.least, most) + more);
}

double lipschitzConstant(const VolumeLayer& layer, const Interval* place) {
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    const VolumeGrid& grid = layer.volume->grid;
    if (layer.channel >= redChannel) {
        // Trilinear, so along an axis the derivative is at most the difference of two samples over the cell.
        return std::numbers::sqrt3 * (layer.most - layer.least) / grid.cell;
    }
    if (!layer.volume->particles) return layer.slope;
    // The samples of particles are no distances: their range bounds the derivative, and the field may jump
    // at the border of the grid.
    if (!layer.volume->made()) return kUnknown;
    for (int axis = 0; axis < 3; ++axis)
        if (place[axis].lo < grid.origin[axis] ||
            place[axis].hi > grid.origin[axis] + grid.cell * (grid.size[axis] - 1))
            return kUnknown;
    const Interval range = particleRange(layer, place);
    return kRoughSlope * (range.hi - range.lo) / grid.cell + kRoughRest;
}

std::size_t texelCount(const FieldVolume& volume) {
    const std::size_t samples = volume.grid.samples();
    if (!volume.particles) return samples + (volume.colored() ? (samples + 3) / 4 : 0);
    std::size_t blocks = 0;
    for (const glm::ivec3& level : blockLevels(volume.grid))
        blocks += std::size_t(level.x) * std::size_t(level.y) * std::size_t(level.z);
    return samples + (blocks + 1) / 2;
}

std::vector<uint32_t> volumeTexels(const std::vector<FieldVolumePtr>& volumes) {
    std::size_t count = 0;
    for (const FieldVolumePtr& volume : volumes) count += texelCount(*volume);
    std::vector<uint32_t> texels(4 * std::max<std::size_t>(count, 1));
    uint32_t* to = texels.data();
    for (const FieldVolumePtr& volume : volumes) {
        const std::size_t samples = volume->grid.samples(), all = texelCount(*volume);
        if (volume->made()) {
            const uint32_t* words = volume->words.data();
            for (std::size_t i = 0; i < samples; ++i)
                std::copy_n(words + 2 * i, i + 1 < samples ? 4 : 2, to + 4 * i);
            std::copy(words + 2 * samples, words + volume->words.size(), to + 4 * samples);
        }
        to += 4 * all;
    }
    return texels;
}

}  // namespace fw
