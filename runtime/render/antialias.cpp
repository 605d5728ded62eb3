#include "runtime/render/antialias.h"

#include <utility>

namespace fw {

void antialias(Commands& commands, Antialias& antialias, Image& pixels, const Image& seen,
               const Buffer& frame) {
    if (!antialias.mix)
        antialias.mix = createComputePipeline(commands.device, {.name = "render/antialias.comp"});
    const VkExtent3D extent = pixels.extent;
    std::swap(pixels, antialias.drawn);
    resizeImage(commands, pixels, extent, VK_FORMAT_R32_UINT);
    for (Image& shown : antialias.shown)
        if (resizeImage(commands, shown, extent, VK_FORMAT_R16G16B16A16_SFLOAT)) antialias.hasHistory = false;
    const uint32_t before = antialias.current;
    antialias.current = 1 - before;
    const uint32_t known = antialias.hasHistory;
    const Descriptor bound[] = {{0, frame},
                                storage(1, seen),
                                storage(2, antialias.drawn),
                                storage(3, antialias.shown[before]),
                                storage(4, antialias.shown[antialias.current]),
                                storage(5, pixels)};
    dispatch(commands, antialias.mix,
             {groupsFor(extent.width, RENDER_TILE), groupsFor(extent.height, RENDER_TILE), 1}, &known,
             sizeof known, bound);
    barrier(commands);
    antialias.hasHistory = true;
}

}  // namespace fw
