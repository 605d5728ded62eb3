#include "runtime/render/fog.h"

#include "shaders/render/render.h"
#include "shaders/shared.h"

namespace fw {

void drawFog(Commands& commands, FogLight& fog, const Image& seen, const Image& shadowMap,
             const Buffer& frame, VkExtent3D extent) {
    if (!fog.march) fog.march = createComputePipeline(commands.device, {.name = "render/fog.comp"});
    const VkExtent3D half = {(extent.width + 1) / 2, (extent.height + 1) / 2, 1};
    for (int i = 0; i < 2; ++i) {
        resizeImage(commands, fog.light[i], half, VK_FORMAT_R16G16B16A16_SFLOAT);
        if (resizeImage(commands, fog.ways[i], half, VK_FORMAT_R32G32_SFLOAT) || !fog.hasHistory)
            clearImage(commands, fog.ways[i]);
    }
    barrier(commands);
    const uint32_t before = fog.current;
    fog.current = 1 - before;
    const Descriptor bound[] = {{0, frame},
                                storage(1, seen),
                                storage(8, shadowMap),
                                storage(12, fog.now()),
                                storage(14, fog.ways[fog.current]),
                                storage(15, fog.light[before]),
                                storage(16, fog.ways[before])};
    dispatch(commands, fog.march,
             {groupsFor(half.width, RENDER_TILE), groupsFor(half.height, RENDER_TILE), 1}, nullptr, 0, bound);
    barrier(commands);
    fog.hasHistory = true;
}

}  // namespace fw
