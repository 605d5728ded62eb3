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

}  // namespace

Graph showingNode(const Graph& graph, std::string_view path) {
    const auto [scope, id] = placeOf(graph, path);
    const Node* pinned = findNode(nodesOf(graph, scope), id);
    if (!pinned || roleOf(pinned->type) == NodeRole::output || roleOf(pinned->type) == NodeRole::groupOutput)
        return graph;
    Graph shown = graph;
    InputValue link = scope.empty() ? linkTo(id) : ledOut(shown, scope, id);
    nodeOfType(shown.nodes, "output").set("surface", std::move(link));
    return shown;
}

}  // namespace fw::editor
