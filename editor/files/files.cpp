#include "editor/files/files.h"

#include <imgui_internal.h>

#include <algorithm>
#include <filesystem>

#include "editor/document/layout.h"
#include "editor/editor.h"
#include "editor/files/arrangement.h"
#include "editor/files/graph_folder.h"
#include "editor/files/tabs.h"
#include "editor/shell/desktop_theme.h"
#include "graph/document/json.h"
#include "graph/implicit3mf/import.h"
#include "runtime/files/import_graph.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;
using Next = Files::Next;
using Origin = Files::Origin;

std::string fileName(const std::string& path) { return fs::path(path).filename().string(); }

/// A document that makes something at once: a box to cut.
Graph freshGraph() {
    const Edited box = addNode({}, "", "box", {0, 0});
    Edited out = addNode(box.graph, "", "output", {260, 0});
    return connect(out.graph, "", {box.nodes.at(0), ""}, {out.nodes.at(0), "surface"});
}

void tell(Editor& editor, std::string title, std::string text, std::vector<Error> problems = {}) {
    for (Error& problem : problems) problem.file = fileName(problem.file);
    editor.files.message = {std::move(title), std::move(text), std::move(problems)};
}

void remember(Editor& editor, const std::string& path) {
    addRecent(editor.files.preferences, path);
    keepPreferences(editor);
}

/// Brings the file's document to the front; whether it is open.
bool showIfOpen(Editor& editor, const std::string& path) {
    const auto open = tabOf(editor, path);
    if (open) showTab(editor, *open);
    return open.has_value();
}

/// Shows what was read of the file.
void adopt(Editor& editor, PartialGraph read, const std::string& text, const std::string& path) {
    Files& files = editor.files;
    take(editor, std::move(read.graph));
    files.origin = isSample(path) ? Origin::sample : read.whole ? Origin::own : Origin::partly;
    files.found = std::move(read.findings);
    files.watch.follow(path, text);
    if (files.origin != Origin::sample) remember(editor, path);
    if (!read.whole)
        tell(editor, "Not all could be read",
             "Parts of " + fileName(path) +
                 " could not be read and are left out here. The file keeps them: saving asks before it is "
                 "replaced. They stay listed under Problems.",
             files.found);
    const std::size_t missing =
        missingFiles(editor.document.graph(), graphFolder(editor.document.graph())).size();
    if (missing > 0)
        say(editor, std::to_string(missing) +
                        (missing == 1 ? " file that it names is" : " files that it names are") +
                        " missing: File, Missing files looks for what is");
}

/// A copy of the file beside it, under a name that is free.
Done keepBeside(const std::string& path) {
    std::error_code error;
    std::string copy = path + ".old";
    for (int i = 2; fs::exists(copy, error); ++i) copy = path + ".old" + std::to_string(i);
    if (fs::copy_file(path, copy, error); !error) return done();
    return Error{.message = "what it holds cannot be kept in " + copy + " (" + error.message() +
                            "): save under another name",
                 .file = path};
}

/// The folder of a graph's file, absolute.
std::string folderOf(const std::string& path) { return fs::path(absolute(path)).parent_path().string(); }

/// The graph with the files that it reads in the folder of its new file.
Graph withFiles(const Graph& graph, const std::string& path, std::vector<std::string>& told) {
    if (graph.path.empty() || sameFile(folderOf(graph.path), folderOf(path))) return graph;
    return withLinksFrom(bringFiles(graph, folderOf(graph.path), folderOf(path), told), folderOf(graph.path),
                         folderOf(path));
}

/// Where a file goes that has no name of its own yet.
std::string proposal(const Editor& editor) {
    const Files& files = editor.files;
    const std::string& path = editor.document.graph().path;
    if (path.empty() || files.origin == Origin::own) return path;
    const std::string stem = fileName(path).substr(0, fileName(path).size() - kGraphEnding.size());
    if (files.origin == Origin::partly)
        return (fs::path(path).parent_path() / (stem + "_repaired" + std::string(kGraphEnding))).string();
    return (fs::path(workFolder(editor)) / fileName(path)).string();
}

void askForName(Editor& editor) {
    editor.files.browser.endings = {std::string(kGraphEnding)};
    open(editor.files.browser, FileBrowser::Kind::save, proposal(editor));
}

