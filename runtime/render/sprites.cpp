#include "runtime/render/sprites.h"

#include <cmath>
#include <glm/matrix.hpp>

namespace fw {

Sprites createSprites(const Device& device) {
    const auto drawing = [&](std::vector<std::string> defines) {
        const bool shadow = !defines.empty();
        return createGraphicsPipeline(
            device, {.shaders = {{.name = "render/sprite.vert"},
                                 {.name = "render/sprite.frag", .defines = std::move(defines)}},
                     .colorFormats = shadow ? std::vector<VkFormat>{} : std::vector{VK_FORMAT_R32G32_UINT},
                     .depthFormat = kDepthFormat,
                     .depthTest = true,
                     .depthWrite = true});
    };
    Sprites sprites;
    sprites.draw = drawing({});
    sprites.drawShadow = drawing({"SHADOW"});
    sprites.surface = createComputePipeline(device, {.name = "render/sprites.comp"});
    return sprites;
}

void drawSprites(Commands& commands, Sprites& sprites, DepthTarget& target,
                 std::span<const ParticleCloud> clouds, const SpriteOptions& options) {
    if (!options.shadow) resizeLooks(commands, sprites.looks, target.attachment.extent);
    imageBarrier(commands, target.attachment, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    beginDrawing(commands, target.attachment, VK_ATTACHMENT_LOAD_OP_LOAD,
                 options.shadow ? nullptr : &sprites.looks);
    for (const ParticleCloud& cloud : clouds) {
        if (cloud.slots == 0) continue;
        // Each cloud is drawn where it is simulated, by an eye that is moved instead: what a scale stretches
        // is right then, too.
        gpu::SpritePush push{};
        const glm::mat4 rows = glm::transpose(options.clip * cloud.toWorld);
        for (int i = 0; i < 4; ++i) push.toClip[i] = rows[i];
        const glm::mat3 linear(cloud.toWorld), back = glm::inverse(linear);
        push.eye = glm::vec4(back * (glm::vec3(options.eye) - options.eye.w * glm::vec3(cloud.toWorld[3])),
                             options.eye.w);
        for (int i = 0; i < 3; ++i) push.normals[i] = back[i];
        push.least = options.least;
        push.radius = options.spheres ? cloud.radius : 0.0f;
        const float scale = std::cbrt(std::abs(glm::determinant(linear)));
        push.perFast = cloud.velocities ? scale / options.fast : 0.0f;
        const VkDeviceSize bytes = 16ull * cloud.slots;
        const Descriptor bound[] = {{0, *cloud.places, 0, bytes},
                                    {1, cloud.velocities ? *cloud.velocities : *cloud.places, 0, bytes}};
        fw::bind(commands, options.shadow ? sprites.drawShadow : sprites.draw, &push, sizeof push, bound);
        vkCmdDraw(commands.handle, 3 * cloud.slots, 1, 0, 0);
    }
    vkCmdEndRendering(commands.handle);
    copyDepth(commands, target);
}

void addSprites(Commands& commands, const Sprites& sprites, GBuffer& gbuffer, const Image& depth,
                const Buffer& frame) {
    const Descriptor bound[] = {{0, frame},
                                storage(1, depth),
                                storage(2, gbuffer.now()),
                                {3, gbuffer.tileLists},
                                storage(4, sprites.looks)};
    dispatchAllTiles(commands, sprites.surface, gbuffer, RENDER_NEAR, nullptr, 0, bound);
    barrier(commands);
}

}  // namespace fw
