#include "runtime/particles/fluid.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <span>
#include <utility>

#include "shaders/shared.h"

#include "shaders/particles/fluid.h"

namespace fw {

namespace {

constexpr double kSoft = 0.01;  // of the squared gradients in a full lattice: what keeps lone particles still

/// Sum over a full cubic lattice of the squared gradients that two particles have of each other, times
/// spacing squared.
double squaresInLattice() {
    const int reach = int(kFluidSupport);
    const double support = kFluidSupport, s5 = std::pow(support, 5);
    double sum = 0.0;
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const double r = std::sqrt(double(x * x + y * y + z * z)),
                             u = std::max(1.0 - r / support, 0.0);
                const double slope = 210.0 / (std::numbers::pi * s5) * u * u * u * r;
                sum += slope * slope;
            }
    return sum;
}

gpu::FluidPush pushOf(const FluidConfig& config, uint32_t count, float step) {
    static const double squares = squaresInLattice();
    gpu::FluidPush push{};
    push.support = kFluidSupport * config.spacing;
    push.cell = 0.5f * push.support;
    push.first = config.lo - 2.5f * push.cell;
    push.cells = glm::ivec3(glm::ceil((config.hi - config.lo) / push.cell)) + 6;
    push.particles = count;
    push.lo = config.lo;
    push.hi = config.hi;
    push.gravity = config.gravity;
    push.step = step;
    push.volume = config.spacing * config.spacing * config.spacing;
    push.viscosity = config.viscosity;
    push.tension = config.tension;
    push.soft = float(kSoft * squares) / (config.spacing * config.spacing);
    return push;
}

Done fits(const Device& device, const gpu::FluidPush& push) {
    const double range = device.properties.limits.maxStorageBufferRange;
    if (4.0 * FLUID_MOST_NEIGHBOURS * push.particles > range)
        return Error{.message = "more particles than this device can list the neighbours of: " +
                                std::to_string(uint64_t(range / (4.0 * FLUID_MOST_NEIGHBOURS))) +
                                " is the most, so raise the spacing"};
    if (4.0 * push.cells.x * push.cells.y * push.cells.z > range)
        return Error{
            .message =
                "the fluid's tank has more cells than this device can use: make it smaller, or raise the "
                "spacing"};
    return done();
}

}  // namespace

FluidKernels createFluidKernels(const Device& device, std::string_view obstacle) {
    ShaderOptions predict{.name = "particles/predict.comp", .field = obstacle};
    if (!obstacle.empty()) predict.defines = {"OBSTACLE", "FIELD_GRADIENT"};
    const std::array shaders = {predict,
                                ShaderOptions{.name = "particles/reorder.comp"},
                                ShaderOptions{.name = "particles/neighbours.comp"},
                                ShaderOptions{.name = "particles/density_error.comp"},
                                ShaderOptions{.name = "particles/give_way.comp"},
                                ShaderOptions{.name = "particles/velocity.comp"},
                                ShaderOptions{.name = "particles/smooth_velocity.comp"}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    return {createCountingSort(device), std::move(made[0]), std::move(made[1]), std::move(made[2]),
            std::move(made[3]),         std::move(made[4]), std::move(made[5]), std::move(made[6])};
}

std::vector<glm::vec3> fluidBlock(const glm::vec3& lo, const glm::vec3& hi, float spacing) {
    const glm::ivec3 count = glm::max(glm::ivec3(glm::round((hi - lo) / spacing)), glm::ivec3(0));
    std::vector<glm::vec3> places;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) places.push_back(lo + spacing * (glm::vec3(x, y, z) + 0.5f));
    return places;
}

void setFluid(const Device& device, FluidParticles& fluid, const std::vector<glm::vec3>& places,
              const std::vector<glm::vec3>& velocities) {
    fluid.count = uint32_t(places.size());
    const auto write = [&](Buffer& buffer, const std::vector<glm::vec3>& from) {
        std::vector<glm::vec4> padded(std::max<std::size_t>(places.size(), 1), glm::vec4(0.0f));
        for (std::size_t i = 0; i < from.size(); ++i) padded[i] = glm::vec4(from[i], 0.0f);
        reserve(device, buffer, 16 * padded.size());
        upload(device, buffer, padded);
    };
    write(fluid.places, places);
    write(fluid.velocities, velocities);
}

Done recordFluidStep(Commands& commands, const FluidKernels& kernels, FluidParticles& b,
                     const FluidConfig& config, float step) {
    const Device& device = commands.device;
    const gpu::FluidPush push = pushOf(config, b.count, step);
    if (const Done fit = fits(device, push); !fit) return fit.error();
    if (b.count == 0) return done();
    for (Buffer* each :
         {&b.guesses, &b.planes, &b.sortedPlaces, &b.sortedGuesses, &b.sortedPlanes, &b.weighed})
        reserve(device, *each, 16ull * b.count);
    for (Buffer* each : {&b.keys, &b.counts, &b.densities}) reserve(device, *each, 4ull * b.count);
    reserve(device, b.lists, 4ull * FLUID_MOST_NEIGHBOURS * b.count);
    const auto run = [&](const Pipeline& kernel, std::span<const Descriptor> bound) {
        dispatch(commands, kernel, spread(groupsFor(b.count, FLUID_GROUP)), push, bound);
        barrier(commands);
    };
    beginStage(commands, "predict");
    std::vector<Descriptor> predicted = {
        {0, b.places}, {1, b.velocities}, {2, b.guesses}, {3, b.planes}, {4, b.keys}};
    addField(predicted, config.field);
    run(kernels.predict, predicted);
    beginStage(commands, "sort");
    sortByKey(commands, kernels.sort, b.cells, b.keys, b.order, b.count,
              uint32_t(push.cells.x * push.cells.y * push.cells.z));
    run(kernels.reorder, std::array{Descriptor{0, b.order}, Descriptor{1, b.places}, Descriptor{2, b.guesses},
                                    Descriptor{3, b.planes}, Descriptor{4, b.sortedPlaces},
                                    Descriptor{5, b.sortedGuesses}, Descriptor{6, b.sortedPlanes}});
    beginStage(commands, "neighbours");
    run(kernels.neighbours, std::array{Descriptor{0, b.sortedGuesses}, Descriptor{1, b.cells.starts},
                                       Descriptor{2, b.lists}, Descriptor{3, b.counts}});
    beginStage(commands, "density");
    const std::array weighs = {Descriptor{0, b.sortedGuesses}, Descriptor{1, b.sortedPlanes},
                               Descriptor{2, b.lists},         Descriptor{3, b.counts},
                               Descriptor{4, b.weighed},       Descriptor{5, b.densities}};
    const std::array moves = {Descriptor{0, b.weighed}, Descriptor{1, b.sortedPlanes}, Descriptor{2, b.lists},
                              Descriptor{3, b.counts}, Descriptor{4, b.sortedGuesses}};
    for (int i = 0; i < config.iterations; ++i) {
        run(kernels.densityError, weighs);
        run(kernels.giveWay, moves);
    }
    beginStage(commands, "velocity");
    // The old guesses' memory is free by now.
    run(kernels.velocity,
        std::array{Descriptor{0, b.sortedPlaces}, Descriptor{1, b.sortedGuesses}, Descriptor{2, b.guesses}});
    run(kernels.smoothVelocity,
        std::array{Descriptor{0, b.sortedGuesses}, Descriptor{1, b.guesses}, Descriptor{2, b.lists},
                   Descriptor{3, b.counts}, Descriptor{4, b.velocities}});
    std::swap(b.places, b.sortedGuesses);
    return done();
}

}  // namespace fw