/// Makes it the choice of this name, if there is one.
template <class Choice, std::size_t count>
void choose(Choice& choice, const char* const (&names)[count], std::string_view name) {
    for (std::size_t i = 0; i < count; ++i)
        if (name == names[i]) choice = Choice(i);
}

/// What another program did to the document's file.
void takeChange(Editor& editor, FileWatch::Change change) {
    if (change.gone) {
        editor.document.markUnsaved();
        say(editor, fileName(editor.document.graph().path) +
                        " is gone: another program removed or renamed it; saving makes it anew");
    } else if (editor.document.unsaved()) {
        editor.files.outside = std::move(change.text);
    } else {
        reload(editor, change.text);
    }
}

/// Makes a graph of another program's file, beside it under a name that is free, and shows that.
void openImported(Editor& editor, const std::string& path) {
    const std::string stem = (fs::path(path).parent_path() / fs::path(path).stem()).string();
    std::error_code error;
    std::string graph = stem + std::string(kGraphEnding);
    for (int i = 2; fs::exists(graph, error); ++i)
        graph = stem + "_" + std::to_string(i) + std::string(kGraphEnding);
    const Result<ImportedFiles> made = importGraph(path, graph);
    if (!made)
        return tell(editor, "This file cannot be opened", "No graph can be made of " + fileName(path) + ":",
                    {made.error()});
    openFile(editor, graph);
    if (!made->warnings.empty())
        return tell(editor, "Opened as a graph",
                    fileName(graph) + " was made of " + fileName(path) + ". What is to be known of it:",
                    made->warnings);
    say(editor, fileName(graph) + " was made of " + fileName(path));
}

/// The editor's first document where it was started for a file.
void openFirst(Editor& editor, const std::string& path) {
    std::error_code error;
    if (!fs::exists(path, error)) {
        editor.document.setPath(path);
        editor.files.watch.follow({}, {});
        return say(editor, path + " does not exist yet: saving makes it");
    }
    openFile(editor, path);
    // Where it cannot be shown at all, what is made instead goes elsewhere, but not far.
    if (editor.document.graph().path.empty())
        editor.files.browser.folder = absolute(fs::path(absolute(path)).parent_path().string());
}

}  // namespace

std::string nameOf(const Editor& editor) { return nameOf(editor.document.graph(), editor.files.origin); }

std::string nameOf(const Graph& graph, Origin origin) {
    return graph.path.empty() || origin == Origin::sample ? "untitled" : fileName(graph.path);
}

std::string stemOf(const Editor& editor) {
    const std::string name = fileName(editor.document.graph().path);
    if (name.empty()) return "untitled";
    return name.ends_with(kGraphEnding) ? name.substr(0, name.size() - kGraphEnding.size())
                                        : fs::path(name).stem().string();
}

void keepPreferences(Editor& editor) {
    if (const Done kept = savePreferences(editor.files.preferences, preferencesPath()); !kept)
        say(editor, format(kept.error()));
}

bool makesFiles(const Editor& editor) { return exports(editor) || renders(editor); }

std::string workFolder(const Editor& editor) {
    const Files& files = editor.files;
    const std::string& path = editor.document.graph().path;
    if (!path.empty() && files.origin != Origin::sample)
        return absolute(fs::path(absolute(path)).parent_path().string());
    if (!files.browser.folder.empty()) return files.browser.folder;
    if (files.preferences.recent.empty()) return absolute(".");
    return fs::path(files.preferences.recent.front()).parent_path().string();
}

void take(Editor& editor, Graph graph) {
    if (!isUntouched(editor)) openTab(editor);
    replaceDocument(editor, Document(placeAll(graph)));
}

void openFile(Editor& editor, const std::string& path) {
    if (showIfOpen(editor, path)) {
        if (editor.document.unsaved())
            return say(editor, nameOf(editor) + " is open here, with unsaved changes");
        if (std::optional<FileWatch::Change> change = editor.files.watch.lookNow())
            takeChange(editor, std::move(*change));
        return;
    }
    if (isImported(path)) return openImported(editor, path);
    const Result<std::string> text = readGraphText(path);
    PartialGraph read;
    if (text)
        read = parseWhatCanBeRead(*text, path);
    else
        read.findings = {text.error()};
    if (!read.any)
        return tell(editor, "This file cannot be opened",
                    fileName(path) + " is left as it is. What can be done about it:", read.findings);
    adopt(editor, std::move(read), *text, path);
}

void newDocument(Editor& editor) { take(editor, freshGraph()); }

