// The node reference: what the library's table says of a type, as a page.
#include "graph/library/reference.h"

#include <spawn.h>

#include <algorithm>
#include <filesystem>

#include "editor/document/library.h"
#include "editor/editor.h"
#include "editor/files/samples.h"
#include "editor/shell/theme.h"

extern char** environ;

namespace fw::editor {

namespace {

constexpr const char* kReferenceTitle = "Node reference";

/// Without the backticks that names have in the page.
std::string plain(std::string text) {
    std::erase(text, '`');
    return text;
}

void quiet(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, themeColor(ThemeColor::quiet));
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

void showInputsOf(const NodeType& type) {
    if (type.inputs.empty() || !ImGui::BeginTable("##inputs", 4, ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("Input", ImGuiTableColumnFlags_WidthStretch, 1.2f);
    ImGui::TableSetupColumn("Type", ImGuiTableColumnFlags_WidthStretch, 0.7f);
    ImGui::TableSetupColumn("Default", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableSetupColumn("Meaning", ImGuiTableColumnFlags_WidthStretch, 3.0f);
    ImGui::TableHeadersRow();
    for (const InputSpec& input : type.inputs) {
        for (const std::string& text :
             {input.name, typeText(input), plain(defaultText(input)), input.doc + plain(rangeText(input))}) {
            ImGui::TableNextColumn();
            ImGui::TextWrapped("%s", text.c_str());
        }
    }
    ImGui::EndTable();
}

void showOutputsOf(const NodeType& type) {
    std::string text;
    for (const OutputSpec& output : type.outputs)
        text += (text.empty() ? "Output: " : ", ") + output.name + " (" + std::string(typeName(output.type)) +
                ")";
    const std::string exactness = exactnessText(type);
    if (!exactness.empty()) text += ". Distance: " + exactness;
    if (!text.empty()) ImGui::TextWrapped("%s.", text.c_str());
}

void showPage(Editor& editor, const NodeType& type) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float high = ImGui::GetFrameHeight(), pad = 0.4f * high;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, {at.x + ImGui::GetContentRegionAvail().x, at.y + high},
                        categoryColor(type.category), 3.0f);
    list->AddText({at.x + pad, at.y + 0.5f * (high - ImGui::GetFontSize())}, themeColor(ThemeColor::onTitle),
                  (type.label + "  ·  " + std::string(categoryName(type.category))).c_str());
    ImGui::Dummy({0, high});
    ImGui::TextWrapped("%s", type.doc.c_str());
    std::string names = "In files and in code: " + type.id;
    for (const std::string& alias : type.aliases) names += ", also " + alias;
    quiet(names);
    ImGui::Spacing();
    showInputsOf(type);
    if (type.open) quiet("The document decides what further inputs and outputs there are.");
    ImGui::Spacing();
    showOutputsOf(type);
    if (!type.body.empty() && ImGui::CollapsingHeader("What it computes")) {
        ImGui::PushFont(editor.shell.fonts().codeOf(ImGui::GetFontSize()));
        ImGui::TextWrapped("%s", type.body.c_str());
        ImGui::PopFont();
    }
    ImGui::Spacing();
    const std::string link = referenceLink(type);
    if (ImGui::SmallButton(("Open " + link).c_str())) openDocument(editor, link);
}

/// The list of types; those of the search.
void showTypes(Reference& reference) {
    std::vector<const NodeType*> all;
    for (const NodeType& type : nodeTypes()) all.push_back(&type);
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", "Search", reference.search, sizeof reference.search);
    ImGui::BeginChild("##types", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
    std::optional<Category> category;
    for (const NodeType* type : findTypes(reference.search, all)) {
        if (reference.search[0] == 0 && category != type->category) {
            category = type->category;
            ImGui::TextDisabled("%s", std::string(categoryName(*category)).c_str());
        }
        const bool chosen = type->id == reference.type;
        if (ImGui::Selectable((type->label + "##" + type->id).c_str(), chosen)) reference.type = type->id;
        if (chosen && ImGui::IsWindowAppearing()) ImGui::SetScrollHereY();
    }
    ImGui::EndChild();
}

}  // namespace

void openReference(Editor& editor) {
    Reference& reference = editor.windows.reference;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const CanvasView& view = editor.canvas.view;
    const NodeBox* box = editor.boxes->find(editor.canvas.active);
    if (view.panel.contains(mouse))
        for (const NodeBox& each : editor.boxes->nodes)
            if (each.area.contains(view.toCanvas(mouse))) box = &each;
    if (box && box->type) reference.type = box->type->id;
    reference.search[0] = 0;
    reference.open = reference.opened = true;
}

void openDocument(Editor& editor, const std::string& link) {
    // They lie beside the samples.
    const std::string samples = samplesFolder();
    const std::string folder =
        samples.empty() ? samples : (std::filesystem::path(samples).parent_path() / "docs").string();
    const std::string place = folder + "/" + link;
    const std::string file = place.substr(0, place.find('#'));
    pid_t process = 0;
    const char* words[] = {"xdg-open", file.c_str(), nullptr};
    if (!folder.empty() &&
        posix_spawnp(&process, words[0], nullptr, nullptr, const_cast<char**>(words), environ) == 0)
        return;
    ImGui::SetClipboardText((folder.empty() ? "docs/" + link : place).c_str());
    say(editor, "nothing here opens " + link + ": its place is in the clipboard");
}

void showReference(Editor& editor) {
    Reference& reference = editor.windows.reference;
    if (!reference.open) return;
    const float unit = editor.shell.scale();
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    const ImVec2 size(std::min(860.0f * unit, 0.9f * whole.x), std::min(560.0f * unit, 0.85f * whole.y));
    ImGui::SetNextWindowSize(size, ImGuiCond_Appearing);
    ImGui::SetNextWindowPos({0.5f * whole.x, 0.5f * whole.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    if (std::exchange(reference.opened, false)) ImGui::SetNextWindowFocus();
    if (ImGui::Begin(kReferenceTitle, &reference.open,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        ImGui::BeginChild(
            "##list",
            {std::clamp(0.24f * ImGui::GetContentRegionAvail().x, 14.0f * ImGui::GetFontSize(),
                        std::max(0.4f * ImGui::GetContentRegionAvail().x, 14.0f * ImGui::GetFontSize())),
             0},
            true, ImGuiWindowFlags_NavFlattened);
        showTypes(reference);
        ImGui::EndChild();
        ImGui::SameLine();
        ImGui::BeginChild("##page", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
        if (const NodeType* type = findNodeType(reference.type)) showPage(editor, *type);
        ImGui::EndChild();
        if (ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) && !ImGui::IsAnyItemActive() &&
            ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
            reference.open = false;
    }
    ImGui::End();
    if (!reference.open) editor.panels.next = Part::canvas;
}

}  // namespace fw::editor
