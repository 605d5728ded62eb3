#include "editor/document/group_sockets.h"

#include <algorithm>
#include <cctype>

#include "editor/document/references.h"
#include "editor/document/wiring.h"
#include "graph/document/input_value.h"

namespace fw::editor {

namespace {

Group* groupOf(Graph& graph, std::string_view id) {
    const auto found = std::ranges::find(graph.groups, id, &Group::id);
    return found == graph.groups.end() ? nullptr : &*found;
}

/// Calls use(entries) with the list of inputs or of outputs.
template <class Its, class Use>
auto withSide(Its& group, GroupSide side, Use use) {
    return side == GroupSide::inputs ? use(group.inputs) : use(group.outputs);
}

bool has(const Group& group, GroupSide side, std::string_view name) {
    return withSide(group, side, [&](const auto& entries) {
        return std::ranges::any_of(entries, [&](const auto& entry) { return entry.name == name; });
    });
}

std::string firstOf(const Group& group, GroupSide side) {
    return withSide(group, side, [](const auto& entries) {
        return entries.empty() ? std::string() : entries.front().name;
    });
}

std::optional<Error> nameProblem(const Group& group, GroupSide side, std::string_view name) {
    if (!isName(name))
        return Error{.message = inQuotes(name) + " is no name: use letters, digits and '_', a letter first",
                     .node = group.id};
    if (has(group, side, name))
        return Error{.message = "the group has " + inQuotes(name) + " already", .node = group.id};
    return std::nullopt;
}

/// Whether the socket is an input of this node, of the scope `in`: of an instance of the group, or of its
/// end.
bool takesIn(const Node& node, std::string_view in, std::string_view group, GroupSide side) {
    return side == GroupSide::inputs ? roleOf(node.type) == NodeRole::group && node.group == group
                                     : roleOf(node.type) == NodeRole::groupOutput && in == group;
}

/// The same for outputs.
bool givesOut(const Node& node, std::string_view in, std::string_view group, GroupSide side) {
    return side == GroupSide::outputs ? roleOf(node.type) == NodeRole::group && node.group == group
                                      : roleOf(node.type) == NodeRole::groupInput && in == group;
}

/// Calls use(nodes, scope) for the document's nodes and those of every group.
template <class Use>
void forScopes(Graph& graph, Use use) {
    use(graph.nodes, std::string_view());
    for (Group& group : graph.groups) use(group.nodes, std::string_view(group.id));
}

/// Calls use(input name, value, node, scope) for every link from the side's sockets. A link without a name
/// leads from the first.
template <class Use>
void forLinks(Graph& graph, std::string_view group, GroupSide side, Use use) {
    forScopes(graph, [&](std::vector<Node>& nodes, std::string_view in) {
        std::set<std::string> sources;
        for (const Node& node : nodes)
            if (givesOut(node, in, group, side)) sources.insert(node.id);
        if (sources.empty()) return;
        for (Node& node : nodes) {
            const auto inputs = node.inputs;  // use() may take some away
            for (const auto& [name, value] : inputs)
                if (const Link* link = std::get_if<Link>(&value.value); link && sources.contains(link->node))
                    use(node, name, in);
        }
    });
}

/// Gives the links from the first socket its name, so that another may be the first.
void nameLinks(Graph& graph, std::string_view group, GroupSide side, const std::string& first) {
    forLinks(graph, group, side, [&](Node& node, const std::string& name, std::string_view) {
        for (auto& [each, value] : node.inputs)
            if (each == name)
                if (Link& link = std::get<Link>(value.value); link.output.empty()) link.output = first;
    });
}

const Link& linkOf(const Node& node, std::string_view input) {
    return std::get<Link>(node.input(input)->value);
}

/// Whether a value by itself may stand where the type is asked for.
bool isOf(const InputValue& value, Type type) { return !valueProblem(type, nullptr, value); }

/// Cuts the wires that join types which do not convert and did before.
void cutMisfits(Graph& graph, const Graph& before) {
    std::vector<std::pair<std::string, Plug>> misfits;
    const auto look = [&](std::string_view scope) {
        const Wiring now(graph, scope), then(before, scope);
        for (const Node& node : nodesOf(graph, scope))
            for (const auto& [name, value] : node.inputs) {
                const Link* link = std::get_if<Link>(&value.value);
                if (!link) continue;
                const Plug input{node.id, name}, output{link->node, link->output};
                const auto from = now.output(output), former = then.output(output);
                if (!from || !former) continue;
                if (!now.typeRefusal(from->type, input).empty() &&
                    then.typeRefusal(former->type, input).empty())
                    misfits.emplace_back(scope, input);
            }
    };
    look({});
    for (const Group& group : before.groups) look(group.id);
    for (const auto& [scope, input] : misfits) graph = disconnect(graph, scope, input);
}

}  // namespace

Result<Graph> addSocket(const Graph& graph, std::string_view group, GroupSide side, std::string_view name,
                        Type type) {
    Graph result = graph;
    Group* found = groupOf(result, group);
    if (!found) return graph;
    if (auto problem = nameProblem(*found, side, name)) return *problem;
    if (found->inputs.size() + found->outputs.size() >= kMaxSockets)
        return Error{.message = "a group has at most " + std::to_string(kMaxSockets) + " inputs and outputs",
                     .node = found->id};
    nameLinks(result, group, side, firstOf(*found, side));
    withSide(*found, side, [&](auto& entries) {
        auto& entry = entries.emplace_back();
        entry.name = name, entry.type = typeName(type);
    });
    return result;
}

Graph removeSocket(const Graph& graph, std::string_view group, GroupSide side, std::string_view name) {
    Graph result = graph;
    Group* found = groupOf(result, group);
    if (!found || !has(*found, side, name)) return graph;
    nameLinks(result, group, side, firstOf(*found, side));
    std::optional<Type> type;
    withSide(*found, side, [&](auto& entries) {
        for (const auto& entry : entries)
            if (entry.name == name) type = typeNamed(entry.type);
    });
    forLinks(result, group, side, [&](Node& node, const std::string& input, std::string_view) {
        if (linkOf(node, input).output == name) unlink(node, input, type);
    });
    forScopes(result, [&](std::vector<Node>& nodes, std::string_view in) {
        for (Node& node : nodes)
            if (takesIn(node, in, group, side))
                std::erase_if(node.inputs, [&](const auto& entry) { return entry.first == name; });
    });
    withSide(*found, side, [&](auto& entries) {
        std::erase_if(entries, [&](const auto& entry) { return entry.name == name; });
    });
    dropLost(result, graph);
    return result;
}

Result<Graph> renameSocket(const Graph& graph, std::string_view group, GroupSide side, std::string_view name,
                           std::string_view to) {
    Graph result = graph;
    Group* found = groupOf(result, group);
    if (!found || !has(*found, side, name) || name == to) return graph;
    if (auto problem = nameProblem(*found, side, to)) return *problem;
    forLinks(result, group, side, [&](Node& node, const std::string& input, std::string_view) {
        for (auto& [each, value] : node.inputs)
            if (each == input)
                if (Link& link = std::get<Link>(value.value); link.output == name) link.output = to;
    });
    std::set<std::string> instances;
    forScopes(result, [&](std::vector<Node>& nodes, std::string_view in) {
        for (Node& node : nodes) {
            if (!takesIn(node, in, group, side)) continue;
            if (in.empty()) instances.insert(node.id);
            for (auto& [each, value] : node.inputs)
                if (each == name) each = to;
        }
    });
    withSide(*found, side, [&](auto& entries) {
        for (auto& entry : entries)
            if (entry.name == name) entry.name = to;
    });
    redirect(result, [&](const Plug& plug) {
        return instances.contains(plug.node) && plug.name == name
                   ? std::optional(Plug{plug.node, std::string(to)})
                   : std::nullopt;
    });
    return result;
}

Graph setSocketType(const Graph& graph, std::string_view group, GroupSide side, std::string_view name,
                    Type type) {
    Graph result = graph;
    Group* found = groupOf(result, group);
    if (!found || !has(*found, side, name)) return graph;
    withSide(*found, side, [&](auto& entries) {
        for (auto& entry : entries)
            if (entry.name == name) entry.type = typeName(type);
    });
    for (GroupInput& input : found->inputs)
        if (side == GroupSide::inputs && input.name == name && input.value && !isOf(*input.value, type))
            input.value.reset();
    forScopes(result, [&](std::vector<Node>& nodes, std::string_view in) {
        for (Node& node : nodes)
            if (takesIn(node, in, group, side))
                std::erase_if(node.inputs, [&](const auto& entry) {
                    return entry.first == name && !std::holds_alternative<Link>(entry.second.value) &&
                           !isOf(entry.second, type);
                });
    });
    cutMisfits(result, graph);
    dropLost(result, graph);
    return result;
}

Graph moveSocket(const Graph& graph, std::string_view group, GroupSide side, std::string_view name,
                 std::size_t to) {
    Graph result = graph;
    Group* found = groupOf(result, group);
    if (!found || !has(*found, side, name)) return graph;
    nameLinks(result, group, side, firstOf(*found, side));
    withSide(*found, side, [&](auto& entries) {
        const auto at = std::ranges::find_if(entries, [&](const auto& entry) { return entry.name == name; });
        auto moved = std::move(*at);
        entries.erase(at);
        entries.insert(entries.begin() + std::ptrdiff_t(std::min(to, entries.size())), std::move(moved));
    });
    return result;
}

Graph setSocketDefault(const Graph& graph, std::string_view group, std::string_view input,
                       std::optional<InputValue> value) {
    Graph result = graph;
    if (Group* found = groupOf(result, group))
        for (GroupInput& each : found->inputs)
            if (each.name == input) each.value = value;
    return result;
}

}  // namespace fw::editor