void askForFile(Editor& editor) {
    const bool sample = editor.files.origin == Origin::sample;
    editor.files.browser.endings = {std::string(kGraphEnding), std::string(k3mfEnding)};
    open(editor.files.browser, FileBrowser::Kind::open, sample ? "" : editor.document.graph().path);
}

void doNext(Editor& editor) {
    Files& files = editor.files;
    switch (std::exchange(files.next, Next::none)) {
        case Next::none: break;
        case Next::drop: addDropped(editor, std::exchange(files.dropped, {})); break;
        case Next::close: closeTab(editor); break;
        case Next::quit:
            if (const auto unsaved = tabToAsk(editor)) {
                showTab(editor, *unsaved);
                files.next = Next::quit, files.asks = true;
                return;
            }
            (makesFiles(editor) ? files.asksExport : editor.quit) = true;
    }
}

bool writeFile(Editor& editor, const std::string& path) {
    Files& files = editor.files;
    const Graph graph = editor.document.graph();
    const bool another = graph.path.empty() || !sameFile(path, graph.path);
    const auto fail = [&](const Error& error) { return say(editor, format(error)), false; };
    if (files.origin == Origin::partly && sameFile(path, graph.path))
        if (const Done kept = keepBeside(path); !kept) return fail(kept.error());
    std::vector<std::string> told{"saved " + path};
    const Graph moved = withFiles(graph, path, told);
    if (const Done kept = keepVersion(path, another || files.keepsNext); !kept)
        told.push_back("no version of what was there is kept: " + format(kept.error()));
    if (const Done saved = saveGraph(moved, path); !saved) return fail(saved.error());
    editor.document.setPath(path);
    editor.document.apply("Save As", moved);
    editor.document.markSaved();
    files.origin = Origin::own;
    files.found.clear();
    files.outside.reset(), files.undecided.reset();
    files.keepsNext = false;
    files.watch.follow(path, writeGraph(moved));
    files.recovery.discard();
    say(editor, joined(told));
    remember(editor, path);
    return true;
}

bool saveTo(Editor& editor, const std::string& path) {
    Files& files = editor.files;
    if (const auto open = tabOf(editor, path); open && *open != editor.tabs.front) {
        files.next = Next::none;
        return say(editor, "nothing was saved: " + fileName(path) +
                               " is open as another document; close that, or take another name"),
               false;
    }
    const std::string& own = editor.document.graph().path;
    if (!own.empty() && sameFile(path, own) && files.origin != Origin::sample) {
        if (!files.outside) files.outside = std::exchange(files.undecided, std::nullopt);
        if (!files.outside)
            if (std::optional<FileWatch::Change> change = files.watch.lookNow(); change && !change->gone)
                files.outside = std::move(change->text);
        if (files.outside) return files.waits = path, false;
    }
    return writeFile(editor, path);
}

void reload(Editor& editor, const std::string& text) {
    Files& files = editor.files;
    files.undecided.reset();
    const std::string path = editor.document.graph().path;
    PartialGraph read = parseWhatCanBeRead(text, path);
    if (files.origin != Origin::sample || !read.whole)
        files.origin = read.whole ? Origin::own : Origin::partly;
    if (!read.any) {
        editor.document.markUnsaved();
        return tell(
            editor, "The file was changed",
            "Another program changed " + fileName(path) +
                ", and it cannot be read now. The document stays as it is here; saving asks before the "
                "file is replaced.",
            read.findings);
    }
    files.found = std::move(read.findings);
    const uint64_t before = editor.document.revision();
    editor.document.apply("Reload", placeAll(read.graph));
    editor.document.markSaved();
    if (editor.document.revision() != before)
        say(editor,
            "another program changed " + fileName(path) + ": it was loaded anew, undo takes that back");
}

void restore(Editor& editor, const Version& version) {
    const Result<std::string> text = readGraphText(version.path);
    const std::string path = editor.document.graph().path;
    PartialGraph read = text ? parseWhatCanBeRead(*text, path) : PartialGraph{};
    if (!text) read.findings = {text.error()};
    if (!read.any) return tell(editor, "This version cannot be read", "It stays where it is:", read.findings);
    editor.document.apply("Go back to " + words(version.until), placeAll(read.graph));
    editor.files.keepsNext = true;
    editor.files.found = std::move(read.findings);
    say(editor, "as it was until " + words(version.until) + ": undo takes that back, saving keeps it");
    if (!read.whole)
        tell(editor, "Not all could be read",
             "Parts of the version until " + words(version.until) +
                 " could not be read and are left out here. It stays where it is. They stay listed under "
                 "Problems.",
             editor.files.found);
}

