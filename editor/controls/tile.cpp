#include "editor/controls/tile.h"

#include "editor/shell/letters.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr float kInTile = 0.2f;  // of the font's size, from the tile's rim to its picture

}  // namespace

float tileNameHeight() { return 1.4f * ImGui::GetFontSize(); }

bool showTile(ImTextureID texture, const std::string& name, float width, float high,
              ImGuiSelectableFlags flags) {
    const float em = ImGui::GetFontSize(), inset = kInTile * em;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool chosen = ImGui::Selectable("##tile", false, flags, {width, high + tileNameHeight()});
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 lo(at.x + inset, at.y + inset), hi(at.x + width - inset, at.y + high - inset);
    if (texture)
        list->AddImageRounded(texture, lo, hi, {0, 0}, {1, 1}, IM_COL32_WHITE, kRound * em);
    else
        list->AddRectFilled(lo, hi, themeColor(ThemeColor::field), kRound * em);
    list->AddText({lo.x, at.y + high}, themeColor(ThemeColor::text),
                  fitted(name, width - 2.0f * inset).c_str());
    return chosen;
}

}  // namespace fw::editor
