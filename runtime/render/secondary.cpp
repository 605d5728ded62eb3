#include "runtime/render/secondary.h"

namespace fw {

namespace {

constexpr uint32_t kStrides[] = {1, 3};  // of the filter's passes, pixels

void defineKinds(ShaderOptions& shader, const SecondaryKinds& kinds) {
    if (kinds.bounce) shader.defines.push_back("BOUNCE");
    if (kinds.reflections) shader.defines.push_back("REFLECTIONS");
}

/// After the rays: into the smooth images.
void recordFilter(Commands& commands, Secondary& secondary, const GBuffer& gbuffer, const Buffer& frame) {
    if (!secondary.filter) {
        ShaderOptions shader{.name = "render/atrous.comp"};
        defineKinds(shader, secondary.kinds);
        secondary.filter = createComputePipeline(commands.device, shader);
    }
    const Image* bounce = &secondary.bounce[secondary.current];
    const Image* reflection = &secondary.reflection[secondary.current];
    for (std::size_t i = 0; i < std::size(kStrides); ++i) {
        std::vector<Descriptor> bound = {{0, frame}, storage(2, gbuffer.now()), {3, gbuffer.tileLists}};
        const auto pass = [&](uint32_t binding, const Image*& from, Image& to) {
            resizeImage(commands, to, from->extent, from->format);
            bound.push_back(storage(binding, *from));
            bound.push_back(storage(binding + 1, to));
            from = &to;
        };
        if (secondary.kinds.bounce) pass(18, bounce, secondary.smoothBounce[i]);
        if (secondary.kinds.reflections) pass(20, reflection, secondary.smoothReflection[i]);
        dispatchAllTiles(commands, secondary.filter, gbuffer, RENDER_NEAR, &kStrides[i], sizeof kStrides[i],
                         bound);
        barrier(commands);
    }
}

}  // namespace

std::optional<SecondaryKinds> secondaryKinds(const Scene& scene, bool transmits) {
    if (!(scene.bounce || scene.reflections || transmits)) return std::nullopt;
    return SecondaryKinds{scene.bounce, scene.reflections, !scene.lights.empty(),
                          scene.sky && !scene.sky->image.empty()};
}

ShaderOptions secondaryShader(std::string_view field, const SecondaryKinds& kinds) {
    ShaderOptions shader{.name = "render/secondary.comp", .field = field};
    defineKinds(shader, kinds);
    if (kinds.lamps) shader.defines.push_back("LAMPS");
    if (kinds.environment) shader.defines.push_back("ENVIRONMENT");
    return shader;
}

void drawSecondary(Commands& commands, Secondary& secondary, const GBuffer& gbuffer, const Image& shadowMap,
                   const Buffer& frame, const Buffer& environment, const FieldBuffers& field,
                   bool transmits) {
    const VkExtent3D extent = gbuffer.now().extent;
    const auto ready = [&](Image& image) {
        return resizeImage(commands, image, extent, VK_FORMAT_R16G16B16A16_SFLOAT);
    };
    const auto forget = [&](Image& image) {
        if (!ready(image) && !secondary.hasHistory) clearImage(commands, image);
    };
    const auto both = [&](Image(&images)[2]) {
        for (Image& image : images) forget(image);
    };
    if (secondary.kinds.bounce) both(secondary.bounce), forget(secondary.smoothBounce[1]);
    if (secondary.kinds.reflections) both(secondary.reflection);
    if (transmits) ready(secondary.passed), ready(secondary.sunlight);
    barrier(commands);
    const uint32_t before = secondary.current;
    secondary.current = 1 - secondary.current;
    std::vector<Descriptor> bound = {{0, frame},
                                     storage(2, gbuffer.now()),
                                     {3, gbuffer.tileLists},
                                     storage(5, gbuffer.before()),
                                     storage(8, shadowMap)};
    if (secondary.kinds.bounce)
        bound.insert(bound.end(),
                     {storage(18, secondary.bounce[before]), storage(24, secondary.smoothBounce[1])});
    if (secondary.kinds.reflections) bound.push_back(storage(20, secondary.reflection[before]));
    if (secondary.kinds.bounce) bound.push_back(storage(19, secondary.bounce[secondary.current]));
    if (secondary.kinds.reflections) bound.push_back(storage(21, secondary.reflection[secondary.current]));
    if (transmits)
        bound.insert(bound.end(), {storage(22, secondary.passed), storage(23, secondary.sunlight)});
    if (secondary.kinds.environment) bound.push_back({25, environment});
    addField(bound, field);
    dispatchTiles(commands, secondary.trace, gbuffer, RENDER_NEAR, nullptr, 0, bound);
    barrier(commands);
    secondary.hasHistory = true;
    if (cancelled(commands) || !(secondary.kinds.bounce || secondary.kinds.reflections)) return;
    beginStage(commands, "filter");
    recordFilter(commands, secondary, gbuffer, frame);
}

void addSecondary(std::vector<Descriptor>& bound, const Secondary& secondary, bool transmits) {
    if (secondary.kinds.bounce) bound.push_back(storage(19, secondary.smoothBounce[1]));
    if (secondary.kinds.reflections) bound.push_back(storage(21, secondary.smoothReflection[1]));
    if (!transmits) return;
    bound.push_back(storage(22, secondary.passed));
    bound.push_back(storage(23, secondary.sunlight));
}

}  // namespace fw
