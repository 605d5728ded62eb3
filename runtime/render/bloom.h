// Light that spills from bright places, as lenses and eyes have it: a share of all light is spread by a sum
// of Gaussians, each twice as wide as the one before, in linear light before the tone map. None is lost or
// won.
//
// The Gaussians are made in a pyramid of pictures, each half as large as the one before, that are enlarged
// and added again (after Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", 2014):
// each at the level in whose texels it is short, by what halving and enlarging have not blurred yet. They are
// as wide by the picture's height, so that it looks the same at any resolution.
#pragma once

#include <vector>

#include "graph/document/scene.h"
#include "runtime/gpu/shader.h"
#include "runtime/render/gbuffer.h"

namespace fw {

/// Of a renderer; made when first asked for.
struct BloomPasses {
    Pipeline down, across, up,
        show[2][2];             ///< the last by whether the tone map is neutral, and there is alpha
    std::vector<Image> levels;  ///< RGBA32_SFLOAT; the first is the picture with its bloom
    std::vector<Image> rows;    ///< ditto, blurred from left to right
};

/// What a level of the pyramid gives to the picture.
struct BloomLevel {
    float plain = 0.0f, blurred = 0.0f;  ///< shares of the light: as it is, and by a Gaussian of this
    float variance = 1.0f;               ///< in its own texels
};

/// Of each level, from the picture itself on, which is not blurred; the sum of all shares is 1. There are at
/// least two.
std::vector<BloomLevel> bloomLevels(const Bloom& bloom, int width, int height);

/// Makes levels[0] and `pixels` of `light`, which is RGBA32_SFLOAT. `frame` is a uniform buffer of a
/// gpu::RenderFrame, which `neutral` is of.
void drawBloom(Commands& commands, BloomPasses& passes, const Bloom& bloom, const Image& light,
               const Buffer& frame, bool neutral, bool cutout, const Image& pixels);

}  // namespace fw
