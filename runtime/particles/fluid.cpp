#include "runtime/particles/fluid.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <span>
#include <utility>

#include "shaders/shared.h"

#include "shaders/particles/fluid.h"
#include "shaders/sort/sort.h"

namespace fw {

namespace {

/// Along each axis. Narrow along x, where the part of a row that the kernel reaches can be taken.
constexpr glm::vec3 kCellsInSupport(4.0f, 1.0f, 1.0f);

/// Those of the tank and one support and a half more on each side.
glm::vec3 cellsOf(const FluidConfig& config) {
    return glm::ceil(((config.hi - config.lo) / (kFluidSupport * config.spacing) + 3.0f) * kCellsInSupport);
}

}  // namespace

FluidLattice fluidLattice() {
    constexpr double kSoft = 0.01;
    const double support = kFluidSupport;
    const int reach = int(kFluidSupport);
    double density = 0.0, squares = 0.0;
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const double r = std::sqrt(double(x * x + y * y + z * z)),
                             u = std::max(1.0 - r / support, 0.0);
                density += u * u * u * u * (5.0 - 4.0 * u);
                squares += u * u * u * u * u * u * r * r;
            }
    const double slope = 20.0 / (density * support * support);
    return {float(1.0 / density), float(kSoft * slope * slope * squares)};
}

gpu::FluidPush fluidPush(const FluidConfig& config, uint32_t count, float step) {
    static const FluidLattice lattice = fluidLattice();
    const float volume = config.spacing * config.spacing * config.spacing;
    gpu::FluidPush push{};
    push.support = kFluidSupport * config.spacing;
    push.near = (config.farOnce ? kFluidNear : 1.0f) * push.support;
    push.perSupport = 1.0f / push.support;
    push.first = config.lo - 1.5f * push.support;
    push.perCell = kCellsInSupport * push.perSupport;
    push.cells = glm::ivec3(cellsOf(config));
    push.particles = count;
    push.lo = config.lo;
    push.hi = config.hi;
    push.gravity = config.gravity;
    push.step = step;
    push.weight = lattice.weight;
    push.slope = -20.0f * push.weight / (push.support * push.support);
    push.relaxation = kFluidRelaxation;
    push.viscosity = std::min(config.viscosity * step, 1.0f);
    const float tension = std::min(config.tension, kFluidMostTension * volume / (step * step));
    push.tension = tension * step / (kTensionOfPairs * config.spacing * config.spacing);
    push.soft = lattice.soft / (config.spacing * config.spacing);
    push.vorticity = config.vorticity * step * config.spacing;
    push.error = config.error;
    return push;
}

namespace {

/// Particles that buffers are made for: a few more, of what grows. All have the same room, for a step
/// exchanges them.
uint64_t roomFor(uint64_t count) {
    constexpr uint64_t kTogether = 8 * FLUID_GROUP;
    return (count + kTogether - 1) / kTogether * kTogether;
}

Done fits(const Device& device, const FluidConfig& config, uint32_t count, float step) {
    const auto positive = [](float value) { return std::isfinite(value) && value > 0.0f; };
    const glm::vec3 size = config.hi - config.lo;
    if (!positive(config.spacing) || !positive(step) || !positive(glm::min(size.x, glm::min(size.y, size.z))))
        return Error{.message = "a fluid's spacing, its tank's sides and its step must be greater than 0"};
    const DeviceLimits& limits = device.limits;
    const uint64_t most = limits.texels() / (FLUID_MOST_NEIGHBOURS / 4);
    if (roomFor(count) > most)
        return Error{.message = "this device can list the neighbours of " + std::to_string(most) +
                                " particles at most: raise the fluid's spacing"};
    const glm::dvec3 cells(cellsOf(config));
    if (4.0 * cells.x * cells.y * cells.z > double(limits.storageRange))
        return Error{.message =
                         "the fluid's tank has more cells than this device can use: make it smaller, or "
                         "raise the spacing"};
    return done();
}

}  // namespace

