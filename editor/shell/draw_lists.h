// Dear ImGui's draw lists on the runtime's Vulkan layer.
//
// One vertex and one index buffer that stay mapped and grow, a push descriptor a texture. The next are drawn
// once the last have been. Colours are blended as they are, in sRGB, as ImGui means them; what is opaque
// (draw_runs.h) has pipelines of its own.
//
// Lifetime: the pipelines are of one colour format; a Texture is of the picture last put into it.
#pragma once

#include <imgui.h>

#include "runtime/gpu/commands.h"
#include "runtime/render/picture.h"

namespace fw::editor {

/// What an ImTextureID points to: a picture, and its copy on the device once it is filled.
struct Texture {
    Picture picture;
    bool filled = false;
    bool opaque = false;  ///< the picture that fills it
    Image image;
};

struct DrawLists {
    Pipeline blended, picture, plain;  ///< the last two for what is opaque, with and without texture
    Sampler sampler;
    Buffer vertices, indices, staging;
};

DrawLists createDrawLists(const Device& device, VkFormat format);

/// Copies the texture's picture into its image, which is made or replaced if its size is another. Waits until
/// it is there.
void fillTexture(const Device& device, DrawLists& lists, Texture& texture);

/// Draws what ImGui::Render() made over `background`. The target is of the pipelines' format, in
/// VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, and as large as the draw data's display.
void draw(Commands& commands, DrawLists& lists, const ImDrawData& data, VkImageView target, VkExtent2D extent,
          ImU32 background);

}  // namespace fw::editor
