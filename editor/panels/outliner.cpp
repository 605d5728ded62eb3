// All nodes of the document and of its groups, in a list that can be searched. A click goes there.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>

#include "editor/panels/properties.h"
#include "editor/shell/icons.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "graph/base/words.h"

namespace fw::editor {

namespace {

/// A line of the list: a scope's, or that of a node in it.
struct Line {
    std::string_view scope;
    const Node* node = nullptr;  ///< null: the line of the scope itself
    std::size_t count = 0;       ///< of the scope's nodes that are found
};

std::string titleOf(const Node& node, const NodeType* type) {
    if (!node.label.empty()) return node.label;
    if (!node.group.empty()) return readable(node.group);
    return type ? type->label : node.type;
}

bool matches(const Node& node, const std::string& wanted) {
    if (wanted.empty() || lowered(node.id).find(wanted) != std::string::npos) return true;
    return lowered(titleOf(node, findNodeType(node.type))).find(wanted) != std::string::npos ||
           lowered(node.type).find(wanted) != std::string::npos;
}

std::vector<Line> linesOf(const Graph& graph, const PanelState& state) {
    const std::string wanted = lowered(state.search);
    std::vector<Line> lines;
    const auto add = [&](std::string_view scope, const std::vector<Node>& nodes) {
        const std::size_t head = lines.size();
        lines.push_back({scope, nullptr, 0});
        const bool open = !wanted.empty() || !state.folded.contains(std::string(scope));
        for (const Node& node : nodes) {
            if (!matches(node, wanted)) continue;
            ++lines[head].count;
            if (open) lines.push_back({scope, &node, 0});
        }
        if (!wanted.empty() && lines[head].count == 0) lines.pop_back();
    };
    add({}, graph.nodes);
    for (const Group& group : graph.groups) add(group.id, group.nodes);
    return lines;
}

/// What a click asked for: gone to when the list has been drawn.
struct Wanted {
    std::string node, toggled;
    std::optional<std::string> scope;
};

void showScope(PanelState& state, const Line& line, bool current, Wanted& wanted) {
    const std::string scope(line.scope);
    const bool folded = state.search.empty() && state.folded.contains(scope);
    if (ImGui::ArrowButton("##fold", folded ? ImGuiDir_Right : ImGuiDir_Down)) {
        if (folded)
            state.folded.erase(scope);
        else
            state.folded.insert(scope);
    }
    ImGui::SameLine();
    const std::string words =
        (scope.empty() ? "Document" : "Group " + readable(scope)) + "  (" + std::to_string(line.count) + ")";
    if (ImGui::Selectable(words.c_str(), current)) wanted.scope = scope;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Click to show it on the canvas");
}

void showNode(const Editor& editor, const Line& line, const std::set<std::string_view>& wrong,
              Wanted& wanted) {
    const Node& node = *line.node;
    const NodeType* type = findNodeType(node.type);
    const bool here = line.scope == editor.canvas.scope;
    const std::string path = line.scope.empty() ? node.id : std::string(line.scope) + "/" + node.id;
    const float em = ImGui::GetFontSize();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##node", here && editor.canvas.selection.contains(node.id), 0,
                          {0, ImGui::GetFrameHeight()})) {
        if (ImGui::GetIO().KeyCtrl && here)
            wanted.toggled = node.id;
        else
            wanted.node = path;
    }
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float middle = at.y + 0.5f * ImGui::GetFrameHeight(), x = at.x + 1.8f * em;
    if (type)
        drawBadge(*list, type->category, {x + 0.5f * em, middle}, em);
    else
        list->AddRectFilled({x, middle - 0.5f * em}, {x + em, middle + 0.5f * em},
                            themeColor(ThemeColor::error), 0.2f * em);
    const ImVec2 text(x + 1.5f * em, middle - 0.5f * em);
    const float right = ImGui::GetItemRectMax().x;
    const std::string whole = titleOf(node, type), title = fitted(whole, right - text.x);
    const ImU32 color = wrong.contains(path) ? themeColor(ThemeColor::error)
                        : node.muted         ? themeColor(ThemeColor::quiet)
                                             : themeColor(ThemeColor::text);
    list->AddText(text, color, title.c_str());
    if (lowered(whole) != node.id) {
        const float after = text.x + ImGui::CalcTextSize(title.c_str()).x + em;
        if (right - after > 2.0f * em)
            list->AddText({after, text.y}, themeColor(ThemeColor::quiet),
                          fitted(node.id, right - after).c_str());
    }
}

}  // namespace

void showOutliner(Editor& editor) {
    PanelState& state = editor.panelState;
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputTextWithHint("##search", "Search nodes by name, id or type", &state.search);
    const std::vector<Line> lines = linesOf(*editor.graph, state);
    if (lines.empty()) return ImGui::TextDisabled("No node has that name");
    std::set<std::string_view> wrong;
    for (const Error& finding : editor.viewport.shown.findings)
        if (finding.severity == Error::Severity::error) wrong.insert(finding.node);

    Wanted wanted;
    ImGui::BeginChild("##nodes");
    ImGuiListClipper clipper;
    clipper.Begin(int(lines.size()), ImGui::GetFrameHeightWithSpacing());
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const Line& line = lines[std::size_t(i)];
            ImGui::PushID(i);
            if (line.node)
                showNode(editor, line, wrong, wanted);
            else
                showScope(state, line, line.scope == editor.canvas.scope, wanted);
            ImGui::PopID();
        }
    ImGui::EndChild();

    Canvas& canvas = editor.canvas;
    if (wanted.scope && *wanted.scope != canvas.scope) {
        canvas.scope = *wanted.scope;
        canvas.select({});
        canvas.frameNext = true;
        editor.drawn = 0;  // of another scope
    } else if (!wanted.toggled.empty()) {
        if (!canvas.selection.erase(wanted.toggled)) canvas.selection.insert(wanted.toggled);
        if (!canvas.selection.contains(canvas.active))
            canvas.active = canvas.selection.empty() ? std::string() : *canvas.selection.begin();
    } else if (!wanted.node.empty()) {
        reveal(editor, wanted.node);
    }
}

}  // namespace fw::editor
