#include "runtime/render/ambient.h"

#include <algorithm>

namespace fw {

namespace {

uint32_t raysWithin(int rays) { return uint32_t(std::clamp(rays, 1, RENDER_MOST_RAYS)); }

}  // namespace

Ambient createAmbient(const Device& device) {
    Ambient ambient;
    ambient.holeCount = createBuffer(device, sizeof(gpu::AmbientHoles));
    return ambient;
}

Ambient createAmbient(const Device& device, std::string_view field, const AmbientOptions& options) {
    Ambient ambient = createAmbient(device);
    ambient.options = options;
    const ShaderOptions shaders[] = {{.name = "render/ambient.comp", .field = field},
                                     {.name = "render/ambient_holes.comp", .field = field}};
    std::vector<Pipeline> pipelines = createComputePipelines(device, shaders);
    ambient.trace = std::move(pipelines[0]);
    ambient.addRays = std::move(pipelines[1]);
    return ambient;
}

void describeAmbient(const Ambient& ambient, gpu::RenderFrame& frame) {
    const AmbientOptions& options = ambient.options;
    frame.ambientRadius = options.radius;
    frame.bias = options.bias;
    frame.ambientSamples = uint32_t(std::max(frame.resting ? options.samples : options.samplesMoving, 2));
    frame.raysNew = raysWithin(options.raysNew);
    frame.raysKept = raysWithin(frame.resting ? options.raysResting : options.raysKept);
    frame.mostKept = uint32_t(frame.resting ? options.enough : options.mostKept);
    frame.balance = options.balance;
}

void drawAmbient(Commands& commands, Ambient& ambient, const GBuffer& gbuffer,
                 const gpu::RenderFrame& described, const Buffer& frame, const FieldBuffers& field) {
    const VkExtent3D extent = gbuffer.now().extent;
    const bool resized = resizeImage(commands, ambient.history[0], extent, VK_FORMAT_R32_UINT);
    resizeImage(commands, ambient.history[1], extent, VK_FORMAT_R32_UINT);
    reserve(commands.device, ambient.holes, 4ull * extent.width * extent.height);
    if (resized || !ambient.hasHistory || !ambient.options.reproject) {
        for (const Image& history : ambient.history) clearImage(commands, history);
        barrier(commands);
    }
    fill(commands, ambient.holeCount, 0, 0, 8);
    fill(commands, ambient.holeCount, 1, 8);
    barrier(commands);
    const Image& before = ambient.now();
    ambient.current = 1 - ambient.current;
    std::vector<Descriptor> bound = {
        {0, frame},         storage(2, gbuffer.now()), {3, gbuffer.tileLists},
        {8, ambient.holes}, {4, ambient.holeCount},    storage(5, gbuffer.before()),
        storage(6, before), storage(7, ambient.now())};
    addField(bound, field);
    dispatchTiles(commands, ambient.trace, gbuffer, RENDER_NEAR, nullptr, 0, bound);
    barrier(commands);
    if (cancelled(commands)) return;
    if (described.balance && described.raysNew > described.raysKept) {
        dispatchIndirect(commands, ambient.addRays, ambient.holeCount, offsetof(gpu::AmbientHoles, arguments),
                         nullptr, 0, bound);
        barrier(commands);
    }
    ambient.rays = (described.resting ? ambient.rays : 0) +
                   int(described.resting ? described.raysKept : described.raysNew);
    ambient.hasHistory = true;
}

void resizeHistory(Commands& commands, Ambient& ambient, VkExtent3D extent) {
    for (Image& history : ambient.history) resizeImage(commands, history, extent, VK_FORMAT_R32_UINT);
    forgetHistory(ambient);
}

void forgetHistory(Ambient& ambient) { ambient.hasHistory = false; }

bool converged(const Ambient& ambient) { return ambient.rays >= ambient.options.enough; }

}  // namespace fw
