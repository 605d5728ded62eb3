#include "editor/document/paths.h"

#include <algorithm>

#include "editor/document/wiring.h"

namespace fw::editor {

namespace {

/// Appends what stands before the ids of the group's nodes, `within` the groups entered so far.
void addPrefixes(const Graph& graph, std::string_view wanted, std::string_view scope,
                 const std::string& prefix, std::vector<std::string_view>& within,
                 std::vector<std::string>& prefixes) {
    if (scope == wanted) return prefixes.push_back(prefix);
    within.push_back(scope);
    for (const Node& node : nodesOf(graph, scope))
        if (!node.group.empty() && graph.group(node.group) &&
            std::ranges::find(within, std::string_view(node.group)) == within.end())
            addPrefixes(graph, wanted, node.group, prefix + node.id + "/", within, prefixes);
    within.pop_back();
}

}  // namespace

std::pair<std::string, std::string> placeOf(const Graph& graph, std::string_view path) {
    std::string scope;
    for (std::size_t slash = path.find('/'); slash != std::string_view::npos; slash = path.find('/')) {
        const std::string_view part = path.substr(0, slash);
        const Node* instance = findNode(nodesOf(graph, scope), part);
        if (instance && graph.group(instance->group))
            scope = instance->group;
        else if (graph.group(part))
            scope = part;
        path.remove_prefix(slash + 1);
    }
    return {std::move(scope), std::string(path)};
}

std::vector<std::string> instancesOf(const Graph& graph, std::string_view scope, std::string_view node) {
    std::vector<std::string> paths;
    std::vector<std::string_view> within;
    addPrefixes(graph, scope, "", "", within, paths);
    for (std::string& path : paths) path += node;
    return paths;
}

}  // namespace fw::editor
