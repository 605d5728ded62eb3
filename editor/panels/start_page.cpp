#include "editor/panels/start_page.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "editor/commands.h"
#include "editor/controls/tile.h"
#include "editor/panels/tour.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSamples[] = {"tower", "goblet", "gyroid_sphere"};
constexpr std::size_t kMostFiles = 5;
constexpr float kWidth = 36.0f,
                kHigh = 25.0f;   // in units of the font's size; lower canvases have no pictures
constexpr float kWhole = 36.0f;  // and in higher ones all of it is seen

bool holds(const Editor& editor) {
    const Graph& graph = editor.document.graph();
    return graph.path.empty() && graph.nodes.empty() && graph.groups.empty() && !editor.document.unsaved();
}

/// The pictures are read aside, and become textures here.
void follow(StartPage& page, Shell& shell) {
    if (!std::exchange(page.looked, true)) {
        const std::string folder = samplesFolder();
        if (folder.empty()) return;
        for (const Sample& sample : listSamples(folder))
            for (const char* name : kSamples)
                if (fs::path(sample.path).filename().string() == name + std::string(kGraphEnding))
                    page.samples.push_back(sample);
        page.textures.resize(page.samples.size());
        page.reading.begin([all = page.samples] {
            std::vector<Picture> pictures;
            for (const Sample& sample : all) pictures.push_back(pictureOf(sample));
            return pictures;
        });
    }
    if (!page.reading.isThere()) return;
    const std::vector<Picture> pictures = page.reading.take();
    for (std::size_t i = 0; i < pictures.size(); ++i)
        if (!pictures[i].pixels.empty()) page.textures[i] = shell.show(nullptr, pictures[i]);
}

void startHeading(const char* words) {
    ImGui::Dummy({0, kSmallGap * ImGui::GetFontSize()});
    ImGui::TextDisabled("%s", words);
}

void showFirstSteps(Editor& editor) {
    startHeading("First steps");
    if (ImGui::Button("Take the tour")) startTour(editor);
    besideIfFits("Tutorial");
    if (ImGui::Button("Tutorial")) command("help.tutorial").run(editor);
    besideIfFits("Shortcuts");
    if (ImGui::Button("Shortcuts")) editor.windows.shortcuts = true;
    const std::string keys = keysOf(command("node.add"), editor.files.preferences);
    if (!keys.empty())
        ImGui::TextWrapped("Or begin here: %s adds the first node where the mouse is.",
                           keys.substr(0, keys.find(' ')).c_str());
}

void showSampleTiles(Editor& editor, bool pictures) {
    StartPage& page = editor.windows.start;
    startHeading("Open a sample");
    std::string chosen;
    if (pictures && !page.samples.empty()) {
        const float gap = ImGui::GetStyle().ItemSpacing.x, count = float(page.samples.size()),
                    width = (ImGui::GetContentRegionAvail().x - gap * (count - 1.0f)) / count;
        for (std::size_t i = 0; i < page.samples.size(); ++i) {
            if (i > 0) ImGui::SameLine();
            ImGui::PushID(int(i));
            if (showTile(page.textures[i], page.samples[i].label, width, width * 9.0f / 16.0f))
                chosen = page.samples[i].path;
            ImGui::PopID();
        }
    }
    if (ImGui::Button("All samples …")) editor.files.samples.opening = true;
    if (!chosen.empty()) openFile(editor, chosen);
}

void showRecentFiles(Editor& editor) {
    const std::vector<std::string> recent = editor.files.preferences.recent;
    startHeading("Go on with");
    std::string chosen;
    const float em = ImGui::GetFontSize(), room = ImGui::GetContentRegionAvail().x;
    for (std::size_t i = 0; i < std::min(recent.size(), kMostFiles); ++i) {
        const fs::path path = recent[i];
        wantGlyphs(recent[i]);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::PushID(int(i));
        if (ImGui::Selectable("##recent")) chosen = recent[i];
        ImGui::PopID();
        const std::string name = fitted(path.filename().string(), 0.55f * room);
        ImDrawList* list = ImGui::GetWindowDrawList();
        list->AddText(at, themeColor(ThemeColor::text), name.c_str());
        const float used = ImGui::CalcTextSize(name.c_str()).x + em;
        list->AddText({at.x + used, at.y}, themeColor(ThemeColor::quiet),
                      fittedEnd(path.parent_path().string(), room - used).c_str());
    }
    if (ImGui::Button("Open …")) askForFile(editor);
    if (!chosen.empty()) openFile(editor, chosen);
}

}  // namespace

void showStartPage(Editor& editor) {
    StartPage& page = editor.windows.start;
    page.open = page.open && holds(editor);
    if (!page.open) return;
    follow(page, editor.shell);
    const Area& canvas = editor.canvas.view.panel;
    const float em = ImGui::GetFontSize();
    const ImVec2 most(std::min(kWidth * em, canvas.width() - 2.0f * em), canvas.height() - 2.0f * em);
    if (most.x < 8.0f * em || most.y < 6.0f * em) return;
    ImGui::SetNextWindowPos(canvas.centre(), ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({most.x, 0}, most);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {2.0f * kGap * em, 2.0f * kGap * em});
    const bool shown = ImGui::Begin(
        "##start", nullptr,
        ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
            ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings |
            ImGuiWindowFlags_AlwaysAutoResize |
            (canvas.height() > kWhole * em ? ImGuiWindowFlags_NoScrollbar : ImGuiWindowFlags_None));
    ImGui::PopStyleVar();
    if (shown) {
        ImGui::PushFont(editor.shell.fonts().of(1.5f * em));
        ImGui::TextUnformatted("Fieldwright");
        ImGui::PopFont();
        showFirstSteps(editor);
        showSampleTiles(editor, canvas.height() > kHigh * em && most.x > 20.0f * em);
        showRecentFiles(editor);
    }
    ImGui::End();
}

}  // namespace fw::editor
