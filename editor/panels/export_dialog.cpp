#include "editor/panels/export_dialog.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;
using Phase = ExportState::Phase;

constexpr double kMegabyte = 1e6;

/// "1,234,567"
std::string grouped(uint64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
    return text;
}

template <class... Values>
std::string printed(const char* format, Values... values) {
    char text[256];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

void setPath(ExportDialog& dialog, std::string path) {
    if (exportFormat(path)) dialog.ending = fs::path(path).extension().string();
    dialog.of.path = std::move(path);
}

void showFormat(Editor& editor) {
    propertyRow("Format");
    const std::string path = exportPath(editor);
    const ExportFormat* chosen = exportFormat(path);
    if (!ImGui::BeginCombo("##format", chosen ? chosen->ending + 1 : "not known")) return;
    for (const ExportFormat& format : exportFormats()) {
        const std::string label = std::string(format.ending + 1) + "   " + format.about;
        if (ImGui::Selectable(label.c_str(), &format == chosen))
            setPath(editor.exporting, fs::path(path).replace_extension(format.ending).string());
    }
    ImGui::EndCombo();
}

void showFile(Editor& editor) {
    ExportDialog& dialog = editor.exporting;
    const float scale = editor.shell.scale(), room = 90.0f * scale;
    propertyRow("File", {}, room);
    std::string path = exportPath(editor);
    if (ImGui::InputText("##file", &path)) setPath(dialog, path);
    ImGui::SameLine(0, 4 * scale);
    if (ImGui::Button("Browse …", {-1, 0})) {
        const ExportFormat* format = exportFormat(path);
        dialog.browser.endings = {format ? format->ending : exportFormats().front().ending};
        open(dialog.browser, FileBrowser::Kind::save, path);
    }
}

void showSettings(Editor& editor) {
    ExportDialog& dialog = editor.exporting;
    if (!beginProperties("export")) return;
    showFormat(editor);
    showFile(editor);
    if (const ExportFormat* format = exportFormat(exportPath(editor)); format && format->manifold) {
        propertyRow("Solid", "For programs that compute with solids (EXT_mesh_manifold).");
        ImGui::Checkbox("marked as one##manifold", &dialog.manifold);
    }
    propertyRow("Resolution");
    bool own = !dialog.givesResolution;
    if (ImGui::Checkbox("as the output node says##resolution", &own)) dialog.givesResolution = !own;
    if (dialog.givesResolution) {
        propertyRow("   cells",
                    "Along the longest side of the region: twice as many take four to eight times "
                    "the time and the memory.");
        if (ImGui::InputInt("##cells", &dialog.resolution, 32, 128))
            dialog.resolution = std::clamp(dialog.resolution, 1, kMostResolution);
    }
    propertyRow("Region");
    ExportDialog::OfDocument& of = dialog.of;
    own = !of.givesRegion;
    if (ImGui::Checkbox("found from the solid##region", &own)) of.givesRegion = !own;
    if (of.givesRegion) {
        propertyRow("   least corner, m");
        dragNumbers(editor, "##least", std::span(of.region).first(3), {},
                    [&of](std::span<const double> to) { std::ranges::copy(to, of.region.begin()); });
        propertyRow("   greatest corner, m");
        dragNumbers(editor, "##greatest", std::span(of.region).last(3), {},
                    [&of](std::span<const double> to) { std::ranges::copy(to, of.region.begin() + 3); });
    }
    if (!editor.graph->timeline->is_null()) {
        propertyRow("Time, s", "The moment of the timeline that is exported.");
        const double seconds = of.seconds.value_or(editor.viewport.seconds);
        dragNumbers(editor, "##time", std::span(&seconds, 1), {.min = 0.0},
                    [&of](std::span<const double> to) { of.seconds = to[0]; });
    }
    endProperties();
}

void begin(Editor& editor) {
    ExportDialog& dialog = editor.exporting;
    const ExportDialog::OfDocument& of = dialog.of;
    ExportWish wish{.graph = editor.graph,
                    .path = exportPath(editor),
                    .seconds = of.seconds.value_or(editor.viewport.seconds),
                    .device = editor.device};
    const std::array<double, 6>& r = of.region;
    const ExportFormat* format = exportFormat(wish.path);
    wish.manifold = dialog.manifold && format && format->manifold;
    if (dialog.givesResolution) wish.mesh.resolution = dialog.resolution;
    if (of.givesRegion) wish.mesh.region = Box{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}};
    dialog.job.reset();
    dialog.job = std::make_unique<ExportJob>(std::move(wish), [] { Shell::wake(); });
    dialog.told = false;
}

