#include "runtime/render/renderer.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <tuple>

#include "runtime/render/describe.h"
#include "runtime/render/lighting.h"
#include "runtime/render/primary.h"
#include "runtime/system/clock.h"

namespace fw {

namespace {

constexpr uint32_t kShadowSize = 768;        // texels along each side
constexpr uint32_t kStillShadowSize = 2048;  // at most: two texels for each pixel of the picture are enough
constexpr double kSlowFrame = 100.0;         // ms; then the next live frame is drawn in parts
constexpr int kRaysStill = 16, kRaysResting = 8;
constexpr uint32_t kSecondaryStill = 4;
constexpr int kFramesAhead = 3;

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

/// Places on the unit disc, spread evenly: a sunflower's (Vogel 1979).
glm::vec2 onDisc(int number, int count) {
    const float radius = std::sqrt((float(number) + 0.5f) / float(count)),
                angle = 2.39996323f * float(number);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The numbers below `count`, each once, in an order in which any few that follow each other lie far apart.
int scattered(int number, int count) {
    int step = std::max(int(0.618 * count), 1);
    while (std::gcd(step, count) != 1) ++step;
    return int(int64_t(number) * step % count);
}

void forgetHistory(Renderer& renderer) {
    fw::forgetHistory(renderer.ambient);
    renderer.secondary.hasHistory = false;
    renderer.fog.hasHistory = false;
    renderer.antialias.hasHistory = false;
}

bool sameView(const gpu::View& a, const gpu::View& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

Picture readPicture(const Renderer& renderer, const RenderOptions& options) {
    const glm::uvec2 size = renderer.described.size;
    return {int(size.x), int(size.y),
            download<uint8_t>(*renderer.device, renderer.readback, 4 * std::size_t(size.x) * size.y),
            options.cutout};
}

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
    if (options.lamps || options.sun) add(kernels.lamps, "render/lamps.comp", lampDefines(options.sun));
    kernels.tracesSun = options.sun;
    if (showsWidths(options.view))
        add(kernels.widths, "render/widths.comp");
    else if (showsField(options.view))
        add(kernels.show, "render/show.comp");
    if (options.secondary) {
        shaders.push_back(secondaryShader(kernels.field, *options.secondary));
        places.push_back(&kernels.secondary);
        kernels.kinds = *options.secondary;
    }
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
    renderer.tracesSun = kernels.tracesSun;
    renderer.show = std::move(kernels.show);
    renderer.widths = std::move(kernels.widths);
    renderer.secondary.trace = std::move(kernels.secondary);
    renderer.secondary.filter = {};
    renderer.secondary.kinds = kernels.kinds;
    renderer.reference = {};
    for (Pipeline& trace : renderer.paths.trace) trace = {};
    renderer.shown.reset();
    renderer.shadowStands = false;
    renderer.tracing.reset();
    renderer.trust = 0.5f;
    renderer.slow = true;
    forgetHistory(renderer);
}

bool drawFrame(Commands& commands, Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
               const gpu::View& view, bool resting, int mean) {
    const VkExtent3D extent = {uint32_t(options.width), uint32_t(options.height), 1};
    const bool still = mean > 0 || options.samples > 1;
    const gpu::RenderFrame before = renderer.described;
    const uint32_t shadowSize =
        still ? std::clamp(2 * std::max(extent.width, extent.height), kShadowSize, kStillShadowSize)
              : kShadowSize;
    renderer.described = describeFrame(renderer, scene, options, view, resting, mean, shadowSize);
    renderer.described.secondaryRays = still ? kSecondaryStill : 1;
    const gpu::RenderFrame& frame = renderer.described;
    if (scene.draft) renderer.described.ambientStrength = 0, renderer.described.lightCount = 0;
    if (scene.draft && !renderer.draft.draw) renderer.draft = createDraft(commands.device);
    if (!scene.particles.empty() && !renderer.sprites.draw) renderer.sprites = createSprites(commands.device);
    std::memcpy(renderer.frame.mapped, &frame, sizeof frame);  // pictures are awaited: none reads it now
    renderer.shadowStands = renderer.shadowStands && before.sun == frame.sun &&
                            before.shadowCentre == frame.shadowCentre &&
                            before.shadowRight == frame.shadowRight && before.shadowSize == frame.shadowSize;
    resizeImage(commands, renderer.pixels, extent, VK_FORMAT_R32_UINT);
    if (resizeGBuffer(commands, renderer.gbuffer, extent) || before.groundEnd != frame.groundEnd)
        forgetHistory(renderer);

    findPlaces(commands, renderer, scene);
    if (!renderer.shadowStands) {
        beginStage(commands, "shadow");
        findShadow(commands, renderer, scene, wantsTracing(scene, options, renderer));
        renderer.shadowStands = true;
    }
    const Care& care = options.reference ? kReferenceCare : still ? kStillCare : kLiveCare;
    if (!findSurfaces(commands, renderer, scene, options, care)) return false;
    if (!scene.particles.empty())
        addSprites(commands, renderer.sprites, renderer.gbuffer, renderer.seen.depth, renderer.frame);
    beginStage(commands, "ambient");
    // Where rays find the sky themselves, none asks how much of it is seen.
    const bool unasked = options.scene.bounce && options.scene.reflections && options.scene.sky &&
                         options.show == RENDER_PICTURE;
    if (scene.draft || unasked)
        resizeHistory(commands, renderer.ambient, extent);
    else if (options.reference)
        traceReference(commands, renderer, scene);
    else
        drawAmbient(commands, renderer.ambient, renderer.gbuffer, frame, renderer.frame,
                    fieldOf(renderer, scene));
    if (cancelled(commands) || !lightFrame(commands, renderer, scene, options, still || resting))
        return false;
    showView(commands, renderer, scene);
    ++renderer.number;
    return true;
}

Result<Picture> renderPicture(Renderer& renderer, const RenderScene& scene, const RenderOptions& options) {
    if (const Done fits = checkPictureSize(options.width, options.height); !fits) return fits.error();
    if (options.samples < 1 || options.samples > kMostSamples)
        return Error{.message =
                         "a picture has from 1 to " + std::to_string(kMostSamples) + " samples a pixel"};
    const gpu::View middle = viewOf(scene, options);
    useEnvironment(*renderer.device, renderer.environment, options.environment);
    if (options.reference && options.bounces > 0 && options.show == RENDER_PICTURE) {
        if (scene.draft)
            return Error{
                .message =
                    "paths of light are traced through the field, and this picture is of the mesh alone: "
                    "leave out --bounces, or the stages that change the mesh"};
        return renderPaths(renderer, scene, options, middle);
    }
    const int first = firstOf(options, options.moment), last = firstOf(options, options.moment + 1);
    if (options.light && first == 0 && !readSurfaces(renderer, scene, options, middle, *options.light))
        return Error{.message = "cancelled"};
    const bool lens = options.scene.camera && options.scene.camera->aperture > 0.0;
    renderer.ambient.options = ambientOptions(scene, options);
    renderer.ambient.options.raysResting = kRaysStill;
    renderer.ambient.options.samplesMoving = renderer.ambient.options.samples;
    renderer.ambient.options.enough = kRaysStill * kMostSamples;
    fw::forgetHistory(renderer.ambient);
    if (first == 0) forgetHistory(renderer), renderer.number = 0;
    renderer.shown.reset();
    // What surfaces throw on each other goes on from frame to frame: some come before the first that counts.
    const int ahead = options.scene.bounce && !options.reference && first == 0 ? kFramesAhead : 0;
    for (int frame = first - ahead; frame < last; ++frame) {
        const int i = std::max(frame, first);
        if (options.progress) options.progress(100 * i / options.samples);
        gpu::View view = middle;
        view.jitter = jitterOf(i, options);
        if (lens) {
            // Each moment has places from all over the lens.
            const int place = options.moments > 1 ? scattered(i, options.samples) : i;
            view = throughLens(view, *options.scene.camera, onDisc(place, options.samples));
            fw::forgetHistory(renderer.ambient);  // each frame sees other places
        }
        renderer.shadowStands = false;
        Commands commands(*renderer.device);
        commands.parted = true;
        commands.cancel = options.cancel;
        if (!drawFrame(commands, renderer, scene, options, view, frame > first - ahead && !lens, i))
            return Error{.message = "cancelled"};
        const bool ends = frame + 1 == options.samples;
        const bool grown =
            options.grows && !ends && frame >= first && std::has_single_bit(uint32_t(frame + 1));
        if (ends || grown) recordReading(commands, renderer.pixels, renderer.readback);
        submit(commands);
        if (grown) options.grows(readPicture(renderer, options));
    }
    if (last < options.samples) return Picture{};  // of the last moment
    if (options.light) options.light->color = readLight(renderer, options);
    return readPicture(renderer, options);
}

Result<bool> renderLive(Renderer& renderer, const RenderScene& scene, const RenderOptions& wishes,
                        Picture* picture) {
    if (const Done fits = checkPictureSize(wishes.width, wishes.height); !fits) return fits.error();
    RenderOptions options = wishes;
    options.samples = 1;
    const Shown shows = {viewOf(scene, options),
                         options.scene,
                         options.environment,
                         scene.content,
                         {uint32_t(options.width), uint32_t(options.height), 1},
                         options.show,
                         options.slice,
                         options.leastWidth};
    const std::optional<Shown>& shown = renderer.shown;
    useEnvironment(*renderer.device, renderer.environment, options.environment);
    const bool sameField = shown && shown->content == shows.content;
    const bool rests = sameField && shown->scene == shows.scene && shown->environment == shows.environment &&
                       sameView(shown->view, shows.view) && shown->extent.width == shows.extent.width &&
                       shown->extent.height == shows.extent.height && shown->show == shows.show &&
                       shown->slice == shows.slice && shown->leastWidth == shows.leastWidth;
    if (rests && renderer.rested >= kRestFrames) return false;
    renderer.rested = rests ? renderer.rested + 1 : 0;
    if (!shown || shown->scene.ao != shows.scene.ao || shown->scene.ground != shows.scene.ground)
        forgetHistory(renderer);
    renderer.shadowStands = renderer.shadowStands && sameField;
    AmbientOptions ambient = ambientOptions(scene, options);
    ambient.raysResting = kRaysResting;
    // Of a field that moves, history is soon wrong where it is not rejected.
    if (!sameField) ambient.mostKept = 8;
    renderer.ambient.options = ambient;
    gpu::View view = shows.view;
    const bool smooths =
        !rests && options.antialias.value_or(!renderer.device->software) && options.show == RENDER_PICTURE;
    view.jitter = jitterOf(smooths ? int(renderer.number) % kAntialiasPlaces : renderer.rested, options);
    const bool lens = rests && options.scene.camera && options.scene.camera->aperture > 0.0;
    if (lens) {
        // Each frame sees other places, from the first one that counts on.
        view = throughLens(view, *options.scene.camera,
                           onDisc(scattered(renderer.rested - 1, kRestFrames), kRestFrames));
        fw::forgetHistory(renderer.ambient);
        options.samples = kRestFrames;
    }
    if (options.primary == Primary::measured && !renderer.tracing && !mustDraw(scene, options)) {
        renderer.described = describeFrame(renderer, scene, options, view, false, 0, kShadowSize);
        measurePrimary(renderer, scene);
    }
    const Clock::time_point start = Clock::now();
    Commands commands(*renderer.device);
    commands.cancel = options.cancel;
    commands.parted = renderer.slow || (options.cancel && renderer.device->software);
    const auto state = [&] {
        return std::tie(renderer.described, renderer.gbuffer.current, renderer.ambient.current,
                        renderer.ambient.rays, renderer.ambient.hasHistory, renderer.secondary.current,
                        renderer.secondary.hasHistory, renderer.fog.current, renderer.fog.hasHistory);
    };
    const std::tuple<gpu::RenderFrame, uint32_t, uint32_t, int, bool, uint32_t, bool, uint32_t, bool> before =
        state();
    // The mean begins with the first frame that rests.
    if (!drawFrame(commands, renderer, scene, options, view, rests && !lens,
                   std::max(renderer.rested - 1, 0))) {
        // As if it had not begun: what it wrote is written anew by the next one, the mean it did not touch.
        state() = before;
        renderer.shadowStands = false;
        if (rests)
            --renderer.rested;
        else
            renderer.shown.reset(), forgetHistory(renderer);
        return false;
    }
    if (smooths)
        antialias(commands, renderer.antialias, renderer.pixels, renderer.seen.depth, renderer.frame);
    else
        renderer.antialias.hasHistory = false;
    if (picture) recordReading(commands, renderer.pixels, renderer.readback);
    submit(commands);
    renderer.slow = millisecondsSince(start) > kSlowFrame;
    renderer.shown = shows;
    if (picture) *picture = readPicture(renderer, options);
    return true;
}

}  // namespace fw