void restore(Editor& editor, const LeftCopy& copy) {
    const Result<Graph> graph = readCopy(copy);
    if (!graph) return tell(editor, "This copy cannot be read", "It stays where it is:", {graph.error()});
    const Graph found = *graph;
    const Result<std::string> text =
        copy.original.empty() ? Result<std::string>(Error{}) : readGraphText(copy.original);
    // As a change of what the file holds, so that it is not lost again.
    PartialGraph before;
    if (text) before = parseWhatCanBeRead(*text, copy.original);
    if (showIfOpen(editor, copy.original) && !editor.document.unsaved())
        replaceDocument(editor, Document(placeAll(before.graph)));
    else
        take(editor, std::move(before.graph));
    editor.document.setPath(copy.original);
    editor.document.apply("Recover", found);
    if (text) {
        editor.files.watch.follow(copy.original, *text);
        editor.files.origin = isSample(copy.original) ? Origin::sample
                              : before.whole          ? Origin::own
                                                      : Origin::partly;
    }
    if (editor.files.recovery.keepNow(found)) removeCopy(copy);
}

void startFiles(Editor& editor, const std::string& path) {
    std::string problem;
    editor.files.preferences = readPreferences(preferencesPath(), problem);
    editor.keymap = keymapOf(editor.files.preferences);
    choose(editor.viewport.navigation, kNavigationNames, editor.files.preferences.navigation);
    choose(editor.viewport.scrolling, kScrollingNames, editor.files.preferences.scrolling);
    setTheme(themeOf(themeChoice(editor.files.preferences.theme)));
    arrange(editor, editor.files.preferences.panels);
    editor.files.left = leftCopies();
    editor.files.offers = !editor.files.left.empty();
    if (!problem.empty()) editor.notice = problem, editor.noticeUntil = 1e9;
    if (!path.empty()) openFirst(editor, path);
}

namespace {

void showPick(Editor& editor) {
    FilePick& pick = editor.files.pick;
    if (!pick.kind) return;
    ImGui::PushID("pick");
    const auto file = show(pick.browser, editor.shell.scale());
    ImGui::PopID();
    if (!file) return;
    std::vector<std::string> told;
    const Result<std::string> path = bringToDocument(editor, *file, *pick.kind, told);
    if (path)
        std::exchange(pick, {}).take(editor, *path);
    else
        told.push_back(path.error().message);
    if (!told.empty()) say(editor, joined(told));
}

void showLinking(Editor& editor) {
    Files& files = editor.files;
    ImGui::PushID("link");
    const auto path = show(files.linkBrowser, editor.shell.scale());
    ImGui::PopID();
    if (path && editor.document.graph().group(files.linking)) linkGroup(editor, files.linking, *path);
}

}  // namespace

void showFiles(Editor& editor) {
    Files& files = editor.files;
    if (const auto path = show(files.browser, editor.shell.scale())) {
        if (files.browser.kind == FileBrowser::Kind::open)
            openFile(editor, *path);
        else if (saveTo(editor, *path))
            doNext(editor);
    }
    if (const auto path = show(files.samples, editor.shell)) openFile(editor, *path);
    showPick(editor);
    showLinking(editor);
    showMissingFiles(editor);
    // Not into what a hand is doing: it waits for that to end.
    if (!editor.document.held())
        if (const std::vector<std::string> dropped = editor.shell.takeDropped(); !dropped.empty())
            drop(editor, dropped);
    const std::string& failure = editor.viewport.shown.failure;
    if (!failure.empty() && std::exchange(files.failureTold, failure) != failure) {
        const std::string kept = keepForNextTime(editor);
        tell(editor, "The preview has stopped",
             "Editing and saving go on. The next change, of the graph or of how it is looked at, begins the "
             "preview anew: if its device ran out of memory, choose fewer cells first." +
                 (kept.empty() ? "" : "\n\n" + kept),
             {{.message = failure}});
    }
    showFileDialogs(editor);
    const std::string title =
        nameOf(editor) + (editor.document.unsaved() ? " * - Fieldwright" : " - Fieldwright");
    if (title != files.title) editor.shell.setTitle(files.title = title);
}

