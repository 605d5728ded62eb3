#include "editor/panels/library.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include "editor/canvas/keyboard.h"
#include "editor/controls/tile.h"
#include "editor/document/library.h"
#include "editor/editor.h"
#include "editor/panels/side.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "graph/document/json.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

constexpr float kTile = 92.0f;            // pixels at scale 1: a picture's side
constexpr double kLookSeconds = 2.0;      // between two readings of the folder
constexpr const char* kPayload = "part";  // ImGui's, the path of a part

int64_t stampOf(const std::string& path) {
    std::error_code none;
    return int64_t(fs::last_write_time(path, none).time_since_epoch().count());
}

/// The picture of a part; empty if it makes no solid, or cannot be read.
Picture pictureOfPart(const std::string& path) {
    try {
        const Result<Graph> graph = readGraph(path, nullptr);
        if (!graph) return {};
        const std::string node = shownNode(*graph);
        if (node.empty()) return {};
        Result<Thumbnail> made = thumbnail(*graph, node);
        return made ? std::move(made->picture) : Picture();
    } catch (const std::exception&) { return {}; }
}

/// Takes the picture that was made, and begins that of the first of these that has none.
void makePictures(Editor& editor, const std::vector<const LibraryPart*>& seen) {
    LibraryPanel& panel = editor.library;
    if (panel.picture.begun()) {
        if (!panel.picture.isThere()) return;
        const Picture picture = panel.picture.take();
        LibraryPanel::Tile& tile = panel.tiles[panel.working];
        tile.stamp = panel.workingStamp, tile.made = true;
        if (!picture.pixels.empty())
            tile.texture = editor.shell.show(tile.texture, picture);
        else if (tile.texture)
            editor.shell.forget(std::exchange(tile.texture, nullptr));
        Shell::wake();  // the tiles of this frame are drawn: nothing else may happen that draws them again
    }
    for (const LibraryPart* part : seen) {
        const int64_t stamp = stampOf(part->path);
        const LibraryPanel::Tile& tile = panel.tiles[part->path];
        if (tile.made && tile.stamp == stamp) continue;
        panel.working = part->path, panel.workingStamp = stamp;
        panel.picture.begin([path = part->path] { return pictureOfPart(path); });
        return;
    }
}

/// The middle of what is seen of the canvas, below what was put there before.
Position inSight(const Editor& editor) {
    return position(freePlace(*editor.boxes, editor.canvas.view.middle));
}

struct Asked {
    const LibraryPart* add = nullptr;
    bool linked = false;
    const LibraryPart* open = nullptr;
    const LibraryPart* remove = nullptr;
};

void showPartTile(Editor& editor, const LibraryPart& part, float width, Asked& asked) {
    const auto found = editor.library.tiles.find(part.path);
    const ImTextureID texture = found == editor.library.tiles.end() ? nullptr : found->second.texture;
    if (showTile(texture, part.label, width, width)) asked.add = &part;
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s\nA click adds it, a drag to the canvas puts it there.", part.label.c_str());
    if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceNoHoldToOpenOthers)) {
        ImGui::SetDragDropPayload(kPayload, part.path.c_str(), part.path.size() + 1);
        ImGui::TextUnformatted(part.label.c_str());
        ImGui::EndDragDropSource();
    }
    if (ImGui::BeginPopupContextItem("part")) {
        if (ImGui::MenuItem("Add")) asked.add = &part;
        if (ImGui::MenuItem("Add linked to its file")) asked.add = &part, asked.linked = true;
        ImGui::Separator();
        if (ImGui::MenuItem("Open")) asked.open = &part;
        if (ImGui::MenuItem("Remove from the library")) asked.remove = &part;
        ImGui::EndPopup();
    }
}

/// The parts whose label or folder has every word that was typed, in their order.
std::vector<std::size_t> foundParts(const LibraryPanel& panel) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < panel.parts.size(); ++i) {
        const LibraryPart& part = panel.parts[i];
        if (match(panel.search, {.label = part.label, .id = {}, .others = {}, .category = part.folder}) <
            kNoMatch)
            found.push_back(i);
    }
    return found;
}

