// Words over a picture, on a plate that they can be read on whatever the picture shows.
#pragma once

#include <imgui.h>

#include <string>

namespace fw::editor {

/// Pixels that the words need with their plate, in ImGui's present font. `scale`: Shell::scale().
ImVec2 plateSize(const std::string& words, float scale);
/// The plate's upper left corner is `at`. `color`: of the words.
void showPlate(ImDrawList* list, ImVec2 at, const std::string& words, ImU32 color, float scale);

}  // namespace fw::editor
