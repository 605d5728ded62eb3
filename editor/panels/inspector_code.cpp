// The code of an expression, what is wrong with it, and a row to add inputs.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "editor/document/expression_inputs.h"
#include "editor/panels/inspector.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr int kLeastLines = 6, kMostLines = 24;

void showFindingsInCode(const Editor& editor, const std::string& path) {
    for (const Error& finding : editor.viewport.shown.findings) {
        if (finding.node != path || finding.codeLine == 0) continue;
        const bool error = finding.severity == Error::Severity::error;
        ImGui::PushStyleColor(ImGuiCol_Text, themeColor(error ? ThemeColor::error : ThemeColor::warning));
        ImGui::TextWrapped("Line %d, column %d: %s", finding.codeLine, finding.codeColumn,
                           finding.message.c_str());
        ImGui::PopStyleColor();
    }
}

void addInput(Editor& editor, const std::string& node) {
    PanelState& state = editor.panelState;
    Result<Graph> added = addExpressionInput(editor.document.graph(), editor.canvas.scope, node,
                                             state.newInput, kExpressionTypes[state.newInputType]);
    if (!added) return say(editor, "cannot add the input: " + added.error().message);
    editor.document.apply("Add Input " + state.newInput, std::move(*added));
    state.newInput.clear();
}

}  // namespace

void showExpression(Editor& editor, const NodeBox& box) {
    const std::string scope = editor.canvas.scope, id = box.node->id;
    const auto lines = int(std::ranges::count(box.node->code, '\n')) + 2;
    const float height = float(std::clamp(lines, kLeastLines, kMostLines)) * ImGui::GetTextLineHeight() +
                         2.0f * ImGui::GetStyle().FramePadding.y;
    ImGui::Spacing();
    ImGui::TextUnformatted("Code");
    ImGui::SameLine();
    ImGui::TextDisabled("Ctrl+Enter applies it");
    editCode(editor, "##code", box.node->code, height, [scope, id](Editor& in, const std::string& code) {
        in.document.apply("Change Code", setCode(in.document.graph(), scope, id, code));
    });
    showFindingsInCode(editor, pathOf(editor, id));

    PanelState& state = editor.panelState;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(9.0f * em);
    const bool entered = ImGui::InputTextWithHint("##input", "new input's name", &state.newInput,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5.0f * em);
    if (ImGui::BeginCombo("##type", std::string(typeName(kExpressionTypes[state.newInputType])).c_str())) {
        for (int i = 0; i < int(std::size(kExpressionTypes)); ++i)
            if (ImGui::Selectable(std::string(typeName(kExpressionTypes[i])).c_str(),
                                  i == state.newInputType))
                state.newInputType = i;
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    if ((ImGui::Button("Add input") || entered) && !state.newInput.empty()) addInput(editor, id);
}

}  // namespace fw::editor