void pickFile(Editor& editor, const FileKind& kind, const std::string& now,
              std::function<void(Editor&, const std::string& path)> take) {
    Files& files = editor.files;
    if (editor.document.graph().path.empty() || files.origin == Origin::sample) {
        say(editor, "save the document first: a graph reads files from its own folder");
        return saveAs(editor);
    }
    files.pick = {.kind = &kind, .take = std::move(take)};
    files.pick.browser.endings.assign(kind.endings.begin(), kind.endings.end());
    const fs::path there = fs::path(workFolder(editor)) / now;
    std::error_code none;
    open(files.pick.browser, FileBrowser::Kind::open,
         !now.empty() && fs::exists(there, none) ? there.string() : workFolder(editor));
}

bool watchFile(Editor& editor, FileWatch::Clock::time_point now) {
    Files& files = editor.files;
    // Not under what is being done: it waits for that to end.
    if (editor.document.held() || files.outside || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
        return false;
    bool assets = files.assets.look(editor.graph, now);
    files.missing.look(editor.graph, assets, now);
    if (assets) editor.document.outdate();
    assets = files.groups.look(editor.graph, now) || assets;
    std::optional<FileWatch::Change> change = files.watch.look(now);
    if (!change) return assets;
    takeChange(editor, std::move(*change));
    return true;
}

void copyText(Editor& editor, std::string text) {
    ImGui::SetClipboardText(text.c_str());
    editor.files.copied = std::move(text);
    editor.files.copiedFrom = editor.document.graph().path;
}

std::string pastedText(Editor& editor) {
    const char* clipboard = ImGui::GetClipboardText();
    std::string text = clipboard ? clipboard : "";
    const Files& files = editor.files;
    const std::string& path = editor.document.graph().path;
    if (text != files.copied || files.copiedFrom.empty() || path == files.copiedFrom) return text;
    const Result<Graph> nodes = parseGraph(text, files.copiedFrom, nullptr);
    if (!nodes) return text;
    const bool linked =
        std::ranges::any_of(nodes->groups, [](const Group& group) { return !group.file.empty(); });
    if (namedFiles(*nodes).empty())
        return linked ? writeGraph(withLinksFrom(*nodes, folderOf(files.copiedFrom),
                                                 path.empty() ? std::string() : folderOf(path)))
                      : text;
    if (path.empty() || files.origin == Origin::sample) {
        say(editor, "the nodes read files of " + folderOf(files.copiedFrom) +
                        ": save the document, and paste them again to have copies of these");
        return text;
    }
    std::vector<std::string> told;
    text = writeGraph(withFiles(*nodes, path, told));
    if (!told.empty()) say(editor, joined(told));
    return text;
}

void showRecent(Editor& editor) {
    const std::vector<std::string> recent = editor.files.preferences.recent;
    if (!ImGui::BeginMenu("Open recent", !recent.empty())) return;
    for (const std::string& path : recent) {
        std::error_code error;
        const bool gone = !fs::exists(path, error);
        wantGlyphs(path);
        if (ImGui::MenuItem(path.c_str(), gone ? "gone" : nullptr, false, !gone)) openFile(editor, path);
    }
    ImGui::EndMenu();
}

void proceed(Editor& editor, Next next) {
    editor.document.settle();  // what is being typed is one of the changes
    editor.files.next = next;
    forgetGivenUp(editor);
    if (editor.document.unsaved())
        editor.files.asks = true;
    else
        doNext(editor);
}

bool save(Editor& editor) {
    editor.document.settle();
    const Files& files = editor.files;
    const std::string path = editor.document.graph().path;
    if (files.origin == Origin::partly) return editor.files.asksPartly = true, false;
    if (!path.empty() && files.origin == Origin::own) return saveTo(editor, path);
    askForName(editor);
    return false;
}

void saveAs(Editor& editor) {
    editor.files.next = Next::none;
    askForName(editor);
}

std::string keepForNextTime(Editor& editor) {
    try {
        editor.document.settle();
    } catch (...) {}  // what is being typed is less than all the rest
    // Those of the documents behind were kept when another came before them.
    if (!editor.document.unsaved())
        return unsavedTab(editor) ? "The unsaved changes are offered at the next start." : "";
    const Done kept = editor.files.recovery.keepNow(editor.document.graph());
    if (!kept) return "The unsaved changes could not be kept: " + format(kept.error());
    return "The unsaved changes are kept in " + editor.files.recovery.path() +
           " and offered at the next start.";
}

}  // namespace fw::editor
