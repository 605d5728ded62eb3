#include "editor/panels/staying_dialog.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

namespace fw::editor {

void showStaying(StayingDialog& dialog, const char* title, float width, float top,
                 const std::function<bool()>& content) {
    if (!dialog.open) return;
    const bool busy = std::exchange(dialog.busy, false);
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    const float fits = std::min(width, 0.95f * whole.x);
    ImGui::SetNextWindowPos({0.5f * whole.x, top * whole.y}, ImGuiCond_Appearing, {0.5f, 0.0f});
    ImGui::SetNextWindowSizeConstraints({fits, 0}, {fits, 0.92f * whole.y});
    if (std::exchange(dialog.toFront, false)) ImGui::SetNextWindowFocus();
    if (ImGui::Begin(title, &dialog.open,
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoSavedSettings)) {
        if (!content() && !busy && ImGui::IsWindowFocused() &&
            ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
            dialog.open = false;
        dialog.busy = ImGui::IsAnyItemActive() || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    }
    ImGui::End();
}

}  // namespace fw::editor
