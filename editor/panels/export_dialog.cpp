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
#include "graph/document/unit.h"
#include "runtime/system/output_file.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;
using Phase = ExportState::Phase;

constexpr double kMegabyte = 1e6;
constexpr int kMostTriangles = 1 << 24;

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

/// A choice among names, the first of which stands for none.
bool chooseWord(const char* id, std::vector<std::string> names, const char* none, std::string& word) {
    names.insert(names.begin(), none);
    auto chosen = std::size_t(std::ranges::find(names, word) - names.begin());
    if (chosen == names.size()) chosen = 0;
    if (!chooseName(id, names, chosen)) return false;
    word = chosen == 0 ? std::string() : names[chosen];
    return true;
}

/// Whether the file is to hold the field itself.
bool wantsFunctions(const Editor& editor) {
    return editor.exporting.functions && lowerExtension(exportPath(editor)) == ".3mf";
}

void showContents(Editor& editor) {
    if (lowerExtension(exportPath(editor)) != ".3mf") return;
    propertyRow(
        "Contents",
        "The field itself, for programs that read 3MF's volumetric and implicit extensions, in place of "
        "triangles.");
    ImGui::Checkbox("functions, not a mesh##functions", &editor.exporting.functions);
}

/// In which unit and with which axis up the file is, where its format leaves that open.
void showPlacement(Editor& editor) {
    const std::string path = exportPath(editor);
    PlacementWish& wish = editor.exporting.file.placement;
    if (!exportFormat(path)) return;
    const LengthUnit& document = unitOf(*editor.graph);
    const auto open = [&](const PlacementWish& other) { return bool(placementOf(path, document, other)); };
    if (open({.purpose = "print"})) {
        propertyRow("For printing", "Millimetres and +Z up, as slicers have it.");
        bool print = wish.forPrinting();
        if (ImGui::Checkbox("millimetres, +Z up##print", &print)) wish = {.purpose = print ? "print" : ""};
    }
    if (wish.forPrinting() && open(wish)) return;
    if (open({.unit = "mm"}) && open({.unit = "m"})) {
        propertyRow("Unit", "Of the lengths in the file, which does not say it.");
        std::vector<std::string> names;
        for (const LengthUnit& unit : lengthUnits()) names.emplace_back(unit.name);
        const std::string own = std::string("the document's, ") + document.name;
        if (chooseWord("##unit", names, own.c_str(), wish.unit)) wish.purpose.clear();
    }
    if (open({.up = "z"})) {
        propertyRow("Up");
        if (chooseWord("##up", {"z"}, "y", wish.up)) wish.purpose.clear();
    }
}

