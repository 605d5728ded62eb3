#include "runtime/render/paths.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "runtime/render/describe.h"
#include "runtime/render/lighting.h"
#include "runtime/render/primary.h"
#include "runtime/render/renderer.h"
#include "runtime/system/clock.h"

namespace fw {

namespace {

constexpr double kBetweenKept = 10'000;  // ms
constexpr int kPathsTogether = 16;       // of a pixel, so that lanes seldom wait for others' last

gpu::PathPush pushOf(const RenderOptions& options, const gpu::View& view, const gpu::RenderFrame& frame) {
    const Scene& scene = options.scene;
    gpu::PathPush push{};
    push.bounces = uint32_t(options.bounces);
    push.focus = 1.0f;
    if (scene.camera && scene.camera->aperture > 0.0) {
        push.lens = 0.5f * float(scene.camera->aperture);
        push.focus = focusOf(*scene.camera, view);
    }
    push.cutout = options.cutout;
    push.sun = frame.sun;
    push.sunWide = scene.sun ? float(1.0 - std::cos(glm::radians(0.5 * scene.sun->size))) : -1.0f;
    return push;
}

/// Runs expose.comp with these defined.
void expose(Commands& commands, Renderer& renderer, std::vector<std::string> defines, const Image& to,
            uint32_t binding, VkDeviceSize bytes, uint32_t paths) {
    Pipeline& pipeline = renderer.paths.expose[defines];
    if (!pipeline)
        pipeline = createComputePipeline(*renderer.device,
                                         {.name = "render/expose.comp", .defines = std::move(defines)});
    const Descriptor bound[] = {
        {0, renderer.frame}, {8, renderer.paths.sums, 0, bytes}, storage(binding, to)};
    dispatch(commands, pipeline,
             {groupsFor(to.extent.width, RENDER_TILE), groupsFor(to.extent.height, RENDER_TILE), 1}, &paths,
             sizeof paths, bound);
    barrier(commands);
}

/// Makes the picture of the sums of so many paths.
void showPaths(Renderer& renderer, const RenderOptions& options, VkDeviceSize bytes, uint32_t paths) {
    const VkExtent3D extent = {uint32_t(options.width), uint32_t(options.height), 1};
    const bool neutral = renderer.described.neutral != 0;
    const Bloom* bloom = bloomOf(options);
    Commands commands(*renderer.device);
    resizeImage(commands, renderer.pixels, extent, VK_FORMAT_R32_UINT);
    if (bloom || options.light) {
        resizeImage(commands, renderer.means, extent, VK_FORMAT_R32G32B32A32_SFLOAT);
        expose(commands, renderer, {"LIGHT"}, renderer.means, 9, bytes, paths);
    }
    if (bloom) {
        drawBloom(commands, renderer.bloom, *bloom, renderer.means, renderer.frame, neutral, options.cutout,
                  renderer.pixels);
    } else {
        std::vector<std::string> defines;
        if (neutral) defines.push_back("NEUTRAL");
        if (options.cutout) defines.push_back("CUTOUT");
        expose(commands, renderer, std::move(defines), renderer.pixels, 10, bytes, paths);
    }
    recordReading(commands, renderer.pixels, renderer.readback);
    submit(commands);
}

}  // namespace

Result<Picture> renderPaths(Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
                            const gpu::View& view) {
    const Device& device = *renderer.device;
    PathTracer& paths = renderer.paths;
    const VkExtent3D extent = {uint32_t(options.width), uint32_t(options.height), 1};
    const uint64_t bytes = 16ull * extent.width * extent.height;
    if (bytes > device.limits.storageRange)
        return Error{.message = "paths of light are traced for at most " +
                                std::to_string(device.limits.storageRange >> 24) +
                                " million pixels on this device: make the picture smaller"};
    renderer.shown.reset();
    const int first = firstOf(options, options.moment), last = firstOf(options, options.moment + 1);
    if (options.light && first == 0 && !readSurfaces(renderer, scene, options, view, *options.light))
        return Error{.message = "cancelled"};
    renderer.described = describeFrame(renderer, scene, options, view, false, 0, 0);
    const gpu::RenderFrame& frame = renderer.described;
    std::memcpy(renderer.frame.mapped, &frame, sizeof frame);
    Pipeline& trace = paths.trace[hasEnvironment(options)];
    if (!trace) {
        ShaderOptions shader{.name = "render/path.comp", .field = renderer.field};
        if (hasEnvironment(options)) shader.defines.push_back("ENVIRONMENT");
        trace = createComputePipeline(device, shader);
    }
    reserve(device, paths.sums, bytes);
    gpu::PathPush push = pushOf(options, view, frame);
    const int known = std::max(first, options.sums ? options.sums->paths : 0);
    if (first == 0 && known > 0) upload(device, paths.sums, options.sums->sums);
    const auto keep = [&](int done) {
        if (options.sums)
            *options.sums = {done, download<float>(device, paths.sums, std::size_t(bytes / sizeof(float)))};
    };
    std::vector<Descriptor> bound = {{0, renderer.frame}, {8, paths.sums, 0, bytes}};
    if (hasEnvironment(options)) bound.push_back({25, renderer.environment.words});
    addField(bound, fieldOf(renderer, scene));
    Clock::time_point kept = Clock::now();
    for (int i = known; i < last;) {
        if (options.progress) options.progress(int(100ll * i / options.samples));
        Commands commands(device);
        commands.parted = true;
        commands.cancel = options.cancel;
        if (i == known) findPlaces(commands, renderer, scene);
        push.path = uint32_t(i);
        push.paths = uint32_t(std::min(kPathsTogether, last - i));
        dispatchRows(commands, trace,
                     {groupsFor(extent.width, RENDER_PATHS), groupsFor(extent.height, RENDER_PATHS), 1},
                     &push, sizeof push, bound);
        if (cancelled(commands)) return Error{.message = "cancelled"};
        submit(commands);
        const int before = std::exchange(i, i + int(push.paths));
        if (options.grows && i < options.samples &&
            std::bit_width(uint32_t(i)) > std::bit_width(uint32_t(before))) {
            showPaths(renderer, options, bytes, uint32_t(i));
            options.grows(readPicture(renderer, options));
        }
        if (options.keepSums && millisecondsSince(kept) > kBetweenKept) {
            keep(i);
            options.keepSums();
            kept = Clock::now();
        }
    }
    const auto all = uint32_t(std::max(known, last));
    keep(int(all));
    if (last < options.samples) return Picture{};  // of the last moment
    showPaths(renderer, options, bytes, all);
    if (options.light) options.light->color = readLight(renderer, options);
    return readPicture(renderer, options);
}

}  // namespace fw
