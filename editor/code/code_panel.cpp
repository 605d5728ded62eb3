// The field of code with what belongs to it: in the inspector, and in a large window over the canvas.
#include <imgui_internal.h>

#include <algorithm>

#include "editor/code/code_editor.h"
#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/panels/side.h"
#include "editor/shell/theme.h"

namespace fw::editor::code {

namespace {

constexpr int kLeastLines = 4, kMostLines = 24;  // of a field that was not dragged

bool isExpression(const NodeBox* box) { return box && roleOf(box->node->type) == NodeRole::expression; }

/// "Code", what can be done with it, where the cursor is.
void showHeading(Editor& editor) {
    CodeEditor& code = editor.code;
    ImGui::TextUnformatted(pending(code) ? "Code *" : "Code");
    ImGui::SameLine();
    ImGui::TextDisabled("Ctrl+Enter applies it");
    const char* size = code.large ? "↙" : "↗";
    const float button = ImGui::CalcTextSize(size).x + 2.0f * ImGui::GetStyle().FramePadding.x;
    const std::string place = std::to_string(code.text.cursor.line + 1) + ":" +
                              std::to_string(columnOf(code.text, code.text.cursor) + 1);
    const float right = ImGui::GetWindowContentRegionMax().x;
    const float x = right - button - ImGui::GetStyle().ItemSpacing.x - ImGui::CalcTextSize(place.c_str()).x;
    ImGui::SameLine();
    if (x > ImGui::GetCursorPosX()) {
        ImGui::SameLine(x);
        ImGui::TextDisabled("%s", place.c_str());
    }
    ImGui::SameLine(std::max(right - button, ImGui::GetCursorPosX()));
    if (ImGui::SmallButton((std::string(size) + "##size").c_str())) toggleWindow(editor);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(code.large ? "Back into the inspector (F4)" : "In a large window (F4)");
}

/// The lower edge of the field, which is dragged to another height.
void showGrip(Editor& editor) {
    CodeEditor& code = editor.code;
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
    const float high = std::round(4.0f * editor.shell.scale());
    const ImRect grip({lo.x, hi.y}, {hi.x, hi.y + high});
    const ImGuiID id = ImGui::GetID("##grip");
    ImGui::ItemAdd(grip, id, nullptr, ImGuiItemFlags_NoNav);
    bool hovered = false, held = false;
    ImGui::ButtonBehavior(grip, id, &hovered, &held);
    if (hovered || held) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNS);
        ImGui::GetWindowDrawList()->AddRectFilled(grip.Min, grip.Max, themeColor(ThemeColor::edge), 2.0f);
    }
    if (held) {
        code.height = std::max(3.0f * line, ImGui::GetIO().MousePos.y - lo.y);
        if (code.view.inside) code.view.focus = true;
    }
    if (hovered && ImGui::IsMouseDoubleClicked(0)) code.height = 0.0f;
}

bool inside(ImVec2 at, ImVec2 lo, ImVec2 hi) {
    return at.x >= lo.x && at.x < hi.x && at.y >= lo.y && at.y < hi.y;
}

}  // namespace

void showField(Editor& editor, const NodeBox& box, ImVec2 size) {
    CodeEditor& code = editor.code;
    keepUp(editor, box);
    if (const auto wanted = std::exchange(code.wantedPlace, std::nullopt)) {
        place(code.text, spotOfPlace(code.text, wanted->first, wanted->second));
        code.view.focus = code.view.follow = true;
    }
    code.frame = ImGui::GetFrameCount();
    const bool listed = steerList(code);
    Shown shown{.text = code.text,
                .colouring = code.colouring,
                .names = code.names.get(),
                .marks = code.marks,
                .font = editor.shell.fonts().codeOf(ImGui::GetFontSize()),
                .scale = editor.shell.scale(),
                .listed = listed};
    shown.covered = [&](ImVec2 at) { return code.list.open && inside(at, code.list.lo, code.list.hi); };
    if (code.renaming.open) code.view.hold = true;
    const Heard heard = showText(code.view, shown, "##code", size);
    code.view.hold = false;
    const ImRect field = GImGui->LastItemData.Rect;
    // The list has heard Escape already.
    if (heard.escape && !listed) {
        if (code.list.call)
            code.list.closedCall = code.list.call;
        else if (code.large)
            toggleWindow(editor);
        else {
            if (pending(code))
                say(editor, "what was typed is taken back: Ctrl+Z in the code brings it again");
            discard(editor);
            ImGui::ClearActiveID();
            code.view.inside = false;
        }
    }
    followList(code, heard);
    if (heard.definition) goToDefinition(editor);
    if (heard.rename) beginRename(editor);
    if (heard.larger) toggleWindow(editor);
    if (heard.apply || (heard.left && !code.renaming.open)) commit(editor);
    if (!code.view.inside) code.list.open = false;
    showSignature(editor, heard);
    showList(editor, heard);
    showHover(editor, heard);
    showRename(editor, heard);
    GImGui->LastItemData.Rect = field;  // for the grip below it
}