void showDone(const ExportState& state) {
    const Report& report = state.report;
    const std::string name = fs::path(state.files.paths.front()).filename().string();
    wrapped(themeColor(ThemeColor::text),
            printed("%s: %.2f MB in %.2f s", name.c_str(), double(state.files.bytes) / kMegabyte,
                    report.totalMs / 1e3));
    wrapped(
        themeColor(ThemeColor::text),
        grouped(report.triangles) + " triangles, " + grouped(report.vertices) + " vertices" +
            (state.measured ? ", " + grouped(report.bodies()) + (report.bodies() == 1 ? " part" : " parts")
                            : std::string()) +
            (state.measured && report.cavities > 0
                 ? ", " + grouped(report.cavities) +
                       (report.cavities == 1 ? " hollow that is closed" : " hollows that are closed")
                 : std::string()));
    if (state.tiled) wrapped(themeColor(ThemeColor::text), "It was meshed in tiles.");
    if (report.capped)
        wrapped(themeColor(ThemeColor::warning),
                "The surface leaves the region and was closed at its boundary: give a larger region if that "
                "is not wanted.");
    if (!state.measured)
        return wrapped(themeColor(ThemeColor::warning), "There was not enough memory free to measure it.");
    std::array<double, 3> size{};
    for (std::size_t axis = 0; axis < 3; ++axis) size[axis] = report.boundsMax[axis] - report.boundsMin[axis];
    wrapped(themeColor(ThemeColor::text), printed("%.4g × %.4g × %.4g m, volume %.4g m³, area %.4g m²",
                                                  size[0], size[1], size[2], report.volume, report.area));
    if (const std::string wrong = soundness(report); wrong.empty())
        wrapped(themeColor(ThemeColor::text), "Watertight: every edge has two triangles.");
    else
        wrapped(themeColor(ThemeColor::warning), "Not watertight: " + wrong + ".");
}

void showJob(Editor& editor, const ExportState& state) {
    const ExportDialog& dialog = editor.exporting;
    ImGui::Separator();
    switch (state.phase) {
        case Phase::running:
            ImGui::ProgressBar(state.part, {-1, 0});
            ImGui::TextUnformatted(dialog.job->cancelling() ? "cancelling …" : state.stage);
            if (state.again) wrapped(themeColor(ThemeColor::warning), "The device was lost: it began again.");
            break;
        case Phase::done: showDone(state); break;
        case Phase::cancelled: ImGui::TextUnformatted("Cancelled: no file was written."); break;
        case Phase::failed:
            for (const Error& problem : state.problems)
                wrapped(themeColor(ThemeColor::error), format(problem));
            break;
    }
}

void showButtons(Editor& editor) {
    ExportDialog& dialog = editor.exporting;
    const ImVec2 size{110 * editor.shell.scale(), 0};
    if (exports(editor)) {
        if (ImGui::Button("Cancel export", size)) dialog.job->cancel();
    } else {
        const std::string path = exportPath(editor);
        std::error_code error;
        if (fs::exists(path, error))
            wrapped(themeColor(ThemeColor::warning),
                    fs::path(path).filename().string() + " is there and will be replaced.");
        if (!exportFormat(path))
            wrapped(themeColor(ThemeColor::error),
                    "The name has to end in one of the formats: choose one above.");
        ImGui::BeginDisabled(!exportFormat(path));
        if (ImGui::Button("Export", size)) begin(editor);
        ImGui::EndDisabled();
    }
    ImGui::SameLine();
    if (ImGui::Button("Close", size)) dialog.open = false;
}

/// What is said in the status line of an export that nobody watches.
std::string outcome(const ExportState& state) {
    if (state.phase == Phase::done)
        return "exported " + state.files.paths.front() + ": " + grouped(state.report.triangles) +
               " triangles";
    if (state.phase == Phase::failed) return "the export failed: " + state.problems.front().message;
    return "the export was cancelled";
}

}  // namespace

std::string soundness(const Report& report) {
    std::string wrong;
    const auto add = [&](uint64_t count, const char* what) {
        if (count > 0) wrong += (wrong.empty() ? "" : ", ") + grouped(count) + " " + what;
    };
    add(report.boundaryEdges, "open edges");
    add(report.nonManifoldEdges, "edges of more than two triangles");
    add(report.nonManifoldVertices, "vertices where parts touch");
    add(report.flippedEdges, "edges between triangles that face opposite ways");
    add(report.degenerateTriangles, "triangles without area");
    return wrong;
}

bool exports(const Editor& editor) {
    return editor.exporting.job && editor.exporting.job->state().phase == Phase::running;
}

std::string exportPath(const Editor& editor) {
    const ExportDialog& dialog = editor.exporting;
    const bool typed = dialog.of.document == editor.viewport.document && !dialog.of.path.empty();
    return typed ? dialog.of.path
                 : (fs::path(workFolder(editor)) / (stemOf(editor) + dialog.ending)).string();
}

void openExport(Editor& editor) {
    ExportDialog& dialog = editor.exporting;
    dialog.of.seconds.reset();
    dialog.open = dialog.toFront = true;
}

void showExport(Editor& editor) {
    ExportDialog& dialog = editor.exporting;
    const std::optional<ExportState> state = dialog.job ? std::optional(dialog.job->state()) : std::nullopt;
    if (!dialog.told && state->phase != Phase::running) {
        dialog.told = true;
        if (!dialog.open) say(editor, outcome(*state));
    }
    const uint64_t document = editor.viewport.document;
    if (dialog.of.document != document) dialog.of = {.document = document};
    const float scale = editor.shell.scale();
    showStaying(dialog, "Export", 520.0f * scale, 0.25f, [&] {
        showSettings(editor);
        if (state) showJob(editor, *state);
        ImGui::Separator();
        showButtons(editor);
        const auto path = show(dialog.browser, scale);
        if (path) setPath(dialog, *path);
        return path.has_value();
    });
}

}  // namespace fw::editor
