#include "runtime/render/primary.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "graph/base/hash.h"
#include "runtime/mesh/octahedral.h"
#include "runtime/render/describe.h"

namespace fw {

namespace {

constexpr double kTrusted = 0.99;     // of the pixels that a field without a known constant must trace right
constexpr float kGravity = 9.81f;     // metres per second squared: what fell as far as the radius is fast
constexpr float kPointPixels = 2.0f;  // half pixels that a point is wide from its middle

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
    if (frame.localSteps) {
        rays.flags |= RENDER_LOCAL_STEPS;
        // A hit more than two cells from the surface would pass for a side of the region (surface.comp).
        const bool parallel = rays.flags & RENDER_PARALLEL;
        const float far = parallel ? 1.0f : glm::distance(rays.origin, frame.centre) + frame.radius;
        rays.close = std::min(rays.close, frame.cellSize / far) * std::min(scene.lipschitz, 1.0f);
        rays.steps = uint32_t(float(care.steps) * std::max(scene.lipschitz, 1.0f));
    }
    traceDepth(commands, renderer.depth, target, extent, rays, fieldOf(renderer, scene));
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

/// How far along the ray of the middle of this pixel the ground is, as in shaders/render/solid.glsl.
std::optional<float> alongToGround(const gpu::RenderFrame& frame, int x, int y) {
    const gpu::View& view = frame.now;
    const glm::vec2 place = (glm::vec2(x, y) + 0.5f) / glm::vec2(frame.size) * 2.0f - 1.0f;
    const glm::vec3 ray = view.forward + place.x * view.right - place.y * view.up;
    if (!(ray.y < 0.0f) || frame.groundEnd <= 0.0f) return std::nullopt;
    const float along = (frame.ground - view.eye.y) / std::min(ray.y, -1e-6f);
    const glm::vec3 p = view.eye + ray * along - frame.centre;
    if (std::hypot(p.x, p.z) >= frame.groundEnd * frame.radius) return std::nullopt;
    return along;
}

/// Of a material in the words of the G-buffer.
uint32_t idOf(const glm::uvec4& surface) {
    if (surface.w >> 24 == 0) return kGroundId;
    return std::max(uint32_t(mixed(mixed(0, surface.z), surface.w) & 0xffffff), kGroundId + 1);
}

}  // namespace

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

bool mustDraw(const RenderScene& scene, const RenderOptions& options) {
    return scene.draft || options.show == RENDER_WIREFRAME || !scene.particles.empty();
}

bool wantsTracing(const RenderScene& scene, const RenderOptions& options, const Renderer& renderer) {
    if (mustDraw(scene, options)) return false;
    const bool known = std::isfinite(scene.lipschitz);
    const bool measured = options.primary == Primary::measured && renderer.tracing.value_or(false) &&
                          (known || renderer.measuredTrust);
    return options.reference ||
           (scene.triangles > 0 && (measured || (options.primary == Primary::traced && known)));
}

void findDepth(Commands& commands, Renderer& renderer, const RenderScene& scene, bool traced,
               const Care& care) {
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

bool findSurfaces(Commands& commands, Renderer& renderer, const RenderScene& scene,
                  const RenderOptions& options, const Care& care) {
    beginStage(commands, "depth");
    findDepth(commands, renderer, scene, wantsTracing(scene, options, renderer), care);
    if (cancelled(commands)) return false;
    renderer.gbuffer.current = 1 - renderer.gbuffer.current;
    if (scene.draft)
        fillFromDraft(commands, renderer.draft, renderer.gbuffer, renderer.seen.depth, renderer.frame,
                      *scene.draft);
    else
        fillGBuffer(commands, renderer.gbuffer, renderer.seen.depth, renderer.frame,
                    fieldOf(renderer, scene));
    return !cancelled(commands);
}

bool readSurfaces(Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
                  const gpu::View& view, LightPicture& picture) {
    const VkExtent3D extent = {uint32_t(options.width), uint32_t(options.height), 1};
    const std::size_t pixels = std::size_t(extent.width) * extent.height;
    renderer.described = describeFrame(renderer, scene, options, view, false, 0, 1);
    const gpu::RenderFrame& frame = renderer.described;
    std::memcpy(renderer.frame.mapped, &frame, sizeof frame);
    if (scene.draft && !renderer.draft.draw) renderer.draft = createDraft(*renderer.device);
    Commands commands(*renderer.device);
    commands.parted = true;
    commands.cancel = options.cancel;
    resizeGBuffer(commands, renderer.gbuffer, extent);
    clearImage(commands, renderer.gbuffer.before());  // becomes now(), in which some tiles stay as they are
    findPlaces(commands, renderer, scene);
    if (!findSurfaces(commands, renderer, scene, options, options.reference ? kReferenceCare : kStillCare))
        return false;
    Buffer readback;
    recordReading(commands, renderer.gbuffer.now(), readback, sizeof(glm::uvec4));
    submit(commands);

    const auto surfaces = download<glm::uvec4>(*renderer.device, readback, pixels);
    picture = {.width = options.width,
               .height = options.height,
               .color = {},
               .depth = std::vector(pixels, kNoDepth),
               .normal = std::vector(pixels, glm::vec3(0)),
               .id = std::vector(pixels, kNothingId)};
    for (std::size_t i = 0; i < pixels; ++i) {
        const float depth = std::bit_cast<float>(surfaces[i].x);
        const uint32_t id = idOf(surfaces[i]);
        if (depth > 0.0f && !(options.cutout && id == kGroundId)) {
            picture.depth[i] = view.near / depth;
            picture.normal[i] = unpackOctahedral(surfaces[i].y);
            picture.id[i] = id;
        } else if (options.cutout) {
            continue;
        } else if (const auto along = alongToGround(frame, int(i) % options.width, int(i) / options.width)) {
            picture.depth[i] = *along;
            picture.normal[i] = glm::vec3(0, 1, 0);
            picture.id[i] = kGroundId;
        }
    }
    return true;
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

void recordReading(Commands& commands, const Image& image, Buffer& readback, uint32_t bytes) {
    const VkExtent3D extent = image.extent;
    reserve(commands.device, readback, VkDeviceSize(bytes) * extent.width * extent.height, Memory::readback);
    VkBufferImageCopy region{};
    region.imageSubresource = {image.aspect, 0, 0, 1};
    region.imageExtent = extent;
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(commands.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           readback.handle, 1, &region);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    barrier(commands);
}

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
            findDepth(commands, renderer, scene, traced, kLiveCare);
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
    const bool compares = !known || scene.lipschitzWithinGrid;
    renderer.tracing = false;
    renderer.measuredTrust = !known;
    for (const float trust : {1.0f, 0.5f}) {
        if (!known) renderer.trust = renderer.described.stepScale = trust;
        const double tracing = timed(true);
        const bool agrees = !compares || agreement(drawn, depths, extent, renderer.described.now.near,
                                                   2.0f * scene.grid.cellSize) >= kTrusted;
        renderer.tracing = agrees && tracing < drawing;
        if (agrees || known) return;
    }
}

}  // namespace fw
