// The inputs and outputs of a group.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "editor/document/group_sockets.h"
#include "editor/panels/inspector.h"
#include "editor/panels/properties.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "graph/document/input_value.h"

namespace fw::editor {

namespace {

/// The types that a group's socket can have, as files have them.
const std::vector<std::string>& socketTypes() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (int i = 0; i < kTypes; ++i) list.emplace_back(typeName(Type(i)));
        return list;
    }();
    return names;
}

bool chooseType(const char* id, std::size_t& chosen) {
    bool taken = false;
    if (!ImGui::BeginCombo(id, chosen < socketTypes().size() ? socketTypes()[chosen].c_str() : "?"))
        return false;
    for (std::size_t i = 0; i < socketTypes().size(); ++i)
        if (ImGui::Selectable(socketTypes()[i].c_str(), i == chosen) && i != chosen) chosen = i, taken = true;
    ImGui::EndCombo();
    return taken;
}

/// The default of a group's input, where it is made of numbers.
void showDefault(Editor& editor, const std::string& group, const GroupInput& input) {
    const auto type = typeNamed(input.type);
    const bool numbers = type == Type::scalar || type == Type::vec2 || type == Type::vec3;
    if (!numbers) return;
    std::vector<double> value(std::size_t(componentCount(*type)), 0.0);
    if (input.value) {
        if (const auto* one = std::get_if<double>(&input.value->value)) value.assign(value.size(), *one);
        if (const auto* list = std::get_if<std::vector<double>>(&input.value->value))
            if (list->size() == value.size()) value = *list;
    }
    ImGui::SetNextItemWidth(-FLT_MIN);
    editNumbers(editor, "##default", value, {.unit = "any"}, "Set Default of " + readable(input.name),
                [group, socket = input.name](const Graph& graph, std::span<const double> to) {
                    return setSocketDefault(graph, group, socket, numbersValue(to));
                });
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("What instances have that give no value of their own");
}

void showSocket(Editor& editor, const std::string& group, GroupSide side, const std::string& name,
                const std::string& type, std::size_t index, std::size_t count) {
    Document& document = editor.document;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(8.0f * em);
    editText(editor, "##name", name, "", [group, side, name](Editor& in, const std::string& text) {
        Result<Graph> renamed = renameSocket(in.document.graph(), group, side, name, text);
        if (!renamed) return say(in, "cannot rename: " + renamed.error().message);
        in.document.apply("Rename Socket", std::move(*renamed));
    });
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5.5f * em);
    std::size_t chosen = std::size_t(std::ranges::find(socketTypes(), type) - socketTypes().begin());
    if (chooseType("##type", chosen))
        document.apply("Set Type of " + readable(name),
                       setSocketType(document.graph(), group, side, name, Type(chosen)));
    ImGui::SameLine();
    ImGui::BeginDisabled(index == 0);
    if (ImGui::SmallButton("↑"))
        document.apply("Move Socket", moveSocket(document.graph(), group, side, name, index - 1));
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(index + 1 == count);
    if (ImGui::SmallButton("↓"))
        document.apply("Move Socket", moveSocket(document.graph(), group, side, name, index + 1));
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::SmallButton("×"))
        document.apply("Remove Socket", removeSocket(document.graph(), group, side, name));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove it, with its wires");
}

void add(Editor& editor, const std::string& group, GroupSide side) {
    PanelState& state = editor.panelState;
    Result<Graph> added =
        addSocket(editor.document.graph(), group, side, state.newSocket, Type(state.newSocketType));
    if (!added) return say(editor, "cannot add it: " + added.error().message);
    editor.document.apply("Add Socket " + state.newSocket, std::move(*added));
    state.newSocket.clear();
}

/// Of what file the group is a copy, how the two stand, and what can be done about it.
void showLink(Editor& editor, const Group& group) {
    if (group.file.empty()) {
        if (ImGui::Button("Link to a file …")) askToLink(editor, group.id);
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("Writes the group into a file of its own, that other documents can use too");
        return;
    }
    ImGui::TextWrapped("A copy of %s", group.file.c_str());
    const GroupLinks::Link* link = editor.files.groups.of(group.id);
    const std::string words = link ? wordsOf(*link) : "";
    wrapped(themeColor(words.empty() ? ThemeColor::quiet : ThemeColor::warning),
            words.empty() ? "The two are the same." : words);
    ImGui::BeginDisabled(!link || !link->problem.empty() || link->state == LinkState::same);
    if (ImGui::Button("Update")) updateGroup(editor, group.id);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Takes what the file holds, as one step");
    besideIfFits("Write the file");
    ImGui::BeginDisabled(!link || (link->problem.empty() && link->state == LinkState::same));
    if (ImGui::Button("Write the file")) writeGroup(editor, group.id);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("What the file holds now is kept beside it");
    besideIfFits("Make it local");
    if (ImGui::Button("Make it local")) unlinkGroup(editor, group.id);
}

}  // namespace

void showGroupSockets(Editor& editor, const std::string& id) {
    const Group* group = editor.graph->group(id);
    ImGui::Spacing();
    showLink(editor, *group);
    ImGui::Spacing();
    ImGui::Text("Inputs of the group %s", readable(id).c_str());
    for (std::size_t i = 0; i < group->inputs.size(); ++i) {
        const GroupInput& input = group->inputs[i];
        ImGui::PushID(input.name.c_str());
        showSocket(editor, id, GroupSide::inputs, input.name, input.type, i, group->inputs.size());
        showDefault(editor, id, input);
        ImGui::PopID();
    }
    ImGui::Spacing();
    ImGui::Text("Outputs of the group %s", readable(id).c_str());
    for (std::size_t i = 0; i < group->outputs.size(); ++i) {
        const GroupOutput& output = group->outputs[i];
        ImGui::PushID(("out " + output.name).c_str());
        showSocket(editor, id, GroupSide::outputs, output.name, output.type, i, group->outputs.size());
        ImGui::PopID();
    }
    ImGui::Spacing();
    PanelState& state = editor.panelState;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(8.0f * em);
    ImGui::InputTextWithHint("##new", "new name", &state.newSocket);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5.5f * em);
    std::size_t chosen = std::size_t(state.newSocketType);
    if (chooseType("##new type", chosen)) state.newSocketType = int(chosen);
    ImGui::BeginDisabled(state.newSocket.empty());
    if (ImGui::Button("Add input")) add(editor, id, GroupSide::inputs);
    besideIfFits("Add output");
    if (ImGui::Button("Add output")) add(editor, id, GroupSide::outputs);
    ImGui::EndDisabled();
}

}  // namespace fw::editor
