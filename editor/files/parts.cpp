#include "editor/files/parts.h"

#include <algorithm>
#include <filesystem>

#include "editor/document/clipboard.h"
#include "editor/document/joining.h"
#include "editor/document/wiring.h"
#include "editor/editor.h"
#include "editor/files/graph_folder.h"
#include "graph/base/words.h"
#include "graph/document/json.h"
#include "runtime/system/output_file.h"
#include "runtime/system/user_folder.h"

namespace fw::editor {

namespace fs = std::filesystem;

std::string libraryFolder(const Preferences& preferences) {
    if (!preferences.library.empty()) return preferences.library;
    const std::string folder = userFolder("XDG_DATA_HOME", "/.local/share");
    return folder.empty() ? folder : folder + "/library";
}

std::vector<LibraryPart> listParts(const std::string& folder, std::string& problem) {
    std::vector<LibraryPart> parts;
    problem.clear();
    std::error_code error;
    if (folder.empty() || !fs::exists(folder, error)) return parts;
    fs::recursive_directory_iterator each(folder, fs::directory_options::skip_permission_denied, error);
    if (error) problem = "the library's folder cannot be read: " + error.message();
    for (; !error && each != fs::recursive_directory_iterator() && parts.size() < kMostParts;
         each.increment(error)) {
        const std::string name = each->path().filename().string();
        std::error_code none;
        if (name.starts_with('.')) {
            if (each->is_directory(none)) each.disable_recursion_pending();
            continue;
        }
        if (!lowered(name).ends_with(kGraphEnding) || !each->is_regular_file(none)) continue;
        const fs::path inside = each->path().parent_path().lexically_relative(folder);
        parts.push_back({each->path().string(), inside == "." ? std::string() : inside.generic_string(),
                         readable(name.substr(0, name.size() - kGraphEnding.size()))});
    }
    std::ranges::sort(parts, {}, [](const LibraryPart& part) {
        return std::tuple(lowered(part.folder), lowered(part.label), part.path);
    });
    return parts;
}

std::string partName(const std::string& words) {
    std::string name;
    for (const char letter : lowered(words)) {
        const bool fits = (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') || letter < 0;
        if (fits)
            name += letter;
        else if (!name.empty() && name.back() != '_')
            name += '_';
    }
    while (name.ends_with('_')) name.pop_back();
    return name.empty() ? "part" : name;
}

std::string proposedName(const Graph& graph, std::string_view scope, std::string_view active,
                         std::span<const LibraryPart> parts) {
    const Node* node = findNode(nodesOf(graph, scope), active);
    std::string words;
    if (node) {
        const bool chosen = node->id.substr(0, node->id.find_last_not_of("_0123456789") + 1) != node->type;
        words = !node->label.empty()   ? node->label
                : !node->group.empty() ? readable(node->group)
                : chosen               ? readable(node->id)
                                       : std::string();
    }
    if (words.empty() && !graph.path.empty()) {
        std::string name = fs::path(graph.path).filename().string();
        if (lowered(name).ends_with(kGraphEnding)) name.resize(name.size() - kGraphEnding.size());
        words = readable(name);
    }
    if (words.empty()) words = "Part";
    const auto taken = [&](const std::string& name) {
        return std::ranges::any_of(parts, [&](const LibraryPart& part) {
            return part.folder.empty() && partName(part.label) == partName(name);
        });
    };
    std::string free = words;
    for (int i = 2; taken(free); ++i) free = words + " " + std::to_string(i);
    return free;
}

Done keepPart(const Editor& editor, const NodeIds& nodes, const std::string& name) {
    const std::string folder = libraryFolder(editor.files.preferences);
    if (folder.empty()) return Error{.message = "there is no folder for a library: set HOME"};
    std::error_code error;
    fs::create_directories(folder, error);
    const Graph& graph = editor.document.graph();
    Result<Graph> part = parseGraph(copyNodes(graph, editor.canvas.scope, nodes), "", nullptr);
    if (!part) return part.error();
    std::vector<std::string> told;
    const std::string own = graphFolder(graph);
    if (!own.empty()) part = withLinksFrom(bringFiles(*part, own, folder, told), own, folder);
    const std::string path = (fs::path(folder) / (name + std::string(kGraphEnding))).string();
    if (const Done kept = keepVersion(path, true); !kept) return kept;
    return saveGraph(*part, path);
}

void addPart(Editor& editor, const LibraryPart& part, Position at, bool linked_, const std::string& to_) {
    Result<Graph> graph = readGraph(part.path, nullptr);
    if (!graph) return say(editor, format(graph.error()));
    const std::string from = fs::path(part.path).parent_path().string(),
                      to = graphFolder(editor.document.graph());
    std::vector<std::string> told;
    const bool reads = !namedFiles(*graph).empty();
    if (reads && (to.empty() || editor.files.origin == Files::Origin::sample)) {
        say(editor, "save the document first: the part reads files, which are copied beside it");
        return saveAs(editor);
    }
    std::string group;
    for (const Node& node : graph->nodes)
        if (linked_ && group.empty() && graph->group(node.group)) group = node.group;
    if (!group.empty()) {
        const std::string digest = digestOf(*graph, group);
        for (Group& each : graph->groups)
            if (each.id == group) each.file = part.path, each.taken = digest;
    }
    const Graph brought = withLinksFrom(to.empty() ? *graph : bringFiles(*graph, from, to, told), from, to);
    Result<Edited> pasted = pasteNodes(editor.document.graph(), editor.canvas.scope, writeGraph(brought), at);
    if (!pasted) {
        Error why = pasted.error();
        why.file = part.path, why.line = why.column = 0;  // of what is pasted, which nobody sees
        return say(editor, "cannot add the part: " + format(why));
    }
    pasted->graph = joinedTo(pasted->graph, editor.canvas.scope, pasted->nodes, to_);
    apply(editor, "Add " + part.label, std::move(*pasted));
    if (!told.empty()) say(editor, joined(told));
}

std::string shownNode(const Graph& graph) {
    const Wiring wiring(graph, "");
    std::string last;
    double right = 0.0;
    for (const Node& node : graph.nodes) {
        if (roleOf(node.type) == NodeRole::output)
            if (const InputValue* shown = node.input("surface"))
                if (const Link* link = std::get_if<Link>(&shown->value)) return link->node;
        const auto socket = wiring.output({node.id, ""});
        const double at = node.at ? (*node.at)[0] : 0.0;
        if (socket && socket->type == Type::surface && (last.empty() || at >= right))
            last = node.id, right = at;
    }
    return last;
}

}  // namespace fw::editor
