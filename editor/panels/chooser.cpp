// A list that is searched by typing and chosen from by arrows and Enter, or by the mouse.
#include <algorithm>
#include <cctype>
#include <sstream>

#include "editor/editor.h"
#include "graph/base/words.h"

namespace fw::editor {

namespace {

bool pressed(ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); }

/// Moves the choice to the next that can be chosen.
void turn(int& chosen, int by, std::span<const Choice> choices, const std::vector<std::size_t>& found) {
    const int count = int(found.size());
    for (int i = 0; i < count; ++i) {
        chosen = ((chosen + by) % count + count) % count;
        if (choices[found[std::size_t(chosen)]].enabled) return;
    }
}

}  // namespace

std::vector<std::size_t> findChoices(std::string_view search, std::span<const Choice> choices) {
    const std::string wanted = lowered(search);
    std::vector<std::size_t> begins, has;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const std::string label = lowered(choices[i].label);
        std::istringstream words(wanted);
        bool all = true;
        for (std::string word; words >> word;) all = all && label.find(word) != std::string::npos;
        if (all) (label.starts_with(wanted) ? begins : has).push_back(i);
    }
    begins.insert(begins.end(), has.begin(), has.end());
    return begins;
}

std::optional<std::size_t> choose(Chooser& chooser, const char* popup, std::span<const Choice> choices,
                                  float scale) {
    const bool opens = std::exchange(chooser.opened, false);
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    const ImVec2 size(std::min(480.0f * scale, 0.95f * whole.x), std::min(420.0f * scale, 0.95f * whole.y));
    if (opens) {
        chooser.search[0] = 0;
        chooser.chosen = -1;
        ImGui::OpenPopup(popup);
        ImGui::SetNextWindowPos({0.5f * (whole.x - size.x), 0.25f * (whole.y - size.y)});
    }
    ImGui::SetNextWindowSize(size);
    if (!ImGui::BeginPopup(popup, ImGuiWindowFlags_NoNavInputs)) return std::nullopt;
    if (opens) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##search", "Search", chooser.search, sizeof chooser.search))
        chooser.chosen = -1;
    const std::vector<std::size_t> found = findChoices(chooser.search, choices);
    const bool down = pressed(ImGuiKey_DownArrow), up = pressed(ImGuiKey_UpArrow);
    if (chooser.chosen < 0 || down) turn(chooser.chosen, 1, choices, found);
    if (up) turn(chooser.chosen, -1, choices, found);
    const bool entered = pressed(ImGuiKey_Enter) || pressed(ImGuiKey_KeyPadEnter);

    std::optional<std::size_t> taken;
    ImGui::BeginChild("##found", {0, 0}, false, ImGuiWindowFlags_NoNav);
    if (found.empty()) ImGui::TextDisabled("Nothing has that name");
    for (int i = 0; i < int(found.size()); ++i) {
        const Choice& choice = choices[found[std::size_t(i)]];
        ImGui::PushID(i);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x;
        const bool clicked = ImGui::Selectable(
            choice.label.c_str(), i == chooser.chosen,
            choice.enabled ? ImGuiSelectableFlags_None : ImGuiSelectableFlags_Disabled, {width, 0});
        if (!choice.detail.empty())
            ImGui::GetWindowDrawList()->AddText(
                {at.x + width - ImGui::CalcTextSize(choice.detail.c_str()).x, at.y},
                ImGui::GetColorU32(ImGuiCol_TextDisabled), choice.detail.c_str());
        if (i == chooser.chosen && (down || up)) ImGui::SetScrollHereY();
        if (clicked || (entered && i == chooser.chosen && choice.enabled)) taken = found[std::size_t(i)];
        ImGui::PopID();
    }
    ImGui::EndChild();
    if (taken || pressed(ImGuiKey_Escape)) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return taken;
}

}  // namespace fw::editor