FluidKernels createFluidKernels(const Device& device, std::string_view obstacle, std::string_view outflow) {
    ShaderOptions predict{.name = "particles/predict.comp", .field = obstacle};
    if (!obstacle.empty()) predict.defines = {"OBSTACLE", "FIELD_GRADIENT"};
    std::vector<ShaderOptions> shaders = {
        predict,
        ShaderOptions{.name = "particles/reorder.comp"},
        ShaderOptions{.name = "particles/neighbours.comp"},
        ShaderOptions{.name = "particles/neighbours.comp", .defines = {"FAR_ONCE"}},
        ShaderOptions{.name = "particles/density_error.comp"},
        ShaderOptions{.name = "particles/density_error.comp", .defines = {"ADD_ERRORS"}},
        ShaderOptions{.name = "particles/enough.comp"},
        ShaderOptions{.name = "particles/give_way.comp"},
        ShaderOptions{.name = "particles/velocity.comp"},
        ShaderOptions{.name = "particles/curl.comp"},
        ShaderOptions{.name = "particles/confine.comp"},
        ShaderOptions{.name = "particles/smooth_velocity.comp"},
        ShaderOptions{.name = "particles/density_gradient.comp"},
        ShaderOptions{.name = "particles/smooth_velocity.comp", .defines = {"TENSION"}}};
    if (!outflow.empty()) shaders.push_back({.name = "particles/drain.comp", .field = outflow});
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    FluidKernels kernels{createCountingSort(device), std::move(made[0]),  std::move(made[1]),
                         std::move(made[2]),         std::move(made[3]),  std::move(made[4]),
                         std::move(made[5]),         std::move(made[6]),  std::move(made[7]),
                         std::move(made[8]),         std::move(made[9]),  std::move(made[10]),
                         std::move(made[11]),        std::move(made[12]), std::move(made[13])};
    if (!outflow.empty()) kernels.drain = std::move(made[14]);
    return kernels;
}

std::vector<glm::vec3> fluidBlock(const glm::vec3& lo, const glm::vec3& hi, float spacing) {
    const glm::ivec3 count = glm::max(glm::ivec3(glm::round((hi - lo) / spacing)), glm::ivec3(0));
    std::vector<glm::vec3> places;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) places.push_back(lo + spacing * (glm::vec3(x, y, z) + 0.5f));
    return places;
}

void reserveFluid(const Device& device, FluidParticles& fluid, uint32_t count) {
    fluid.count = count;
    for (Buffer* each : {&fluid.places, &fluid.velocities})
        reserve(device, *each, 16 * std::max<uint64_t>(roomFor(count), 1));
}

void setFluid(const Device& device, FluidParticles& fluid, const std::vector<glm::vec3>& places,
              const std::vector<glm::vec3>& velocities) {
    reserveFluid(device, fluid, uint32_t(places.size()));
    const auto write = [&](const Buffer& buffer, const std::vector<glm::vec3>& from) {
        std::vector<glm::vec4> padded(std::max<std::size_t>(places.size(), 1), glm::vec4(0.0f));
        for (std::size_t i = 0; i < from.size(); ++i) padded[i] = glm::vec4(from[i], 0.0f);
        upload(device, buffer, padded);
    };
    write(fluid.places, places);
    write(fluid.velocities, velocities);
}

void addToFluid(const Device& device, FluidParticles& fluid, const std::vector<glm::vec3>& places,
                const std::vector<glm::vec3>& velocities, uint32_t firstId) {
    const uint32_t old = std::exchange(fluid.count, fluid.count + uint32_t(places.size()));
    const auto add = [&](Buffer& buffer, const std::vector<glm::vec4>& from) {
        if (buffer.size < 16 * roomFor(fluid.count)) {
            Buffer larger = createBuffer(device, 16 * roomFor(fluid.count + fluid.count / 4));
            Commands commands(device);
            if (old > 0) copy(commands, buffer, 0, larger, 0, 16ull * old);
            submit(commands);
            buffer = std::move(larger);
        }
        uploadBytes(device, buffer, from.data(), 16 * from.size(), 16ull * old);
    };
    std::vector<glm::vec4> at;
    for (const glm::vec3& each : places) at.emplace_back(each, 0.0f);
    add(fluid.places, at);
    add(fluid.velocities, numbered(velocities, firstId));
}

std::vector<glm::vec4> numbered(const std::vector<glm::vec3>& velocities, uint32_t firstId) {
    std::vector<glm::vec4> all;
    all.reserve(velocities.size());
    for (const glm::vec3& each : velocities) all.emplace_back(each, std::bit_cast<float>(firstId++));
    return all;
}

void drainFluid(Commands& commands, const FluidKernels& kernels, FluidParticles& b,
                const FieldBuffers& outflow) {
    if (b.count == 0) return;
    const Device& device = commands.device;
    gpu::FluidPush push{};
    push.particles = b.count;
    for (Buffer* each : {&b.sortedPlaces, &b.sortedGuesses, &b.sortedPlanes})
        reserve(device, *each, 16 * roomFor(b.count));
    reserve(device, b.keys, 4 * roomFor(b.count));
    static_assert(FLUID_DRAIN_BLOCK <= SORT_MOST_SETTLED);
    const uint32_t blocks = groupsFor(b.count, FLUID_DRAIN_BLOCK);
    const auto run = [&](const Pipeline& kernel, std::span<const Descriptor> bound) {
        dispatch(commands, kernel, spread(device, groupsFor(b.count, FLUID_GROUP)), push, bound);
        barrier(commands);
    };
    std::vector<Descriptor> drained = {{0, b.places}, {1, b.keys}};
    addField(drained, outflow);
    run(*kernels.drain, drained);
    sortByKey(commands, kernels.sort, b.cells, b.keys, b.order, b.count, blocks + 1);
    run(kernels.reorder,
        std::array{Descriptor{0, b.order}, Descriptor{1, b.places}, Descriptor{2, b.velocities},
                   Descriptor{3, b.velocities}, Descriptor{4, b.sortedPlaces}, Descriptor{5, b.sortedGuesses},
                   Descriptor{6, b.sortedPlanes}, Descriptor{7, b.velocities}});
    submit(commands);
    std::swap(b.places, b.sortedPlaces);
    std::swap(b.velocities, b.sortedGuesses);
    b.count = download<uint32_t>(device, b.cells.starts, 1, 4ull * blocks)[0];
}

