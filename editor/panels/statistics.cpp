// What the last picture took: triangles, time by stage, memory; and what each node adds to the field.
#include <algorithm>
#include <cstdio>

#include "editor/editor.h"
#include "editor/shell/letters.h"
#include "graph/document/unit.h"

namespace fw::editor {

namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

void row(const char* name, const char* format, double value) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    ImGui::TableNextColumn();
    ImGui::Text(format, value);
}

/// The nodes that a sample of the field spends most on. A click goes there.
void showCosts(Editor& editor, const std::vector<NodeEffort>& efforts) {
    constexpr std::size_t kMost = 12;
    double all = 0.0;
    for (const NodeEffort& effort : efforts) all += effort.sample;
    if (all == 0.0) return;
    ImGui::Spacing();
    ImGui::TextUnformatted("Cost of the field by node");
    if (!ImGui::BeginTable("costs", 2, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg)) return;
    std::string goTo;
    for (std::size_t i = 0; i < std::min(efforts.size(), kMost); ++i) {
        const NodeEffort& effort = efforts[i];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (ImGui::Selectable((effort.node + "##cost").c_str(), false, ImGuiSelectableFlags_SpanAllColumns))
            goTo = effort.node;
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip(
                "%.0f operations, as long as %.0f additions for each sample.\n"
                "What alike nodes share is told of one of them.",
                effort.operations, effort.sample);
        ImGui::TableNextColumn();
        char text[32];
        std::snprintf(text, sizeof text, "%.0f %%", 100.0 * effort.sample / all);
        ImGui::ProgressBar(float(effort.sample / all), {-FLT_MIN, 0}, text);
    }
    ImGui::EndTable();
    if (efforts.size() > kMost) ImGui::TextDisabled("and %zu more", efforts.size() - kMost);
    if (!goTo.empty()) reveal(editor, goTo);
}

/// How large the solid is, and what it weighs.
void showSolid(const Editor& editor) {
    const PreviewResult& shown = editor.viewport.shown;
    if (!shown.size) return ImGui::TextDisabled("measuring …");
    const Graph& graph = *editor.graph;
    const auto rows = sizeRows(*shown.size, unitOf(graph), densityOf(graph));
    if (!ImGui::BeginTable("size", 2, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg)) return;
    std::string all;
    for (const auto& [name, value] : rows) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(fitted(value, ImGui::GetContentRegionAvail().x).c_str());
        all += name + "\t" + value + "\n";
    }
    ImGui::EndTable();
    if (ImGui::SmallButton("Copy##size")) ImGui::SetClipboardText(all.c_str());
    if (!densityOf(graph)) {
        ImGui::SameLine();
        ImGui::TextDisabled("The scene panel has the density, for the mass.");
    }
    ImGui::Spacing();
}

}  // namespace

void showStatistics(Editor& editor) {
    const PreviewResult& shown = editor.viewport.shown;
    const PreviewStatistics& statistics = shown.statistics;
    if (shown.picture.width == 0 && statistics.triangles == 0)
        return ImGui::TextDisabled("Nothing has been made yet.");
    showSolid(editor);
    if (!ImGui::BeginTable("statistics", 2, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg))
        return;
    row("Nodes", "%.0f", double(editor.graph->nodes.size()));
    row("Triangles", "%.0f", double(statistics.triangles));
    row("Vertices", "%.0f", double(statistics.vertices));
    row("Cells along the longest side", "%.0f", double(statistics.resolution));
    row("Memory of the device", "%.1f MiB", double(statistics.deviceBytes) / kMebibyte);
    row("Submissions to the device", "%.0f", double(statistics.submissions));
    row("   of them awaited", "%.0f", double(statistics.waits));
    row("From edit to picture", "%.1f ms", statistics.milliseconds);
    double all = 0.0;
    for (const StageTime& stage : statistics.stages) all += stage.milliseconds;
    for (const StageTime& stage : statistics.stages) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(("   " + stage.name).c_str());
        ImGui::TableNextColumn();
        char text[32];
        std::snprintf(text, sizeof text, "%.2f ms", stage.milliseconds);
        ImGui::ProgressBar(all > 0.0 ? float(stage.milliseconds / all) : 0.0f, {-FLT_MIN, 0}, text);
    }
    ImGui::EndTable();
    showCosts(editor, shown.efforts);
}

}  // namespace fw::editor
