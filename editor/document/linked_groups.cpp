#include "editor/document/linked_groups.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "editor/document/brought_groups.h"
#include "editor/document/group_sockets.h"
#include "editor/document/layout.h"
#include "editor/document/soundness.h"
#include "graph/base/hash.h"
#include "graph/document/json.h"

namespace fw::editor {

namespace {

Group* findGroup(Graph& graph, std::string_view id) {
    const auto found = std::ranges::find(graph.groups, id, &Group::id);
    return found == graph.groups.end() ? nullptr : &*found;
}

/// The instance of the group, the group, and the groups in it, alone.
Graph shown(const Graph& graph, std::string_view group) {
    Graph part;
    part.nodes.emplace_back();
    part.nodes[0].id = group, part.nodes[0].type = idOf(NodeRole::group), part.nodes[0].group = group;
    part.groups = groupsFor(part.nodes, graph.groups);
    return part;
}

/// Whether any node of the graph is an instance of the group.
bool isUsed(const Graph& graph, const std::string& group) {
    const auto shows = [&](const std::vector<Node>& nodes) {
        return std::ranges::find(nodes, group, &Node::group) != nodes.end();
    };
    return shows(graph.nodes) ||
           std::ranges::any_of(graph.groups, [&](const Group& each) { return shows(each.nodes); });
}

template <class Sockets>
const std::string* typeIn(const Sockets& sockets, const std::string& name) {
    const auto found = std::ranges::find_if(sockets, [&](const auto& each) { return each.name == name; });
    return found == sockets.end() ? nullptr : &found->type;
}

/// The graph without what leads to sockets of the group that it will have no more, or of another type.
template <class Sockets>
Graph fitted(Graph graph, std::string_view group, GroupSide side, const Sockets& before,
             const Sockets& after) {
    for (const auto& socket : before) {
        const std::string* type = typeIn(after, socket.name);
        if (!type)
            graph = removeSocket(graph, group, side, socket.name);
        else if (*type != socket.type && typeNamed(*type))
            graph = setSocketType(graph, group, side, socket.name, *typeNamed(*type));
    }
    return graph;
}

}  // namespace

std::string textOfGroup(const Graph& graph, std::string_view group) {
    Graph part = shown(graph, group);
    if (Group* own = findGroup(part, group)) own->file.clear(), own->taken.clear();
    part.nodes[0].at = {0.0, 0.0};
    const std::string& instance = part.nodes[0].id;
    Edited out = addNode(part, "", idOf(NodeRole::output), {260, 0});
    if (!out.nodes.empty() && refusal(out.graph, "", {instance, ""}, {out.nodes[0], "surface"}).empty())
        return writeGraph(connect(out.graph, "", {instance, ""}, {out.nodes[0], "surface"}));
    return writeGraph(part);
}

Result<ShownGroup> groupShownBy(std::string_view text, const std::string& path) {
    Result<Graph> graph = parseGraph(text, path, nullptr);
    if (!graph) return graph.error();
    for (const Node& node : graph->nodes)
        if (graph->group(node.group)) return ShownGroup{placeAll(*graph), node.group};
    return Error{.message = "shows no group: a group's file has a node that is an instance of it",
                 .file = path};
}

std::string digestOf(const Graph& graph, std::string_view group) {
    if (!graph.group(group)) return {};
    Graph part = placeAll(shown(graph, group));
    std::map<std::string, std::string> names;  // by when they are first met
    const auto name = [&](std::string& id) {
        if (!id.empty()) id = names.emplace(id, "g" + std::to_string(names.size())).first->second;
    };
    name(part.nodes[0].group);
    part.nodes[0].id = "instance";
    std::vector<Group> groups;
    for (std::size_t met = 0; met < names.size(); ++met) {
        const std::string wanted = "g" + std::to_string(met);
        const auto former =
            std::ranges::find_if(names, [&](const auto& each) { return each.second == wanted; });
        Group* found = findGroup(part, former->first);
        if (!found) continue;
        for (Node& node : found->nodes) name(node.group);
        found->file.clear(), found->taken.clear();
        groups.push_back(std::move(*found));
        groups.back().id = wanted;
    }
    part.groups = std::move(groups);
    uint64_t digest = 0;
    for (const char letter : writeGraph(part)) digest = mixed(digest, uint64_t(letter));
    char words[24];
    std::snprintf(words, sizeof words, "%016llx", static_cast<unsigned long long>(digest));
    return words;
}

Result<Graph> withGroupOf(const Graph& graph, std::string_view group, const ShownGroup& from) {
    const Group* before = graph.group(group);
    Graph source = shown(from.graph, from.group);
    const Group* there = source.group(from.group);
    if (!before || !there) return Error{.message = "there is no such group"};
    const std::vector<Group> nested = groupsFor(before->nodes, graph.groups);
    Group content = *there;
    std::erase_if(source.groups, [&](const Group& each) { return each.id == from.group; });
    source.nodes = content.nodes;  // which follow where groups in it get other names

    Graph next = fitted(graph, group, GroupSide::inputs, before->inputs, content.inputs);
    next = fitted(std::move(next), group, GroupSide::outputs, before->outputs, content.outputs);
    addGroups(source, next);
    Group& own = *findGroup(next, group);
    own.inputs = content.inputs, own.outputs = content.outputs, own.nodes = source.nodes;
    own.extra = content.extra;
    // From without to within, for a group may be used by another that goes.
    for (bool any = true; any;) {
        any = false;
        for (const Group& each : nested)
            if (each.id != group && findGroup(next, each.id) && !isUsed(next, each.id))
                any = std::erase_if(next.groups, [&](const Group& of) { return of.id == each.id; }) > 0;
    }
    if (const auto error = newError(graph, next)) return *error;
    return next;
}

Graph linked(const Graph& graph, std::string_view group, std::string file) {
    Graph next = graph;
    if (Group* own = findGroup(next, group)) {
        own->taken = file.empty() ? std::string() : digestOf(graph, group);
        own->file = std::move(file);
    }
    return next;
}

LinkState linkState(const std::string& taken, const std::string& here, const std::string& inFile) {
    if (here == inFile) return LinkState::same;
    if (here == taken) return LinkState::fileChanged;
    return inFile == taken ? LinkState::changedHere : LinkState::bothChanged;
}

}  // namespace fw::editor
