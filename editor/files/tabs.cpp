#include "editor/files/tabs.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "editor/document/layout.h"
#include "editor/editor.h"
#include "editor/files/graph_folder.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

/// What is in front as it goes behind; the editor's parts are left to be replaced.
std::unique_ptr<DocumentBehind> takeFront(Editor& editor) {
    editor.document.settle();
    takeHand(editor.viewport, 0);
    ImGui::ClearActiveID();  // it would go on with what is typed, over another document
    if (editor.document.unsaved())
        if (const Done kept = editor.files.recovery.keepNow(editor.document.graph()); !kept)
            say(editor, "the unsaved changes are not kept for the next start: " + format(kept.error()));
    auto behind = std::make_unique<DocumentBehind>(
        DocumentBehind{.document = std::move(editor.document),
                       .canvas = editor.canvas,
                       .panels = std::move(editor.panelState),
                       .look = editor.viewport,
                       .thumbnails = {},
                       .file = std::move(static_cast<DocumentFile&>(editor.files))});
    for (const auto& [path, shown] : editor.thumbnails.shown) behind->thumbnails.insert(path);
    return behind;
}

/// Brings what lies behind as the tab in front there, where nothing is.
void bringFront(Editor& editor) {
    const std::unique_ptr<DocumentBehind> next = std::exchange(editor.tabs.all[editor.tabs.front], nullptr);
    replaceDocument(editor, std::move(next->document));
    editor.canvas = std::move(next->canvas);
    editor.panelState = std::move(next->panels);
    static_cast<DocumentLook&>(editor.viewport) = next->look;
    static_cast<DocumentFile&>(editor.files) = std::move(next->file);
    for (const std::string& path : next->thumbnails) editor.thumbnails.toggle(editor.shell, path);
}

const Document& documentAt(const Editor& editor, std::size_t index) {
    return index == editor.tabs.front ? editor.document : editor.tabs.all[index]->document;
}

std::string tabName(const Editor& editor, std::size_t index) {
    if (index == editor.tabs.front) return nameOf(editor);
    const DocumentBehind& behind = *editor.tabs.all[index];
    return nameOf(behind.document.graph(), behind.file.origin);
}

}  // namespace

bool isUntouched(const Editor& editor) {
    return !editor.document.unsaved() && editor.document.stepCount() == 1 &&
           (editor.document.graph().path.empty() || editor.files.origin == DocumentFile::Origin::sample);
}

std::optional<std::size_t> tabOf(const Editor& editor, const std::string& path) {
    for (std::size_t i = 0; i < editor.tabs.all.size(); ++i) {
        const std::string& own = documentAt(editor, i).graph().path;
        if (!own.empty() && sameFile(own, path)) return i;
    }
    return std::nullopt;
}

std::optional<std::size_t> unsavedTab(const Editor& editor) {
    for (std::size_t i = 0; i < editor.tabs.all.size(); ++i)
        if (i != editor.tabs.front && editor.tabs.all[i]->document.unsaved()) return i;
    return std::nullopt;
}

std::optional<std::size_t> tabToAsk(const Editor& editor) {
    for (std::size_t i = 0; i < editor.tabs.all.size(); ++i)
        if (i != editor.tabs.front && editor.tabs.all[i]->document.unsaved() &&
            !editor.tabs.all[i]->file.givenUp)
            return i;
    return std::nullopt;
}

void forgetGivenUp(Editor& editor) {
    editor.files.givenUp = false;
    for (const auto& behind : editor.tabs.all)
        if (behind) behind->file.givenUp = false;
}

void discardKept(Editor& editor) {
    editor.files.recovery.discard();
    for (const auto& behind : editor.tabs.all)
        if (behind) behind->file.recovery.discard();
}

void replaceDocument(Editor& editor, Document document) {
    ImGui::ClearActiveID();
    editor.document = std::move(document);
    editor.viewport.forget(editor.shell);
    editor.panelState = {};
    editor.add = {};
    editor.frameMenu = {};
    editor.drawn = 0;
    Canvas canvas;
    canvas.minimap = editor.canvas.minimap, canvas.costs = editor.canvas.costs;
    editor.canvas = std::move(canvas);
    editor.thumbnails.clear(editor.shell);
    DocumentFile file;
    file.recovery = std::move(editor.files.recovery);
    static_cast<DocumentFile&>(editor.files) = std::move(file);
    editor.files.groups.forget();
    editor.outline.open = false;
    editor.outline.does = outline::Window::Does::nothing;
}