void showMessages(Editor& editor) {
    CodeEditor& code = editor.code;
    int id = 0;
    for (const Mark& mark : code.marks) {
        const std::string words = "Line " + std::to_string(mark.range.from.line + 1) + ", column " +
                                  std::to_string(columnOf(code.text, mark.range.from) + 1) + ": " +
                                  mark.message;
        wrapped(themeColor(mark.error ? ThemeColor::error : ThemeColor::warning), words);
        ImGui::PushID(id++);
        if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
        if (ImGui::IsItemClicked()) {
            place(code.text, mark.range.from);
            code.view.focus = code.view.follow = true;
        }
        ImGui::PopID();
    }
}

void showInInspector(Editor& editor, const NodeBox& box) {
    CodeEditor& code = editor.code;
    takeUp(editor, box);
    ImGui::Spacing();
    if (code.large) {
        ImGui::TextUnformatted("Code");
        ImGui::SameLine();
        if (ImGui::SmallButton("Back from the large window")) toggleWindow(editor);
        return;
    }
    showHeading(editor);
    const int lines = std::clamp(int(code.text.lines.size()) + 1, kLeastLines, kMostLines);
    const float line = std::round(1.22f * editor.shell.fonts().codeOf(ImGui::GetFontSize())->FontSize);
    const float height =
        code.height > 0.0f ? code.height : float(lines) * line + ImGui::GetStyle().ScrollbarSize + 8.0f;
    showField(editor, box, {-FLT_MIN, std::round(height)});
    showGrip(editor);
}

void toggleWindow(Editor& editor) {
    CodeEditor& code = editor.code;
    const NodeBox* box = editor.boxes ? editor.boxes->find(editor.canvas.active) : nullptr;
    if (!isExpression(box)) return;
    // A key is heard by the command and by the text.
    if (std::exchange(code.toggled, ImGui::GetFrameCount()) == ImGui::GetFrameCount()) return;
    code.large = !code.large;
    code.list.open = false;
    code.view.focus = true;
    if (!code.large && code.edits(editor.canvas.scope, box->node->id)) return;
    takeUp(editor, *box);
}

void showWindow(Editor& editor) {
    CodeEditor& code = editor.code;
    if (!code.large || code.frame == ImGui::GetFrameCount()) return;  // once a frame: a key counts once
    const NodeBox* box = editor.boxes ? editor.boxes->find(editor.canvas.active) : nullptr;
    if (!isExpression(box)) {
        commit(editor);
        code.large = false;
        return;
    }
    takeUp(editor, *box);
    const Area canvas = editor.canvas.view.panel;
    const float em = ImGui::GetFontSize(), rim = std::round(0.8f * em);
    ImGui::SetNextWindowPos({canvas.lo.x + rim, canvas.lo.y + rim});
    ImGui::SetNextWindowSize(
        {std::max(canvas.width() - 2 * rim, 12 * em), std::max(canvas.height() - 2 * rim, 8 * em)});
    bool open = true;
    const std::string title = "Code of " + titleOf(*box) + "###code_window";
    if (ImGui::Begin(title.c_str(), &open,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar |
                         ImGuiWindowFlags_NoScrollWithMouse)) {
        showHeading(editor);
        // Room for what is wrong, at most a third of the window; it scrolls by itself.
        const float whole = ImGui::GetContentRegionAvail().y;
        float messages = 0.0f;
        for (const Mark& mark : code.marks)
            messages += ImGui::CalcTextSize(("Line 0000, column 000: " + mark.message).c_str(), nullptr,
                                            false, ImGui::GetContentRegionAvail().x)
                            .y +
                        ImGui::GetStyle().ItemSpacing.y;
        messages = std::min(messages, whole / 3.0f);
        const float between = messages > 0.0f ? ImGui::GetStyle().ItemSpacing.y : 0.0f;
        showField(editor, *box, {-FLT_MIN, std::max(whole - messages - between, 4 * em)});
        if (messages > 0.0f) {
            ImGui::BeginChild("##messages", {0, messages});
            showMessages(editor);
            ImGui::EndChild();
        }
    }
    if (ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) && !ImGui::IsAnyItemActive() &&
        !code.view.inside && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
        open = false;
    ImGui::End();
    if (!open && code.large) toggleWindow(editor);
}

void goToFinding(Editor& editor, const Error& finding) {
    const std::string node = finding.node;
    if (finding.codeLine > 0) {
        editor.code.wantedPlace = {finding.codeLine, finding.codeColumn};
        if (!editor.code.large) showPanel(editor, "inspector");
    }
    reveal(editor, node);
}

void markRow(Editor& editor, std::string_view input, ImVec2 lo, ImVec2 hi) {
    CodeEditor& code = editor.code;
    if (code.wantedInput != input) return;
    if (std::exchange(code.wantedScroll, false)) ImGui::SetScrollHereY();
    if (now() < code.wantedUntil)
        ImGui::GetWindowDrawList()->AddRect({lo.x - 2, lo.y - 1}, {hi.x + 2, hi.y + 1},
                                            themeColor(ThemeColor::active), 3.0f, 0, 2.0f);
    else
        code.wantedInput.clear();
}

}  // namespace fw::editor::code
