#include "runtime/render/draft.h"

#include <cstddef>

namespace fw {

Draft createDraft(const Device& device) {
    Draft draft;
    const auto drawing = [&](std::vector<std::string> defines) {
        return createGraphicsPipeline(
            device,
            {.shaders = {{.name = "render/draft.vert", .defines = defines},
                         {.name = "render/draft.frag", .defines = defines}},
             .colorFormats = {VK_FORMAT_R32G32_UINT},
             .depthFormat = kDepthFormat,
             .vertexStride = sizeof(gpu::MeshVertex),
             .vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(gpu::MeshVertex, position)},
                                  {1, 0, VK_FORMAT_R32_UINT, offsetof(gpu::MeshVertex, normal)}},
             .depthTest = true,
             .depthWrite = true});
    };
    draft.draw = drawing({});
    draft.drawColored = drawing({"COLORS"});
    draft.surface = createComputePipeline(device, {.name = "render/draft.comp"});
    return draft;
}

void drawDraft(Commands& commands, Draft& draft, DepthTarget& target, VkExtent3D extent,
               const glm::mat4& clip, const MesherBuffers& mesh, const Clusters* clusters, uint32_t colors) {
    resizeLooks(commands, draft.looks, extent);
    prepareDepth(commands, target, extent);
    beginDrawing(commands, target.attachment, VK_ATTACHMENT_LOAD_OP_CLEAR, &draft.looks);
    if (clusters && colors > 0) {
        const Descriptor bound[] = {{0, mesh.colors, 0, 12ull * colors}};
        drawClusters(commands, draft.drawColored, clip, mesh, *clusters, bound);
    } else if (clusters) {
        drawClusters(commands, draft.draw, clip, mesh, *clusters);
    }
    vkCmdEndRendering(commands.handle);
    copyDepth(commands, target);
}

void fillFromDraft(Commands& commands, const Draft& draft, GBuffer& gbuffer, const Image& depth,
                   const Buffer& frame, const gpu::DraftMaterial& material) {
    beginStage(commands, "tiles");
    listTiles(commands, gbuffer, depth, frame);
    beginStage(commands, "surface");
    const Descriptor bound[] = {{0, frame},
                                storage(1, depth),
                                storage(2, gbuffer.now()),
                                {3, gbuffer.tileLists},
                                storage(4, draft.looks)};
    dispatchAllTiles(commands, draft.surface, gbuffer, RENDER_NEAR, &material, sizeof material, bound);
    barrier(commands);
}

}  // namespace fw
