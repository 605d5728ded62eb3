// Particles one by one, as points or spheres, in pictures whose field has no surface of theirs.
//
// Each is a triangle about its disc, drawn into the depth of all that is drawn there, and into the sun's
// shadow map; the fragment shader gives the disc the depth and the normals of a sphere. After the G-buffer
// was made, its pixels that show particles become theirs. The faster a particle is, the whiter it is.
//
// Lifetime: pipelines serve all graphs; the image takes the size of the picture.
#pragma once

#include <span>

#include "runtime/particles/cloud.h"
#include "runtime/render/gbuffer.h"

namespace fw {

struct Sprites {
    Pipeline draw, drawShadow, surface;
    Image looks;  ///< R32G32_UINT: the normal, octahedral, and the colour; 0 where there is none
};

Sprites createSprites(const Device& device);

/// How all particles are drawn.
struct SpriteOptions {
    glm::mat4 clip{1.0f};
    glm::vec4 eye{};      ///< w 1: where rays begin; w 0: their common direction
    float fast = 1.0f;    ///< the speed at which a particle is all white, metres per second
    float least = 0.0f;   ///< radius in the picture, metres at a distance of 1 from the eye
    bool spheres = true;  ///< as large as they are; else all of the least radius
    bool shadow = false;  ///< depth alone
};

/// Draws the particles into a target that drawDepth() or drawDraft() has left.
void drawSprites(Commands& commands, Sprites& sprites, DepthTarget& target,
                 std::span<const ParticleCloud> clouds, const SpriteOptions& options);

/// Makes the pixels of gbuffer.now() that show particles theirs, after fillGBuffer() or fillFromDraft().
void addSprites(Commands& commands, const Sprites& sprites, GBuffer& gbuffer, const Image& depth,
                const Buffer& frame);

}  // namespace fw
