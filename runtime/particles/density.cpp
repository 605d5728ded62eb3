#include "runtime/particles/density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <string>

#include "shaders/shared.h"

#include "shaders/particles/density.h"

namespace fw {

namespace {

/// Cells: a sample looks at (2 * 20 + 1)^3 of them, and some devices end loops of more turns.
constexpr int kMostProxyReach = 20;

/// In double: not yet known to be few enough for whole numbers.
double reachOf(const DensityConfig& config) { return std::ceil(double(config.radius) / config.grid.cell); }
glm::dvec3 bucketsOf(const DensityConfig& config) {
    return glm::floor(glm::dvec3(config.grid.size - 1) * (double(config.grid.cell) / config.radius) + 1.01) +
           2.0;
}

gpu::DensityPush pushOf(const DensityConfig& config, uint32_t particles) {
    const DensityGrid& grid = config.grid;
    constexpr uint32_t kMostSum = std::numeric_limits<uint32_t>::max() - 1;
    gpu::DensityPush push{};
    push.size = grid.size;
    push.particles = particles;
    push.origin = grid.origin;
    push.cell = grid.cell;
    push.radius = config.radius;
    push.first = grid.origin - 1.01f * config.radius;
    if (config.method == DensityMethod::exact)
        push.buckets = bucketsOf(config);
    else
        push.reach = int(reachOf(config));
    // All of them may be in one place.
    push.unit = std::min(float(DENSITY_MOST_UNIT), float(kMostSum / std::max(particles, 1u)));
    return push;
}

Done fits(const DensityConfig& config, const Device& device) {
    if (!(config.radius > 0.0f) || !std::isfinite(config.radius))
        return Error{.message = "the radius must be a finite number above 0"};
    const int most = config.method == DensityMethod::blur ? DENSITY_MOST_REACH : kMostProxyReach;
    const double reach = reachOf(config);
    if (config.method != DensityMethod::exact && !(reach <= most))
        return Error{.message = "the radius is " +
                                (reach < 1e6 ? std::to_string(int(reach)) : "more than a million") +
                                " cells, and " + std::to_string(most) + " is the most of the method " +
                                kDensityMethodNames[std::size_t(config.method)] +
                                ": lower the resolution or the radius, or take the method exact"};
    const uint64_t range = device.limits.storageRange;
    const double samples = double(paddedSamples(config.grid));
    const glm::dvec3 sides = bucketsOf(config);
    const double buckets = sides.x * sides.y * sides.z;
    const double needed = std::max(samples * (config.method == DensityMethod::proxies ? 16 : 4),
                                   config.method == DensityMethod::exact ? 4 * (buckets + 1) : 0.0);
    if (needed > double(range) || samples > double(device.limits.texels()))
        return Error{
            .message =
                "the particles' grid is larger than this device can use: lower the resolution, or raise the "
                "radius"};
    return done();
}

std::array<Pipeline, 3> createBlur(const Device& device, int reach) {
    std::array<ShaderOptions, 3> shaders;
    for (std::size_t axis = 0; axis < 3; ++axis)
        shaders[axis] = {.name = "particles/blur.comp",
                         .defines = {"REACH " + std::to_string(reach), "AXIS " + std::to_string(axis)}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    return {std::move(made[0]), std::move(made[1]), std::move(made[2])};
}

}  // namespace

uint32_t paddedSamples(const DensityGrid& grid) {
    return uint32_t((grid.size.x + 3) / 4 * 4) * uint32_t(grid.size.y) * uint32_t(grid.size.z);
}

DensityKernels createDensityKernels(const Device& device) {
    const std::array shaders = {ShaderOptions{.name = "particles/bucket.comp"},
                                ShaderOptions{.name = "particles/gather.comp"},
                                ShaderOptions{.name = "particles/exact.comp"},
                                ShaderOptions{.name = "particles/splat.comp", .defines = {"PROXIES"}},
                                ShaderOptions{.name = "particles/proxies.comp"},
                                ShaderOptions{.name = "particles/splat.comp"}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    DensityKernels kernels;
    kernels.sort = createCountingSort(device);
    Pipeline* const places[] = {&kernels.bucket,       &kernels.gather,  &kernels.exact,
                                &kernels.splatProxies, &kernels.proxies, &kernels.splat};
    for (std::size_t i = 0; i < made.size(); ++i) *places[i] = std::move(made[i]);
    return kernels;
}

std::vector<float> blurWeights(double radius) {
    // The best product w_i w_j w_k for the tensor T_ijk of densities at whole offsets: the direction T(w, w),
    // again and again, then a length whose cube is T(w, w, w). Of the symmetric offsets those above 0 stand
    // for two.
    const int reach = int(std::ceil(radius));
    const auto many = [](int i) { return i == 0 ? 1.0 : 2.0; };
    std::vector<double> w(std::size_t(reach) + 1);
    for (int i = 0; i <= reach; ++i) w[std::size_t(i)] = std::exp(-3.0 * i * i / (radius * radius));
    double length = 0.0;  // of T(w, w), which is T(w, w, w) in the end
    for (int turn = 0; turn < 40; ++turn) {
        double squares = 0.0;
        for (int i = 0; i <= reach; ++i) squares += many(i) * w[std::size_t(i)] * w[std::size_t(i)];
        std::vector<double> next(w.size(), 0.0);
        length = 0.0;
        for (int i = 0; i <= reach; ++i) {
            double& sum = next[std::size_t(i)];
            for (int j = 0; j <= reach; ++j)
                for (int k = 0; k <= reach; ++k) {
                    const double s = std::max(1.0 - (i * i + j * j + k * k) / (radius * radius), 0.0);
                    sum += many(j) * many(k) * s * s * s * w[std::size_t(j)] * w[std::size_t(k)] / squares;
                }
            length += many(i) * sum * sum;
        }
        length = std::sqrt(length);
        for (double& each : next) each /= length;
        w = std::move(next);
    }
    for (double& each : w) each *= std::cbrt(length);
    return {w.begin(), w.end()};
}

void recordSorted(Commands& commands, const DensityKernels& kernels, DensityBuffers& b,
                  const gpu::DensityPush& push, const Buffer& particles) {
    const uint32_t groups = groupsFor(push.particles, DENSITY_GROUP);
    const auto buckets = uint32_t(push.buckets.x * push.buckets.y * push.buckets.z);
    reserve(commands.device, b.keys, 4ull * push.particles);
    reserve(commands.device, b.sorted, 16ull * push.particles);
    beginStage(commands, "sort");
    dispatchGroups(commands, kernels.bucket, groups, push,
                   std::array{Descriptor{0, particles}, Descriptor{1, b.keys}});
    barrier(commands);
    sortByKey(commands, kernels.sort, b.buckets, b.keys, b.order, push.particles, buckets + 1);
    dispatchGroups(commands, kernels.gather, groups, push,
                   std::array{Descriptor{0, particles}, Descriptor{1, b.order}, Descriptor{2, b.sorted}});
    barrier(commands);
}

namespace {

/// What the ways share.
struct Run {
    Commands& commands;
    DensityKernels& kernels;
    DensityBuffers& buffers;
    const DensityConfig& config;
    const Buffer& particles;
    gpu::DensityPush push;
    uint32_t samples;  ///< rows padded

    void dispatchOver(uint32_t items, const Pipeline& kernel, std::span<const Descriptor> bound) const {
        dispatchGroups(commands, kernel, groupsFor(items, DENSITY_GROUP), push, bound);
        barrier(commands);
    }
};

void recordExact(const Run& run) {
    DensityBuffers& b = run.buffers;
    recordSorted(run.commands, run.kernels, b, run.push, run.particles);
    beginStage(run.commands, "density");
    run.dispatchOver(
        run.samples, run.kernels.exact,
        std::array{Descriptor{0, b.sorted}, Descriptor{1, b.buckets.starts}, Descriptor{2, b.density}});
}

/// Adds the particles to the grid: so many bytes a sample.
void recordSplat(const Run& run, const Pipeline& kernel, uint32_t bytes) {
    beginStage(run.commands, "splat");
    reserve(run.commands.device, run.buffers.grid, uint64_t(bytes) * run.samples);
    fill(run.commands, run.buffers.grid, 0);
    barrier(run.commands);
    run.dispatchOver(run.push.particles, kernel,
                     std::array{Descriptor{0, run.particles}, Descriptor{1, run.buffers.grid}});
}

void recordProxies(const Run& run) {
    recordSplat(run, run.kernels.splatProxies, 16);
    beginStage(run.commands, "density");
    run.dispatchOver(run.samples, run.kernels.proxies,
                     std::array{Descriptor{0, run.buffers.grid}, Descriptor{1, run.buffers.density}});
}

void recordBlur(Run& run) {
    recordSplat(run, run.kernels.splat, 4);
    DensityBuffers& b = run.buffers;
    const Device& device = run.commands.device;
    beginStage(run.commands, "blur");
    reserve(device, b.weights, 4 * (DENSITY_MOST_REACH + 1));
    const std::vector<float> weights = blurWeights(double(run.config.radius) / run.config.grid.cell);
    update(run.commands, b.weights, weights.data(), 4 * weights.size());
    std::array<Pipeline, 3>& blur = run.kernels.blurs[run.push.reach];
    if (!blur[0]) blur = createBlur(device, run.push.reach);
    const glm::ivec3 texels((run.push.size.x + 7) / 8, run.push.size.y, run.push.size.z);
    const uint32_t all = uint32_t(texels.x) * uint32_t(texels.y) * uint32_t(texels.z);
    for (Buffer* each : {&b.blurredX, &b.blurredY}) reserve(device, *each, 16ull * all);
    const Buffer* const steps[] = {&b.grid, &b.blurredX, &b.blurredY, &b.density};
    for (int axis = 0; axis < 3; ++axis) {
        const auto count = uint32_t(texels[axis]);
        const uint32_t pieces = axis == 0 ? 1 : groupsFor(count, uint32_t(DENSITY_PIECE(run.push.reach)));
        run.dispatchOver(all / count * pieces, blur[std::size_t(axis)],
                         std::array{Descriptor{0, *steps[axis]}, Descriptor{1, *steps[axis + 1]},
                                    Descriptor{2, b.weights}});
    }
}

}  // namespace

Done recordDensity(Commands& commands, DensityKernels& kernels, DensityBuffers& buffers,
                   const DensityConfig& config, const Buffer& particles, uint32_t count) {
    if (const Done fit = fits(config, commands.device); !fit) return fit.error();
    Run run{commands, kernels, buffers, config, particles, pushOf(config, count), paddedSamples(config.grid)};
    reserve(commands.device, buffers.density, 4ull * run.samples);
    if (count == 0) {
        fill(commands, buffers.density, 0);
        barrier(commands);
    } else if (config.method == DensityMethod::exact) {
        recordExact(run);
    } else if (config.method == DensityMethod::proxies) {
        recordProxies(run);
    } else {
        recordBlur(run);
    }
    return done();
}

}  // namespace fw
