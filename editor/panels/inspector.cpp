// The inspector: everything about the active node.
#include "editor/panels/inspector.h"

#include <algorithm>

#include "editor/document/paths.h"
#include "editor/panels/properties.h"
#include "editor/preview/pinned.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "graph/library/reference.h"

namespace fw::editor {

namespace {

/// A bar in the colour of the node's category with its type.
void showType(const NodeBox& box) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetFrameHeight();
    const ImU32 color = box.type ? categoryColor(box.type->category) : themeColor(ThemeColor::error);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, {at.x + width, at.y + height}, color, 3.0f);
    const std::string words = box.type
                                  ? box.type->label + "  ·  " + std::string(categoryName(box.type->category))
                                  : "unknown type \"" + box.node->type + "\"";
    list->AddText({at.x + 0.4f * height, at.y + 0.5f * (height - ImGui::GetFontSize())},
                  themeColor(ThemeColor::onTitle), words.c_str());
    ImGui::Dummy({width, height});
    if (box.type) wrapped(themeColor(ThemeColor::quiet), box.type->doc);
}

void showNames(Editor& editor, const NodeBox& box) {
    const std::string scope = editor.canvas.scope, id = box.node->id;
    if (!beginProperties("names")) return;
    propertyRow("Label", "What the node is called on the canvas.");
    if (std::exchange(editor.windows.renames, false)) ImGui::SetKeyboardFocusHere();
    const std::string otherwise = box.type ? box.type->label : box.node->type;
    editText(editor, "##label", box.node->label, otherwise.c_str(),
             [scope, id](Editor& in, const std::string& text) {
                 in.document.apply("Set Label", setLabel(in.document.graph(), scope, id, text));
             });
    propertyRow("Id", "What links, parameters and tracks call the node: a-z, 0-9 and '_'. They follow.");
    editText(editor, "##id", id, "", [scope, id](Editor& in, const std::string& text) {
        Result<Graph> renamed = renameNode(in.document.graph(), scope, id, text);
        if (!renamed) return say(in, "cannot rename: " + renamed.error().message);
        const std::string path = scope.empty() ? "" : scope + "/";
        std::vector<std::string> shown = pinnedNodes(in.viewport.pinned);
        std::ranges::replace(shown, path + id, path + text);
        in.viewport.pinned = pinnedTogether(shown);
        in.thumbnails.rename(path + id, path + text);
        in.document.apply("Rename Node", std::move(*renamed));
        if (in.canvas.scope != scope || in.canvas.active != id) return;
        in.canvas.select({text});
    });
    propertyRow("Shown", "A muted node passes on its first input of its output's type.");
    bool muted = box.node->muted, collapsed = box.node->collapsed;
    if (ImGui::Checkbox("Muted", &muted))
        editor.document.apply(
            "Mute", toggleMuted(editor.document.graph(), scope, std::span<const std::string>(&id, 1)));
    besideIfFits(ImGui::CalcTextSize("Collapsed").x + ImGui::GetFrameHeight() +
                 ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Checkbox("Collapsed", &collapsed))
        editor.document.apply("Collapse", toggleCollapsed(editor.document.graph(), scope,
                                                          std::span<const std::string>(&id, 1)));
    endProperties();
}

/// What was found about the node, but for its code.
void showFindings(const Editor& editor, const std::string& path) {
    for (const Error& finding : problemsOf(editor)) {
        if (finding.node != path || finding.codeLine > 0) continue;
        const bool error = finding.severity == Error::Severity::error;
        wrapped(themeColor(error ? ThemeColor::error : ThemeColor::warning),
                (finding.input.empty() ? "" : readable(finding.input) + ": ") + finding.message);
    }
}

/// A line for every node that makes a surface, so that what is below it stays where it is when more is known.
void showExactness(const Editor& editor, const NodeBox& box) {
    const std::string& id = box.node->id;
    const NodeExactness* said = exactnessOf(editor, id);
    const auto makes = [](const Row& row) { return row.output && row.type == Type::surface; };
    if (said || std::ranges::any_of(box.rows, makes))
        wrapped(themeColor(ThemeColor::quiet),
                "Distance: " + (said ? exactnessText(said->exactness) : "known when it is in the picture"));
    if (placeOf(*editor.graph, editor.viewport.shown.spoiledBy) == std::pair(editor.canvas.scope, id))
        wrapped(themeColor(ThemeColor::warning), "From this node on the field is no exact distance.");
}

}  // namespace

void showInspector(Editor& editor) {
    const NodeBox* box = editor.boxes->find(editor.canvas.active);
    if (!box) {
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        ImGui::TextWrapped("%s", editor.canvas.selection.empty()
                                     ? "Select a node to see and change its values."
                                     : "Click a node to make it the active one.");
        ImGui::PopStyleColor();
        return;
    }
    std::string goTo;
    ImGui::PushID(editor.canvas.scope.c_str());
    ImGui::PushID(box->node->id.c_str());
    showType(*box);
    showNames(editor, *box);
    showFindings(editor, pathOf(editor, box->node->id));
    showExactness(editor, *box);
    const bool expression = roleOf(box->node->type) == NodeRole::expression;
    if (expression) showExpression(editor, *box);
    const bool anyInput = std::ranges::any_of(box->rows, [](const Row& row) { return !row.output; });
    if (anyInput) {
        ImGui::Spacing();
        showInputs(editor, *box, goTo);
    }
    const bool end =
        roleOf(box->node->type) == NodeRole::groupInput || roleOf(box->node->type) == NodeRole::groupOutput;
    const std::string group = end ? editor.canvas.scope : box->node->group;
    if (!group.empty() && editor.graph->group(group)) showGroupSockets(editor, group);
    ImGui::PopID();
    ImGui::PopID();
    if (!goTo.empty()) reveal(editor, goTo);
}

}  // namespace fw::editor
