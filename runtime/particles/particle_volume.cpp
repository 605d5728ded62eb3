#include "runtime/particles/particle_volume.h"

#include <array>
#include <cmath>
#include <utility>

#include "runtime/bake/sweep.h"
#include "shaders/shared.h"

#include "shaders/particles/volume.h"

namespace fw {

namespace {

uint32_t countOf(const glm::ivec3& size) { return uint32_t(size.x) * uint32_t(size.y) * uint32_t(size.z); }

}  // namespace

ParticleVolumeKernels createParticleVolumeKernels(const Device& device) {
    const std::array shaders = {ShaderOptions{.name = "particles/level.comp"},
                                ShaderOptions{.name = "particles/level.comp", .defines = {"DISTANCES"}},
                                ShaderOptions{.name = "particles/reach.comp"},
                                ShaderOptions{.name = "particles/samples.comp"},
                                ShaderOptions{.name = "particles/pyramid.comp"},
                                ShaderOptions{.name = "particles/seed.comp"},
                                ShaderOptions{.name = "particles/samples.comp", .defines = {"SWEPT"}}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    ParticleVolumeKernels kernels;
    kernels.density = createDensityKernels(device);
    kernels.surface = createSurfaceKernels(device);
    kernels.sweep = createSweep(device);
    Pipeline* const places[] = {&kernels.level,   &kernels.border, &kernels.reach,       &kernels.samples,
                                &kernels.pyramid, &kernels.seed,   &kernels.sweptSamples};
    for (std::size_t i = 0; i < made.size(); ++i) *places[i] = std::move(made[i]);
    return kernels;
}

namespace {

/// What level.comp takes: densities, or distances.
Done recordDistances(Commands& commands, ParticleVolumeKernels& kernels, ParticleVolumeBuffers& b,
                     const ParticleVolumeConfig& config, const Buffer& particles, uint32_t count) {
    const DensityGrid grid{
        .origin = config.grid.origin, .cell = float(config.grid.cell), .size = config.grid.size};
    if (config.surface == ParticleSurface::blobs)
        return recordDensity(commands, kernels.density, b.density,
                             {.grid = grid, .radius = float(config.numbers.radius), .method = config.method},
                             particles, count);
    return recordSurface(commands, kernels.density, kernels.surface, b.density, b.shapes,
                         {.grid = grid, .drop = float(config.numbers.drop), .surface = config.surface},
                         particles, count);
}

}  // namespace

Done recordParticleVolume(Commands& commands, ParticleVolumeKernels& kernels, ParticleVolumeBuffers& b,
                          const ParticleVolumeConfig& config, const Buffer& particles, uint32_t count,
                          const Buffer& volumes, uint32_t first) {
    const Device& device = commands.device;
    const uint64_t most = device.limits.storageRange;
    if (volumes.size > most)
        return Error{.message = "the samples of all fields on grids are " +
                                std::to_string(volumes.size >> 20) + " MiB, and this device can use " +
                                std::to_string(most >> 20) +
                                " where particles are among them: lower the resolution"};
    const VolumeGrid& grid = config.grid;
    if (const Done recorded = recordDistances(commands, kernels, b, config, particles, count); !recorded)
        return recorded.error();

    const std::vector<glm::ivec3> levels = blockLevels(grid);
    const double threshold = std::cbrt(config.numbers.threshold);
    gpu::ParticleVolumePush push{};
    push.size = grid.size;
    push.cell = float(grid.cell);
    push.blocks = levels.front();
    push.first = first;
    push.coarse = (levels.front() + 1) / 2;
    push.radius = float(config.numbers.radius / grid.cell);
    push.least = float(threshold);
    push.most = float(std::max(1.0, threshold + 0.1));
    const bool blobs = config.surface == ParticleSurface::blobs;
    push.flattest = blobs ? 1.0f : 0.4f;
    const uint32_t blocks = countOf(push.blocks), coarse = countOf(push.coarse);
    reserve(device, b.least, 4ull * blocks);
    for (Buffer& each : b.reach) reserve(device, each, 4ull * coarse);
    const auto run = [&](const Pipeline& kernel, uint32_t items, std::span<const Descriptor> bound) {
        dispatchGroups(commands, kernel, groupsFor(items, VOLUME_GROUP), push, bound);
        barrier(commands);
    };
    beginStage(commands, "distance");
    run(blobs ? kernels.level : kernels.border, blocks,
        std::array{Descriptor{0, b.density.density}, Descriptor{1, b.least},
                   Descriptor{2, b.density.density}});
    if (config.trueDistance) {
        const auto samples = uint32_t(grid.samples());
        reserve(device, b.nearest, 16ull * samples);
        run(kernels.seed, samples, std::array{Descriptor{0, b.density.density}, Descriptor{1, b.nearest}});
        beginStage(commands, "sweep");
        recordSweeps(commands, kernels.sweep, b.nearest, grid.size);
        beginStage(commands, "samples");
        run(kernels.sweptSamples, blocks,
            std::array{Descriptor{0, b.nearest}, Descriptor{1, b.density.density}, Descriptor{2, volumes}});
    } else {
        for (push.axis = 0; push.axis < 3; ++push.axis)
            run(kernels.reach, coarse,
                std::array{Descriptor{0, b.least}, Descriptor{1, b.reach[(push.axis + 1) % 2]},
                           Descriptor{2, b.reach[push.axis % 2]}});
        beginStage(commands, "samples");
        run(kernels.samples, blocks,
            std::array{Descriptor{0, b.density.density}, Descriptor{1, b.reach[0]}, Descriptor{2, volumes}});
    }
    for (std::size_t level = 1; level < levels.size(); ++level) {
        push.blocks = levels[level - 1];
        push.from = push.to;
        push.to += countOf(push.blocks);
        run(kernels.pyramid, countOf(levels[level]), std::array{Descriptor{0, volumes}});
    }
    return done();
}

FieldVolumePtr downloadVolume(const Device& device, const FieldVolume& unmade, const Buffer& volumes,
                              uint32_t first) {
    const std::size_t samples = unmade.grid.samples(), all = texelCount(unmade);
    const auto texels = download<uint32_t>(device, volumes, 4 * all, kTexelBytes * std::size_t(first));
    std::vector<uint32_t> words(2 * samples);
    for (std::size_t i = 0; i < samples; ++i)
        words[2 * i] = texels[4 * i], words[2 * i + 1] = texels[4 * i + 1];
    words.insert(words.end(), texels.begin() + std::ptrdiff_t(4 * samples), texels.end());
    return std::make_shared<const FieldVolume>(unmade, std::move(words));
}

}  // namespace fw
