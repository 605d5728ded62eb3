#include "runtime/render/gbuffer.h"

#include <algorithm>
#include <array>

namespace fw {

namespace {

constexpr uint32_t kTraceGroup = 8;  // pixels along each side of a work group of trace.comp
// Tiles of a slice: of 200 joined boxes some 20 ms. Where a slice starts is a multiple of 256 bytes, which is
// the most that a device may ask for.
constexpr uint32_t kSlice = 64;

/// Tiles that one dispatch is of at most.
uint32_t mostTiles(const Device& device) {
    assert(device.limits.groups >= kSlice);
    return device.limits.groups / kSlice * kSlice;
}

/// Where in GBuffer::arguments the dispatch over a slice of a list is; the lists' lengths come before.
uint32_t slicesOf(const Device& device, VkExtent3D extent) {
    return groupsFor(tilesOf(extent), mostTiles(device));
}
VkDeviceSize argumentsOf(uint32_t list, uint32_t slices, uint32_t slice) {
    return 4 * RENDER_LISTS + (list * slices + slice) * sizeof(gpu::DispatchArguments);
}

/// What is bound, with the lists of tiles from the given one on.
std::vector<Descriptor> fromTile(std::span<const Descriptor> bound, const GBuffer& gbuffer, uint32_t first) {
    std::vector<Descriptor> sliced(bound.begin(), bound.end());
    for (Descriptor& descriptor : sliced)
        if (descriptor.binding == 3) descriptor = Descriptor(3, gbuffer.tileLists, 4ull * first);
    return sliced;
}

}  // namespace

uint32_t tilesOf(VkExtent3D extent) {
    return groupsFor(extent.width, RENDER_TILE) * groupsFor(extent.height, RENDER_TILE);
}

Descriptor storage(uint32_t binding, const Image& image) {
    return Descriptor(binding, image.view, VK_IMAGE_LAYOUT_GENERAL);
}

void clearImage(Commands& commands, const Image& image) {
    const VkClearColorValue nothing{};
    const VkImageSubresourceRange all = {image.aspect, 0, 1, 0, 1};
    vkCmdClearColorImage(commands.handle, image.handle, VK_IMAGE_LAYOUT_GENERAL, &nothing, 1, &all);
}

bool resizeImage(Commands& commands, Image& image, VkExtent3D extent, VkFormat format) {
    if (image && image.format == format && image.extent.width == extent.width &&
        image.extent.height == extent.height)
        return false;
    ImageOptions options{.extent = extent, .format = format};
    if (format == kDepthFormat)
        options.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    image = {};  // first: the two need not fit at once
    image = createImage(commands.device, options);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    if (format == kDepthFormat) return true;
    clearImage(commands, image);
    barrier(commands);
    return true;
}

void resizeLooks(Commands& commands, Image& looks, VkExtent3D extent) {
    if (looks && looks.extent.width == extent.width && looks.extent.height == extent.height) return;
    looks = {};
    looks = createImage(commands.device,
                        {.extent = extent,
                         .format = VK_FORMAT_R32G32_UINT,
                         .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT});
    imageBarrier(commands, looks, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
}

DepthPipelines createDepthPipelines(const Device& device) {
    DepthPipelines pipelines;
    pipelines.draw = createGraphicsPipeline(device, {.shaders = {{.name = "render/depth.vert"}},
                                                     .depthFormat = kDepthFormat,
                                                     .vertexStride = sizeof(gpu::MeshVertex),
                                                     .depthTest = true,
                                                     .depthWrite = true});
    return pipelines;
}

void beginDrawing(Commands& commands, const Image& depth, VkAttachmentLoadOp load, const Image* color) {
    auto attachment = zeroed<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    attachment.imageView = depth.view;
    attachment.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    attachment.loadOp = load;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingAttachmentInfo painted = attachment;
    auto info = zeroed<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    info.renderArea.extent = {depth.extent.width, depth.extent.height};
    info.layerCount = 1;
    info.pDepthAttachment = &attachment;
    if (color) {
        painted.imageView = color->view;
        painted.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
        painted.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        info.colorAttachmentCount = 1;
        info.pColorAttachments = &painted;
    }
    vkCmdBeginRendering(commands.handle, &info);
    // A negative height keeps y upwards, and with it the winding.
    const auto width = float(depth.extent.width), height = float(depth.extent.height);
    const VkViewport viewport = {0, height, width, -height, 0, 1};
    vkCmdSetViewport(commands.handle, 0, 1, &viewport);
    vkCmdSetScissor(commands.handle, 0, 1, &info.renderArea);
}

void drawClusters(Commands& commands, const Pipeline& pipeline, const glm::mat4& clip,
                  const MesherBuffers& mesh, const Clusters& clusters, std::span<const Descriptor> bound) {
    fw::bind(commands, pipeline, &clip, sizeof clip, bound);
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(commands.handle, 0, 1, &mesh.vertices.handle, &start);
    vkCmdBindIndexBuffer(commands.handle, indicesOf(clusters, mesh).handle, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexedIndirect(commands.handle, clusters.counts.handle, offsetof(gpu::ClusterCounts, draw), 1,
                             0);
}

void prepareDepth(Commands& commands, DepthTarget& target, VkExtent3D extent) {
    resizeImage(commands, target.attachment, extent, kDepthFormat);
    imageBarrier(commands, target.attachment, VK_IMAGE_LAYOUT_UNDEFINED,
                 VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
}

void copyDepth(Commands& commands, DepthTarget& target) {
    const VkExtent3D extent = target.attachment.extent;
    resizeImage(commands, target.depth, extent, VK_FORMAT_R32_SFLOAT);
    reserve(commands.device, target.copy, 4ull * extent.width * extent.height);
    VkBufferImageCopy region{};
    region.imageSubresource = {target.attachment.aspect, 0, 0, 1};
    region.imageExtent = extent;
    imageBarrier(commands, target.attachment, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    barrier(commands);  // what was copied before, in this frame even, is read
    vkCmdCopyImageToBuffer(commands.handle, target.attachment.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           target.copy.handle, 1, &region);
    barrier(commands);
    region.imageSubresource.aspectMask = target.depth.aspect;
    imageBarrier(commands, target.depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands.handle, target.copy.handle, target.depth.handle,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    imageBarrier(commands, target.depth, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
}

void drawDepth(Commands& commands, const DepthPipelines& pipelines, DepthTarget& target, VkExtent3D extent,
               const glm::mat4& clip, const MesherBuffers& mesh, const Clusters* clusters) {
    prepareDepth(commands, target, extent);
    beginDrawing(commands, target.attachment, VK_ATTACHMENT_LOAD_OP_CLEAR);
    if (clusters) drawClusters(commands, pipelines.draw, clip, mesh, *clusters);
    vkCmdEndRendering(commands.handle);
    copyDepth(commands, target);
}

void traceDepth(Commands& commands, const DepthPipelines& pipelines, DepthTarget& target, VkExtent3D extent,
                gpu::TracePush rays, const FieldBuffers& field) {
    resizeImage(commands, target.depth, extent, VK_FORMAT_R32_SFLOAT);
    rays.size = {extent.width, extent.height};
    const VkExtent3D cones = {groupsFor(extent.width, RENDER_CONE), groupsFor(extent.height, RENDER_CONE), 1};
    resizeImage(commands, target.starts, cones, VK_FORMAT_R32_SFLOAT);
    const auto pass = [&](const Pipeline& pipeline, VkExtent3D size, const Image& written) {
        std::vector<Descriptor> bound = {storage(0, written), storage(1, target.starts)};
        addField(bound, field);
        dispatchRows(commands, pipeline,
                     {groupsFor(size.width, kTraceGroup), groupsFor(size.height, kTraceGroup), 1}, &rays,
                     sizeof rays, bound);
        barrier(commands);
    };
    pass(pipelines.cones, cones, target.starts);
    pass(pipelines.trace, extent, target.depth);
}

GBuffer createGBuffer(const Device& device) {
    GBuffer gbuffer;
    gbuffer.tiles = createComputePipeline(device, {.name = "render/tiles.comp"});
    return gbuffer;
}

GBuffer createGBuffer(const Device& device, std::string_view field) {
    GBuffer gbuffer = createGBuffer(device);
    gbuffer.surface = createComputePipeline(device, {.name = "render/surface.comp", .field = field});
    return gbuffer;
}

bool resizeGBuffer(Commands& commands, GBuffer& gbuffer, VkExtent3D extent) {
    if (!resizeImage(commands, gbuffer.surfaces[0], extent, VK_FORMAT_R32G32B32A32_UINT)) return false;
    resizeImage(commands, gbuffer.surfaces[1], extent, VK_FORMAT_R32G32B32A32_UINT);
    reserve(commands.device, gbuffer.tileLists, 4ull * RENDER_LISTS * tilesOf(extent));
    reserve(commands.device, gbuffer.arguments,
            argumentsOf(RENDER_LISTS, slicesOf(commands.device, extent), 0));
    return true;
}

void listTiles(Commands& commands, GBuffer& gbuffer, const Image& depth, const Buffer& frame) {
    const VkExtent3D extent = depth.extent;
    std::vector<uint32_t> none(RENDER_LISTS);  // lengths of 0, and dispatches of no groups
    for (uint32_t i = 0; i < RENDER_LISTS * slicesOf(commands.device, extent); ++i)
        none.insert(none.end(), {0, 1, 1});
    vkCmdUpdateBuffer(commands.handle, gbuffer.arguments.handle, 0, none.size() * 4, none.data());
    barrier(commands);
    const std::array<Descriptor, 4> bound = {Descriptor(0, frame), storage(1, depth),
                                             Descriptor(3, gbuffer.tileLists),
                                             Descriptor(4, gbuffer.arguments)};
    dispatch(commands, gbuffer.tiles,
             {groupsFor(extent.width, RENDER_TILE), groupsFor(extent.height, RENDER_TILE), 1}, nullptr, 0,
             bound);
    barrier(commands);
}

void fillGBuffer(Commands& commands, GBuffer& gbuffer, const Image& depth, const Buffer& frame,
                 const FieldBuffers& field) {
    beginStage(commands, "tiles");
    listTiles(commands, gbuffer, depth, frame);
    beginStage(commands, "surface");
    std::vector<Descriptor> bound = {
        {0, frame}, storage(1, depth), storage(2, gbuffer.now()), {3, gbuffer.tileLists}};
    addField(bound, field);
    dispatchTiles(commands, gbuffer.surface, gbuffer, RENDER_NEAR, nullptr, 0, bound);
    barrier(commands);
}

void dispatchAllTiles(Commands& commands, const Pipeline& pipeline, const GBuffer& gbuffer, uint32_t list,
                      const void* push, std::size_t pushSize, std::span<const Descriptor> bound) {
    const uint32_t slices = slicesOf(commands.device, gbuffer.now().extent);
    for (uint32_t slice = 0; slice < slices; ++slice)
        dispatchIndirect(commands, pipeline, gbuffer.arguments, argumentsOf(list, slices, slice), push,
                         pushSize, fromTile(bound, gbuffer, slice * mostTiles(commands.device)));
}

void dispatchTiles(Commands& commands, const Pipeline& pipeline, const GBuffer& gbuffer, uint32_t list,
                   const void* push, std::size_t pushSize, std::span<const Descriptor> bound) {
    if (!commands.parted) return dispatchAllTiles(commands, pipeline, gbuffer, list, push, pushSize, bound);
    flush(commands);
    const uint32_t tiles = download<uint32_t>(commands.device, gbuffer.arguments, RENDER_LISTS)[list];
    uint32_t slices = 1;
    for (uint32_t first = 0; first < tiles;) {
        if (commands.cancel && *commands.cancel) return;
        slices = std::min(slices, mostTiles(commands.device) / kSlice);
        const uint32_t now = std::min(slices * kSlice, tiles - first);
        dispatch(commands, pipeline, {now, 1, 1}, push, pushSize, fromTile(bound, gbuffer, first));
        first += now;
        if (first < tiles) slices = flushPart(commands, slices);
    }
}

}  // namespace fw
