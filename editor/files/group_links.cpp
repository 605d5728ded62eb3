#include "editor/files/group_links.h"

#include <algorithm>
#include <filesystem>

#include "editor/document/paths.h"
#include "editor/editor.h"
#include "editor/files/graph_folder.h"
#include "editor/files/watch.h"
#include "graph/document/json.h"
#include "runtime/system/output_file.h"

namespace fw::editor {

namespace {

namespace fs = std::filesystem;

std::string fullPath(const std::string& folder, const std::string& file) {
    std::error_code error;
    return fs::absolute(fs::path(folder) / file, error).lexically_normal().string();
}

Done writeText(const std::string& path, const std::string& text) {
    if (const Done kept = keepVersion(path, true); !kept) return kept;
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    file->write(text);
    return file->commit();
}

/// What is said of a link, at the first node that shows the group.
Error findingOf(const Graph& graph, const GroupLinks::Link& link) {
    Error finding{.message = "the group " + readable(link.group) + ": " + wordsOf(link),
                  .severity = Error::Severity::warning};
    const auto shows = [&](const std::string& scope, const std::vector<Node>& nodes) {
        const auto node = std::ranges::find(nodes, link.group, &Node::group);
        if (finding.node.empty() && node != nodes.end())
            finding.node = (scope.empty() ? "" : scope + "/") + node->id;
    };
    shows("", graph.nodes);
    for (const Group& group : graph.groups) shows(group.id, group.nodes);
    return finding;
}

const GroupLinks::Link* linkOf(Editor& editor, const std::string& group) {
    editor.files.groups.forget();  // what is done goes by what the file holds now
    editor.files.groups.look(std::make_shared<const Graph>(editor.document.graph()));
    return editor.files.groups.of(group);
}

void writeTo(Editor& editor, const std::string& group, const std::string& path, const std::string& name) {
    const Graph& graph = editor.document.graph();
    if (const Done written = writeText(path, textOfGroup(graph, group)); !written)
        return say(editor, format(written.error()));
    editor.document.apply(name, linked(graph, group, pathFrom(graphFolder(graph), path)));
    editor.files.groups.forget();
    say(editor, "wrote " + path);
}

}  // namespace

void GroupLinks::read(const std::string& path, File& file) const {
    file.digest.clear(), file.problem.clear();
    const Result<std::string> text = readGraphText(path);
    const Result<ShownGroup> shown = text ? groupShownBy(*text, path) : Result<ShownGroup>(text.error());
    if (shown)
        file.digest = digestOf(shown->graph, shown->group);
    else
        file.problem = shown.error().message;
}

bool GroupLinks::look(const std::shared_ptr<const Graph>& graph, Clock::time_point now) {
    const bool another = graph != seen;
    if (!another && std::chrono::duration<double>(now - looked).count() < kWatchSeconds) return false;
    const bool any =
        std::ranges::any_of(graph->groups, [](const Group& group) { return !group.file.empty(); });
    seen = graph, looked = now;
    if (!any) {
        files.clear();
        const bool had = !links.empty();
        links.clear(), found.clear();
        return had;
    }
    std::map<std::string, File> named;
    bool changed = another;
    for (const Group& group : graph->groups) {
        if (group.file.empty()) continue;
        const std::string path = fullPath(graphFolder(*graph), group.file);
        if (named.contains(path)) continue;
        const auto known = files.find(path);
        File file = known == files.end() ? File{fw::FileWatch(path), {}, {}} : known->second;
        if (file.watch.changed() || known == files.end()) read(path, file), changed = true;
        named.emplace(path, std::move(file));
    }
    files = std::move(named);
    if (!changed) return false;
    links.clear(), found.clear();
    for (const Group& group : graph->groups) {
        if (group.file.empty()) continue;
        Link link{.group = group.id, .path = fullPath(graphFolder(*graph), group.file), .problem = {}};
        const File& file = files.at(link.path);
        link.problem = file.problem;
        if (link.problem.empty())
            link.state = linkState(group.taken, digestOf(*graph, group.id), file.digest);
        if (!link.problem.empty() || link.state != LinkState::same) found.push_back(findingOf(*graph, link));
        links.push_back(std::move(link));
    }
    return true;
}

const GroupLinks::Link* GroupLinks::of(std::string_view group) const {
    const auto link = std::ranges::find(links, group, &Link::group);
    return link == links.end() ? nullptr : &*link;
}

std::string wordsOf(const GroupLinks::Link& link) {
    const std::string name = fs::path(link.path).filename().string();
    if (!link.problem.empty()) return "its file " + name + " cannot be used: " + link.problem;
    switch (link.state) {
        case LinkState::same: return {};
        case LinkState::fileChanged:
            return "its file " + name + " was changed: update takes what it holds now";
        case LinkState::changedHere: return "it was changed here, and its file " + name + " was not";
        case LinkState::bothChanged: return "it was changed here, and its file " + name + " elsewhere";
    }
    return {};
}

std::string pathFrom(const std::string& folder, const std::string& file) {
    if (folder.empty()) return file;
    const fs::path relative = fs::path(file).lexically_relative(folder);
    return relative.empty() ? file : relative.generic_string();
}

Graph withLinksFrom(Graph graph, const std::string& from, const std::string& to) {
    for (Group& group : graph.groups)
        if (!group.file.empty()) group.file = pathFrom(to, fullPath(from, group.file));
    return graph;
}

void updateGroup(Editor& editor, const std::string& group) {
    const GroupLinks::Link* link = linkOf(editor, group);
    if (!link) return say(editor, "the group " + readable(group) + " is linked to no file");
    const std::string path = link->path;
    const Result<std::string> text = readGraphText(path);
    const Result<ShownGroup> shown = text ? groupShownBy(*text, path) : Result<ShownGroup>(text.error());
    if (!shown) return say(editor, format(shown.error()));
    // Files that it reads lie beside its file.
    const std::string folder = graphFolder(editor.document.graph());
    std::vector<std::string> told;
    ShownGroup brought = *shown;
    if (!folder.empty())
        brought.graph = bringFiles(brought.graph, fs::path(path).parent_path().string(), folder, told);
    const Result<Graph> next = withGroupOf(editor.document.graph(), group, brought);
    if (!next) return say(editor, "cannot update the group: " + next.error().message);
    editor.document.apply("Update " + readable(group),
                          linked(*next, group, editor.document.graph().group(group)->file));
    editor.files.groups.forget();
    told.insert(told.begin(), "the group " + readable(group) + " is as " +
                                  fs::path(path).filename().string() + " has it: undo takes that back");
    say(editor, joined(told));
}

void writeGroup(Editor& editor, const std::string& group) {
    const GroupLinks::Link* link = linkOf(editor, group);
    if (!link) return say(editor, "the group " + readable(group) + " is linked to no file");
    writeTo(editor, group, std::string(link->path), "Write " + readable(group));
}

void linkGroup(Editor& editor, const std::string& group, const std::string& path) {
    const std::string& own = editor.document.graph().path;
    std::error_code error;
    if (!own.empty() && (fs::equivalent(own, path, error) || fullPath("", own) == fullPath("", path)))
        return say(editor, "this is the document's own file: give the group another");
    writeTo(editor, group, fullPath("", path), "Link " + readable(group));
}

void unlinkGroup(Editor& editor, const std::string& group) {
    editor.document.apply("Make " + readable(group) + " Local", linked(editor.document.graph(), group, {}));
}

void askToLink(Editor& editor, const std::string& group) {
    Files& files = editor.files;
    files.linking = group;
    const Group* now = editor.document.graph().group(group);
    const std::string file = now && !now->file.empty() ? now->file : group + std::string(kGraphEnding);
    open(files.linkBrowser, FileBrowser::Kind::save, (fs::path(workFolder(editor)) / file).string());
}

}  // namespace fw::editor
