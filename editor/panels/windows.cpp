#include "editor/panels/windows.h"

#include "editor/editor.h"
#include "editor/panels/tour.h"

namespace fw::editor {

namespace {

void showAbout(Editor& editor) {
    constexpr const char* kTitle = "About Fieldwright";
    if (std::exchange(editor.windows.about, false)) ImGui::OpenPopup(kTitle);
    bool stays = true;
    if (!ImGui::BeginPopupModal(kTitle, &stays,
                                ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings))
        return;
    ImGui::TextUnformatted("Fieldwright " FIELDWRIGHT_VERSION);
    ImGui::TextDisabled("Graphs of nodes to fields, fields to meshes.");
    ImGui::Spacing();
    ImGui::PushTextWrapPos(std::min(40.0f * ImGui::GetFontSize(), 0.8f * ImGui::GetMainViewport()->Size.x));
    ImGui::Text("Vulkan device: %s", editor.shell.device().name().c_str());
    ImGui::Text("Preferences: %s", preferencesPath().c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::Button("Close") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
        ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace

void showWindows(Editor& editor) {
    code::showWindow(editor);
    showOutline(editor);
    showPalette(editor);
    showPreferences(editor);
    showReference(editor);
    showShortcuts(editor);
    showTour(editor);
    showAbout(editor);
}

}  // namespace fw::editor
