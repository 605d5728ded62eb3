// What a picture shows while its field's kernels are being compiled, and of a mesh that was changed after it
// was made of the field: the mesh alone.
//
// The G-buffer that surface.comp makes from the field is made from the mesh's depth and its vertices' normals
// and colours instead, else in one material. All that lights it samples no field and stays as it is
// (shaders/render/light.comp with the sun's shadow map); ambient occlusion and the lamps, which trace through
// the field, are left out.
//
// Lifetime: pipelines serve all graphs; the images take the size of the picture.
#pragma once

#include "runtime/render/gbuffer.h"

namespace fw {

struct Draft {
    Pipeline draw, drawColored, surface;
    Image looks;  ///< R32G32_UINT: the normal, octahedral, and the colour as in the G-buffer
};

Draft createDraft(const Device& device);

/// Draws the listed clusters (none if null) for `target.depth` and the looks, in place of drawDepth. `colors`
/// of the vertices have one of their own: all or none.
void drawDraft(Commands& commands, Draft& draft, DepthTarget& target, VkExtent3D extent,
               const glm::mat4& clip, const MesherBuffers& mesh, const Clusters* clusters, uint32_t colors);

/// Makes gbuffer.now() of what was drawn, in place of fillGBuffer.
void fillFromDraft(Commands& commands, const Draft& draft, GBuffer& gbuffer, const Image& depth,
                   const Buffer& frame, const gpu::DraftMaterial& material);

}  // namespace fw
