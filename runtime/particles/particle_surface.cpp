#include "runtime/particles/particle_surface.h"

#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>

#include "shaders/shared.h"

#include "shaders/particles/density.h"

namespace fw {

namespace {

/// Buckets on each side of the samples: a sample feels particles that feel others.
constexpr int kAround = 2 * SURFACE_SIDES;

float reachOf(const SurfaceConfig& config) {
    return float(config.surface == ParticleSurface::average ? AVERAGE_REACH : ANISOTROPIC_REACH);
}
float sideOf(const SurfaceConfig& config) { return reachOf(config) * config.drop / SURFACE_SIDES; }

/// In double: not yet known to be few enough for whole numbers.
glm::dvec3 bucketsOf(const SurfaceConfig& config) {
    const DensityGrid& grid = config.grid;
    return glm::floor(glm::dvec3(grid.size - 1) * (double(grid.cell) / sideOf(config)) + 1.01) +
           2.0 * kAround;
}

gpu::DensityPush pushOf(const SurfaceConfig& config, uint32_t particles) {
    gpu::DensityPush push{};
    push.size = config.grid.size;
    push.particles = particles;
    push.origin = config.grid.origin;
    push.cell = config.grid.cell;
    push.radius = sideOf(config);
    push.drop = SURFACE_SIDES / reachOf(config);
    push.none = config.surface == ParticleSurface::average ? float(SURFACE_SIDES)
                                                           : float(ANISOTROPIC_LONE) * push.drop;
    push.buckets = bucketsOf(config);
    push.first = config.grid.origin - (float(kAround) + 0.01f) * push.radius;
    return push;
}

Done fits(const SurfaceConfig& config, uint32_t particles, const Device& device) {
    if (!(config.drop > 0.0f) || !std::isnormal(sideOf(config)))
        return Error{.message = "the radius of a drop must be a finite number above 0"};
    const auto range = double(device.limits.storageRange);
    const double samples = paddedSamples(config.grid);
    const glm::dvec3 sides = bucketsOf(config);
    const double buckets = sides.x * sides.y * sides.z;
    if (4 * samples > range || 4 * (buckets + 1) > range || samples > double(device.limits.texels()))
        return Error{
            .message =
                "the particles' grid is larger than this device can use: lower the resolution, or raise the "
                "radius of a drop"};
    const double shapes =
        config.surface == ParticleSurface::anisotropic ? 4.0 * SHAPE_WORDS * particles : 0.0;
    if (shapes > range || shapes / 16 > double(device.limits.texels()))
        return Error{.message =
                         "there are more particles than this device can shape kernels for: take the surface "
                         "average, or fewer particles"};
    return done();
}

}  // namespace

SurfaceKernels createSurfaceKernels(const Device& device) {
    const std::array shaders = {
        ShaderOptions{.name = "particles/blocks.comp"}, ShaderOptions{.name = "particles/average.comp"},
        ShaderOptions{.name = "particles/shape.comp"}, ShaderOptions{.name = "particles/anisotropic.comp"}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    return {std::move(made[0]), std::move(made[1]), std::move(made[2]), std::move(made[3])};
}

Done recordSurface(Commands& commands, const DensityKernels& sorting, const SurfaceKernels& kernels,
                   DensityBuffers& b, Buffer& shapes, const SurfaceConfig& config, const Buffer& particles,
                   uint32_t count) {
    const Device& device = commands.device;
    if (const Done fit = fits(config, count, device); !fit) return fit.error();
    const gpu::DensityPush push = pushOf(config, count);
    const uint32_t samples = paddedSamples(config.grid);
    reserve(device, b.density, 4ull * samples);
    if (count == 0) {
        fill(commands, b.density, std::bit_cast<uint32_t>((push.none - push.drop) * push.radius / push.cell));
        barrier(commands);
        return done();
    }
    const glm::uvec3 sides = glm::uvec3(config.grid.size + 3) / 4u;
    const uint32_t blocks = sides.x * sides.y * sides.z;
    const auto run = [&](const Pipeline& kernel, uint32_t groups, std::span<const Descriptor> bound) {
        dispatchGroups(commands, kernel, groups, push, bound);
        barrier(commands);
    };
    const bool shaped = config.surface == ParticleSurface::anisotropic;
    recordSorted(commands, sorting, b, push, particles);
    if (shaped) {
        beginStage(commands, "shape");
        reserve(device, shapes, 4ull * SHAPE_WORDS * count);
        run(kernels.shape, groupsFor(count, DENSITY_GROUP),
            std::array{Descriptor{0, b.sorted}, Descriptor{1, b.buckets.starts}, Descriptor{2, shapes},
                       Descriptor{3, b.keys}});
        beginStage(commands, "sort");
        sortByKey(commands, sorting.sort, b.buckets, b.keys, b.order, count,
                  uint32_t(push.buckets.x * push.buckets.y * push.buckets.z) + 1);
    }
    beginStage(commands, "blocks");
    reserve(device, b.grid, 16 + 4ull * blocks);
    fill(commands, b.grid, 0, 0, 8);
    fill(commands, b.grid, 1, 8, 4);
    fill(commands, b.grid, 0, 12, 4);
    barrier(commands);
    const Descriptor starts{1, b.buckets.starts}, distances{2, b.density}, listed{4, b.grid};
    run(kernels.blocks, groupsFor(blocks, DENSITY_GROUP), std::array{starts, distances, listed});
    beginStage(commands, "surface");
    dispatchIndirect(commands, shaped ? kernels.anisotropic : kernels.average, b.grid, 0, push,
                     std::array{Descriptor{0, shaped ? shapes : b.sorted}, starts, distances,
                                Descriptor{3, b.order}, listed});
    barrier(commands);
    return done();
}

}  // namespace fw
