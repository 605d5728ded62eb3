#include "editor/files/missing_files.h"

#include <algorithm>
#include <filesystem>

#include "editor/editor.h"
#include "editor/files/graph_folder.h"
#include "editor/files/watch.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "graph/assets/particle_file.h"
#include "graph/base/words.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMissingTitle = "Missing files";

/// How many of the last parts of two paths are the same, whatever their case.
int alike(const fs::path& a, const fs::path& b) {
    std::vector<std::string> one, other;
    for (const fs::path& part : a) one.push_back(lowered(part.string()));
    for (const fs::path& part : b) other.push_back(lowered(part.string()));
    int count = 0;
    while (std::size_t(count) < std::min(one.size(), other.size()) &&
           one[one.size() - 1 - std::size_t(count)] == other[other.size() - 1 - std::size_t(count)])
        ++count;
    return count;
}

/// The files that were found in place of those that are missing, brought to the document: one step of undo.
void relink(Editor& editor, const std::vector<NamedFile>& missing,
            const std::map<std::string, std::string>& found) {
    std::vector<std::string> told;
    std::map<std::string, std::string> brought;
    for (const NamedFile& file : missing) {
        const auto there = found.find(file.path);
        if (there == found.end() || brought.contains(file.path)) continue;
        const Result<std::string> path = bringToDocument(editor, there->second, *file.kind, told);
        if (path)
            brought.emplace(file.path, *path);
        else
            told.push_back(path.error().message);
    }
    if (!brought.empty()) {
        Graph graph = editor.document.graph();
        renameFiles(graph, [&](const NamedFile& file) {
            const auto at = brought.find(file.path);
            return at == brought.end() ? file.path : at->second;
        });
        editor.document.apply(brought.size() == 1 ? "Relink File" : "Relink Files", std::move(graph));
        editor.document.outdate();  // where it lies as it was named it is there now
    }
    const std::size_t left = missing.size() - brought.size();
    told.insert(told.begin(), std::to_string(brought.size()) + " found" +
                                  (left > 0 ? ", " + std::to_string(left) + " still missing" : ""));
    say(editor, joined(told));
    editor.files.missing.opening = left > 0;
}

void showList(Editor& editor, const std::vector<NamedFile>& missing) {
    MissingFilesDialog& dialog = editor.files.missing;
    const std::string folder = graphFolder(editor.document.graph());
    ImGui::TextWrapped(
        "These files are not where the document has them. What is found goes beside the document, if it is "
        "not there or in a folder below already.");
    ImGui::BeginChild("##missing", {0, -2.0f * ImGui::GetFrameHeightWithSpacing()});
    const NamedFile* choose = nullptr;
    for (std::size_t i = 0; i < missing.size(); ++i) {
        ImGui::PushID(int(i));
        if (ImGui::SmallButton("Choose …")) choose = &missing[i];
        ImGui::SameLine();
        ImGui::TextUnformatted(missing[i].path.c_str());
        ImGui::SameLine();
        ImGui::TextDisabled("%s", std::string(missing[i].kind->noun).c_str());
        ImGui::PopID();
    }
    ImGui::EndChild();
    if (choose) {
        ImGui::CloseCurrentPopup();
        const NamedFile file = *choose;
        pickFile(editor, *file.kind, {}, [file](Editor& in, const std::string& path) {
            Graph graph = in.document.graph();
            renameFiles(graph,
                        [&](const NamedFile& each) { return each.path == file.path ? path : each.path; });
            in.document.apply("Relink File", std::move(graph));
            in.document.outdate();
            in.files.missing.opening =
                !missingFiles(in.document.graph(), graphFolder(in.document.graph())).empty();
        });
    }
    const float wide = 150.0f * editor.shell.scale();
    if (ImGui::Button("Look in a folder …", {wide, 0})) {
        ImGui::CloseCurrentPopup();
        dialog.browser.endings.clear();
        open(dialog.browser, FileBrowser::Kind::folder, folder);
    }
    ImGui::SameLine();
    if (ImGui::Button("Close", {wide, 0}) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
        ImGui::CloseCurrentPopup();
}

}  // namespace

