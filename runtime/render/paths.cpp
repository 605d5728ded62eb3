#include "runtime/render/paths.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "runtime/render/describe.h"
#include "runtime/render/primary.h"
#include "runtime/render/renderer.h"
#include "runtime/system/clock.h"

namespace fw {

namespace {

constexpr double kBetweenKept = 10'000;  // ms
constexpr int kPathsTogether = 16;       // of a pixel, so that lanes seldom wait for others' last

gpu::PathPush pushOf(const Scene& scene, const gpu::View& view, const gpu::RenderFrame& frame, int bounces) {
    gpu::PathPush push{};
    push.bounces = uint32_t(bounces);
    push.focus = 1.0f;
    if (scene.camera && scene.camera->aperture > 0.0) {
        push.lens = 0.5f * float(scene.camera->aperture);
        push.focus = focusOf(*scene.camera, view);
    }
    push.sun = frame.sun;
    push.sunWide = scene.sun ? float(1.0 - std::cos(glm::radians(0.5 * scene.sun->size))) : -1.0f;
    return push;
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
    renderer.described = describeFrame(renderer, scene, options, view, false, 0, 0);
    const gpu::RenderFrame& frame = renderer.described;
    std::memcpy(renderer.frame.mapped, &frame, sizeof frame);
    if (!paths.trace)
        paths.trace = createComputePipeline(device, {.name = "render/path.comp", .field = renderer.field});
    Pipeline& expose = paths.expose[frame.neutral];
    if (!expose) {
        ShaderOptions shader{.name = "render/expose.comp"};
        if (frame.neutral != 0) shader.defines.push_back("NEUTRAL");
        expose = createComputePipeline(device, shader);
    }
    reserve(device, paths.sums, bytes);
    gpu::PathPush push = pushOf(options.scene, view, frame, options.bounces);
    const int known = options.sums ? options.sums->paths : 0;
    if (known > 0) upload(device, paths.sums, options.sums->sums);
    const auto keep = [&](int done) {
        if (options.sums)
            *options.sums = {done, download<float>(device, paths.sums, std::size_t(bytes / sizeof(float)))};
    };
    std::vector<Descriptor> bound = {{0, renderer.frame}, {8, paths.sums, 0, bytes}};
    addField(bound, fieldOf(renderer, scene));
    Clock::time_point kept = Clock::now();
    for (int i = known; i < options.samples;) {
        if (options.progress) options.progress(int(100ll * i / options.samples));
        Commands commands(device);
        commands.parted = true;
        commands.cancel = options.cancel;
        if (i == known) findPlaces(commands, renderer, scene);
        push.path = uint32_t(i);
        push.paths = uint32_t(std::min(kPathsTogether, options.samples - i));
        dispatchRows(commands, paths.trace,
                     {groupsFor(extent.width, RENDER_PATHS), groupsFor(extent.height, RENDER_PATHS), 1},
                     &push, sizeof push, bound);
        if (cancelled(commands)) return Error{.message = "cancelled"};
        submit(commands);
        i += int(push.paths);
        if (options.keepSums && millisecondsSince(kept) > kBetweenKept) {
            keep(i);
            options.keepSums();
            kept = Clock::now();
        }
    }
    keep(std::max(known, options.samples));
    Commands commands(device);
    resizeImage(commands, renderer.pixels, extent, VK_FORMAT_R32_UINT);
    const Descriptor shown[] = {{0, renderer.frame}, {8, paths.sums, 0, bytes}, storage(10, renderer.pixels)};
    dispatch(commands, expose,
             {groupsFor(extent.width, RENDER_TILE), groupsFor(extent.height, RENDER_TILE), 1}, nullptr, 0,
             shown);
    barrier(commands);
    recordReading(commands, renderer.pixels, renderer.readback);
    submit(commands);
    return readPicture(renderer);
}

}  // namespace fw
