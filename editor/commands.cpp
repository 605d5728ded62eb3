#include "editor/commands.h"

#include <sstream>
#include <vector>

#include "editor/document/clipboard.h"
#include "editor/document/layout.h"
#include "editor/panels/playback.h"

namespace fw::editor {

namespace {

bool always(const Editor&) { return true; }
bool anySelected(const Editor& editor) { return !editor.canvas.selection.empty(); }
bool severalSelected(const Editor& editor) { return editor.canvas.selection.size() > 1; }

NodeIds selected(const Editor& editor) {
    return {editor.canvas.selection.begin(), editor.canvas.selection.end()};
}
const Graph& graphOf(const Editor& editor) { return editor.document.graph(); }
const std::string& scopeOf(const Editor& editor) { return editor.canvas.scope; }

/// Where a node goes that was not put anywhere: under the mouse, or in the middle of what is seen.
ImVec2 hereOn(const Editor& editor) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return editor.canvas.view.panel.contains(mouse) ? editor.canvas.view.toCanvas(mouse)
                                                    : editor.canvas.view.middle;
}

void addHere(Editor& editor) {
    editor.add.wish = {hereOn(editor), std::nullopt, false};
    editor.add.opened = true;
}

void remove(Editor& editor, bool heal) {
    const std::size_t count = editor.canvas.selection.size();
    editor.document.apply(count == 1 ? "Delete Node" : "Delete Nodes",
                          removeNodes(graphOf(editor), scopeOf(editor), selected(editor), heal));
}

void copy(Editor& editor) {
    ImGui::SetClipboardText(copyNodes(graphOf(editor), scopeOf(editor), selected(editor)).c_str());
}

void paste(Editor& editor) {
    const char* text = ImGui::GetClipboardText();
    Result<Edited> pasted =
        pasteNodes(graphOf(editor), scopeOf(editor), text ? text : "", position(hereOn(editor)));
    if (!pasted) return say(editor, "cannot paste: " + format(pasted.error()));
    apply(editor, "Paste", std::move(*pasted));
}

void group(Editor& editor) {
    Result<Edited> grouped = groupNodes(graphOf(editor), scopeOf(editor), selected(editor));
    if (!grouped) return say(editor, "cannot group: " + grouped.error().message);
    apply(editor, "Group", std::move(*grouped));
}

bool groupActive(const Editor& editor) {
    const NodeBox* box = editor.boxes->find(editor.canvas.active);
    return box && !box->node->group.empty();
}

void ungroupActive(Editor& editor) {
    apply(editor, "Ungroup", ungroup(graphOf(editor), scopeOf(editor), editor.canvas.active));
}

void enterOrLeave(Editor& editor) {
    const NodeBox* box = editor.boxes->find(editor.canvas.active);
    enter(editor, box ? box->node->group : std::string());
}

void layOutNodes(Editor& editor) {
    const std::vector<Node>& nodes = nodesOf(graphOf(editor), scopeOf(editor));
    NodeIds ids = selected(editor);
    if (ids.size() < 2) {
        ids.clear();
        for (const Node& node : nodes) ids.push_back(node.id);
    }
    std::vector<double> heights;
    for (const std::string& id : ids) heights.push_back(double(editor.boxes->find(id)->area.height()));
    editor.document.apply("Lay Out Nodes", layOut(graphOf(editor), scopeOf(editor), ids, heights));
}

template <Alignment how>
void alignNodes(Editor& editor) {
    editor.document.apply("Align Nodes", align(graphOf(editor), scopeOf(editor), selected(editor), how));
}

void selectIds(Editor& editor, const std::set<std::string>& ids) {
    editor.canvas.selection = ids;
    if (!ids.contains(editor.canvas.active))
        editor.canvas.active = ids.empty() ? std::string() : *ids.begin();
}

void selectAll(Editor& editor) {
    std::set<std::string> all;
    for (const NodeBox& box : editor.boxes->nodes) all.insert(box.node->id);
    selectIds(editor, all);
}

void invert(Editor& editor) {
    std::set<std::string> others;
    for (const NodeBox& box : editor.boxes->nodes)
        if (!editor.canvas.selection.contains(box.node->id)) others.insert(box.node->id);
    selectIds(editor, others);
}

void frame(Editor& editor, bool all) {
    const bool some = !all && !editor.canvas.selection.empty();
    editor.canvas.view.frame(editor.boxes->around(some ? &editor.canvas.selection : nullptr));
}

bool pictured(const Editor& editor) { return editor.viewport.texture != nullptr; }

template <Side side>
void look(Editor& editor) {
    lookFrom(editor.viewport, side);
}

template <Tool tool>
void use(Editor& editor) {
    editor.viewport.gizmo.tool = tool;
}

constexpr Command kCommands[] = {
    {"file.new", "File", "New", "Ctrl+N", always, [](Editor& e) { proceed(e, Files::Next::fresh); }},
    {"file.open", "File", "Open …", "Ctrl+O", always, [](Editor& e) { proceed(e, Files::Next::browse); }},
    {"file.samples", "File", "Samples …", "", always, [](Editor& e) { proceed(e, Files::Next::samples); }},
    {"file.save", "File", "Save", "Ctrl+S", always,
     [](Editor& e) { e.files.next = Files::Next::none, save(e); }},
    {"file.save_as", "File", "Save as …", "Ctrl+Shift+S", always, saveAs},
    {"file.export", "File", "Export …", "Ctrl+E", always, openExport},
    {"edit.undo", "Edit", "Undo", "Ctrl+Z", [](const Editor& e) { return e.document.canUndo(); },
     [](Editor& e) { e.document.undo(); }},
    {"edit.redo", "Edit", "Redo", "Ctrl+Shift+Z Ctrl+Y", [](const Editor& e) { return e.document.canRedo(); },
     [](Editor& e) { e.document.redo(); }},
    {"edit.cut", "Edit", "Cut", "Ctrl+X", anySelected, [](Editor& e) { copy(e), remove(e, false); }, true},
    {"edit.copy", "Edit", "Copy", "Ctrl+C", anySelected, copy},
    {"edit.paste", "Edit", "Paste", "Ctrl+V", always, paste},
    {"edit.duplicate", "Edit", "Duplicate", "Ctrl+D", anySelected,
     [](Editor& e) { apply(e, "Duplicate", duplicate(graphOf(e), scopeOf(e), selected(e), false)); }, true},
    {"edit.duplicate_wired", "Edit", "Duplicate with inputs", "Ctrl+Shift+D", anySelected,
     [](Editor& e) { apply(e, "Duplicate", duplicate(graphOf(e), scopeOf(e), selected(e), true)); }},
    {"edit.delete", "Edit", "Delete", "Delete X", anySelected, [](Editor& e) { remove(e, false); }},
    {"edit.delete_heal", "Edit", "Delete and heal wires", "Ctrl+Delete Ctrl+Shift+X", anySelected,
     [](Editor& e) { remove(e, true); }},
    {"edit.select_all", "Edit", "Select all", "Ctrl+A", always, selectAll, true},
    {"edit.invert", "Edit", "Invert selection", "Ctrl+I", always, invert},
    {"edit.upstream", "Edit", "Select what feeds it", "L", anySelected,
     [](Editor& e) { selectIds(e, upstream(nodesOf(graphOf(e), scopeOf(e)), selected(e))); }},
    {"edit.downstream", "Edit", "Select what it feeds", "Shift+L", anySelected,
     [](Editor& e) { selectIds(e, downstream(nodesOf(graphOf(e), scopeOf(e)), selected(e))); }},
    {"node.add", "Node", "Add …", "Shift+A Tab", always, addHere},
    {"node.mute", "Node", "Mute", "M", anySelected,
     [](Editor& e) { e.document.apply("Mute", toggleMuted(graphOf(e), scopeOf(e), selected(e))); }, true},
    {"node.collapse", "Node", "Collapse", "H", anySelected,
     [](Editor& e) { e.document.apply("Collapse", toggleCollapsed(graphOf(e), scopeOf(e), selected(e))); }},
    {"node.swap", "Node", "Swap inputs", "Alt+S", [](const Editor& e) { return !e.canvas.active.empty(); },
     [](Editor& e) { e.document.apply("Swap Inputs", swapInputs(graphOf(e), scopeOf(e), e.canvas.active)); }},
    {"node.group", "Node", "Group", "Ctrl+G", anySelected, group, true},
    {"node.ungroup", "Node", "Ungroup", "Ctrl+Shift+G", groupActive, ungroupActive},
    {"node.enter", "Node", "Enter or leave group", "Ctrl+Tab",
     [](const Editor& e) { return groupActive(e) || !e.canvas.scope.empty(); }, enterOrLeave},
    {"node.frame", "Node", "Comment frame", "Ctrl+J", anySelected,
     [](Editor& e) { e.document.apply("Add Frame", frameNodes(graphOf(e), scopeOf(e), selected(e))); }},
    {"node.layout", "Node", "Lay out", "Ctrl+L", always, layOutNodes, true},
    {"node.align_left", "Node", "Align left sides", "", severalSelected, alignNodes<Alignment::left>},
    {"node.align_right", "Node", "Align right sides", "", severalSelected, alignNodes<Alignment::right>},
    {"node.align_top", "Node", "Align tops", "", severalSelected, alignNodes<Alignment::top>},
    {"node.align_bottom", "Node", "Align bottoms", "", severalSelected, alignNodes<Alignment::bottom>},
    {"node.spread_x", "Node", "Equal gaps across", "", severalSelected,
     [](Editor& e) {
         e.document.apply("Distribute Nodes", distribute(graphOf(e), scopeOf(e), selected(e), true));
     }},
    {"node.spread_y", "Node", "Equal gaps down", "", severalSelected,
     [](Editor& e) {
         e.document.apply("Distribute Nodes", distribute(graphOf(e), scopeOf(e), selected(e), false));
     }},
    {"picture.frame", "Picture", "Frame the solid", "F", pictured, frameSolid, false, true},
    {"picture.reset", "Picture", "Back to the scene's camera", "Home 0 Pad0", pictured,
     [](Editor& e) { e.viewport.ownCamera = false; }, false, true},
    {"picture.front", "Picture", "From the front", "1 Pad1", pictured, look<Side::front>, true, true},
    {"picture.back", "Picture", "From the back", "Ctrl+1 Ctrl+Pad1", pictured, look<Side::back>, false, true},
    {"picture.right", "Picture", "From the right", "3 Pad3", pictured, look<Side::right>, false, true},
    {"picture.left", "Picture", "From the left", "Ctrl+3 Ctrl+Pad3", pictured, look<Side::left>, false, true},
    {"picture.top", "Picture", "From the top", "7 Pad7", pictured, look<Side::top>, false, true},
    {"picture.bottom", "Picture", "From the bottom", "Ctrl+7 Ctrl+Pad7", pictured, look<Side::bottom>, false,
     true},
    {"picture.shading", "Picture", "Next shading", "Z", pictured, [](Editor& e) { shadeNext(e.viewport); },
     true, true},
    {"picture.move", "Picture", "Move", "W", pictured, use<Tool::move>, true, true},
    {"picture.rotate", "Picture", "Rotate", "E", pictured, use<Tool::turn>, false, true},
    {"picture.scale", "Picture", "Scale", "R", pictured, use<Tool::scale>, false, true},
    {"view.frame", "View", "Frame selection", "F", always, [](Editor& e) { frame(e, false); }},
    {"view.frame_all", "View", "Frame all", "Home", always, [](Editor& e) { frame(e, true); }},
    {"view.minimap", "View", "Minimap", "", always, [](Editor& e) { e.canvas.minimap = !e.canvas.minimap; }},
    {"view.pin", "View", "Show the node's own field", "Ctrl+Shift+P",
     [](const Editor& e) { return !e.canvas.active.empty() && e.canvas.scope.empty(); },
     [](Editor& e) {
         e.viewport.pinned = e.viewport.pinned == e.canvas.active ? std::string() : e.canvas.active;
     }},
    {"view.timeline", "View", "Timeline", "Ctrl+T", always,
     [](Editor& e) { e.panels.timeline = !e.panels.timeline; }, true},
    {"view.statistics", "View", "Statistics", "", always,
     [](Editor& e) { e.panels.statistics = !e.panels.statistics; }},
    {"file.quit", "File", "Quit", "Ctrl+Q", always, [](Editor& e) { proceed(e, Files::Next::quit); }, true},
};

/// What each key of the table runs, read from its texts once.
const std::vector<std::pair<Shortcut, const Command*>>& shortcuts() {
    static const std::vector<std::pair<Shortcut, const Command*>> all = [] {
        std::vector<std::pair<Shortcut, const Command*>> read;
        for (const Command& command : kCommands) {
            std::istringstream keys(command.keys);
            for (std::string text; keys >> text;)
                if (const auto shortcut = shortcutOf(text)) read.emplace_back(*shortcut, &command);
        }
        return read;
    }();
    return all;
}

/// The command's label with what it would do: "Undo Add Box".
std::string labelOf(const Command& command, const Editor& editor) {
    const std::string_view id = command.id;
    std::string label = command.label;
    if (id == "edit.undo" && editor.document.canUndo()) label += " " + editor.document.undoName();
    if (id == "edit.redo" && editor.document.canRedo()) label += " " + editor.document.redoName();
    return label;
}

}  // namespace