/// What the file has beside triangles, as far as its format has it.
void showForm(Editor& editor) {
    ExportDialog& dialog = editor.exporting;
    MeshWish& file = dialog.file;
    const std::string path = exportPath(editor);
    const ExportFormat* const format = exportFormat(path);
    if (!format) return;
    propertyRow("Triangles", "Decimated to at most so many, with borders and creases where they are.");
    bool all = !dialog.triangles;
    if (ImGui::Checkbox("as many as there are##triangles", &all))
        dialog.triangles = all ? std::nullopt : std::optional(10'000);
    if (dialog.triangles) {
        propertyRow("   at most");
        if (ImGui::InputInt("##most", &*dialog.triangles, 1000, 10'000))
            dialog.triangles = std::clamp(*dialog.triangles, 4, kMostTriangles);
    }
    if (format->parts) {
        propertyRow("Textures", "Colours, finish, light, occlusion and normals, baked from the field.");
        std::vector<std::string> sizes;
        for (int size = kLeastTexture; size <= kMostTexture; size *= 2) sizes.push_back(std::to_string(size));
        std::string size = file.textures ? std::to_string(*file.textures) : std::string();
        if (chooseWord("##textures", sizes, "none", size))
            file.textures = size.empty() ? std::nullopt : std::optional(std::stoi(size));
        if (!file.textures) {
            propertyRow("Materials", "Faces are cut where the materials of two nodes meet.");
            ImGui::Checkbox("cut along their borders##split", &file.splitMaterials);
        }
    }
    if (!isGltf(path)) return;
    propertyRow("Levels", "Of detail, each with a quarter of the triangles of the one before: NAME_LOD0, …");
    if (ImGui::SliderInt("##lods", &file.lods, 1, kMostLevels))
        file.lods = std::clamp(file.lods, 1, kMostLevels);
    propertyRow("Parts", "What touches nowhere is a node of its own.");
    ImGui::BeginDisabled(file.lods > 1);
    ImGui::Checkbox("as nodes##parts", &file.parts);
    ImGui::EndDisabled();
    propertyRow("Size", "Few bits a number, in meshoptimizer's code: for three.js, Babylon and engines.");
    ImGui::Checkbox("compressed##compress", &file.compress);
    propertyRow("Solid", "For programs that compute with solids (EXT_mesh_manifold).");
    ImGui::BeginDisabled(file.lods > 1 || file.parts || file.compress);
    ImGui::Checkbox("marked as one##manifold", &file.manifold);
    ImGui::EndDisabled();
}

/// What is asked of the dialog's file: no more than its format has, and than goes together.
MeshWish wishFor(const Editor& editor, const std::string& path) {
    MeshWish wish = editor.exporting.file;
    const ExportFormat* const format = exportFormat(path);
    if (!format) return wish;
    if (!format->parts) wish.textures.reset(), wish.splitMaterials = false;
    if (wish.textures) wish.splitMaterials = false;
    if (!isGltf(path)) wish.compress = wish.parts = wish.manifold = false, wish.lods = 1;
    if (wish.lods > 1) wish.parts = false;
    if (wish.lods > 1 || wish.parts || wish.compress) wish.manifold = false;
    if (!placementOf(path, unitOf(*editor.graph), wish.placement)) wish.placement = {};
    return wish;
}

void showResolution(ExportDialog& dialog) {
    propertyRow("Resolution");
    bool own = !dialog.givesResolution;
    if (ImGui::Checkbox("as the output node says##resolution", &own)) dialog.givesResolution = !own;
    if (!dialog.givesResolution) return;
    propertyRow("   cells",
                "Along the longest side of the region: twice as many take four to eight times "
                "the time and the memory.");
    if (ImGui::InputInt("##cells", &dialog.resolution, 32, 128))
        dialog.resolution = std::clamp(dialog.resolution, 1, kMostResolution);
}

void showSettings(Editor& editor) {
    ExportDialog& dialog = editor.exporting;
    if (!beginProperties("export")) return;
    showFormat(editor);
    showFile(editor);
    showContents(editor);
    if (!wantsFunctions(editor)) {
        showPlacement(editor);
        showForm(editor);
        showResolution(dialog);
    }
    propertyRow("Region");
    ExportDialog::OfDocument& of = dialog.of;
    bool own = !of.givesRegion;
    if (ImGui::Checkbox("found from the solid##region", &own)) of.givesRegion = !own;
    if (of.givesRegion) {
        propertyRow("   least corner");
        dragNumbers(editor, "##least", std::span(of.region).first(3), {.unit = "m"},
                    [&of](std::span<const double> to) { std::ranges::copy(to, of.region.begin()); });
        propertyRow("   greatest corner");
        dragNumbers(editor, "##greatest", std::span(of.region).last(3), {.unit = "m"},
                    [&of](std::span<const double> to) { std::ranges::copy(to, of.region.begin() + 3); });
    }
    if (!editor.graph->timeline->is_null()) {
        propertyRow("Time", "The moment of the timeline that is exported.");
        const double seconds = of.seconds.value_or(editor.viewport.seconds);
        dragNumbers(editor, "##time", std::span(&seconds, 1), {.min = 0.0, .unit = "s"},
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
    wish.file = wishFor(editor, wish.path);
    wish.triangles = dialog.triangles.value_or(0);
    wish.functions = wantsFunctions(editor);
    if (wish.functions) wish.file = {};
    if (dialog.givesResolution && !wish.functions) wish.mesh.resolution = dialog.resolution;
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
    if (state.functions > 0) {
        wrapped(themeColor(ThemeColor::text), "The field itself, in " + grouped(state.functions) + " nodes.");
        for (const Error& note : state.notes) wrapped(themeColor(ThemeColor::warning), format(note));
        return;
    }
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
    for (const auto& [what, value] : sizeRows(report, report.lengths(), report.density))
        wrapped(themeColor(ThemeColor::text), what + ": " + value);
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
        return "exported " + state.files.paths.front() + ": " +
               (state.functions > 0 ? grouped(state.functions) + " nodes of functions"
                                    : grouped(state.report.triangles) + " triangles");
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
    showStaying(dialog, "Export", 520.0f * scale, 0.06f, [&] {
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
