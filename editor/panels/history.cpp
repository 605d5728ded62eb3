// The steps of undo as a list, the last below: a click takes back all after it, or does all up to it again.
#include <utility>

#include "editor/editor.h"

namespace fw::editor {

void showHistory(Editor& editor) {
    Document& document = editor.document;
    const std::size_t now = document.step();
    std::size_t goTo = now;
    ImGuiListClipper clipper;
    clipper.Begin(int(document.stepCount()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const std::size_t step = std::size_t(i);
            const std::string& name = document.stepName(step);
            ImGui::PushID(i);
            // What was taken back is paler: the next change drops it.
            if (step > now) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_TextDisabled));
            if (ImGui::Selectable(name.empty() ? "As it was opened" : name.c_str(), step == now)) goTo = step;
            if (step > now) ImGui::PopStyleColor();
            ImGui::PopID();
        }
    if (std::exchange(editor.panelState.historyAt, now) != now) {
        const float line = ImGui::GetTextLineHeightWithSpacing(), top = line * float(now),
                    room = ImGui::GetWindowHeight(), from = ImGui::GetScrollY();
        if (top < from || top + line > from + room) ImGui::SetScrollY(top - 0.5f * room);
    }
    document.goTo(goTo);
}

}  // namespace fw::editor