void openTab(Editor& editor) {
    editor.tabs.all[editor.tabs.front] = takeFront(editor);
    editor.files.recovery = Recovery();
    editor.tabs.front = editor.tabs.all.size();
    editor.tabs.all.push_back(nullptr);
}

void showTab(Editor& editor, std::size_t index) {
    if (index == editor.tabs.front || index >= editor.tabs.all.size()) return;
    editor.tabs.all[editor.tabs.front] = takeFront(editor);
    editor.tabs.front = index;
    bringFront(editor);
}

void turnTabs(Editor& editor, int by) {
    const int count = int(editor.tabs.all.size());
    showTab(editor, std::size_t(((int(editor.tabs.front) + by) % count + count) % count));
}

void closeTab(Editor& editor) {
    Tabs& tabs = editor.tabs;
    editor.files.recovery.discard();
    if (tabs.all.size() == 1) {
        replaceDocument(editor, Document(Graph()));
        return newDocument(editor);
    }
    tabs.all.erase(tabs.all.begin() + std::ptrdiff_t(tabs.front));
    tabs.front = std::min(tabs.front, tabs.all.size() - 1);
    bringFront(editor);
}

void showTabs(Editor& editor) {
    const Tabs& tabs = editor.tabs;
    if (tabs.all.size() < 2) return;
    const float letter = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemSpacing.x,
                least = 5.0f * letter + gap, list = 2.0f * letter,
                room = ImGui::GetContentRegionAvail().x - gap;
    if (room < least + list) return;
    // As many as have room, around the one in front; the rest in a list.
    const std::size_t count = std::min(tabs.all.size(), std::size_t((room - list) / least)),
                      first = std::clamp(tabs.front + 1, count, tabs.all.size()) - count;
    const float width = std::min((room - list) / float(count) - gap, 14.0f * letter);
    std::optional<std::size_t> shown, closed;
    const auto label = [&](std::size_t i) {
        return tabName(editor, i) + (documentAt(editor, i).unsaved() ? " *" : "");
    };
    ImGui::Separator();
    for (std::size_t i = first; i < first + count; ++i) {
        const bool front = i == tabs.front;
        const std::string name = label(i);
        ImGui::PushID(int(i));
        const ImVec2 cursor = ImGui::GetCursorScreenPos(),
                     at(std::floor(cursor.x),
                        cursor.y + ImGui::GetCurrentWindow()->DC.CurrLineTextBaseOffset);
        const bool pressed = ImGui::Selectable("##tab", front, 0, {width, 0}),
                   hovered = ImGui::IsItemHovered();
        if (hovered) {
            const std::string& path = documentAt(editor, i).graph().path;
            ImGui::SetTooltip("%s", path.empty() ? name.c_str() : path.c_str());
        }
        const float cross = front || hovered ? letter : 0.0f;
        const ImVec2 hi(at.x + width - cross, at.y + ImGui::GetTextLineHeight());
        ImGui::RenderTextEllipsis(ImGui::GetWindowDrawList(), at, hi, hi.x, hi.x, name.c_str(), nullptr,
                                  nullptr);
        if (cross > 0.0f) {
            const ImVec2 centre(hi.x + 0.5f * letter, at.y + 0.5f * ImGui::GetTextLineHeight());
            const bool over = hovered && ImGui::GetIO().MousePos.x > hi.x;
            const ImU32 color = ImGui::GetColorU32(over ? ImGuiCol_Text : ImGuiCol_TextDisabled);
            for (const float way : {-1.0f, 1.0f})
                ImGui::GetWindowDrawList()->AddLine(
                    {centre.x - 0.25f * letter, centre.y - way * 0.25f * letter},
                    {centre.x + 0.25f * letter, centre.y + way * 0.25f * letter}, color);
        }
        if (hovered && (ImGui::IsMouseClicked(2) || (pressed && ImGui::GetIO().MousePos.x > hi.x)))
            closed = i;
        else if (pressed)
            shown = i;
        ImGui::PopID();
    }
    if (count < tabs.all.size() &&
        ImGui::BeginMenu(("+" + std::to_string(tabs.all.size() - count)).c_str())) {
        for (std::size_t i = 0; i < tabs.all.size(); ++i) {
            ImGui::PushID(int(i));
            if (ImGui::MenuItem(label(i).c_str(), nullptr, i == tabs.front)) shown = i;
            ImGui::PopID();
        }
        ImGui::EndMenu();
    }
    if (shown) showTab(editor, *shown);
    if (closed) {
        showTab(editor, *closed);
        proceed(editor, Files::Next::close);
    }
}

}  // namespace fw::editor
