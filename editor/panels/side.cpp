#include "editor/panels/side.h"

#include <imgui_internal.h>

#include <algorithm>

namespace fw::editor {

namespace {

constexpr SidePanel kSidePanels[] = {
    {"inspector", "Inspector", &Panels::inspector, showInspector},
    {"outliner", "Outliner", &Panels::outliner, showOutliner},
    {"problems", "Problems", &Panels::problems, showProblems},
    {"parameters", "Parameters", &Panels::parameters, showParameters},
    {"scene", "Scene", &Panels::scene, showScene},
    {"statistics", "Statistics", &Panels::statistics, showStatistics},
    {"history", "History", &Panels::history, showHistory},
    {"library", "Library", &Panels::library, showLibrary},
    {"probe", "Probe", &Panels::probe, showProbe},
};

/// With the number of problems; the tab's identity stays.
std::string labelOf(const SidePanel& panel, const Editor& editor) {
    std::string label = panel.label;
    const std::size_t found = editor.viewport.shown.findings.size() + editor.files.found.size() +
                              editor.files.groups.findings().size();
    if (panel.open == &Panels::problems && found > 0) label += " (" + std::to_string(found) + ")";
    return label + "###" + panel.id;
}

bool Panels::*openOf(std::string_view id) { return std::ranges::find(kSidePanels, id, &SidePanel::id)->open; }

/// What has the keyboard, with the first thing in it marked if keys move about there.
void giveKeyboard() {
    ImGuiWindow* window = ImGui::GetCurrentWindow();
    ImGui::FocusWindow(window);
    if (!(window->Flags & ImGuiWindowFlags_NoNavInputs)) ImGui::NavInitWindow(window, true);
}

}  // namespace

std::span<const SidePanel> sidePanels() { return kSidePanels; }

void showSidePanels(Editor& editor) {
    Panels& panels = editor.panels;
    if (!ImGui::BeginTabBar("##side", ImGuiTabBarFlags_FittingPolicyScroll)) return;
    for (const SidePanel& panel : kSidePanels) {
        if (!(panels.*panel.open)) continue;
        const bool wanted = panels.wanted == panel.id;
        if (!ImGui::BeginTabItem(labelOf(panel, editor).c_str(), &(panels.*panel.open),
                                 wanted ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None))
            continue;
        panels.front = panel.id;
        if (wanted) panels.wanted.clear();
        ImGui::BeginChild("##content", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
        if (panels.wanted.empty()) takeKeyboard(editor, Part::side);
        panel.show(editor);
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

void showPanel(Editor& editor, std::string_view id) {
    Panels& panels = editor.panels;
    panels.*openOf(id) = true;
    panels.wanted = id;
    panels.next = Part::side;
}

void togglePanel(Editor& editor, std::string_view id) {
    Panels& panels = editor.panels;
    if (!(panels.*openOf(id)) || panels.front != id || panels.keyboard != Part::side)
        return showPanel(editor, id);
    panels.*openOf(id) = false;
    panels.next = Part::canvas;
}

void turnPanels(Editor& editor, int by) {
    Panels& panels = editor.panels;
    std::vector<const char*> open;
    for (const SidePanel& panel : kSidePanels)
        if (panels.*panel.open) open.push_back(panel.id);
    if (open.empty()) return;
    const auto at = std::ranges::find(open, panels.front) - open.begin(), count = std::ssize(open);
    panels.wanted = open[std::size_t((at % count + by + count) % count)];
    panels.next = Part::side;
}

void turnParts(Editor& editor, int by) {
    constexpr int kCount = int(Part::timeline) + 1;
    int part = int(editor.panels.keyboard);
    do part = (part + by + kCount) % kCount;
    while (part == int(Part::timeline) && !editor.panels.timeline);
    editor.panels.next = Part(part);
}

void takeKeyboard(Editor& editor, Part part) {
    Panels& panels = editor.panels;
    if (panels.next == part) {
        panels.next.reset();
        giveKeyboard();
    }
    if (ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows)) panels.keyboard = part;
}

void followMouse(Editor& editor) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool moved = io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f;
    const bool there = ImGui::IsWindowHovered();
    if (there && moved && !std::exchange(editor.panels.mouseOnCanvas, true) && !ImGui::IsAnyItemActive())
        editor.panels.next = Part::canvas;
    if (!there) editor.panels.mouseOnCanvas = false;
}

void leavePanels(Editor& editor) {
    const bool inWindow = ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows);
    if (inWindow && ImGui::GetIO().NavActive && !ImGui::IsAnyItemActive() &&
        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
        editor.panels.next = Part::canvas;
    // The window itself has nothing to move about in, but for the menus.
    if (ImGui::IsWindowFocused() && ImGui::GetCurrentContext()->NavLayer == ImGuiNavLayer_Main)
        editor.panels.next = Part::canvas;
}

bool panelsSteer(const Shortcut& key) { return ImGui::GetIO().NavActive && steersPanels(key); }

}  // namespace fw::editor
