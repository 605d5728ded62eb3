#include "runtime/render/lighting.h"

#include "runtime/render/primary.h"

namespace fw {

namespace {

constexpr uint32_t kRaysReference = 64;  // of a frame

/// The pipeline of light.comp with these defined, made at its first use.
const Pipeline& lightPipeline(Renderer& renderer, std::vector<std::string> defines) {
    Pipeline& light = renderer.light[defines];
    if (!light)
        light = createComputePipeline(*renderer.device,
                                      {.name = "render/light.comp", .defines = std::move(defines)});
    return light;
}

/// Edges of the triangles that are seen, over the picture; the mesh's depth has been drawn.
void drawWireframe(Commands& commands, Renderer& renderer, const RenderScene& scene) {
    const Image& depth = renderer.seen.attachment;
    if (!renderer.wireframe)
        renderer.wireframe = createGraphicsPipeline(
            *renderer.device,
            {.shaders = {{.name = "render/wireframe.vert"}, {.name = "render/wireframe.frag"}},
             .depthFormat = depth.format,
             .depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL,
             .depthTest = true});
    imageBarrier(commands, depth, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    beginDrawing(commands, depth, VK_ATTACHMENT_LOAD_OP_LOAD);
    const glm::mat4 clip = toClip(renderer.described.now);
    const Descriptor bound[] = {
        {1, scene.mesh.vertices, 0, VkDeviceSize(scene.vertices) * sizeof(gpu::MeshVertex)},
        {2, scene.mesh.triangles, 0, 12ull * scene.triangles},
        storage(10, renderer.pixels)};
    fw::bind(commands, renderer.wireframe, &clip, sizeof clip, bound);
    vkCmdDraw(commands.handle, 3 * scene.triangles, 1, 0, 0);
    vkCmdEndRendering(commands.handle);
    barrier(commands);
}

/// Widths of walls or gaps, over the picture.
void drawWidths(Commands& commands, Renderer& renderer, const RenderScene& scene) {
    if (!renderer.widths)
        renderer.widths =
            createComputePipeline(*renderer.device, {.name = "render/widths.comp", .field = renderer.field});
    std::vector<Descriptor> bound = {{0, renderer.frame},
                                     storage(2, renderer.gbuffer.now()),
                                     {3, renderer.gbuffer.tileLists},
                                     storage(10, renderer.pixels)};
    addField(bound, fieldOf(renderer, scene));
    dispatchTiles(commands, renderer.widths, renderer.gbuffer, RENDER_SOLID, nullptr, 0, bound);
    barrier(commands);
}

}  // namespace

std::vector<std::string> lampDefines(bool tracesSun) {
    return tracesSun ? std::vector<std::string>{"TRACED_SUN"} : std::vector<std::string>{};
}

bool lightFrame(Commands& commands, Renderer& renderer, const RenderScene& scene,
                const RenderOptions& options, bool mean) {
    const Device& device = commands.device;
    const GBuffer& gbuffer = renderer.gbuffer;
    const gpu::RenderFrame& frame = renderer.described;
    const VkExtent3D extent = {frame.size.x, frame.size.y, 1};
    const bool lamps = frame.lightCount > 0, fog = frame.fogDensity > 0.0f;
    const bool sun = options.scene.sun && options.scene.sun->traced && !scene.draft;
    std::vector<Descriptor> bound = {
        {0, renderer.frame},         storage(1, renderer.seen.depth),    storage(2, gbuffer.now()),
        {3, gbuffer.tileLists},      storage(7, renderer.ambient.now()), storage(8, renderer.shadow.depth),
        storage(10, renderer.pixels)};
    const auto overTiles = [&](const Pipeline& pipeline, uint32_t list) {
        dispatchAllTiles(commands, pipeline, gbuffer, list, nullptr, 0, bound);
    };
    const bool environment = hasEnvironment(options);
    if (environment) bound.push_back({25, renderer.environment.words});
    if (lamps || sun) {
        beginStage(commands, "lamps");
        if (!renderer.lamps || renderer.tracesSun != sun)
            renderer.lamps = createComputePipeline(
                device, {.name = "render/lamps.comp", .field = renderer.field, .defines = lampDefines(sun)});
        renderer.tracesSun = sun;
        resizeImage(commands, renderer.lampLight, extent, VK_FORMAT_R16G16B16A16_SFLOAT);
        bound.push_back(storage(11, renderer.lampLight));
        std::vector<Descriptor> read = {{0, renderer.frame},
                                        storage(2, gbuffer.now()),
                                        {3, gbuffer.tileLists},
                                        storage(13, renderer.lampLight)};
        addField(read, fieldOf(renderer, scene));
        for (const uint32_t list : {RENDER_SOLID, RENDER_GROUND}) {
            dispatchTiles(commands, renderer.lamps, gbuffer, list, &list, sizeof list, read);
            if (cancelled(commands)) return false;
        }
        barrier(commands);
    }
    if (fog) {
        beginStage(commands, "fog");
        drawFog(commands, renderer.fog, renderer.seen.depth, renderer.shadow.depth, renderer.frame, extent);
        bound.push_back(storage(12, renderer.fog.now()));
    } else {
        renderer.fog.hasHistory = false;
    }
    std::optional<SecondaryKinds> secondary = scene.draft || showsNoLight(options.show)
                                                  ? std::nullopt
                                                  : secondaryKinds(options.scene, scene.transmits);
    if (secondary) secondary->environment = environment;
    const Bloom* bloom = bloomOf(options);
    mean = mean || options.light || bloom;
    const bool linear = secondary || options.light || bloom;
    if (secondary) {
        beginStage(commands, "secondary");
        if (!renderer.secondary.trace || renderer.secondary.kinds != *secondary) {
            renderer.secondary.trace =
                createComputePipeline(device, secondaryShader(renderer.field, *secondary));
            renderer.secondary.filter = {};
            renderer.secondary.kinds = *secondary;
            renderer.secondary.hasHistory = false;
        }
        drawSecondary(commands, renderer.secondary, gbuffer, renderer.shadow.depth, renderer.frame,
                      renderer.environment.words, fieldOf(renderer, scene), scene.transmits);
        if (cancelled(commands)) return false;
        addSecondary(bound, renderer.secondary, scene.transmits);
    } else {
        renderer.secondary.hasHistory = false;
    }
    resizeImage(commands, renderer.means, extent,
                linear ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32G32_UINT);
    bound.push_back(storage(9, renderer.means));
    beginStage(commands, "light");
    for (const uint32_t list : {RENDER_SOLID, RENDER_GROUND, RENDER_BACK}) {
        std::vector<std::string> defines = {"LIST " + std::to_string(list)};
        const auto define = [&](bool wanted, const char* name) {
            if (wanted) defines.push_back(name);
        };
        define(lamps, "LAMPS");
        define(sun, "TRACED_SUN");
        define(fog, "FOG");
        define(!frame.studio, "SKY");
        define(environment, "ENVIRONMENT");
        define(mean, "MEAN");
        define(mean && linear, "LINEAR");
        define(options.cutout, "CUTOUT");
        define(frame.neutral, "NEUTRAL");
        define(secondary && secondary->bounce, "BOUNCE");
        define(secondary && secondary->reflections, "REFLECTIONS");
        define(secondary && scene.transmits, "TRANSMITS");
        overTiles(lightPipeline(renderer, std::move(defines)), list);
    }
    barrier(commands);
    if (bloom)
        drawBloom(commands, renderer.bloom, *bloom, renderer.means, renderer.frame, frame.neutral,
                  options.cutout, renderer.pixels);
    return true;
}

void traceReference(Commands& commands, Renderer& renderer, const RenderScene& scene) {
    const GBuffer& gbuffer = renderer.gbuffer;
    const VkExtent3D extent = gbuffer.now().extent;
    if (!renderer.reference)
        renderer.reference = createComputePipeline(
            *renderer.device, {.name = "render/reference.comp", .field = renderer.field});
    for (Image& history : renderer.ambient.history)
        resizeImage(commands, history, extent, VK_FORMAT_R32_UINT);
    std::vector<Descriptor> bound = {{0, renderer.frame},
                                     storage(2, gbuffer.now()),
                                     {3, gbuffer.tileLists},
                                     storage(7, renderer.ambient.now())};
    addField(bound, fieldOf(renderer, scene));
    dispatchTiles(commands, renderer.reference, gbuffer, RENDER_NEAR, &kRaysReference, sizeof kRaysReference,
                  bound);
    barrier(commands);
}

std::vector<float> readLight(const Renderer& renderer, const RenderOptions& options) {
    const Image& light = bloomOf(options) ? renderer.bloom.levels[0] : renderer.means;
    Buffer readback;
    Commands commands(*renderer.device);
    recordReading(commands, light, readback, 4 * sizeof(float));
    submit(commands);
    auto color = download<float>(*renderer.device, readback,
                                 4 * std::size_t(light.extent.width) * light.extent.height);
    for (std::size_t i = 3; i < color.size() && !options.cutout; i += 4) color[i] = 1.0f;  // but for rounding
    return color;
}

void showView(Commands& commands, Renderer& renderer, const RenderScene& scene) {
    const uint32_t view = renderer.described.show;
    if (view == RENDER_WIREFRAME) {
        beginStage(commands, "view");
        const uint64_t most = commands.device.limits.storageRange;
        if (scene.triangles > 0 && 12ull * scene.triangles <= most && 16ull * scene.vertices <= most)
            drawWireframe(commands, renderer, scene);
    }
    if (!showsField(view) || scene.draft) return;
    beginStage(commands, "view");
    if (showsWidths(view)) return drawWidths(commands, renderer, scene);
    if (!renderer.show)
        renderer.show =
            createComputePipeline(*renderer.device, {.name = "render/show.comp", .field = renderer.field});
    std::vector<Descriptor> bound = {
        {0, renderer.frame}, storage(1, renderer.seen.depth), storage(10, renderer.pixels)};
    addField(bound, fieldOf(renderer, scene));
    const VkExtent3D extent = renderer.pixels.extent;
    dispatchRows(commands, renderer.show,
                 {groupsFor(extent.width, RENDER_TILE), groupsFor(extent.height, RENDER_TILE), 1}, nullptr, 0,
                 bound);
    barrier(commands);
}

}  // namespace fw
