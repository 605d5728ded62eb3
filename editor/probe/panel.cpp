// The panel of the probe: where it is, what every output gives there, what was measured, and a plot along a
// line.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/probe/plot_view.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "graph/document/unit.h"
#include "runtime/system/output_file.h"

namespace fw::editor {

namespace {

constexpr const char* kAxisLetters[] = {"x", "y", "z"};

constexpr double kFarthest = 1e9;  // from the origin, that a place can be typed

/// The three numbers of a place; `set` hears of another.
void editPlace(Editor& editor, const char* id, const Point& point,
               const std::function<void(Probe&, const Point&)>& set) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    dragNumbers(editor, id, point, {.min = -kFarthest, .max = kFarthest, .unit = "m"},
                [&probe = editor.probe, set](std::span<const double> to) {
                    set(probe, {to[0], to[1], to[2]});
                });
}

/// One end of the line.
void editEnd(Editor& editor, const char* id, std::size_t end) {
    editPlace(editor, id, editor.probe.ends[end], [end](Probe& probe, const Point& to) {
        if (end < probe.ends.size()) probe.ends[end] = to;
    });
}

std::string nameAt(const Editor& editor, const std::string& id) {
    const NodeBox* box = editor.boxes ? editor.boxes->find(id) : nullptr;
    return box ? titleOf(*box) : id;
}

/// "b: Ball", the input and what is linked to it.
std::string partWords(const Editor& editor, const Reading& reading) {
    if (reading.part.empty() || !editor.boxes) return {};
    for (const Wire& wire : editor.boxes->wires) {
        const Plug input = editor.boxes->input(wire);
        if (input.node == reading.node && input.name == reading.part)
            return readable(reading.part) + ": " + nameAt(editor, editor.boxes->output(wire).node);
    }
    return readable(reading.part);
}

std::string slopeWords(const Reading& reading) {
    if (reading.numbers.empty() || (reading.type != Type::surface && reading.type != Type::scalar)) return {};
    char text[40];
    std::snprintf(text, sizeof text, "%.4g", reading.slope);
    return text;
}

/// All that is read, a line each, for the clipboard.
std::string allWords(const Editor& editor) {
    const Probe& probe = editor.probe;
    char line[160];
    std::snprintf(line, sizeof line, "at\t%.9g\t%.9g\t%.9g\n", (*probe.point)[0], (*probe.point)[1],
                  (*probe.point)[2]);
    std::string words = line;
    for (const Reading& reading : probe.readings)
        words += reading.node + "\t" + reading.output + "\t" + valueWords(reading, 9, unitOf(*editor.graph)) +
                 "\t" + slopeWords(reading) + "\t" + reading.part + "\n";
    return words;
}

void showPlace(Editor& editor) {
    Probe& probe = editor.probe;
    const ImVec2 from = ImGui::GetCursorScreenPos();
    editPlace(editor, "##point", probe.point.value_or(Point{}),
              [](Probe& of, const Point& to) { of.point = to, of.pinned = true; });
    if (ImGui::IsMouseHoveringRect(
            from, {from.x + ImGui::GetContentRegionAvail().x, from.y + ImGui::GetFrameHeight()}) &&
        ImGui::IsWindowHovered())
        ImGui::SetTooltip("x, y, z: typed or dragged, they stay");
    if (ImGui::Checkbox("Pinned", &probe.pinned) && probe.pinned && !probe.point) probe.point = Point{};
    ImGui::SameLine();
    ImGui::Checkbox("Selected nodes only", &probe.selectedOnly);
    if (!probe.point || probe.readings.empty()) return;
    ImGui::SameLine();
    if (ImGui::SmallButton("Copy")) ImGui::SetClipboardText(allWords(editor).c_str());
}

void showReadings(Editor& editor, float height) {
    Probe& probe = editor.probe;
    if (!probe.problem.empty()) return ImGui::TextDisabled("%s", probe.problem.c_str());
    if (!probe.point) return ImGui::TextDisabled("Point at the solid in the picture, or type a place.");
    std::vector<const Reading*> listed;
    for (const Reading& reading : probe.readings)
        if (!probe.selectedOnly || editor.canvas.selection.contains(reading.node)) listed.push_back(&reading);
    const float line = ImGui::GetTextLineHeightWithSpacing();
    height = std::min(height, line * (float(listed.size()) + 1.0f));
    if (!ImGui::BeginTable("readings", 5,
                           ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg |
                               ImGuiTableFlags_ScrollY | ImGuiTableFlags_Resizable,
                           {0, height}))
        return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const auto& [name, weight] :
         {std::pair("Node", 2.2f), {"Output", 1.4f}, {"Value", 2.4f}, {"Gradient", 1.3f}, {"Part", 2.0f}})
        ImGui::TableSetupColumn(name, 0, weight);
    ImGui::TableHeadersRow();
    std::string goTo;
    const LengthUnit& lengths = unitOf(*editor.graph);
    ImGuiListClipper clipper;
    clipper.Begin(int(listed.size()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const Reading& reading = *listed[std::size_t(i)];
            ImGui::PushID(i);
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            if (ImGui::Selectable(nameAt(editor, reading.node).c_str(),
                                  editor.canvas.selection.contains(reading.node),
                                  ImGuiSelectableFlags_SpanAllColumns))
                goTo = reading.node;
            if (ImGui::IsItemHovered())
                ImGui::SetTooltip(
                    "%s\nThe gradient's length is 1 where the value is a distance.\nOf several "
                    "surfaces, Part is the one whose value this is: of a union the nearest.",
                    reading.node.c_str());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(readable(reading.output).c_str());
            ImGui::TableNextColumn();
            if (reading.color) {
                const float side = ImGui::GetTextLineHeight();
                ImGui::ColorButton("##colour", ImGui::ColorConvertU32ToFloat4(shownColor(*reading.color)),
                                   ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                                   {side, side});
                ImGui::SameLine();
            }
            ImGui::TextUnformatted(valueWords(reading, 6, lengths).c_str());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(slopeWords(reading).c_str());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(partWords(editor, reading).c_str());
            ImGui::PopID();
        }
    ImGui::EndTable();
    if (!goTo.empty()) reveal(editor, pathOf(editor, goTo));
}

void showTool(Editor& editor, const char* name, Measure tool) {
    const bool up = editor.probe.tool == tool;
    ImGui::PushStyleColor(ImGuiCol_Button,
                          ImGui::GetStyleColorVec4(up ? ImGuiCol_ButtonActive : ImGuiCol_Button));
    if (ImGui::Button(name)) useMeasure(editor, tool);
    ImGui::PopStyleColor();
}

void showMeasured(Editor& editor) {
    const Probe& probe = editor.probe;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Measure");
    ImGui::SameLine();
    showTool(editor, "Length", Measure::length);
    ImGui::SameLine();
    showTool(editor, "Angle", Measure::angle);
    ImGui::SameLine();
    showTool(editor, "Radius", Measure::radius);
    ImGui::SameLine();
    showTool(editor, "Wall", Measure::wall);
    const std::string words = measuredWords(probe, sizeSeen(editor), unitOf(*editor.graph));
    if (words.empty()) return;
    besideIfFits("Copy##measured");
    if (ImGui::Button("Copy##measured")) ImGui::SetClipboardText(words.c_str());
    ImGui::TextUnformatted(words.c_str());
}

/// Through the probe's point along an axis, as far as the solid's box.
void lineAlong(Probe& probe, const Box& region, std::size_t axis) {
    Point from = *probe.point, to = from;
    const double room = 0.05 * (region.hi[axis] - region.lo[axis]);
    from[axis] = std::min(region.lo[axis], from[axis]) - room;
    to[axis] = std::max(region.hi[axis], to[axis]) + room;
    probe.ends = {from, to};
}

/// Writes the table; a word in the status line.
void writePlot(Editor& editor, const std::string& path) {
    const Done written = [&]() -> Done {
        Result<OutputFile> file = OutputFile::open(path, nullptr);
        if (!file) return file.error();
        file->write(csvOf(*editor.probe.plot));
        return file->commit();
    }();
    say(editor, written ? "wrote " + path : format(written.error()));
}

void showLine(Editor& editor) {
    constexpr std::size_t kMost = 3;
    Probe& probe = editor.probe;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Line");
    ImGui::SameLine();
    showTool(editor, "Two points", Measure::line);
    ImGui::BeginDisabled(!probe.point.has_value());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        ImGui::SameLine();
        if (ImGui::Button((std::string("Along ") + kAxisLetters[axis]).c_str()))
            lineAlong(probe, editor.viewport.shown.region, axis);
    }
    ImGui::EndDisabled();
    if (probe.ends.size() < 2) return;
    editEnd(editor, "##from", 0);
    editEnd(editor, "##to", 1);
    if (!probe.plot)
        return ImGui::TextDisabled("%s", probe.plotted.empty() ? "Select a node: its output is plotted."
                                                               : "The selected node has no value to plot.");
    const Plot& plot = *probe.plot;
    const char* const unit = unitOf(*editor.graph).name;
    ImGui::Text("%s, %.4g %s", nameAt(editor, probe.plotted).c_str(), plot.line.length(), unit);
    ImGui::SameLine();
    if (ImGui::SmallButton("Save as CSV …")) {
        probe.browser.endings = {".csv"};
        const std::string name = stemOf(editor) + "_" + probe.plotted + ".csv";
        open(probe.browser, FileBrowser::Kind::save,
             (std::filesystem::path(workFolder(editor)) / name).string());
    }
    for (std::size_t i = 0; i < std::min(plot.walls.size(), kMost); ++i)
        ImGui::Text("%.6g %s thick, from %.6g to %.6g %s", plot.walls[i].thickness(), unit,
                    plot.walls[i].from, plot.walls[i].to, unit);
    if (plot.walls.size() > kMost) ImGui::TextDisabled("and %zu more", plot.walls.size() - kMost);
    if (plot.walls.empty())
        for (std::size_t i = 0; i < std::min(plot.crossings.size(), kMost); ++i)
            ImGui::Text("crosses zero at %.6g %s", plot.crossings[i], unit);
    showPlot(plot, unit, editor.shell.scale());
}

}  // namespace

void showProbe(Editor& editor) {
    Probe& probe = editor.probe;
    showPlace(editor);
    showReadings(editor, 0.5f * ImGui::GetWindowHeight());
    ImGui::Separator();
    showMeasured(editor);
    showLine(editor);
    const std::optional<std::string> path = show(probe.browser, editor.shell.scale());
    if (path && probe.plot) writePlot(editor, *path);
}

}  // namespace fw::editor
