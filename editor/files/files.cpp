#include "editor/files/files.h"

#include <filesystem>

#include "editor/document/layout.h"
#include "editor/editor.h"
#include "graph/json.h"

namespace fw::editor {

namespace {

using Next = Files::Next;

constexpr const char* kQuestion = "Unsaved changes";
constexpr const char* kOffer = "Recovered work";

std::string nameOf(const Editor& editor) {
    const std::string& path = editor.document.graph().path;
    return path.empty() ? "untitled" : std::filesystem::path(path).filename().string();
}

/// A document that makes something at once: a box to cut.
Graph freshGraph() {
    const Edited box = addNode({}, "", "box", {0, 0});
    Edited out = addNode(box.graph, "", "output", {260, 0});
    return connect(out.graph, "", {box.nodes.at(0), ""}, {out.nodes.at(0), "surface"});
}

void take(Editor& editor, Graph graph) {
    editor.document = Document(placeAll(graph));
    editor.boxes.reset();
    editor.drawn = 0;
    editor.canvas = Canvas();
    editor.viewport.pinned.clear();
    editor.viewport.ownCamera = false;
}

void openPath(Editor& editor, const std::string& path) {
    Result<Graph> graph = readGraph(path, nullptr);
    if (!graph) return say(editor, format(graph.error()));
    take(editor, std::move(*graph));
    Files& files = editor.files;
    addRecent(files.preferences, std::filesystem::absolute(path).string());
    if (const Done kept = savePreferences(files.preferences, preferencesPath()); !kept)
        say(editor, format(kept.error()));
}

/// Nothing is lost any more.
void doNext(Editor& editor) {
    Files& files = editor.files;
    const Next next = std::exchange(files.next, Next::none);
    if (next == Next::fresh) take(editor, freshGraph());
    if (next == Next::browse) open(files.browser, FileBrowser::Kind::open, editor.document.graph().path);
    if (next == Next::open) openPath(editor, files.nextPath);
    if (next == Next::quit) editor.quit = true;
}

bool write(Editor& editor, const std::string& path) {
    Graph graph = editor.document.graph();
    if (const Done saved = saveGraph(graph, path); !saved) return say(editor, format(saved.error())), false;
    editor.document.setPath(path);
    editor.document.markSaved();
    editor.files.recovery.discard();
    addRecent(editor.files.preferences, std::filesystem::absolute(path).string());
    if (const Done kept = savePreferences(editor.files.preferences, preferencesPath()); !kept)
        say(editor, format(kept.error()));
    else
        say(editor, "saved " + path);
    return true;
}

void showQuestion(Editor& editor) {
    Files& files = editor.files;
    if (std::exchange(files.asks, false)) ImGui::OpenPopup(kQuestion);
    if (!ImGui::BeginPopupModal(kQuestion, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    ImGui::TextUnformatted(("Save the changes of " + nameOf(editor) + " first?").c_str());
    if (ImGui::Button("Save")) {
        ImGui::CloseCurrentPopup();
        if (save(editor)) doNext(editor);  // else the file is asked for, and what is next waits
    }
    ImGui::SameLine();
    if (ImGui::Button("Discard")) {
        ImGui::CloseCurrentPopup();
        doNext(editor);
    }
    ImGui::SameLine();
    if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        ImGui::CloseCurrentPopup();
        files.next = Next::none;
    }
    ImGui::EndPopup();
}

void showOffer(Editor& editor) {
    Files& files = editor.files;
    if (files.left.empty()) return;
    if (!ImGui::IsPopupOpen(kOffer)) ImGui::OpenPopup(kOffer);
    if (!ImGui::BeginPopupModal(kOffer, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    ImGui::TextUnformatted("The editor ended before these changes were saved:");
    for (std::size_t i = 0; i < files.left.size(); ++i) {
        const LeftCopy copy = files.left[i];
        ImGui::PushID(int(i));
        ImGui::Text("%s, %s", copy.original.empty() ? "untitled" : copy.original.c_str(), copy.when.c_str());
        ImGui::SameLine();
        const bool restore = ImGui::Button("Restore");
        ImGui::SameLine();
        const bool remove = ImGui::Button("Delete");
        ImGui::PopID();
        if (restore) {
            Result<Graph> graph = readCopy(copy);
            if (!graph) {
                say(editor, format(graph.error()));
            } else {
                // As a change of what the file holds, so that it is not lost again.
                const Graph found = *graph;
                Result<Graph> before =
                    copy.original.empty() ? Result<Graph>(Graph()) : readGraph(copy.original, nullptr);
                take(editor, before ? std::move(*before) : Graph());
                editor.document.setPath(copy.original);
                editor.document.apply("Recover", found);
                removeCopy(copy);
            }
        }
        if (remove) removeCopy(copy);
        if (!restore && !remove) continue;
        files.left.erase(files.left.begin() + std::ptrdiff_t(i));
        break;
    }
    if (files.left.empty()) ImGui::CloseCurrentPopup();
    if (ImGui::Button("Later")) files.left.clear(), ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace

void startFiles(Editor& editor) {
    std::string problem;
    editor.files.preferences = readPreferences(preferencesPath(), problem);
    editor.files.left = leftCopies();
    if (!problem.empty()) editor.notice = problem, editor.noticeUntil = 1e9;
}

void showFiles(Editor& editor) {
    Files& files = editor.files;
    if (const auto path = show(files.browser, editor.shell.scale())) {
        if (files.browser.kind == FileBrowser::Kind::open)
            openPath(editor, *path);
        else if (write(editor, *path))
            doNext(editor);
    }
    showQuestion(editor);
    showOffer(editor);
    const bool unsaved = editor.document.unsaved();
    const std::string title = nameOf(editor) + (unsaved ? " * - Fieldwright" : " - Fieldwright");
    if (title != files.title) editor.shell.setTitle(files.title = title);
}

void proceed(Editor& editor, Next next, std::string path) {
    editor.files.next = next;
    editor.files.nextPath = std::move(path);
    if (editor.document.unsaved())
        editor.files.asks = true;
    else
        doNext(editor);
}

bool save(Editor& editor) {
    const std::string path = editor.document.graph().path;
    if (!path.empty()) return write(editor, path);
    saveAs(editor);
    return false;
}

void saveAs(Editor& editor) {
    open(editor.files.browser, FileBrowser::Kind::save, editor.document.graph().path);
}

}  // namespace fw::editor
