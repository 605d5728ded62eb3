// A picture above its name, to be chosen: a sample, a part of the library.
#pragma once

#include <imgui.h>

#include <string>

namespace fw::editor {

/// Pixels that the name below a picture needs.
float tileNameHeight();
/// `width` and `high` are the picture's place, pixels; without a texture it is empty. A name that does not
/// fit ends in "…". Whether it was clicked; ImGui's last item is the tile.
bool showTile(ImTextureID texture, const std::string& name, float width, float high,
              ImGuiSelectableFlags flags = ImGuiSelectableFlags_None);

}  // namespace fw::editor