namespace {

/// Records the turns of a step: particles give way to one another.
void takeTurns(Commands& commands, const FluidKernels& kernels, FluidParticles& b, const FluidConfig& config,
               const gpu::FluidPush& push) {
    const bool many = b.count > kParticlesSentTogether, ends = config.error > 0.0f;
    const glm::uvec3 groups = spread(commands.device, groupsFor(b.count, FLUID_GROUP));
    if (ends) {
        reserve(commands.device, b.errors, 4 * FLUID_ERROR_SUMS);
        reserve(commands.device, b.turns, sizeof(gpu::FluidTurns));
        fill(commands, b.errors, 0);
        const gpu::FluidTurns first{groups, gpu::uvec3(1), 0};
        update(commands, b.turns, &first, sizeof first);
        barrier(commands);
    }
    const auto run = [&](const Pipeline& kernel, std::span<const Descriptor> bound) {
        if (ends) dispatchIndirect(commands, kernel, b.turns, 0, push, bound);
        if (!ends) dispatch(commands, kernel, groups, push, bound);
        barrier(commands);
    };
    const std::array weighs = {Descriptor{0, b.sortedGuesses}, Descriptor{1, b.sortedPlanes},
                               Descriptor{2, b.lists},         Descriptor{3, b.counts},
                               Descriptor{4, b.weighed},       Descriptor{5, b.densities},
                               Descriptor{6, b.far},           Descriptor{7, b.errors}};
    const std::array moves = {Descriptor{0, b.weighed},       Descriptor{1, b.sortedPlanes},
                              Descriptor{2, b.lists},         Descriptor{3, b.counts},
                              Descriptor{4, b.sortedGuesses}, Descriptor{5, b.sortedGuesses}};
    for (int i = 0; i < config.iterations; ++i) {
        run(ends ? kernels.addedError : kernels.densityError, weighs);
        if (ends) {
            dispatchIndirect(commands, kernels.enough, b.turns, offsetof(gpu::FluidTurns, one), push,
                             std::array{Descriptor{0, b.errors}, Descriptor{1, b.turns}});
            barrier(commands);
        }
        run(kernels.giveWay, moves);
        if (many) sendOn(commands);
    }
}

}  // namespace

