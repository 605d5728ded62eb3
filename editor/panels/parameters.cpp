// The exposed parameters: their names, values, ranges and order.
#include "editor/document/parameters.h"

#include <algorithm>
#include <cmath>

#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"
#include "graph/document/unit.h"
#include "graph/language/typed_number.h"

namespace fw::editor {

namespace {

std::string boundText(const std::optional<double>& bound) { return bound ? numberText(*bound) : ""; }

/// A bound of the range as text: a number or an expression, or nothing for none.
void editBound(Editor& editor, const char* id, std::size_t index, const std::optional<double>& bound,
               Graph (*set)(const Graph&, std::size_t, std::optional<double>)) {
    const std::string name = editor.document.graph().parameters[index].name;
    editText(editor, id, boundText(bound), "none", [index, name, set](Editor& in, const std::string& text) {
        const Graph& graph = in.document.graph();
        if (index >= graph.parameters.size() || graph.parameters[index].name != name) return;
        std::optional<double> number;
        if (!text.empty()) {
            const Node* node = graph.node(graph.parameters[index].node);
            const std::string_view unit = node ? unitOfInput(*node, graph.parameters[index].input) : "any";
            const Result<double> typed = typedNumber(text, unit, unitOf(graph));
            if (!typed) return say(in, "no range: " + typed.error().message);
            number = *typed;
        }
        in.document.apply("Set Range of " + name, set(graph, index, number));
    });
}

void showValue(Editor& editor, const ExposedParameter& parameter) {
    const Plug plug{parameter.node, parameter.input};
    const Graph& graph = editor.document.graph();
    const Node* node = graph.node(parameter.node);
    if (!node)
        return ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(themeColor(ThemeColor::error)), "no node %s",
                                  parameter.node.c_str());
    const InputValue* given = node->input(parameter.input);
    if (given && std::holds_alternative<Link>(given->value)) return ImGui::TextDisabled("linked");
    if (given && std::holds_alternative<bool>(given->value)) {
        bool on = std::get<bool>(given->value);
        if (ImGui::Checkbox("##on", &on))
            editor.document.apply("Set " + parameter.name,
                                  setInput(graph, "", plug, InputValue{.value = on}));
        return;
    }
    const NodeType* type = findNodeType(node->type);
    const int index = type ? inputIndex(*type, parameter.input) : -1;
    const InputSpec* spec = index < 0 ? nullptr : &type->inputs[std::size_t(index)];
    NumberRange range{.unit = unitOfInput(*node, parameter.input)};
    if (parameter.min) range.min = *parameter.min;
    if (parameter.max) range.max = *parameter.max;
    if (spec) range.min = std::max(range.min, spec->min), range.max = std::min(range.max, spec->max);
    if (std::isfinite(range.max - range.min)) range.speed = (range.max - range.min) / 250.0;
    const std::string held = parameter.node + "." + parameter.input;
    const Timeline* timeline = timelineOf(editor);
    if (timeline)
        if (const auto track = trackOfInput(graph, *timeline, plug))
            return editAnimated(editor, "##value", timeline->tracks[*track], range, parameter.name, held);
    std::vector<double> numbers = inputNumbers(*node, parameter.input);
    if (numbers.empty()) return ImGui::TextDisabled("no number");
    if (spec && std::size_t(componentCount(spec->type)) > numbers.size())
        numbers.resize(std::size_t(componentCount(spec->type)), numbers[0]);
    range.whole = spec && spec->type == Type::integer;
    editNumbers(
        editor, "##value", numbers, range, "Set " + parameter.name,
        [plug](const Graph& in, std::span<const double> to) {
            return setInput(in, "", plug, numbersValue(to));
        },
        held);
}

void showMenu(Editor& editor, std::size_t index, std::string& goTo) {
    Document& document = editor.document;
    const std::vector<ExposedParameter>& all = document.graph().parameters;
    if (ImGui::MenuItem("Go to its node")) goTo = all[index].node;
    if (ImGui::MenuItem("Move up", nullptr, false, index > 0))
        document.apply("Move Parameter", moveParameter(document.graph(), index, index - 1));
    if (ImGui::MenuItem("Move down", nullptr, false, index + 1 < all.size()))
        document.apply("Move Parameter", moveParameter(document.graph(), index, index + 1));
    if (ImGui::MenuItem("Remove"))
        document.apply("Remove Parameter", removeParameter(document.graph(), index));
}

void showParameter(Editor& editor, std::size_t index, std::string& goTo) {
    const ExposedParameter parameter = editor.document.graph().parameters[index];
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-FLT_MIN);
    editText(editor, "##name", parameter.name, "name",
             [index, before = parameter.name](Editor& in, const std::string& text) {
                 const auto& all = in.document.graph().parameters;
                 if (index >= all.size() || all[index].name != before) return;
                 Result<Graph> renamed = renameParameter(in.document.graph(), index, text);
                 if (!renamed) return say(in, "cannot rename: " + renamed.error().message);
                 in.document.apply("Rename Parameter", std::move(*renamed));
             });
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s of %s", readable(parameter.input).c_str(), parameter.node.c_str());
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-FLT_MIN);
    showValue(editor, parameter);
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-FLT_MIN);
    editBound(editor, "##min", index, parameter.min, setParameterMin);
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-FLT_MIN);
    editBound(editor, "##max", index, parameter.max, setParameterMax);
    ImGui::TableNextColumn();
    if (ImGui::Button("…")) ImGui::OpenPopup("menu");
    if (ImGui::BeginPopup("menu")) {
        showMenu(editor, index, goTo);
        ImGui::EndPopup();
    }
}