std::span<const Command> commands() { return kCommands; }

void runShortcuts(Editor& editor) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup) || editor.document.inGesture() ||
        editor.canvas.field.state != FieldEdit::State::none || editor.viewport.drag.busy())
        return;
    if (deletesKey(editor) && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Delete)))
        return removeSelectedKey(editor);
    // Space asks for the menu when it goes up, if nothing was panned with it.
    if (ImGui::IsKeyReleased(ImGui::GetKeyIndex(ImGuiKey_Space))) {
        if (!editor.canvas.spacePans && !io.KeyCtrl && !io.KeyAlt) addHere(editor);
        editor.canvas.spacePans = false;
    }
    for (const auto& [shortcut, command] : shortcuts())
        if (pressed(shortcut) && (!command->overPicture || editor.viewport.hovered) && command->can(editor))
            return command->run(editor);
}

void showMenus(Editor& editor) {
    for (const char* menu : {"File", "Edit", "Node", "View", "Picture"}) {
        if (!ImGui::BeginMenu(menu)) continue;
        for (const Command& command : kCommands) {
            if (std::string_view(command.menu) != menu) continue;
            if (command.separated) ImGui::Separator();
            const std::string keys(
                command.keys,
                std::string_view(command.keys).substr(0, std::string_view(command.keys).find(' ')).size());
            if (ImGui::MenuItem(labelOf(command, editor).c_str(), keys.c_str(), false, command.can(editor)))
                command.run(editor);
            if (std::string_view(command.id) == "file.open") showRecent(editor);
        }
        ImGui::EndMenu();
    }
}

}  // namespace fw::editor
