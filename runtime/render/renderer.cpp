#include "runtime/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>
#include <tuple>

namespace fw {

namespace {

constexpr uint32_t kShadowSize = 768;  // texels along each side
constexpr uint32_t kStillShadowSize = 2048;
constexpr int kRestFrames = 64;          // of the live view, after which it stops
constexpr uint32_t kRaysReference = 64;  // of a frame
/// How exactly a ray is traced.
struct Care {
    float close;     // a field below it is a hit, in pixels
    uint32_t steps;  // at most
};
constexpr Care kLiveCare = {1.0f, 160}, kStillCare = {0.1f, 320}, kReferenceCare = {0.02f, 1024};
constexpr double kTrusted = 0.99;  // of the pixels that a field without a known constant must trace right
constexpr int kRaysStill = 16, kRaysResting = 8;
constexpr float kGroundEnd = 2.8f;  // where the ground has faded, in the solid's radii
constexpr float kExposure = 0.66f;
constexpr float kFogEnd = 12.0f;      // in the solid's radii
constexpr float kGravity = 9.81f;     // metres per second squared: what fell as far as the radius is fast
constexpr float kPointPixels = 2.0f;  // half pixels that a point is wide from its middle

/// Evenly in the unit square, the first in its middle (Roberts' R2 sequence).
glm::vec2 evenly(int number) {
    const double x = 0.5 + 0.7548776662466927 * number, y = 0.5 + 0.5698402909980532 * number;
    return {float(x - std::floor(x)), float(y - std::floor(y))};
}

gpu::Light describe(const Lamp& lamp) {
    gpu::Light light{};
    light.position = vector(lamp.position);
    light.color = vector(lamp.color) * float(lamp.strength);
    light.size = std::max(0.5f * float(lamp.size), 1e-3f);
    light.directional = lamp.type == Lamp::Type::directional;
    light.cosOuter = -2.0f;
    light.cosInner = -1.0f;
    light.direction = glm::vec3(0, -1, 0);
    if (lamp.type != Lamp::Type::point)
        light.direction = glm::normalize(vector(lamp.target) - vector(lamp.position));
    if (lamp.type == Lamp::Type::spot) {
        const float half = glm::radians(0.5f * float(lamp.angle));
        light.cosOuter = std::cos(half);
        light.cosInner = std::cos(half * (1.0f - float(lamp.blend))) + 1e-4f;
    }
    return light;
}

/// The sun's direction and its shadow map's axes; `turn` in the unit square is a place on its disc.
void describeSun(gpu::RenderFrame& frame, const Scene& scene, const SeenBounds& bounds, glm::vec2 turn,
                 uint32_t size) {
    const Sun sun = scene.sun.value_or(Sun{});
    const float azimuth = glm::radians(float(sun.azimuth)), elevation = glm::radians(float(sun.elevation));
    const glm::vec3 middle(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                           std::cos(azimuth) * std::cos(elevation));
    const glm::vec3 upward = std::abs(middle.y) < 0.999f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
    glm::vec3 right = glm::normalize(glm::cross(upward, middle)), up = glm::cross(middle, right);
    const float r = std::sqrt(turn.x) * std::tan(glm::radians(0.5f * float(sun.size))),
                angle = 6.2831853f * turn.y;
    frame.sun = glm::normalize(middle + r * std::cos(angle) * right + r * std::sin(angle) * up);
    frame.sunLight = scene.sun ? vector(sun.color) * float(sun.strength) : glm::vec3(0);
    right = glm::normalize(glm::cross(upward, frame.sun)), up = glm::cross(frame.sun, right);
    const float half = 1.02f * bounds.radius;
    frame.shadowCentre = bounds.centre;
    frame.shadowRight = right / half;
    frame.shadowUp = up / half;
    frame.shadowForward = -frame.sun / half;
    frame.shadowTexel = 2.0f * half / float(size);
    frame.shadowSize = scene.sun ? size : 0;
}

glm::mat4 shadowClip(const gpu::RenderFrame& frame) {
    const glm::vec3 x = frame.shadowRight, y = frame.shadowUp, z = -0.5f * frame.shadowForward;
    const auto shift = [&](glm::vec3 axis) { return -glm::dot(axis, frame.shadowCentre); };
    return {
        {x.x, y.x, z.x, 0}, {x.y, y.y, z.y, 0}, {x.z, y.z, z.z, 0}, {shift(x), shift(y), 0.5f + shift(z), 1}};
}

gpu::TracePush shadowRays(const gpu::RenderFrame& frame) {
    const auto whole = [](glm::vec3 axis) { return axis / glm::dot(axis, axis); };
    gpu::TracePush rays{};
    rays.direction = -frame.sun;
    rays.origin = frame.shadowCentre - whole(frame.shadowForward);
    rays.originX = whole(frame.shadowRight);
    rays.originY = whole(frame.shadowUp);
    rays.near = 0.5f * glm::length(frame.shadowForward);
    rays.pixel = 0.25f * frame.shadowTexel;
    rays.parallel = 1;
    return rays;
}

gpu::RenderFrame describe(const Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
                          const gpu::View& view, bool resting, int mean, uint32_t shadowSize) {
    const Scene& look = options.scene;
    const SeenBounds& bounds = scene.bounds;
    gpu::RenderFrame frame{};
    frame.now = view;
    frame.now.pixel = glm::length(view.up) / float(options.height);
    frame.before = renderer.number > 0 ? renderer.described.now : frame.now;
    frame.size = {options.width, options.height};
    frame.tiles = tilesOf({frame.size.x, frame.size.y, 1});
    frame.number = renderer.number;
    frame.resting = resting;
    frame.lo = scene.grid.lo;
    frame.hi = scene.grid.hi;
    frame.cellSize = scene.grid.cellSize;
    frame.stepScale =
        std::isfinite(scene.lipschitz) ? 1.0f / std::max(scene.lipschitz, 1.0f) : renderer.trust;
    frame.centre = bounds.centre;
    frame.radius = bounds.radius;
    // Seen from below there is none, so that the solid's underside is in the light.
    const float ground = look.ground ? float(look.ground->height.value_or(bounds.foot)) : -1e30f;
    const bool grounded = look.ground && view.eye.y >= ground;
    frame.ground = grounded ? ground : -1e30f;
    frame.groundEnd = grounded ? kGroundEnd : 0.0f;
    describeAmbient(renderer.ambient, frame);
    frame.ambientStrength = look.ao ? float(look.ao->strength) : 0.0f;
    describeSun(frame, look, bounds, mean > 0 ? evenly(mean) : glm::vec2(0), shadowSize);
    const Sky sky = look.sky.value_or(Sky{});
    frame.zenith = vector(sky.zenith) * float(sky.strength);
    frame.horizon = vector(sky.horizon) * float(sky.strength);
    frame.groundColor = vector(sky.ground) * float(sky.strength);
    frame.studio = !look.sky;
    frame.exposure = kExposure * std::exp2(float(look.exposure));
    frame.mean = uint32_t(mean);
    frame.show = options.show;
    frame.sliceAxis = options.slice.axis < 0 ? 3 : uint32_t(options.slice.axis);
    frame.sliceAt = options.slice.at;
    if (look.fog) {
        frame.fogColor = vector(look.fog->color);
        frame.fogDensity = float(look.fog->density);
        frame.fogFalloff = look.fog->height > 0.0 ? 1.0f / float(look.fog->height) : 0.0f;
        frame.fogEnd = kFogEnd * bounds.radius;
    }
    frame.lightCount = uint32_t(std::min<std::size_t>(look.lights.size(), RENDER_MOST_LIGHTS));
    for (uint32_t i = 0; i < frame.lightCount; ++i) frame.lights[i] = describe(look.lights[i]);
    return frame;
}

/// What the field's kernels read; their lists are made by listPlaces() before.
FieldBuffers fieldOf(const Renderer& renderer, const RenderScene& scene) {
    FieldBuffers field = scene.buffers;
    if (renderer.places.list) field.lists = &renderer.places.lists;
    return field;
}

void findPlaces(Commands& commands, Renderer& renderer, const RenderScene& scene) {
    if (scene.draft || !renderer.places.list) return;
    beginStage(commands, "places");
    listPlaces(commands, renderer.places, *scene.families, scene.buffers, scene.grid.lo, scene.grid.hi,
               scene.content);
}

/// Whether the mesh must be drawn: a draft is, edges lie at its depth, and particles are drawn beside it.
bool mustDraw(const RenderScene& scene, const RenderOptions& options) {
    return scene.draft || options.show == RENDER_WIREFRAME || !scene.particles.empty();
}

bool wantsTracing(const RenderScene& scene, const RenderOptions& options, const Renderer& renderer) {
    if (mustDraw(scene, options)) return false;
    const bool measured = options.primary == Primary::measured && renderer.tracing.value_or(false);
    const bool known = options.primary == Primary::traced && std::isfinite(scene.lipschitz);
    return options.reference || (scene.triangles > 0 && (measured || known));
}

/// Lists what of the mesh a pass draws; null if there is none.
const Clusters* cull(Commands& commands, Renderer& renderer, const RenderScene& scene, const glm::mat4& clip,
                     const glm::vec4& eye, bool backs) {
    boundClusters(commands, renderer.clusters, scene.mesh, scene.triangles, scene.content);
    if (scene.triangles == 0) return nullptr;
    cullClusters(commands, renderer.clusters, scene.mesh, clip, eye, backs);
    return &renderer.clusters;
}

void trace(Commands& commands, Renderer& renderer, const RenderScene& scene, DepthTarget& target,
           VkExtent3D extent, gpu::TracePush rays, const Care& care) {
    const gpu::RenderFrame& frame = renderer.described;
    rays.lo = frame.lo;
    rays.hi = frame.hi;
    rays.stepScale = frame.stepScale;
    rays.close = care.close * rays.pixel;
    rays.steps = care.steps;
    traceDepth(commands, renderer.depth, target, extent, rays, fieldOf(renderer, scene));
}

void findDepth(Commands& commands, Renderer& renderer, const RenderScene& scene, bool traced,
               const Care& care = kLiveCare) {
    const gpu::RenderFrame& frame = renderer.described;
    const VkExtent3D extent = {frame.size.x, frame.size.y, 1};
    if (!traced) {
        const glm::mat4 clip = toClip(frame.now);
        const bool outside = glm::any(glm::lessThan(frame.now.eye, frame.lo - 2.0f * frame.now.near)) ||
                             glm::any(glm::greaterThan(frame.now.eye, frame.hi + 2.0f * frame.now.near));
        const Clusters* clusters =
            cull(commands, renderer, scene, clip, glm::vec4(frame.now.eye, 1), !outside);
        if (scene.draft)
            drawDraft(commands, renderer.draft, renderer.seen, extent, clip, scene.mesh, clusters,
                      scene.draft->colored ? scene.vertices : 0);
        else
            drawDepth(commands, renderer.depth, renderer.seen, extent, clip, scene.mesh, clusters);
        if (!scene.particles.empty())
            drawSprites(commands, renderer.sprites, renderer.seen, scene.particles,
                        {.clip = clip,
                         .eye = glm::vec4(frame.now.eye, 1),
                         .fast = std::sqrt(2.0f * kGravity * frame.radius),
                         .least = (frame.show == RENDER_SPHERES ? 1.0f : kPointPixels) * frame.now.pixel,
                         .spheres = frame.show == RENDER_SPHERES});
        return;
    }
    gpu::TracePush rays = raysOf(frame.now);
    rays.pixel = frame.now.pixel;
    trace(commands, renderer, scene, renderer.seen, extent, rays, care);
}

void findShadow(Commands& commands, Renderer& renderer, const RenderScene& scene, bool traced) {
    const gpu::RenderFrame& frame = renderer.described;
    const uint32_t size = std::max(frame.shadowSize, 1u);
    if (!traced || frame.shadowSize == 0) {
        const glm::mat4 clip = shadowClip(frame);
        const bool any = frame.shadowSize > 0;
        drawDepth(commands, renderer.depth, renderer.shadow, {size, size, 1}, clip, scene.mesh,
                  any ? cull(commands, renderer, scene, clip, glm::vec4(-frame.sun, 0), false) : nullptr);
        if (any && !scene.particles.empty() && frame.show == RENDER_SPHERES)
            drawSprites(commands, renderer.sprites, renderer.shadow, scene.particles,
                        {.clip = clip, .eye = glm::vec4(-frame.sun, 0), .shadow = true});
        return;
    }
    trace(commands, renderer, scene, renderer.shadow, {size, size, 1}, shadowRays(frame), kLiveCare);
}

/// Copies an image of four bytes a pixel to where the host can read it.
void recordReading(Commands& commands, const Image& image, Buffer& readback) {
    const VkExtent3D extent = image.extent;
    reserve(commands.device, readback, 4ull * extent.width * extent.height, Memory::readback);
    VkBufferImageCopy region{};
    region.imageSubresource = {image.aspect, 0, 0, 1};
    region.imageExtent = extent;
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(commands.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           readback.handle, 1, &region);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    barrier(commands);
}

/// The part of the pixels with a depth in either whose depth is also found, within `off` metres, at or beside
/// them in the other.
double agreement(const std::vector<float>& a, const std::vector<float>& b, VkExtent3D extent, float near,
                 float off) {
    const auto along = [near](float depth) { return depth > 0.0f ? near / depth : 0.0f; };
    const int width = int(extent.width), height = int(extent.height);
    std::size_t seen = 0, found = 0;
    for (int y = 1; y + 1 < height; ++y) {
        for (int x = 1; x + 1 < width; ++x) {
            const std::size_t here = std::size_t(y) * extent.width + std::size_t(x);
            if (a[here] <= 0.0f && b[here] <= 0.0f) continue;
            bool same = false;
            for (int i = 0; i < 9 && !same; ++i) {
                const std::size_t there =
                    here + std::size_t(i / 3) * extent.width + std::size_t(i % 3) - extent.width - 1;
                same = std::abs(along(a[here]) - along(b[there])) < off;
            }
            ++seen, found += same;
        }
    }
    return seen ? double(found) / double(seen) : 0.0;
}

/// Times drawing and tracing, and notes which is to be used: the faster one. A field without a known constant
/// is traced only if that shows what drawing shows, in whole steps or else in half ones.
void measurePrimary(Renderer& renderer, const RenderScene& scene) {
    const VkExtent3D extent = {renderer.described.size.x, renderer.described.size.y, 1};
    const std::size_t pixels = std::size_t(extent.width) * extent.height;
    Buffer readback = createBuffer(*renderer.device, 4 * pixels, Memory::readback);
    std::vector<float> depths;
    Commands ahead(*renderer.device);
    findPlaces(ahead, renderer, scene);
    submit(ahead);
    const auto timed = [&](bool traced) {
        double took = 0;
        for (int i = 0; i < 2; ++i) {  // the first warms up
            Commands commands(*renderer.device, true);
            beginStage(commands, "depth");
            findDepth(commands, renderer, scene, traced);
            beginStage(commands, "reading");
            recordReading(commands, renderer.seen.depth, readback);
            submit(commands);
            took = commands.stages[0].milliseconds;
        }
        depths = download<float>(*renderer.device, readback, pixels);
        return took;
    };
    const double drawing = timed(false);
    const std::vector<float> drawn = std::move(depths);
    const bool known = std::isfinite(scene.lipschitz);
    renderer.tracing = false;
    for (const float trust : {1.0f, 0.5f}) {
        renderer.trust = trust;
        if (!known) renderer.described.stepScale = trust;
        const double tracing = timed(true);
        if (!known && agreement(drawn, depths, extent, renderer.described.now.near,
                                2.0f * scene.grid.cellSize) < kTrusted)
            continue;
        renderer.tracing = tracing < drawing;
        return;
    }
}

/// The pipeline that lights one kind of tiles, made at its first use.
const Pipeline& lightPipeline(Renderer& renderer, uint32_t list, bool lamps, bool fog, bool mean) {
    const bool sky = !renderer.described.studio;
    Pipeline& light = renderer.light[list][lamps + 2 * fog + 4 * mean + 8 * sky];
    if (light) return light;
    ShaderOptions options{.name = "render/light.comp"};
    options.defines.push_back("LIST " + std::to_string(list));
    if (lamps) options.defines.push_back("LAMPS");
    if (fog) options.defines.push_back("FOG");
    if (sky) options.defines.push_back("SKY");
    if (mean) options.defines.push_back("MEAN");
    light = createComputePipeline(*renderer.device, options);
    return light;
}

/// False if the commands are cancelled, before the mean is added to.
bool lightFrame(Commands& commands, Renderer& renderer, const RenderScene& scene, bool mean) {
    const Device& device = commands.device;
    const GBuffer& gbuffer = renderer.gbuffer;
    const gpu::RenderFrame& frame = renderer.described;
    const VkExtent3D extent = {frame.size.x, frame.size.y, 1};
    const bool lamps = frame.lightCount > 0, fog = frame.fogDensity > 0.0f;
    std::vector<Descriptor> bound = {
        {0, renderer.frame},        storage(1, renderer.seen.depth),    storage(2, gbuffer.now()),
        {3, gbuffer.tileLists},     storage(7, renderer.ambient.now()), storage(8, renderer.shadow.depth),
        storage(9, renderer.means), storage(10, renderer.pixels)};
    const auto overTiles = [&](const Pipeline& pipeline, uint32_t list) {
        dispatchAllTiles(commands, pipeline, gbuffer, list, nullptr, 0, bound);
    };
    if (lamps) {
        beginStage(commands, "lamps");
        if (!renderer.lamps)
            renderer.lamps =
                createComputePipeline(device, {.name = "render/lamps.comp", .field = renderer.field});
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
        if (!renderer.fog) renderer.fog = createComputePipeline(device, {.name = "render/fog.comp"});
        const VkExtent3D half = {(extent.width + 1) / 2, (extent.height + 1) / 2, 1};
        resizeImage(commands, renderer.fogLight, half, VK_FORMAT_R16G16B16A16_SFLOAT);
        bound.push_back(storage(12, renderer.fogLight));
        dispatch(commands, renderer.fog,
                 {groupsFor(half.width, RENDER_TILE), groupsFor(half.height, RENDER_TILE), 1}, nullptr, 0,
                 bound);
        barrier(commands);
    }
    beginStage(commands, "light");
    for (const uint32_t list : {RENDER_SOLID, RENDER_GROUND, RENDER_BACK})
        overTiles(lightPipeline(renderer, list, lamps, fog, mean), list);
    barrier(commands);
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
    dispatchAllTiles(commands, renderer.reference, gbuffer, RENDER_NEAR, &kRaysReference,
                     sizeof kRaysReference, bound);
    barrier(commands);
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
    if (!renderer.show)
        renderer.show =
            createComputePipeline(*renderer.device, {.name = "render/show.comp", .field = renderer.field});
    std::vector<Descriptor> bound = {
        {0, renderer.frame}, storage(1, renderer.seen.depth), storage(10, renderer.pixels)};
    addField(bound, fieldOf(renderer, scene));
    const VkExtent3D extent = renderer.pixels.extent;
    dispatch(commands, renderer.show,
             {groupsFor(extent.width, RENDER_TILE), groupsFor(extent.height, RENDER_TILE), 1}, nullptr, 0,
             bound);
    barrier(commands);
}

/// What ambient occlusion is to do for this scene.
AmbientOptions ambientOptions(const RenderScene& scene, const RenderOptions& options) {
    const float radius = scene.bounds.radius;
    AmbientOptions ambient;
    ambient.radius = 0.35f * radius;
    if (options.scene.ao && options.scene.ao->radius > 0)  // no rays shorter than rounding, none for nothing
        ambient.radius = std::clamp(float(options.scene.ao->radius), 1e-3f * radius, 1e3f * radius);
    ambient.bias = std::min(0.5f * scene.grid.cellSize, 0.004f * radius);
    return ambient;
}

gpu::View viewOf(const RenderScene& scene, const RenderOptions& options) {
    const float aspect = float(options.width) / float(options.height);
    return options.scene.camera ? cameraView(*options.scene.camera, scene.bounds, aspect)
                                : framingView(options.framed, aspect);
}

/// Where the frame of this number samples its pixels: the first in their middle.
glm::vec2 jitterOf(int number, const RenderOptions& options) {
    return (evenly(number) - 0.5f) * 2.0f / glm::vec2(options.width, options.height);
}

bool sameView(const gpu::View& a, const gpu::View& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

Picture readPicture(const Renderer& renderer) {
    const glm::uvec2 size = renderer.described.size;
    return {int(size.x), int(size.y),
            download<uint8_t>(*renderer.device, renderer.readback, 4 * std::size_t(size.x) * size.y)};
}

}  // namespace

std::optional<FieldKernels> createFieldKernels(const Device& device, std::string field,
                                               const FieldKernelOptions& options) {
    FieldKernels kernels;
    kernels.field = std::move(field);
    std::vector<ShaderOptions> shaders;
    std::vector<Pipeline*> places;
    const auto add = [&](Pipeline& place, const char* name, std::vector<std::string> defines = {}) {
        shaders.push_back({.name = name, .field = kernels.field, .defines = std::move(defines)});
        places.push_back(&place);
    };
    add(kernels.cones, "render/trace.comp", {"CONES"});
    add(kernels.trace, "render/trace.comp");
    add(kernels.surface, "render/surface.comp");
    add(kernels.ambient, "render/ambient.comp");
    add(kernels.ambientHoles, "render/ambient_holes.comp");
    if (hasFamilies(kernels.field)) add(kernels.places, "render/places.comp");
    if (options.lamps) add(kernels.lamps, "render/lamps.comp");
    if (options.show) add(kernels.show, "render/show.comp");
    const std::size_t step = options.when == Compile::behind ? 1 : shaders.size();
    for (std::size_t i = 0; i < shaders.size(); i += step) {
        if (options.cancel && *options.cancel) return std::nullopt;
        std::vector<Pipeline> made =
            createComputePipelines(device, std::span(shaders).subspan(i, step), nullptr, options.when);
        for (std::size_t j = 0; j < step; ++j) *places[i + j] = std::move(made[j]);
    }
    return kernels;
}

Renderer createRenderer(const Device& device) {
    Renderer renderer;
    renderer.device = &device;
    renderer.depth = createDepthPipelines(device);
    renderer.clusters = createClusters(device);
    renderer.gbuffer = createGBuffer(device);
    renderer.ambient = createAmbient(device);
    renderer.frame = createBuffer(device, sizeof(gpu::RenderFrame), Memory::upload);
    return renderer;
}

Renderer createRenderer(const Device& device, std::string field) {
    Renderer renderer = createRenderer(device);
    setField(renderer, std::move(*createFieldKernels(device, std::move(field))));
    return renderer;
}

void setField(Renderer& renderer, FieldKernels kernels) {
    renderer.field = std::move(kernels.field);
    renderer.depth.cones = std::move(kernels.cones);
    renderer.depth.trace = std::move(kernels.trace);
    renderer.gbuffer.surface = std::move(kernels.surface);
    renderer.ambient.trace = std::move(kernels.ambient);
    renderer.ambient.addRays = std::move(kernels.ambientHoles);
    renderer.places.list = std::move(kernels.places);
    renderer.places.content.reset();
    renderer.lamps = std::move(kernels.lamps);
    renderer.show = std::move(kernels.show);
    renderer.reference = {};
    renderer.shown.reset();
    renderer.shadowStands = false;
    renderer.tracing.reset();
    renderer.trust = 0.5f;
    forgetHistory(renderer.ambient);
}

bool drawFrame(Commands& commands, Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
               const gpu::View& view, bool resting, int mean) {
    const Device& device = commands.device;
    const VkExtent3D extent = {uint32_t(options.width), uint32_t(options.height), 1};
    const bool still = mean > 0 || options.samples > 1;
    const gpu::RenderFrame before = renderer.described;
    renderer.described =
        describe(renderer, scene, options, view, resting, mean, still ? kStillShadowSize : kShadowSize);
    const gpu::RenderFrame& frame = renderer.described;
    if (scene.draft) renderer.described.ambientStrength = 0, renderer.described.lightCount = 0;
    if (scene.draft && !renderer.draft.draw) renderer.draft = createDraft(device);
    if (!scene.particles.empty() && !renderer.sprites.draw) renderer.sprites = createSprites(device);
    uploadBytes(device, renderer.frame, &frame, sizeof frame);
    renderer.shadowStands = renderer.shadowStands && before.sun == frame.sun &&
                            before.shadowCentre == frame.shadowCentre &&
                            before.shadowRight == frame.shadowRight && before.shadowSize == frame.shadowSize;
    resizeImage(commands, renderer.pixels, extent, VK_FORMAT_R32_UINT);
    resizeImage(commands, renderer.means, extent, VK_FORMAT_R32G32_UINT);
    if (resizeGBuffer(commands, renderer.gbuffer, extent) || before.groundEnd != frame.groundEnd)
        forgetHistory(renderer.ambient);

    findPlaces(commands, renderer, scene);
    const bool traced = wantsTracing(scene, options, renderer);
    if (!renderer.shadowStands) {
        beginStage(commands, "shadow");
        findShadow(commands, renderer, scene, traced);
        renderer.shadowStands = true;
    }
    beginStage(commands, "depth");
    findDepth(commands, renderer, scene, traced,
              options.reference ? kReferenceCare
              : still           ? kStillCare
                                : kLiveCare);
    if (cancelled(commands)) return false;
    renderer.gbuffer.current = 1 - renderer.gbuffer.current;
    if (scene.draft)
        fillFromDraft(commands, renderer.draft, renderer.gbuffer, renderer.seen.depth, renderer.frame,
                      *scene.draft);
    else
        fillGBuffer(commands, renderer.gbuffer, renderer.seen.depth, renderer.frame,
                    fieldOf(renderer, scene));
    if (cancelled(commands)) return false;
    if (!scene.particles.empty())
        addSprites(commands, renderer.sprites, renderer.gbuffer, renderer.seen.depth, renderer.frame);
    beginStage(commands, "ambient");
    if (scene.draft)
        resizeHistory(commands, renderer.ambient, extent);
    else if (options.reference)
        traceReference(commands, renderer, scene);
    else
        drawAmbient(commands, renderer.ambient, renderer.gbuffer, frame, renderer.frame,
                    fieldOf(renderer, scene));
    if (cancelled(commands) || !lightFrame(commands, renderer, scene, still || resting)) return false;
    showView(commands, renderer, scene);
    ++renderer.number;
    return true;
}

Result<Picture> renderPicture(Renderer& renderer, const RenderScene& scene, const RenderOptions& options) {
    if (const Done fits = checkPictureSize(options.width, options.height); !fits) return fits.error();
    if (options.samples < 1 || options.samples > kMostSamples)
        return Error{.message =
                         "a picture has from 1 to " + std::to_string(kMostSamples) + " samples a pixel"};
    gpu::View view = viewOf(scene, options);
    renderer.ambient.options = ambientOptions(scene, options);
    renderer.ambient.options.raysResting = kRaysStill;
    renderer.ambient.options.samplesMoving = renderer.ambient.options.samples;
    renderer.ambient.options.enough = kRaysStill * kMostSamples;
    forgetHistory(renderer.ambient);
    renderer.number = 0;
    renderer.shown.reset();
    for (int i = 0; i < options.samples; ++i) {
        if (options.cancel && *options.cancel) return Error{.message = "cancelled"};
        if (options.progress) options.progress(100 * i / options.samples);
        view.jitter = jitterOf(i, options);
        renderer.shadowStands = false;
        Commands commands(*renderer.device);
        drawFrame(commands, renderer, scene, options, view, i > 0, i);
        if (i + 1 == options.samples) recordReading(commands, renderer.pixels, renderer.readback);
        submit(commands);
    }
    return readPicture(renderer);
}

Result<bool> renderLive(Renderer& renderer, const RenderScene& scene, const RenderOptions& wishes,
                        Picture& picture) {
    if (const Done fits = checkPictureSize(wishes.width, wishes.height); !fits) return fits.error();
    RenderOptions options = wishes;
    options.samples = 1;
    const Shown shows = {viewOf(scene, options), options.scene,
                         scene.content,          {uint32_t(options.width), uint32_t(options.height), 1},
                         options.show,           options.slice};
    const std::optional<Shown>& shown = renderer.shown;
    const bool sameField = shown && shown->content == shows.content;
    const bool rests = sameField && shown->scene == shows.scene && sameView(shown->view, shows.view) &&
                       shown->extent.width == shows.extent.width &&
                       shown->extent.height == shows.extent.height && shown->show == shows.show &&
                       shown->slice == shows.slice;
    if (rests && renderer.rested >= kRestFrames) return false;
    renderer.rested = rests ? renderer.rested + 1 : 0;
    if (!shown || shown->scene.ao != shows.scene.ao || shown->scene.ground != shows.scene.ground)
        forgetHistory(renderer.ambient);
    renderer.shadowStands = renderer.shadowStands && sameField;
    AmbientOptions ambient = ambientOptions(scene, options);
    ambient.raysResting = kRaysResting;
    // Of a field that moves, history is soon wrong where it is not rejected.
    if (!sameField) ambient.mostKept = 8;
    renderer.ambient.options = ambient;
    gpu::View view = shows.view;
    view.jitter = jitterOf(renderer.rested, options);
    if (options.primary == Primary::measured && !renderer.tracing && !mustDraw(scene, options)) {
        renderer.described = describe(renderer, scene, options, view, false, 0, kShadowSize);
        measurePrimary(renderer, scene);
    }
    Commands commands(*renderer.device);
    commands.cancel = options.cancel;
    const auto state = [&] {
        return std::tie(renderer.described, renderer.gbuffer.current, renderer.ambient.current,
                        renderer.ambient.rays, renderer.ambient.hasHistory);
    };
    const std::tuple<gpu::RenderFrame, uint32_t, uint32_t, int, bool> before = state();
    // The mean begins with the first frame that rests.
    if (!drawFrame(commands, renderer, scene, options, view, rests, std::max(renderer.rested - 1, 0))) {
        // As if it had not begun: what it wrote is written anew by the next one, the mean it did not touch.
        state() = before;
        renderer.shadowStands = false;
        if (rests)
            --renderer.rested;
        else
            renderer.shown.reset(), forgetHistory(renderer.ambient);
        return false;
    }
    recordReading(commands, renderer.pixels, renderer.readback);
    submit(commands);
    renderer.shown = shows;
    picture = readPicture(renderer);
    return true;
}

}  // namespace fw
