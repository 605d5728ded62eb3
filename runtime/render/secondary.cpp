#include "runtime/render/secondary.h"

namespace fw {

namespace {

void defineKinds(ShaderOptions& shader, const SecondaryKinds& kinds) {
    if (kinds.bounce) shader.defines.push_back("BOUNCE");
    if (kinds.reflections) shader.defines.push_back("REFLECTIONS");
}

/// After the rays.
void recordFilter(Commands& commands, Secondary& secondary, const GBuffer& gbuffer, const Buffer& frame) {
    if (!secondary.filter) {
        ShaderOptions shader{.name = "render/atrous.comp"};
        defineKinds(shader, secondary.kinds);
        secondary.filter = createComputePipeline(commands.device, shader);
    }
    std::vector<Descriptor> bound = {{0, frame}, storage(2, gbuffer.now()), {3, gbuffer.tileLists}};
    const auto pass = [&](uint32_t binding, const Image& from, const Image& to) {
        bound.insert(bound.end(), {storage(binding, from), storage(binding + 1, to)});
    };
    if (secondary.kinds.bounce) pass(18, secondary.rawBounce, secondary.bounce[secondary.current]);
    if (secondary.kinds.reflections)
        pass(20, secondary.rawReflection, secondary.reflection[secondary.current]);
    dispatchAllTiles(commands, secondary.filter, gbuffer, RENDER_NEAR, nullptr, 0, bound);
    barrier(commands);
}

}  // namespace

std::optional<SecondaryKinds> secondaryKinds(const Scene& scene, bool transmits) {
    if (!(scene.bounce || scene.reflections || transmits)) return std::nullopt;
    return SecondaryKinds{scene.bounce, scene.reflections, !scene.lights.empty(),
                          scene.sky && scene.sky->isPicture()};
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
    const auto forget = [&](Image& raw, Image(&images)[2]) {
        for (Image* image : {&raw, &images[0], &images[1]})
            if (!ready(*image) && !secondary.hasHistory) clearImage(commands, *image);
    };
    if (secondary.kinds.bounce) forget(secondary.rawBounce, secondary.bounce);
    if (secondary.kinds.reflections) forget(secondary.rawReflection, secondary.reflection);
    if (transmits) ready(secondary.passed), ready(secondary.sunlight);
    barrier(commands);
    const uint32_t before = secondary.current;
    secondary.current = 1 - secondary.current;
    std::vector<Descriptor> bound = {{0, frame},
                                     storage(2, gbuffer.now()),
                                     {3, gbuffer.tileLists},
                                     storage(5, gbuffer.before()),
                                     storage(8, shadowMap)};
    const auto history = [&](uint32_t binding, const Image& was, const Image& raw) {
        bound.insert(bound.end(), {storage(binding, was), storage(binding + 1, raw)});
    };
    if (secondary.kinds.bounce) history(18, secondary.bounce[before], secondary.rawBounce);
    if (secondary.kinds.reflections) history(20, secondary.reflection[before], secondary.rawReflection);
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
    if (secondary.kinds.bounce) bound.push_back(storage(19, secondary.bounce[secondary.current]));
    if (secondary.kinds.reflections) bound.push_back(storage(21, secondary.reflection[secondary.current]));
    if (!transmits) return;
    bound.push_back(storage(22, secondary.passed));
    bound.push_back(storage(23, secondary.sunlight));
}

}  // namespace fw
