#include "runtime/render/describe.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace fw {

namespace {

constexpr float kGroundEnd = 2.8f;       // where the ground has faded, in the solid's radii
constexpr float kLeastConstant = 1e-3f;  // of proven Lipschitz constants; declared ones count as 1 or more
constexpr float kExposure = 0.66f;
constexpr uint32_t kFogKept = 4;  // frames that a moving view's fog is the mean of
constexpr float kFogEnd = 12.0f;  // in the solid's radii

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

/// Of a lamp in so many parts, each as wide as leaves no gaps between their penumbras.
float widthOfPart(int count) { return std::min(1.5f / std::sqrt(float(count)), 1.0f); }

/// One of `count` parts of a lamp whose shadows are the mean of theirs: at a place within its ball such that
/// from each side they cover its disc evenly (a point of the unit sphere of four dimensions, projected into
/// three).
void takePart(gpu::Light& light, int number, int count) {
    // The R3 sequence (Roberts 2018).
    const auto along = [&](double step) { return float(std::fmod(0.5 + step * number, 1.0)); };
    const float share = along(0.8191725133961645), a = 6.2831853f * along(0.6710436067037893),
                b = 6.2831853f * along(0.5497004779019703);
    const float wide = std::sqrt(1.0f - share);
    light.position +=
        light.size * glm::vec3(wide * std::cos(a), std::sqrt(share) * std::cos(b), wide * std::sin(a));
    light.size *= widthOfPart(count);
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

}  // namespace

glm::vec2 evenly(int number) {
    const double x = 0.5 + 0.7548776662466927 * number, y = 0.5 + 0.5698402909980532 * number;
    return {float(x - std::floor(x)), float(y - std::floor(y))};
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
    rays.flags = RENDER_PARALLEL;
    return rays;
}

gpu::RenderFrame describeFrame(const Renderer& renderer, const RenderScene& scene,
                               const RenderOptions& options, const gpu::View& view, bool resting, int mean,
                               uint32_t shadowSize) {
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
    const bool known = std::isfinite(scene.lipschitz);
    frame.localSteps = known && scene.lipschitzWithinGrid;
    const float least = frame.localSteps ? kLeastConstant : 1.0f;
    frame.stepScale = known ? 1.0f / std::max(scene.lipschitz, least) : renderer.trust;
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
    if (hasEnvironment(options)) describeEnvironment(renderer.environment, sky, frame);
    frame.studio = !look.sky;
    frame.exposure = kExposure * std::exp2(float(look.exposure));
    frame.neutral = look.tone == Tone::neutral;
    frame.mean = uint32_t(mean);
    frame.show = options.show;
    frame.sliceAxis = options.slice.axis < 0 ? 3 : uint32_t(options.slice.axis);
    frame.sliceAt = options.slice.at;
    const glm::vec3 size = frame.hi - frame.lo;
    frame.leastWidth =
        options.leastWidth > 0.0f ? options.leastWidth : usualWidth(std::max({size.x, size.y, size.z}));
    if (look.fog) {
        frame.fogColor = vector(look.fog->color);
        frame.fogDensity = float(look.fog->density);
        frame.fogFalloff = look.fog->height > 0.0 ? 1.0f / float(look.fog->height) : 0.0f;
        frame.fogEnd = kFogEnd * bounds.radius;
        frame.fogKept = resting || options.samples > 1 ? 0 : kFogKept;
    }
    frame.lightCount = uint32_t(std::min<std::size_t>(look.lights.size(), RENDER_MOST_LIGHTS));
    const int parts = options.samples > 1 ? options.samples : resting ? kRestFrames : 1;
    if (look.sun) frame.sunWide = std::tan(glm::radians(0.5f * float(look.sun->size))) * widthOfPart(parts);
    // Beside whole paths of light they are as large as there.
    const bool inParts = parts > 1 && !options.reference && secondaryKinds(look, scene.transmits);
    for (uint32_t i = 0; i < frame.lightCount; ++i) {
        frame.lights[i] = describe(look.lights[i]);
        if (inParts && !frame.lights[i].directional) takePart(frame.lights[i], mean, parts);
    }
    return frame;
}

}  // namespace fw