std::vector<NamedFile> missingFiles(const Graph& graph, const std::string& folder) {
    std::vector<NamedFile> missing = namedFiles(graph);
    std::erase_if(missing, [&](const NamedFile& file) {
        if (file.kind->apart || (file.kind == &kParticleFile && namesSequence(file.path))) return true;
        std::error_code none;
        return fs::is_regular_file(fs::path(folder) / file.path, none);
    });
    return missing;
}

std::map<std::string, std::string> lookFor(const std::vector<NamedFile>& files, const std::string& folder) {
    std::map<std::string, std::vector<std::string>>
        wanted;  // paths of the graph by the name in small letters
    for (const NamedFile& file : files)
        wanted[lowered(fs::path(file.path).filename().string())].push_back(file.path);
    std::map<std::string, std::string> found;
    std::error_code error;
    fs::recursive_directory_iterator each(folder, fs::directory_options::skip_permission_denied, error);
    std::size_t looked = 0;
    for (; !error && each != fs::recursive_directory_iterator() && looked < kMostLookedAt;
         each.increment(error), ++looked) {
        const std::string name = each->path().filename().string();
        std::error_code none;
        if (name.starts_with('.') && each->is_directory(none)) each.disable_recursion_pending();
        const auto asked = wanted.find(lowered(name));
        if (asked == wanted.end() || !each->is_regular_file(none)) continue;
        const std::string path = each->path().string();
        for (const std::string& of : asked->second) {
            const auto [at, first] = found.emplace(of, path);
            const int now = alike(of, path), before = alike(of, at->second);
            if (!first && (now > before || (now == before && path < at->second))) at->second = path;
        }
    }
    return found;
}

void MissingFilesDialog::look(const std::shared_ptr<const Graph>& graph, bool changed,
                              Clock::time_point now) {
    if (changed) seen.reset();
    if (seen == graph || std::chrono::duration<double>(now - looked).count() < kWatchSeconds) return;
    seen = graph, looked = now;
    known = missingFiles(*graph, graphFolder(*graph));
}

void openMissingFiles(Editor& editor) {
    const std::string folder = graphFolder(editor.document.graph());
    const std::vector<NamedFile> missing = missingFiles(editor.document.graph(), folder);
    if (missing.empty()) return say(editor, "no file that the document names is missing");
    // What lies below the document needs no question.
    if (const auto found = lookFor(missing, folder); !folder.empty() && !found.empty())
        return relink(editor, missing, found);
    editor.files.missing.opening = true;
}

void showMissingFiles(Editor& editor) {
    MissingFilesDialog& dialog = editor.files.missing;
    if (dialog.opening && !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) {
        dialog.opening = false;
        ImGui::OpenPopup(kMissingTitle);
    }
    ImGui::PushID("missing");
    const auto folder = show(dialog.browser, editor.shell.scale());
    ImGui::PopID();
    const bool shown = ImGui::IsPopupOpen(kMissingTitle);
    if (!shown && !folder) return;
    const std::vector<NamedFile> missing =
        missingFiles(editor.document.graph(), graphFolder(editor.document.graph()));
    if (folder) relink(editor, missing, lookFor(missing, *folder));
    const ImVec2 whole = ImGui::GetMainViewport()->Size;
    const float scale = editor.shell.scale();
    ImGui::SetNextWindowSize(
        {std::min(560.0f * scale, 0.95f * whole.x), std::min(340.0f * scale, 0.9f * whole.y)},
        ImGuiCond_Appearing);
    ImGui::SetNextWindowPos({0.5f * whole.x, 0.45f * whole.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(kMissingTitle, nullptr, ImGuiWindowFlags_NoSavedSettings)) return;
    if (missing.empty()) ImGui::CloseCurrentPopup();
    showList(editor, missing);
    ImGui::EndPopup();
}

}  // namespace fw::editor
