// The command palette, and wires from a list.
#include "editor/commands.h"

namespace fw::editor {

namespace {

/// "Union · A" as the canvas shows it.
std::string plugText(const Boxes& boxes, const Plug& plug) {
    const NodeBox* box = boxes.find(plug.node);
    std::string node = box ? titleOf(*box) : plug.node;
    if (box && node != readable(plug.node)) node += " (" + plug.node + ")";
    return node + " · " + readable(plug.name);
}

void showConnect(Editor& editor) {
    Windows& windows = editor.windows;
    std::vector<Choice> choices;
    if (windows.connect.opened || ImGui::IsPopupOpen("Connect"))
        for (const Connection& each : windows.connections)
            choices.push_back(
                {plugText(*editor.boxes, each.output) + "  →  " + plugText(*editor.boxes, each.input)});
    const auto chosen = choose(windows.connect, "Connect", choices, editor.shell.scale());
    if (!chosen) return;
    const Connection& wire = windows.connections[*chosen];
    editor.document.apply("Connect",
                          connect(editor.document.graph(), editor.canvas.scope, wire.output, wire.input));
}

}  // namespace

void offerConnections(Editor& editor) {
    Windows& windows = editor.windows;
    windows.connections = connectionsOf(editor.document.graph(), editor.canvas.scope, editor.canvas.active,
                                        editor.canvas.selection);
    if (windows.connections.empty()) return say(editor, "there is nothing that this node could be wired to");
    windows.connect.opened = true;
}

void showPalette(Editor& editor) {
    Chooser& palette = editor.windows.palette;
    std::vector<Choice> choices;
    if (palette.opened || ImGui::IsPopupOpen("Commands"))
        for (const Command& command : commands()) {
            const std::string menu = command.menu;
            choices.push_back({(menu.empty() ? "" : menu + ": ") + labelOf(command, editor),
                               keysOf(command, editor.files.preferences), command.can(editor)});
        }
    // In the next frame, when the popup is gone that could be in the command's way.
    if (const auto chosen = choose(palette, "Commands", choices, editor.shell.scale()))
        editor.windows.chosen = &commands()[*chosen];
    showConnect(editor);
}

}  // namespace fw::editor