/// Nodes of type parameter are played as parameters too; they are edited where they are.
void showParameterNodes(const Editor& editor, std::string& goTo) {
    const Graph& graph = editor.document.graph();
    const std::vector<NamedParameter> all = namedParameters(graph);
    if (all.size() <= graph.parameters.size()) return;
    ImGui::Spacing();
    ImGui::TextDisabled("Parameter nodes");
    for (std::size_t i = graph.parameters.size(); i < all.size(); ++i) {
        ImGui::PushID(int(i));
        if (ImGui::Selectable(all[i].name.c_str())) goTo = all[i].node;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Click to go to the node");
        ImGui::PopID();
    }
}

}  // namespace

void showParameters(Editor& editor) {
    std::string goTo;
    if (editor.document.graph().parameters.empty()) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled(
            "No parameters. Expose an input with the … button beside it in the inspector: whoever plays the "
            "graph can then change it.");
        ImGui::PopTextWrapPos();
    } else if (ImGui::BeginTable("parameters", 5, ImGuiTableFlags_SizingStretchProp)) {
        const float em = ImGui::GetFontSize();
        ImGui::TableSetupColumn("Name", ImGuiTableColumnFlags_WidthStretch, 0.32f);
        ImGui::TableSetupColumn("Value", ImGuiTableColumnFlags_WidthStretch, 0.44f);
        ImGui::TableSetupColumn("From", ImGuiTableColumnFlags_WidthStretch, 0.12f);
        ImGui::TableSetupColumn("To", ImGuiTableColumnFlags_WidthStretch, 0.12f);
        ImGui::TableSetupColumn("##more", ImGuiTableColumnFlags_WidthFixed, 1.8f * em);
        ImGui::TableHeadersRow();
        for (std::size_t i = 0; i < editor.document.graph().parameters.size(); ++i) {
            ImGui::PushID(int(i));
            showParameter(editor, i, goTo);
            ImGui::PopID();
        }
        ImGui::EndTable();
    }
    showParameterNodes(editor, goTo);
    if (!goTo.empty()) reveal(editor, goTo);
}

}  // namespace fw::editor
