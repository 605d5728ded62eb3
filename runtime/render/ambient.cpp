#include "runtime/render/ambient.h"

#include <algorithm>
#include <cmath>

#include "shaders/render/ambient.h"

namespace fw {

namespace {

/// Images for the size of the frame; whether they are new.
bool resize(Commands& commands, Ambient& ambient, VkExtent3D extent) {
    const Device& device = commands.device;
    if (ambient.result && ambient.result.extent.width == extent.width &&
        ambient.result.extent.height == extent.height)
        return false;
    for (Image& history : ambient.history) {
        history = createImage(device, {.extent = extent, .format = VK_FORMAT_R32G32B32A32_UINT});
        imageBarrier(commands, history, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    }
    ambient.result = createImage(device, {.extent = extent, .format = VK_FORMAT_R32_SFLOAT});
    imageBarrier(commands, ambient.result, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    reserve(device, ambient.tileList,
            4ull * groupsFor(extent.width, AMBIENT_TILE) * groupsFor(extent.height, AMBIENT_TILE));
    return true;
}

void clear(Commands& commands, const Image& image, VkClearColorValue value) {
    const VkImageSubresourceRange all = {image.aspect, 0, 1, 0, 1};
    vkCmdClearColorImage(commands.handle, image.handle, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
}

gpu::AmbientView describe(const Ambient& ambient, const AmbientFrame& frame, bool resting) {
    const AmbientOptions& options = ambient.options;
    gpu::AmbientView view{};
    view.inverseNow = frame.view.inverseViewProjection;
    view.before = ambient.before.viewProjection;
    view.inverseBefore = ambient.before.inverseViewProjection;
    view.eye = frame.view.eye;
    view.radius = options.radius;
    view.bias = options.bias;
    view.stepScale = std::isfinite(frame.lipschitz) ? 1.0f / std::max(frame.lipschitz, 1.0f) : 0.5f;
    view.width = frame.depth.extent.width;
    view.height = frame.depth.extent.height;
    view.frame = ambient.frame;
    view.samples = uint32_t(std::max(options.samples, 1));
    view.raysNew = uint32_t(std::clamp(options.raysNew, 1, AMBIENT_MOST_RAYS));
    view.raysKept = uint32_t(std::clamp(options.raysKept, 1, AMBIENT_MOST_RAYS));
    view.mostKept = uint32_t(resting ? options.enough : options.mostKept);
    view.balance = options.balance;
    return view;
}

}  // namespace

Ambient createAmbient(const Device& device, std::string_view field, const AmbientOptions& options) {
    Ambient ambient;
    ambient.options = options;
    const ShaderOptions shaders[] = {{.name = "render/ambient_tiles.comp"},
                                     {.name = "render/ambient.comp", .field = field}};
    std::vector<Pipeline> pipelines = createComputePipelines(device, shaders);
    ambient.tiles = std::move(pipelines[0]);
    ambient.trace = std::move(pipelines[1]);
    ambient.view = createBuffer(device, sizeof(gpu::AmbientView), Memory::upload);
    ambient.arguments = createBuffer(device, sizeof(gpu::DispatchArguments));
    return ambient;
}

void drawAmbient(Commands& commands, Ambient& ambient, const AmbientFrame& frame) {
    const VkExtent3D extent = frame.depth.extent;
    const bool anew = resize(commands, ambient, extent) || !ambient.hasHistory || !ambient.options.reproject;
    const bool resting = !anew && frame.view == ambient.before;
    if (!resting) ambient.rays = 0;
    Image& before = ambient.history[ambient.frame % 2];
    Image& now = ambient.history[(ambient.frame + 1) % 2];
    upload(commands.device, ambient.view, std::vector{describe(ambient, frame, resting)});
    beginStage(commands, "ambient");
    fill(commands, ambient.arguments, 1);
    fill(commands, ambient.arguments, 0, 0, 4);
    if (anew) clear(commands, before, {});
    clear(commands, now, {});
    VkClearColorValue open{};
    open.float32[0] = 1.0f;
    clear(commands, ambient.result, open);
    barrier(commands);
    const auto storage = [](uint32_t binding, const Image& image) {
        return Descriptor(binding, image.view, VK_IMAGE_LAYOUT_GENERAL);
    };
    std::vector<Descriptor> bound = {
        storage(0, frame.depth),    storage(1, frame.normal), storage(2, before), storage(3, now),
        storage(4, ambient.result), {5, ambient.tileList},    {6, ambient.view},  {7, ambient.arguments}};
    if (frame.parameters) bound.push_back({FIELD_PARAMETERS, *frame.parameters});
    dispatch(commands, ambient.tiles,
             {groupsFor(extent.width, AMBIENT_TILE), groupsFor(extent.height, AMBIENT_TILE), 1}, nullptr, 0,
             bound);
    barrier(commands);
    dispatchIndirect(commands, ambient.trace, ambient.arguments, 0, nullptr, 0, bound);
    barrier(commands);
    ambient.rays += resting ? ambient.options.raysKept : ambient.options.raysNew;
    ambient.before = frame.view;
    ambient.hasHistory = true;
    ++ambient.frame;
}

void forgetHistory(Ambient& ambient) { ambient.hasHistory = false; }

bool converged(const Ambient& ambient) { return ambient.rays >= ambient.options.enough; }

}  // namespace fw
