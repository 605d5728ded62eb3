#include "runtime/particles/foam.h"

#include <algorithm>
#include <array>
#include <glm/vec4.hpp>
#include <limits>
#include <utility>

#include "shaders/shared.h"

#include "shaders/particles/fluid.h"
#include "shaders/particles/foam.h"

namespace fw {

FoamKernels createFoamKernels(const Device& device, std::string_view obstacle) {
    ShaderOptions move{.name = "particles/foam_move.comp", .field = obstacle};
    if (!obstacle.empty()) move.defines = {"OBSTACLE", "FIELD_GRADIENT"};
    const std::array shaders = {ShaderOptions{.name = "particles/foam_normals.comp"},
                                ShaderOptions{.name = "particles/foam_torn.comp"},
                                ShaderOptions{.name = "particles/foam_vacant.comp"},
                                ShaderOptions{.name = "particles/foam_free.comp"},
                                ShaderOptions{.name = "particles/foam_births.comp"},
                                move,
                                ShaderOptions{.name = "particles/foam_shown.comp"}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    return {createKeyCounting(device), std::move(made[0]), std::move(made[1]), std::move(made[2]),
            std::move(made[3]),        std::move(made[4]), std::move(made[5]), std::move(made[6])};
}

void reserveFoam(const Device& device, FoamParticles& foam, uint32_t slots) {
    foam.slots = slots;
    for (Buffer* each : {&foam.places, &foam.velocities}) reserve(device, *each, 16ull * slots);
    reserve(device, foam.ids, foamIdBytes(slots));
}

void clearFoam(const Device& device, FoamParticles& foam, uint32_t slots) {
    reserveFoam(device, foam, slots);
    upload(device, foam.places, std::vector(slots, glm::vec4(std::numeric_limits<float>::quiet_NaN())));
    upload(device, foam.velocities, std::vector(slots, glm::vec4(0.0f, 0.0f, 0.0f, -1.0f)));
    upload(device, foam.ids, std::vector<uint32_t>(slots + 2));
}

namespace {

void writeNumbers(Commands& commands, FoamParticles& foam, const gpu::FoamNumbers& numbers) {
    reserve(commands.device, foam.numbers, sizeof numbers);
    update(commands, foam.numbers, &numbers, sizeof numbers);
}

}  // namespace

void recordFoamStep(Commands& commands, const FoamKernels& kernels, FoamParticles& foam,
                    const FoamConfig& config, FluidParticles& fluid, const FluidConfig& flowing, float step) {
    const Device& device = commands.device;
    const gpu::FluidPush push = fluidPush(flowing, fluid.count, step);
    writeNumbers(commands, foam,
                 {.slots = foam.slots,
                  .step = config.step,
                  .seed = config.seed,
                  .amount = config.amount * step,
                  .speed = config.speed,
                  .lifetime = config.lifetime,
                  .shown = 0});
    const auto run = [&](const Pipeline& kernel, uint32_t items, std::span<const Descriptor> bound) {
        dispatch(commands, kernel, spread(device, groupsFor(items, FLUID_GROUP)), push, bound);
        barrier(commands);
    };
    beginStage(commands, "foam");
    if (fluid.count > 0) {
        const uint64_t some = fluid.count + fluid.count / 8 + 1;  // of what grows a few more
        reserve(device, foam.normals, 16ull * some);
        for (Buffer* each : {&foam.given, &foam.before}) reserve(device, *each, 4ull * some);
        for (Buffer* each : {&foam.vacant, &foam.free}) reserve(device, *each, 4ull * (foam.slots + 1));
        run(kernels.normals, fluid.count,
            std::array{Descriptor{0, fluid.places}, Descriptor{1, fluid.sortedPlanes},
                       Descriptor{2, fluid.lists}, Descriptor{3, fluid.counts}, Descriptor{4, foam.normals}});
        run(kernels.torn, fluid.count + 1,
            std::array{Descriptor{0, foam.numbers}, Descriptor{1, fluid.places},
                       Descriptor{2, fluid.velocities}, Descriptor{3, foam.normals},
                       Descriptor{4, fluid.lists}, Descriptor{5, fluid.counts}, Descriptor{6, foam.given}});
        sumCounts(commands, kernels.counting, foam.sums, foam.given, foam.before, fluid.count + 1);
        run(kernels.vacant, foam.slots + 1,
            std::array{Descriptor{0, foam.numbers}, Descriptor{1, foam.velocities},
                       Descriptor{2, foam.vacant}});
        sumCounts(commands, kernels.counting, foam.vacantSums, foam.vacant, foam.vacantBefore,
                  foam.slots + 1);
        run(kernels.free, foam.slots,
            std::array{Descriptor{0, foam.numbers}, Descriptor{1, foam.vacant},
                       Descriptor{2, foam.vacantBefore}, Descriptor{3, foam.free}});
        run(kernels.births, fluid.count,
            std::array{Descriptor{0, foam.numbers}, Descriptor{1, fluid.places},
                       Descriptor{2, fluid.velocities}, Descriptor{3, foam.before},
                       Descriptor{4, foam.vacantBefore}, Descriptor{5, foam.free}, Descriptor{6, foam.places},
                       Descriptor{7, foam.velocities}, Descriptor{8, foam.ids}});
    } else {  // no cell has any, and nothing is born
        const VkDeviceSize counts = 4ull * foam.slots, now = 4ull * (config.step & 1);
        copy(commands, foam.ids, counts + now, foam.ids, counts + 4 - now, 4);
        reserve(device, fluid.cells.starts, 4ull * uint32_t(push.cells.x * push.cells.y * push.cells.z));
        fill(commands, fluid.cells.starts, 0);
        barrier(commands);
    }
    std::vector<Descriptor> moved = {{0, foam.numbers},       {1, fluid.places}, {2, fluid.velocities},
                                     {3, fluid.cells.starts}, {4, foam.places},  {5, foam.velocities}};
    addField(moved, flowing.field);
    run(kernels.move, foam.slots, moved);
}

void recordFoamShown(Commands& commands, const FoamKernels& kernels, FoamParticles& foam, int kind) {
    reserve(commands.device, foam.shown, 16ull * foam.slots);
    gpu::FoamNumbers numbers{};
    numbers.slots = foam.slots;
    numbers.shown = kind;
    writeNumbers(commands, foam, numbers);
    const std::array bound = {Descriptor{0, foam.numbers}, Descriptor{1, foam.places},
                              Descriptor{2, foam.velocities}, Descriptor{3, foam.shown}};
    dispatch(commands, kernels.shown, spread(commands.device, groupsFor(foam.slots, FLUID_GROUP)),
             gpu::FluidPush{}, bound);
    barrier(commands);
}

}  // namespace fw
