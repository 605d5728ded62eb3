// What a picture shows, before light falls on it: depth, then for each pixel of the tiles that hold surface
// its exact depth, normal and material.
//
// Depth comes from the mesh by rasterisation or from the field by sphere tracing; which is cheaper depends on
// the device, the field and the picture, and is for the caller to choose. All else comes from the field
// (shaders/render/surface.comp). The same depth passes draw the sun's shadow map: the mesh is generated once
// and drawn by each pass.
//
// Lifetime: pipelines belong to a field, images to a size. Images are in VK_IMAGE_LAYOUT_GENERAL between the
// calls.
#pragma once

#include <glm/mat4x4.hpp>
#include <string_view>

#include "runtime/mesher/mesher.h"
#include "runtime/render/clusters.h"
#include "runtime/render/view.h"

namespace fw {

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;  ///< of an attachment

/// A depth image. What is drawn is copied into it, for a depth attachment cannot be a storage image, and
/// fetching from a sampler is several times slower on software devices than loading from an image.
struct DepthTarget {
    Image depth;       ///< R32_SFLOAT
    Image attachment;  ///< D32_SFLOAT, if anything was drawn
    Image starts;  ///< R32_SFLOAT, if anything was traced: how far the rays of RENDER_CONE^2 pixels are free
    Buffer copy;
};

struct DepthPipelines {
    Pipeline draw, cones, trace;
};

/// Without those that trace, which belong to a field.
DepthPipelines createDepthPipelines(const Device& device);

/// Begins to draw into the whole of a depth attachment, and of a colour attachment that is cleared to zeros
/// if there is one, y upwards in clip space.
void beginDrawing(Commands& commands, const Image& depth, VkAttachmentLoadOp load,
                  const Image* color = nullptr);

/// Draws the listed clusters (cullClusters) between beginDrawing and its end.
void drawClusters(Commands& commands, const Pipeline& pipeline, const glm::mat4& clip,
                  const MesherBuffers& mesh, const Clusters& clusters,
                  std::span<const Descriptor> bound = {});

/// Makes the attachment of this size, ready to be drawn into; and copies what was drawn to `depth`.
void prepareDepth(Commands& commands, DepthTarget& target, VkExtent3D extent);
void copyDepth(Commands& commands, DepthTarget& target);

/// Draws the depth of the listed clusters (cullClusters) through `clip`; of nothing if `clusters` is null.
void drawDepth(Commands& commands, const DepthPipelines& pipelines, DepthTarget& target, VkExtent3D extent,
               const glm::mat4& clip, const MesherBuffers& mesh, const Clusters* clusters);

/// Traces the field's depth.
void traceDepth(Commands& commands, const DepthPipelines& pipelines, DepthTarget& target, VkExtent3D extent,
                gpu::TracePush rays, const FieldBuffers& field);

struct GBuffer {
    Pipeline tiles, surface;
    Image surfaces[2];  ///< RGBA32_UINT (shaders/render/gbuffer.glsl): of this frame and of the one before
    uint32_t current = 0;
    Buffer tileLists,
        arguments;  ///< RENDER_LISTS lists of tiles; their lengths, and the dispatches of a group a tile

    const Image& now() const { return surfaces[current]; }
    const Image& before() const { return surfaces[1 - current]; }
};

/// With the pipeline for a field, or without it.
GBuffer createGBuffer(const Device& device, std::string_view field);
GBuffer createGBuffer(const Device& device);

/// Takes the size; whether it is another than before, so that `before()` holds nothing.
bool resizeGBuffer(Commands& commands, GBuffer& gbuffer, VkExtent3D extent);

/// Makes now() from the depth. `frame` is a uniform buffer of a gpu::RenderFrame.
void fillGBuffer(Commands& commands, GBuffer& gbuffer, const Image& depth, const Buffer& frame,
                 const FieldBuffers& field);

/// Lists the tiles alone, for a now() that was filled otherwise.
void listTiles(Commands& commands, GBuffer& gbuffer, const Image& depth, const Buffer& frame);

/// One group for each tile of a list, whose kernel reads it at binding 3.
void dispatchAllTiles(Commands& commands, const Pipeline& pipeline, const GBuffer& gbuffer, uint32_t list,
                      const void* push, std::size_t pushSize, std::span<const Descriptor> bound);

/// The same for passes that may take long: a parted recording runs some tiles at a time, and leaves out the
/// rest once it is cancelled.
void dispatchTiles(Commands& commands, const Pipeline& pipeline, const GBuffer& gbuffer, uint32_t list,
                   const void* push, std::size_t pushSize, std::span<const Descriptor> bound);

/// Tiles that cover a picture.
uint32_t tilesOf(VkExtent3D extent);

/// The image for a binding, in VK_IMAGE_LAYOUT_GENERAL.
Descriptor storage(uint32_t binding, const Image& image);

/// Makes an R32G32_UINT image of this size, unless it is, that is drawn into and then read.
void resizeLooks(Commands& commands, Image& looks, VkExtent3D extent);

/// Fills the image with zeros.
void clearImage(Commands& commands, const Image& image);

/// Makes the image anew if its size or format differ; whether it did. The new one is cleared.
bool resizeImage(Commands& commands, Image& image, VkExtent3D extent, VkFormat format);

}  // namespace fw
