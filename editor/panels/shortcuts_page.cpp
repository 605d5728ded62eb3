// The page of shortcuts: every key of the command table as the preferences have it, and what the mouse does.
#include "editor/commands.h"

namespace fw::editor {

namespace {

constexpr const char* kShortcutsTitle = "Shortcuts";

// As canvas/canvas.h has it.
constexpr std::pair<const char*, const char*> kMouse[] = {
    {"Left", "selects; drags nodes, wires, a box"},
    {"Alt + left drag", "selects by lasso"},
    {"Middle drag, Space + drag", "pans"},
    {"Wheel", "zooms"},
    {"Right", "adds a node; keys of a number"},
    {"Ctrl + right drag", "cuts wires"},
    {"Shift + right drag", "adds a reroute"},
    {"Alt + right drag", "connects two nodes"},
    {"Double click", "enters a group"},
    {"Drag on a number", "changes it; Shift: finely"},
    {"Click on a number", "types it: 2*pi/3 will do"},
    {"Ctrl + click on a number", "gives back its default"},
};

// As controls/number.h and panels/add_menu.cpp have it.
constexpr std::pair<const char*, const char*> kTyping[] = {
    {"A digit", "begins the selected node's first number"},
    {"Tab, Shift+Tab", "go to the next number, the one before"},
    {"Ctrl+Enter", "takes it for all numbers of a vector"},
    {"Shift+Enter", "takes it, and asks for the next node"},
    {"Shift+Enter in the menu", "adds the node wired to the selected one"},
    {"Tab in the menu", "the same, and the menu comes again"},
};

// As code/view_keys.cpp and code/code_editor.h have it.
constexpr std::pair<const char*, const char*> kCode[] = {
    {"Ctrl+Enter", "applies the code"},
    {"Escape", "closes a list; takes back what was typed"},
    {"Ctrl+Space", "lists what can be written; Enter, Tab take it"},
    {"F12, Ctrl + click", "goes to where a name is defined"},
    {"F2", "gives an input or a variable another name"},
    {"F4", "shows the code in a large window, and back"},
    {"Ctrl+F, F3, Shift+F3", "finds; the next place, the one before"},
    {"Ctrl+Z, Ctrl+Y", "undo and redo what was typed"},
    {"Tab, Shift+Tab", "indent lines, and back"},
    {"Ctrl+Slash", "makes lines comments, and back"},
    {"Alt+Up, Alt+Down", "move lines"},
    {"Ctrl+D", "doubles the line, or what is selected"},
};

// As timeline/strip.h has it.
constexpr std::pair<const char*, const char*> kMouseInTime[] = {
    {"Drag in the ruler", "shows another time"},
    {"Ctrl + drag in it", "marks what is played"},
    {"Drag on a key", "moves what is selected"},
    {"Shift, Ctrl + click", "selects also; takes away"},
    {"Drag beside keys", "selects by a box"},
    {"Ends of the bar", "scale what is selected"},
    {"Double click", "adds a key"},
    {"Drag on a tangent", "turns it; Alt: one side"},
    {"Alt", "not from frame to frame"},
    {"Wheel, middle drag", "zooms, pans"},
};

void row(const std::string& keys, const std::string& what) {
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", keys.c_str());
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", what.c_str());
}

void heading(const char* words) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", words);
    ImGui::TableNextRow();
}

bool beginColumn(const char* id, float width) {
    ImGui::BeginChild(id, {width, -ImGui::GetFrameHeightWithSpacing()}, false, ImGuiWindowFlags_NavFlattened);
    if (ImGui::BeginTable("##keys", 2)) {
        const float em = ImGui::GetFontSize(), room = ImGui::GetContentRegionAvail().x;
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, std::min(13.0f * em, 0.5f * room));
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
        return true;
    }
    ImGui::EndChild();
    return false;
}

void endColumn() {
    ImGui::EndTable();
    ImGui::EndChild();
}

void showMenu(const Editor& editor, std::string_view menu, const char* title) {
    heading(title);
    for (const Command& command : commands()) {
        const std::string keys = keysOf(command, editor.files.preferences);
        if (command.menu == menu && !keys.empty()) row(keys, command.label);
    }
}

void showPart(const Editor& editor, int part) {
    if (part == 0) {
        showMenu(editor, "File", "File");
        showMenu(editor, "Edit", "Edit");
        showMenu(editor, "Help", "Help");
        showMenu(editor, "", "On the canvas");
    } else if (part == 1) {
        showMenu(editor, "Node", "Node");
        heading("Mouse on the canvas");
        for (const auto& [mouse, what] : kMouse) row(mouse, what);
        heading("Typing on the canvas");
        for (const auto& [keys, what] : kTyping) row(keys, what);
        showMenu(editor, "Timeline", "On the timeline");
        heading("Mouse on the timeline");
        for (const auto& [mouse, what] : kMouseInTime) row(mouse, what);
    } else {
        showMenu(editor, "View", "View");
        showMenu(editor, "Picture", "Over the picture");
        heading("In the code of an expression");
        for (const auto& [keys, what] : kCode) row(keys, what);
    }
}

}  // namespace

void showShortcuts(Editor& editor) {
    if (std::exchange(editor.windows.shortcuts, false)) ImGui::OpenPopup(kShortcutsTitle);
    const float unit = editor.shell.scale();
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    ImGui::SetNextWindowSize(
        {std::min(1150.0f * unit, 0.95f * whole.x), std::min(720.0f * unit, 0.9f * whole.y)});
    ImGui::SetNextWindowPos({0.5f * whole.x, 0.5f * whole.y}, ImGuiCond_Always, {0.5f, 0.5f});
    bool stays = true;
    if (!ImGui::BeginPopupModal(
            kShortcutsTitle, &stays,
            ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove))
        return;
    // As many columns as can be read; the last one has what is left.
    constexpr float kColumn = 25.0f;  // in units of the font's size
    constexpr int kParts = 3;
    const float room = ImGui::GetContentRegionAvail().x;
    const int columns = std::clamp(int(room / (kColumn * ImGui::GetFontSize())), 1, kParts);
    for (int column = 0; column < columns; ++column) {
        ImGui::PushID(column);
        if (column > 0) ImGui::SameLine();
        const bool last = column + 1 == columns;
        if (beginColumn("##column", last ? 0.0f : room / float(columns))) {
            for (int i = column; i < (last ? kParts : column + 1); ++i) showPart(editor, i);
            endColumn();
        }
        ImGui::PopID();
    }
    const bool change = ImGui::Button("Change keys …");
    ImGui::SameLine();
    if (change || ImGui::Button("Close") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
        ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    editor.windows.preferences.opened |= change;
}

}  // namespace fw::editor
