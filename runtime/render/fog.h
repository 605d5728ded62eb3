// Fog with the sun's rays in it (shaders/render/fog.comp), at half the picture's width and height.
//
// Lifetime: a FogLight remembers one view's frames, as Ambient does.
#pragma once

#include "runtime/render/gbuffer.h"

namespace fw {

struct FogLight {
    Pipeline march;
    Image light[2];  ///< RGBA16_SFLOAT: what it sends, and the share of light that it lets through
    Image ways[2];  ///< RG32_SFLOAT: metres to where the light comes from, and the frames that it is the mean
                    ///< of
    uint32_t current = 0;
    bool hasHistory = false;

    const Image& now() const { return light[current]; }
};

/// Records one frame, after the shadow map and the depth. `frame` is a uniform buffer of a gpu::RenderFrame,
/// `extent` the picture's.
void drawFog(Commands& commands, FogLight& fog, const Image& seen, const Image& shadowMap,
             const Buffer& frame, VkExtent3D extent);

}  // namespace fw
