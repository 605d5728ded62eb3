// The menu to add nodes from: a search field and what it finds, by mouse or keyboard.
#include "editor/document/library.h"
#include "editor/editor.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr const char* kPopup = "Add node";

/// What the menu offers: all types that can be added here, or those that fit the open wire.
std::vector<const NodeType*> offered(const Editor& editor) {
    const Graph& graph = editor.document.graph();
    std::vector<const NodeType*> types;
    if (editor.add.wish.plug) {
        types = typesThatFit(graph, editor.canvas.scope, *editor.add.wish.plug, editor.add.wish.plugIsOutput);
    } else {
        for (const NodeType& type : nodeTypes()) types.push_back(&type);
    }
    std::erase_if(types, [&](const NodeType* type) {
        const bool onlyInGroups = type->role == NodeRole::groupInput || type->role == NodeRole::groupOutput;
        return type->role == NodeRole::group || type->role == NodeRole::frame ||
               (onlyInGroups && editor.canvas.scope.empty());
    });
    return types;
}

/// Adds the node, and connects it to the open wire.
void add(Editor& editor, const NodeType& type, std::string_view group = {}) {
    const AddMenu& menu = editor.add;
    Edited edited =
        addNode(editor.document.graph(), editor.canvas.scope, type.id, position(menu.wish.at), group);
    if (menu.wish.plug && !edited.nodes.empty()) {
        const Plug& plug = *menu.wish.plug;
        const std::string& id = edited.nodes.front();
        const auto other = menu.wish.plugIsOutput
                               ? fittingInput(edited.graph, editor.canvas.scope, plug, id)
                               : fittingOutput(edited.graph, editor.canvas.scope, id, plug);
        if (other)
            edited.graph = menu.wish.plugIsOutput ? connect(edited.graph, editor.canvas.scope, plug, *other)
                                                  : connect(edited.graph, editor.canvas.scope, *other, plug);
    }
    apply(editor, "Add " + type.label, std::move(edited));
    ImGui::CloseCurrentPopup();
}

}  // namespace

void showAddMenu(Editor& editor) {
    AddMenu& menu = editor.add;
    if (menu.opened) {
        menu.search[0] = 0;
        menu.chosen = 0;
        ImGui::OpenPopup(kPopup);
        ImGui::SetNextWindowPos(editor.canvas.view.toScreen(menu.wish.at));
    }
    const float unit = editor.shell.scale();
    ImGui::SetNextWindowSize({300 * unit, 380 * unit});
    if (!ImGui::BeginPopup(kPopup)) return;
    if (menu.opened) ImGui::SetKeyboardFocusHere();
    menu.opened = false;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##search", "Search", menu.search, sizeof menu.search)) menu.chosen = 0;

    const std::vector<const NodeType*> types = findTypes(menu.search, offered(editor));
    std::vector<const Group*> groups;
    if (!menu.wish.plug)
        for (const Group& group : editor.document.graph().groups)
            if (group.id != editor.canvas.scope &&
                std::string_view(group.id).find(menu.search) != std::string_view::npos)
                groups.push_back(&group);
    const int count = int(types.size() + groups.size());
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow))) ++menu.chosen;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow))) --menu.chosen;
    menu.chosen = count > 0 ? (menu.chosen % count + count) % count : 0;
    const bool entered = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter)) ||
                         ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter));

    ImGui::BeginChild("##found");
    if (count == 0)
        ImGui::TextDisabled(menu.wish.plug ? "Nothing of that name fits this wire" : "Nothing has that name");
    const NodeType* taken = nullptr;
    const Group* takenGroup = nullptr;
    std::optional<Category> category;
    const bool moved = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow)) ||
                       ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow));
    for (int i = 0; i < count; ++i) {
        const bool isType = i < int(types.size());
        if (isType && menu.search[0] == 0 && category != types[std::size_t(i)]->category) {
            category = types[std::size_t(i)]->category;
            ImGui::TextDisabled("%s", std::string(categoryName(*category)).c_str());
        }
        const std::string label = isType ? types[std::size_t(i)]->label + "##" + types[std::size_t(i)]->id
                                         : readable(groups[std::size_t(i) - types.size()]->id) + " (group)";
        const bool clicked = ImGui::Selectable(("  " + label).c_str(), i == menu.chosen);
        if (i == menu.chosen && moved) ImGui::SetScrollHereY();
        if (ImGui::IsItemHovered() && isType) ImGui::SetTooltip("%s", types[std::size_t(i)]->doc.c_str());
        if (!clicked && !(entered && i == menu.chosen)) continue;
        if (isType)
            taken = types[std::size_t(i)];
        else
            takenGroup = groups[std::size_t(i) - types.size()];
    }
    ImGui::EndChild();
    // At once, whatever has been typed.
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
    if (taken) add(editor, *taken);
    if (takenGroup) add(editor, *findNodeType("group"), takenGroup->id);
    ImGui::EndPopup();
}

}  // namespace fw::editor