Done recordFluidStep(Commands& commands, const FluidKernels& kernels, FluidParticles& b,
                     const FluidConfig& config, float step) {
    const Device& device = commands.device;
    if (const Done fit = fits(device, config, b.count, step); !fit) return fit.error();
    if (b.count == 0) return done();
    gpu::FluidPush push = fluidPush(config, b.count, step);
    const uint64_t room = roomFor(b.count);
    for (Buffer* each :
         {&b.guesses, &b.planes, &b.sortedPlaces, &b.sortedGuesses, &b.sortedPlanes, &b.weighed})
        reserve(device, *each, 16 * room);
    for (Buffer* each : {&b.keys, &b.counts, &b.far, &b.densities}) reserve(device, *each, 4 * room);
    if (config.vorticity > 0.0f) reserve(device, b.curls, 16 * room);
    const uint32_t groups = groupsFor(b.count, FLUID_GROUP);
    reserve(device, b.lists, 4ull * FLUID_MOST_NEIGHBOURS * room);
    const bool many = b.count > kParticlesSentTogether;
    const auto run = [&](const Pipeline& kernel, std::span<const Descriptor> bound) {
        dispatch(commands, kernel, spread(device, groups), push, bound);
        barrier(commands);
    };
    const auto sendIfMany = [&] {
        if (many) sendOn(commands);
    };
    beginStage(commands, "predict");
    std::vector<Descriptor> predicted = {{0, b.places}, {1, b.velocities}, {2, b.guesses},
                                         {3, b.planes}, {4, b.keys},       {5, b.places}};
    addField(predicted, config.field);
    run(kernels.predict, predicted);
    beginStage(commands, "sort");
    sortByKey(commands, kernels.sort, b.cells, b.keys, b.order, b.count,
              uint32_t(push.cells.x * push.cells.y * push.cells.z));
    run(kernels.reorder,
        std::array{Descriptor{0, b.order}, Descriptor{1, b.places}, Descriptor{2, b.guesses},
                   Descriptor{3, b.planes}, Descriptor{4, b.sortedPlaces}, Descriptor{5, b.sortedGuesses},
                   Descriptor{6, b.sortedPlanes}, Descriptor{7, b.velocities}});
    sendIfMany();
    beginStage(commands, "neighbours");
    // Written as words, of which not all may be bound at once; read as texels, which may.
    const uint64_t listBytes = 4ull * FLUID_MOST_NEIGHBOURS * FLUID_GROUP;  // of a group
    const auto most = uint32_t(
        std::min<uint64_t>(device.limits.storageRange / listBytes, 2 * kParticlesSentTogether / FLUID_GROUP));
    for (uint32_t group = 0; group < groups; group += most) {
        const uint32_t some = std::min(most, groups - group);
        push.from = group * FLUID_GROUP;
        dispatch(commands, config.farOnce ? kernels.nearNeighbours : kernels.neighbours, spread(device, some),
                 push,
                 std::array{Descriptor{0, b.sortedGuesses}, Descriptor{1, b.cells.starts},
                            Descriptor{2, b.lists, group * listBytes, some * listBytes},
                            Descriptor{3, b.counts}, Descriptor{4, b.far}});
        sendIfMany();
    }
    barrier(commands);
    beginStage(commands, "density");
    takeTurns(commands, kernels, b, config, push);
    beginStage(commands, "velocity");
    // The old guesses' memory is free by now.
    run(kernels.velocity,
        std::array{Descriptor{0, b.sortedPlaces}, Descriptor{1, b.sortedGuesses}, Descriptor{2, b.guesses}});
    if (config.vorticity > 0.0f) {
        run(kernels.curl,
            std::array{Descriptor{0, b.sortedGuesses}, Descriptor{1, b.guesses}, Descriptor{2, b.lists},
                       Descriptor{3, b.counts}, Descriptor{4, b.curls}});
        run(kernels.confine,
            std::array{Descriptor{0, b.sortedGuesses}, Descriptor{1, b.curls}, Descriptor{2, b.lists},
                       Descriptor{3, b.counts}, Descriptor{4, b.guesses}});
    }
    std::vector<Descriptor> smoothed = {
        {0, b.sortedGuesses}, {1, b.guesses}, {2, b.lists}, {3, b.counts}, {4, b.velocities}};
    if (config.tension > 0.0f) {
        run(kernels.densityGradient,
            std::array{Descriptor{0, b.sortedGuesses}, Descriptor{1, b.sortedPlanes}, Descriptor{2, b.lists},
                       Descriptor{3, b.counts}, Descriptor{4, b.weighed}});
        smoothed.insert(smoothed.end(), {{5, b.sortedPlanes}, {6, b.weighed}});
    }
    run(config.tension > 0.0f ? kernels.drawTogether : kernels.smoothVelocity, smoothed);
    std::swap(b.places, b.sortedGuesses);
    return done();
}

namespace {

/// `ahead` records what goes ahead of each step, by its number, and `behind` what follows.
template <class Ahead, class Behind>
Done recordSteps(Commands& commands, const FluidKernels& kernels, FluidParticles& fluid,
                 const FluidConfig& config, float step, int count, Ahead ahead, Behind behind) {
    uint64_t recorded = 0;
    for (int i = 0; i < count; ++i) {
        ahead(i);
        if (const Done stepped = recordFluidStep(commands, kernels, fluid, config, step); !stepped)
            return stepped;
        behind();
        if ((recorded += fluid.count) < kParticlesSentTogether) continue;
        sendOn(commands);
        recorded = 0;
    }
    return done();
}

}  // namespace

Done recordFluidSteps(Commands& commands, const FluidKernels& kernels, FluidParticles& fluid,
                      const FluidConfig& config, float step, int count,
                      const std::function<void(int)>& ahead) {
    return recordSteps(
        commands, kernels, fluid, config, step, count,
        [&](int i) {
            if (ahead) ahead(i);
        },
        [] {});
}

Done recordSettling(Commands& commands, const FluidKernels& kernels, FluidParticles& fluid,
                    FluidConfig config) {
    constexpr int kTurns = 30;
    constexpr float kStep = 1.0f / 240;
    config.gravity = glm::vec3(0.0f);
    return recordSteps(
        commands, kernels, fluid, config, kStep, kTurns, [](int) {},
        [&] {
            fill(commands, fluid.velocities, 0);
            barrier(commands);
        });
}

}  // namespace fw
