#include "editor/controls/plate.h"

#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr float kBesideWords = 5.0f, kAboveWords = 3.0f;  // pixels at scale 1 to the plate's rim

}  // namespace

ImVec2 plateSize(const std::string& words, float scale) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    return {size.x + 2.0f * kBesideWords * scale, size.y + 2.0f * kAboveWords * scale};
}

void showPlate(ImDrawList* list, ImVec2 at, const std::string& words, ImU32 color, float scale) {
    const ImVec2 size = plateSize(words, scale);
    list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, themeColor(ThemeColor::plate),
                        kRound * ImGui::GetFontSize());
    list->AddText({at.x + kBesideWords * scale, at.y + kAboveWords * scale}, color, words.c_str());
}

}  // namespace fw::editor
