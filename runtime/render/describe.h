// A frame as the shaders are told of it: gpu::RenderFrame (shaders/render/render.h), of the scene, the
// options and the view.
#pragma once

#include "runtime/render/renderer.h"

namespace fw {

inline constexpr int kRestFrames = 64;  ///< of the live view, after which it stops

/// Evenly in the unit square, the first in its middle (Roberts' R2 sequence).
glm::vec2 evenly(int number);

/// `mean`: which of the frames this is that the picture is the mean of. `shadowSize` is the shadow map's,
/// texels.
gpu::RenderFrame describeFrame(const Renderer& renderer, const RenderScene& scene,
                               const RenderOptions& options, const gpu::View& view, bool resting, int mean,
                               uint32_t shadowSize);

/// Of the sun's shadow map: to its clip space, and the rays that trace it.
glm::mat4 shadowClip(const gpu::RenderFrame& frame);
gpu::TracePush shadowRays(const gpu::RenderFrame& frame);

}  // namespace fw
