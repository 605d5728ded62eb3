#include "runtime/render/gbuffer.h"

#include <array>

namespace fw {

namespace {

constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr uint32_t kTraceGroup = 8;  // pixels along each side of a work group of trace.comp

}  // namespace

Descriptor storage(uint32_t binding, const Image& image) {
    return Descriptor(binding, image.view, VK_IMAGE_LAYOUT_GENERAL);
}

bool resizeImage(Commands& commands, Image& image, VkExtent3D extent, VkFormat format) {
    if (image && image.format == format && image.extent.width == extent.width &&
        image.extent.height == extent.height)
        return false;
    ImageOptions options{.extent = extent, .format = format};
    if (format == kDepthFormat)
        options.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    image = {};  // first: the two need not fit at once
    image = createImage(commands.device, options);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    return true;
}

DepthPipelines createDepthPipelines(const Device& device, std::string_view field) {
    DepthPipelines pipelines;
    pipelines.draw = createGraphicsPipeline(device, {.shaders = {{.name = "render/depth.vert"}},
                                                     .depthFormat = kDepthFormat,
                                                     .vertexStride = sizeof(gpu::MeshVertex),
                                                     .depthTest = true,
                                                     .depthWrite = true});
    pipelines.trace = createComputePipeline(device, {.name = "render/trace.comp", .field = field});
    return pipelines;
}

void drawDepth(Commands& commands, const DepthPipelines& pipelines, DepthTarget& target, VkExtent3D extent,
               const glm::mat4& clip, const MesherBuffers& mesh, bool triangles) {
    target.isTraced = false;
    resizeImage(commands, target.drawn, extent, kDepthFormat);
    imageBarrier(commands, target.drawn, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    auto attachment = zeroed<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    attachment.imageView = target.drawn.view;
    attachment.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    auto info = zeroed<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    info.renderArea.extent = {extent.width, extent.height};
    info.layerCount = 1;
    info.pDepthAttachment = &attachment;
    vkCmdBeginRendering(commands.handle, &info);
    // A negative height keeps y upwards, and with it the winding.
    const auto width = float(extent.width), height = float(extent.height);
    const VkViewport viewport = {0, height, width, -height, 0, 1};
    vkCmdSetViewport(commands.handle, 0, 1, &viewport);
    vkCmdSetScissor(commands.handle, 0, 1, &info.renderArea);
    if (triangles) {
        bind(commands, pipelines.draw, &clip, sizeof clip, {});
        const VkDeviceSize start = 0;
        vkCmdBindVertexBuffers(commands.handle, 0, 1, &mesh.vertices.handle, &start);
        vkCmdBindIndexBuffer(commands.handle, mesh.triangles.handle, 0, VK_INDEX_TYPE_UINT32);
        vkCmdDrawIndexedIndirect(commands.handle, mesh.counts.handle, offsetof(gpu::MesherCounts, draw), 1,
                                 0);
    }
    vkCmdEndRendering(commands.handle);
    imageBarrier(commands, target.drawn, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
}

void traceDepth(Commands& commands, const DepthPipelines& pipelines, DepthTarget& target, VkExtent3D extent,
                gpu::TracePush rays, const Buffer* parameters) {
    target.isTraced = true;
    resizeImage(commands, target.traced, extent, VK_FORMAT_R32_SFLOAT);
    rays.size = {extent.width, extent.height};
    std::vector<Descriptor> bound = {storage(0, target.traced)};
    if (parameters) bound.emplace_back(FIELD_PARAMETERS, *parameters);
    dispatch(commands, pipelines.trace,
             {groupsFor(extent.width, kTraceGroup), groupsFor(extent.height, kTraceGroup), 1}, rays, bound);
    barrier(commands);
}

GBuffer createGBuffer(const Device& device, std::string_view field) {
    GBuffer gbuffer;
    const std::array shaders = {ShaderOptions{.name = "render/tiles.comp"},
                                ShaderOptions{.name = "render/surface.comp", .field = field}};
    std::vector<Pipeline> pipelines = createComputePipelines(device, shaders);
    gbuffer.tiles = std::move(pipelines[0]);
    gbuffer.surface = std::move(pipelines[1]);
    gbuffer.arguments = createBuffer(device, sizeof(gpu::DispatchArguments));
    gbuffer.sampler = createSampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    return gbuffer;
}

bool resizeGBuffer(Commands& commands, GBuffer& gbuffer, VkExtent3D extent) {
    if (!resizeImage(commands, gbuffer.surfaces[0], extent, VK_FORMAT_R32G32B32A32_UINT)) return false;
    resizeImage(commands, gbuffer.surfaces[1], extent, VK_FORMAT_R32G32B32A32_UINT);
    reserve(commands.device, gbuffer.tileList,
            4ull * groupsFor(extent.width, RENDER_TILE) * groupsFor(extent.height, RENDER_TILE));
    return true;
}

void listTiles(Commands& commands, GBuffer& gbuffer, const Image& depth, const Buffer& frame) {
    const VkExtent3D extent = depth.extent;
    fill(commands, gbuffer.arguments, 1);
    fill(commands, gbuffer.arguments, 0, 0, 4);
    barrier(commands);
    const std::array<Descriptor, 5> bound = {
        Descriptor(0, frame), Descriptor(1, depth.view, VK_IMAGE_LAYOUT_GENERAL, gbuffer.sampler.handle),
        storage(2, gbuffer.now()), Descriptor(3, gbuffer.tileList), Descriptor(4, gbuffer.arguments)};
    dispatch(commands, gbuffer.tiles,
             {groupsFor(extent.width, RENDER_TILE), groupsFor(extent.height, RENDER_TILE), 1}, nullptr, 0,
             bound);
    barrier(commands);
}

void fillGBuffer(Commands& commands, GBuffer& gbuffer, const Image& depth, const Buffer& frame,
                 const Buffer* parameters) {
    listTiles(commands, gbuffer, depth, frame);
    std::vector<Descriptor> bound = {
        {0, frame},
        {1, depth.view, VK_IMAGE_LAYOUT_GENERAL, gbuffer.sampler.handle},
        storage(2, gbuffer.now()),
        {3, gbuffer.tileList}};
    if (parameters) bound.emplace_back(FIELD_PARAMETERS, *parameters);
    dispatchIndirect(commands, gbuffer.surface, gbuffer.arguments, 0, nullptr, 0, bound);
    barrier(commands);
}

}  // namespace fw
