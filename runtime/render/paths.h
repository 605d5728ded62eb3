// Pictures by whole paths of light, traced through the field: the ground truth of reflections, indirect light
// and transmission (shaders/render/path.comp, which has the theory).
//
// Each sample adds one path to each pixel's sum; their mean is exposed. The sums can be taken out and given
// back, so that a picture goes on where it was left: the same picture as in one go, to the bit.
//
// Lifetime: pipelines belong to a field, the sums to a size.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runtime/gpu/resources.h"
#include "runtime/gpu/shader.h"
#include "runtime/render/picture.h"
#include "runtime/render/view.h"

namespace fw {

/// What was traced so far.
struct PathSums {
    int paths = 0;            ///< of each pixel
    std::vector<float> sums;  ///< four floats a pixel: linear red, green and blue, and `paths`, or
                              ///< of a cutout those that met the solid
};

/// Of a renderer; made when first asked for.
struct PathTracer {
    Pipeline trace[2];                                    ///< by whether the sky is a picture's
    std::map<std::vector<std::string>, Pipeline> expose;  ///< by what expose.comp defines
    Buffer sums;                                          ///< four floats a pixel
};

struct Renderer;
struct RenderScene;
struct RenderOptions;

/// The picture from `view` by RenderOptions::samples paths a pixel. Errors: cancelled; more pixels than
/// the device can bind the sums of.
Result<Picture> renderPaths(Renderer& renderer, const RenderScene& scene, const RenderOptions& options,
                            const gpu::View& view);

}  // namespace fw
