#include "editor/preview/pinned.h"

#include <algorithm>

#include "editor/document/edits.h"
#include "editor/document/paths.h"

namespace fw::editor {

namespace {

/// The node of this type among those, added if there is none.
Node& nodeOfType(std::vector<Node>& nodes, const char* type) {
    const auto found = std::ranges::find(nodes, type, &Node::type);
    if (found != nodes.end()) return found->muted = false, *found;
    Node added;
    added.id = freshId(nodes, type);
    added.type = type;
    return nodes.emplace_back(std::move(added));
}

InputValue linkTo(std::string node, std::string output = {}) {
    InputValue link;
    link.value = Link{std::move(node), std::move(output)};
    return link;
}

/// Leads the node out of its group; the link to it from outside.
InputValue ledOut(Graph& graph, const std::string& scope, const std::string& id) {
    Group& group = *std::ranges::find(graph.groups, scope, &Group::id);
    auto output = std::ranges::find(group.outputs, typeName(Type::surface), &GroupOutput::type);
    if (output == group.outputs.end()) {
        GroupOutput added;
        added.name = "surface", added.type = typeName(Type::surface);
        while (std::ranges::find(group.outputs, added.name, &GroupOutput::name) != group.outputs.end())
            added.name += "_";
        output = group.outputs.insert(group.outputs.end(), std::move(added));
    }
    nodeOfType(group.nodes, "group_output").set(output->name, linkTo(id));
    auto instance = std::ranges::find(graph.nodes, scope, &Node::group);
    if (instance == graph.nodes.end()) {
        Node added;
        added.id = freshId(graph.nodes, scope);
        added.type = "group", added.group = scope;
        instance = graph.nodes.insert(graph.nodes.end(), std::move(added));
    }
    instance->muted = false;
    return linkTo(instance->id, output->name);
}

constexpr std::string_view kPlus = " + ";  // between paths, which have none of these letters

/// The graph with the union of those nodes of the scope, and that one's id.
std::pair<Graph, std::string> withUnion(const Graph& graph, const std::string& scope, const NodeIds& ids) {
    Graph joined = graph;
    std::vector<Node>& nodes =
        scope.empty() ? joined.nodes : std::ranges::find(joined.groups, scope, &Group::id)->nodes;
    std::string last = ids[0];
    for (std::size_t i = 1; i < ids.size(); ++i) {
        Node both;
        both.id = freshId(nodes, "shown"), both.type = "union";
        both.set("a", linkTo(last)), both.set("b", linkTo(ids[i]));
        last = both.id;
        nodes.push_back(std::move(both));
    }
    return {std::move(joined), std::move(last)};
}

Graph showingOne(const Graph& graph, std::string_view path) {
    const auto [scope, id] = placeOf(graph, path);
    const Node* pinned = findNode(nodesOf(graph, scope), id);
    if (!pinned || roleOf(pinned->type) == NodeRole::output || roleOf(pinned->type) == NodeRole::groupOutput)
        return graph;
    Graph shown = graph;
    InputValue link = scope.empty() ? linkTo(id) : ledOut(shown, scope, id);
    nodeOfType(shown.nodes, "output").set("surface", std::move(link));
    return shown;
}

}  // namespace

std::string pinnedTogether(std::span<const std::string> paths) {
    std::string all;
    for (const std::string& path : paths) all += (all.empty() ? "" : std::string(kPlus)) + path;
    return all;
}

std::vector<std::string> pinnedNodes(std::string_view pinned) {
    std::vector<std::string> paths;
    while (!pinned.empty()) {
        const std::size_t plus = pinned.find(kPlus);
        paths.emplace_back(pinned.substr(0, plus));
        pinned.remove_prefix(plus == std::string_view::npos ? pinned.size() : plus + kPlus.size());
    }
    return paths;
}

bool makesSurface(const Node& node) {
    const NodeType* type = findNodeType(node.type);
    return type && !type->outputs.empty() && type->outputs.front().type == Type::surface;
}

Graph showingNode(const Graph& graph, std::string_view pinned) {
    const std::vector<std::string> paths = pinnedNodes(pinned);
    if (paths.size() < 2) return showingOne(graph, pinned);
    const std::string scope = placeOf(graph, paths[0]).first;
    NodeIds ids;
    for (const std::string& path : paths)
        if (const auto [of, id] = placeOf(graph, path); of == scope && findNode(nodesOf(graph, scope), id))
            ids.push_back(id);
    if (ids.empty()) return graph;
    const auto [joined, last] = withUnion(graph, scope, ids);
    return showingOne(joined, paths[0].substr(0, paths[0].rfind('/') + 1) + last);
}

}  // namespace fw::editor
