#include "editor/shell/draw_lists.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "editor/shell/draw_runs.h"

namespace fw::editor {

namespace {

/// As in shaders/editor/ui.vert.
struct Push {
    float scale[2], offset[2];
};

/// All vertices and indices of the frame, one list after the other, into the mapped buffers.
void gather(const Device& device, DrawLists& lists, const ImDrawData& data) {
    const auto room = [&](Buffer& buffer, VkDeviceSize bytes) {
        // With a reserve, so that a growing interface does not allocate in every frame.
        if (bytes > buffer.size) reserve(device, buffer, bytes + bytes / 2, Memory::upload);
    };
    finish(device);  // the last frame has read them
    room(lists.vertices, VkDeviceSize(data.TotalVtxCount) * sizeof(ImDrawVert));
    room(lists.indices, VkDeviceSize(data.TotalIdxCount) * sizeof(ImDrawIdx));
    auto* vertex = static_cast<ImDrawVert*>(lists.vertices.mapped);
    auto* index = static_cast<ImDrawIdx*>(lists.indices.mapped);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        vertex = std::copy(list.VtxBuffer.begin(), list.VtxBuffer.end(), vertex);
        index = std::copy(list.IdxBuffer.begin(), list.IdxBuffer.end(), index);
    }
}

/// The command's clip rectangle within the target; empty if nothing of it is seen.
VkRect2D scissorOf(const ImDrawCmd& command, const ImDrawData& data, VkExtent2D extent) {
    const auto inside = [](float pixel, uint32_t size) {
        return int32_t(std::clamp(pixel, 0.0f, float(size)));
    };
    const int32_t x0 = inside(command.ClipRect.x - data.DisplayPos.x, extent.width),
                  y0 = inside(command.ClipRect.y - data.DisplayPos.y, extent.height),
                  x1 = inside(command.ClipRect.z - data.DisplayPos.x, extent.width),
                  y1 = inside(command.ClipRect.w - data.DisplayPos.y, extent.height);
    return {{x0, y0}, {uint32_t(std::max(0, x1 - x0)), uint32_t(std::max(0, y1 - y0))}};
}

bool isOpaque(const Picture& picture) {
    for (std::size_t i = 3; i < picture.pixels.size(); i += 4)
        if (picture.pixels[i] != 255) return false;
    return true;
}

void beginDrawing(Commands& commands, VkImageView target, VkExtent2D extent, ImU32 background) {
    const ImVec4 color = ImGui::ColorConvertU32ToFloat4(background);
    auto attachment = zeroed<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    attachment.imageView = target;
    attachment.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.clearValue.color = {{color.x, color.y, color.z, 1.0f}};
    auto info = zeroed<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    info.renderArea.extent = extent;
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &attachment;
    vkCmdBeginRendering(commands.handle, &info);
    const VkViewport viewport = {0, 0, float(extent.width), float(extent.height), 0, 1};
    vkCmdSetViewport(commands.handle, 0, 1, &viewport);
}

}  // namespace

DrawLists createDrawLists(const Device& device, VkFormat format) {
    DrawLists lists;
    GraphicsOptions options{
        .shaders = {{.name = "editor/ui.vert"}, {.name = "editor/ui.frag"}},
        .colorFormats = {format},
        .vertexStride = sizeof(ImDrawVert),
        .vertexAttributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
                             {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
                             {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}},
        .cull = VK_CULL_MODE_NONE,
        .blend = {VK_TRUE, VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD,
                  VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD, 0xf}};
    lists.blended = createGraphicsPipeline(device, options);
    options.blend.blendEnable = VK_FALSE;
    lists.picture = createGraphicsPipeline(device, options);
    options.shaders[1].name = "editor/plain.frag";
    lists.plain = createGraphicsPipeline(device, options);
    lists.sampler = createSampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    return lists;
}

void fillTexture(const Device& device, DrawLists& lists, Texture& texture) {
    const Picture& picture = texture.picture;
    const VkExtent3D extent = {uint32_t(picture.width), uint32_t(picture.height), 1};
    Image& image = texture.image;
    if (!image || image.extent.width != extent.width || image.extent.height != extent.height)
        image = createImage(device, {.extent = extent,
                                     .format = VK_FORMAT_R8G8B8A8_UNORM,
                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    reserve(device, lists.staging, picture.pixels.size(), Memory::upload);
    upload(device, lists.staging, picture.pixels);
    Commands commands(device);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = extent;
    vkCmdCopyBufferToImage(commands.handle, lists.staging.handle, image.handle,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    submit(commands);
    texture.filled = true;
    texture.opaque = isOpaque(picture);
}

void draw(Commands& commands, DrawLists& lists, const ImDrawData& data, VkImageView target, VkExtent2D extent,
          ImU32 background) {
    gather(commands.device, lists, data);
    beginDrawing(commands, target, extent, background);
    const float wide = 2.0f / data.DisplaySize.x, high = 2.0f / data.DisplaySize.y;
    const Push push = {{wide, high}, {-1.0f - data.DisplayPos.x * wide, -1.0f - data.DisplayPos.y * high}};
    if (data.TotalIdxCount > 0) {
        const VkDeviceSize start = 0;
        vkCmdBindVertexBuffers(commands.handle, 0, 1, &lists.vertices.handle, &start);
        vkCmdBindIndexBuffer(commands.handle, lists.indices.handle, 0,
                             sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
    }
    uint32_t firstVertex = 0, firstIndex = 0;
    const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    const ImTextureID glyphs = ImGui::GetIO().Fonts->TexID;
    const Pipeline* pipeline = nullptr;  // that is bound, with this texture
    ImTextureID bound = nullptr;
    const auto use = [&](const Pipeline& next, ImTextureID id) {
        if (std::exchange(pipeline, &next) == &next && bound == id) return;
        bound = id;
        const Descriptor texture(0, static_cast<const Texture*>(id)->image.view,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, lists.sampler.handle);
        fw::bind(commands, next, &push, sizeof push, std::span(&texture, 1));
    };
    std::vector<DrawRun> runs;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            assert(!command.UserCallback && "the interface draws no callbacks");
            const VkRect2D scissor = scissorOf(command, data, extent);
            if (command.ElemCount == 0 || scissor.extent.width == 0 || scissor.extent.height == 0) continue;
            vkCmdSetScissor(commands.handle, 0, 1, &scissor);
            const ImTextureID id = command.GetTexID();
            runs.assign(1, {0, command.ElemCount, false});
            if (id == glyphs || static_cast<const Texture*>(id)->opaque)
                cutIntoRuns(list, command, id == glyphs ? &white : nullptr, runs);
            for (const DrawRun& run : runs) {
                use(!run.opaque ? lists.blended : id == glyphs ? lists.plain : lists.picture, id);
                vkCmdDrawIndexed(commands.handle, run.count, 1, firstIndex + command.IdxOffset + run.first,
                                 int32_t(firstVertex + command.VtxOffset), 0);
            }
        }
        firstVertex += uint32_t(list.VtxBuffer.Size);
        firstIndex += uint32_t(list.IdxBuffer.Size);
    }
    vkCmdEndRendering(commands.handle);
}

}  // namespace fw::editor