/// Further nodes that the selected ones are fed by.
std::size_t feedingCount(const Editor& editor, std::set<std::string>& all) {
    const NodeIds selected(editor.canvas.selection.begin(), editor.canvas.selection.end());
    all = upstream(nodesOf(editor.document.graph(), editor.canvas.scope), selected);
    all.insert(selected.begin(), selected.end());
    return all.size() - selected.size();
}

void keepSelected(Editor& editor) {
    LibraryPanel& panel = editor.library;
    const std::string name = partName(panel.name);
    std::set<std::string> all;
    (void)feedingCount(editor, all);
    const std::set<std::string>& chosen = panel.feeds ? all : editor.canvas.selection;
    if (const Done kept = keepPart(editor, NodeIds(chosen.begin(), chosen.end()), name); !kept)
        return say(editor, format(kept.error()));
    say(editor, "kept as " + name + " in the library");
    const std::string file = name + std::string(kGraphEnding);
    toFront(editor.files.preferences.taken,
            (fs::path(libraryFolder(editor.files.preferences)) / file).string(), kMostTaken);
    panel.name.clear();
    panel.looked = {};
    editor.panels.next = Part::canvas;
}

void showKeeping(Editor& editor) {
    LibraryPanel& panel = editor.library;
    const float em = ImGui::GetFontSize();
    ImGui::BeginDisabled(editor.canvas.selection.empty());
    const bool narrow = ImGui::GetContentRegionAvail().x < 26.0f * em;
    ImGui::SetNextItemWidth(narrow ? -FLT_MIN : -9.8f * em);
    if (std::exchange(panel.names, false)) ImGui::SetKeyboardFocusHere();
    const bool entered =
        ImGui::InputTextWithHint("##name", "name of the selection", &panel.name,
                                 ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (!narrow) ImGui::SameLine();
    ImGui::BeginDisabled(panel.name.empty());
    if (ImGui::Button("Keep", {3.6f * em, 0}) || (entered && !panel.name.empty())) keepSelected(editor);
    ImGui::EndDisabled();
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("Keeps the selected nodes, with their values, as a part");
    ImGui::SameLine();
    if (ImGui::Button("Folder …", {-1, 0})) {
        panel.browser.endings.clear();
        std::error_code none;
        const bool there = fs::is_directory(panel.folder, none);
        open(panel.browser, FileBrowser::Kind::folder, there ? panel.folder : "");
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Parts lie in %s", panel.folder.c_str());
    std::set<std::string> all;
    const std::size_t feeding = feedingCount(editor, all);
    if (feeding == 0) return;
    const std::string words =
        "with " + std::to_string(feeding) + (feeding == 1 ? " node that feeds it" : " nodes that feed it");
    const float room =
        ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight() - ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::Checkbox((fitted(words, room) + "###feeds").c_str(), &panel.feeds);
}

void showParts(Editor& editor, const std::vector<std::size_t>& found, Asked& asked) {
    LibraryPanel& panel = editor.library;
    const float scale = editor.shell.scale(), gap = ImGui::GetStyle().ItemSpacing.x;
    const float room = ImGui::GetContentRegionAvail().x;
    const int columns = std::max(1, int((room + gap) / (kTile * scale + gap)));
    const float width = (room - gap * float(columns - 1)) / float(columns);
    const float high = width + tileNameHeight();
    std::vector<const LibraryPart*> seen;
    for (std::size_t i = 0; i < found.size();) {
        const std::string& folder = panel.parts[found[i]].folder;
        if (!folder.empty()) ImGui::TextDisabled("%s", folder.c_str());
        for (int column = 0; i < found.size() && panel.parts[found[i]].folder == folder; ++i) {
            if (column > 0) ImGui::SameLine();
            column = (column + 1) % columns;
            const LibraryPart& part = panel.parts[found[i]];
            if (!ImGui::IsRectVisible({width, high})) {
                ImGui::Dummy({width, high});
                continue;
            }
            seen.push_back(&part);
            ImGui::PushID(part.path.c_str());
            showPartTile(editor, part, width, asked);
            ImGui::PopID();
        }
    }
    makePictures(editor, seen);
}

}  // namespace

void lookAtLibrary(Editor& editor) {
    LibraryPanel& panel = editor.library;
    const auto take = [&](LibraryPanel::Reading read) {
        panel.parts = std::move(read.parts), panel.problem = std::move(read.problem);
        std::set<std::string_view> paths;
        for (const LibraryPart& part : panel.parts) paths.insert(part.path);
        std::erase_if(panel.tiles, [&](const auto& tile) {
            const bool gone = !paths.contains(tile.first);
            if (gone && tile.second.texture) editor.shell.forget(tile.second.texture);
            return gone;
        });
    };
    const auto read = [](const std::string& folder) {
        LibraryPanel::Reading all;
        all.parts = listParts(folder, all.problem);
        return all;
    };
    const std::string folder = libraryFolder(editor.files.preferences);
    const SteadyClock::time_point now = SteadyClock::now();
    // At once where it is another one, or was changed here; what others do to it is noticed meanwhile.
    if (folder != panel.folder || panel.looked == SteadyClock::time_point()) {
        panel.reading = {};
        panel.folder = folder, panel.looked = now;
        return take(read(folder));
    }
    if (panel.reading.begun()) {
        if (!panel.reading.isThere()) return;
        take(panel.reading.take());
    }
    if (std::chrono::duration<double>(now - panel.looked).count() < kLookSeconds) return;
    panel.looked = now;
    panel.reading.begin([read, folder] { return read(folder); });
}

void keepInLibrary(Editor& editor) {
    showPanel(editor, "library");
    lookAtLibrary(editor);
    editor.library.names = true;
    editor.library.name = proposedName(editor.document.graph(), editor.canvas.scope, editor.canvas.active,
                                       editor.library.parts);
}

void takeDraggedPart(Editor& editor) {
    const ImGuiPayload* payload = ImGui::GetDragDropPayload();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (!payload || !payload->IsDataType(kPayload) || !ImGui::IsMouseReleased(0) ||
        !editor.canvas.view.panel.contains(mouse))
        return;
    const auto found =
        std::ranges::find(editor.library.parts, static_cast<const char*>(payload->Data), &LibraryPart::path);
    if (found == editor.library.parts.end()) return;
    const LibraryPart part = *found;
    addPart(editor, part, position(editor.canvas.view.toCanvas(mouse)), ImGui::GetIO().KeyAlt);
    editor.panels.next = Part::canvas;
}

void showLibrary(Editor& editor) {
    LibraryPanel& panel = editor.library;
    lookAtLibrary(editor);
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", "Search the library", &panel.search);
    showKeeping(editor);
    const std::vector<std::size_t> found = foundParts(panel);
    Asked asked;
    ImGui::BeginChild("##parts");
    if (!panel.problem.empty()) ImGui::TextWrapped("%s", panel.problem.c_str());
    if (panel.parts.empty())
        ImGui::TextWrapped(
            "Nothing is kept yet. Select nodes, give them a name above, and keep them: they are here in "
            "every "
            "document.");
    else if (found.empty())
        ImGui::TextDisabled("Nothing has that name");
    showParts(editor, found, asked);
    ImGui::EndChild();
    if (const auto folder = show(panel.browser, editor.shell.scale())) {
        editor.files.preferences.library = *folder;
        keepPreferences(editor);
    }
    if (asked.add) {
        const LibraryPart part = *asked.add;
        addPart(editor, part, inSight(editor), asked.linked);
    }
    if (asked.open) openFile(editor, asked.open->path);
    if (asked.remove) {
        std::error_code error;
        if (const Done kept = keepVersion(asked.remove->path, true); !kept)
            return say(editor, format(kept.error()));
        fs::remove(asked.remove->path, error);
        say(editor, error ? "it cannot be removed: " + error.message()
                          : asked.remove->label + " is no part of the library any more");
        panel.looked = {};
    }
}

}  // namespace fw::editor
