// What is seen first: the depth of the picture and of the sun's shadow map, drawn from the mesh or traced
// through the field (gbuffer.h has both), and which of them.
#pragma once

#include "runtime/render/renderer.h"

namespace fw {

/// How exactly a ray is traced.
struct Care {
    float close;     ///< a field below it is a hit, in pixels
    uint32_t steps;  ///< at most
};
inline constexpr Care kLiveCare = {1.0f, 160}, kStillCare = {0.1f, 320}, kReferenceCare = {0.02f, 1024};

/// What the field's kernels read; their lists are made by findPlaces() before.
FieldBuffers fieldOf(const Renderer& renderer, const RenderScene& scene);
void findPlaces(Commands& commands, Renderer& renderer, const RenderScene& scene);

/// Whether the mesh must be drawn: a draft is, edges lie at its depth, and particles are drawn beside it.
bool mustDraw(const RenderScene& scene, const RenderOptions& options);
/// Whether this picture is traced.
bool wantsTracing(const RenderScene& scene, const RenderOptions& options, const Renderer& renderer);

/// Times drawing and tracing, and notes which is to be used: the faster one. A field without a known constant
/// is traced only if that shows what drawing shows, in whole steps or else in half ones.
void measurePrimary(Renderer& renderer, const RenderScene& scene);

/// Makes renderer.seen, as the frame that is described sees it; with particles, where they are shown.
void findDepth(Commands& commands, Renderer& renderer, const RenderScene& scene, bool traced,
               const Care& care);
/// Makes renderer.seen and the G-buffer's now(), as the frame that is described sees them. False if the
/// commands were cancelled.
bool findSurfaces(Commands& commands, Renderer& renderer, const RenderScene& scene,
                  const RenderOptions& options, const Care& care);
/// Fills the picture's depths, normals and materials by a frame of their own, which is `view`'s. False if it
/// was cancelled.
bool readSurfaces(Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
                  const gpu::View& view, LightPicture& picture);
/// Makes renderer.shadow; of a texel, if there is no sun.
void findShadow(Commands& commands, Renderer& renderer, const RenderScene& scene, bool traced);

/// Copies an image of so many bytes a pixel to where the host can read it.
void recordReading(Commands& commands, const Image& image, Buffer& readback, uint32_t bytes = 4);

}  // namespace fw
