// The code of an expression, and a row to add inputs.
#include <imgui.h>
#include <imgui_stdlib.h>

#include "editor/document/expression_inputs.h"
#include "editor/panels/inspector.h"
#include "editor/panels/properties.h"
#include "editor/shell/letters.h"

namespace fw::editor {

namespace {

void addInput(Editor& editor, const std::string& node) {
    PanelState& state = editor.panelState;
    Result<Graph> added = addExpressionInput(editor.document.graph(), editor.canvas.scope, node,
                                             state.newInput, kExpressionTypes[state.newInputType]);
    if (!added) return say(editor, "cannot add the input: " + added.error().message);
    editor.document.apply("Add Input " + state.newInput, std::move(*added));
    state.newInput.clear();
    state.refocus = ImGui::GetID("##input");  // for the next one
}

}  // namespace

void showExpression(Editor& editor, const NodeBox& box) {
    code::showInInspector(editor, box);
    const std::string id = box.node->id;
    PanelState& state = editor.panelState;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(9.0f * em);
    if (state.refocus == ImGui::GetID("##input")) {
        ImGui::SetKeyboardFocusHere();
        state.refocus = 0;
    }
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
    besideIfFits("Add input");
    if ((ImGui::Button("Add input") || entered) && !state.newInput.empty()) addInput(editor, id);
    // Behind what would move with each letter otherwise.
    if (!editor.code.large) code::showMessages(editor);
}

}  // namespace fw::editor
