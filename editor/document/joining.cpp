#include "editor/document/joining.h"

#include <algorithm>

#include "editor/document/layout.h"
#include "editor/document/wiring.h"

namespace fw::editor {

namespace {

constexpr double kJoinedBeside = 40.0, kJoinedUnder = 20.0;  // canvas units between two nodes

/// Whether both are of one type, as far as that is known.
bool alike(const Wiring& wiring, const Plug& output, const Plug& input) {
    const std::optional<Socket> from = wiring.output(output), to = wiring.input(input);
    return !from || !to || !from->type || !to->type || from->type == to->type;
}

std::vector<Plug> outputsOf(const Wiring& wiring, std::string_view node) {
    std::vector<Plug> plugs;
    const auto index = wiring.find(node);
    if (!index || !hasKnownSockets(wiring.scope(), *index)) return plugs;
    for (std::string& name : outputNames(wiring.scope(), *index))
        plugs.push_back({std::string(node), std::move(name)});
    return plugs;
}

/// The wire that leads from a node to another.
struct Join {
    Plug output, input;
};
std::optional<Join> joinOf(const Graph& graph, std::string_view scope, std::string_view from,
                           std::string_view to) {
    const Wiring wiring(graph, scope);
    for (const Plug& output : outputsOf(wiring, from))
        if (const auto input = wiring.fittingInput(output, to); input && alike(wiring, output, *input))
            return Join{output, *input};
    return {};
}

/// The node type that makes of this the other, as a solid of particles, and needs nothing else; nullptr: none
/// does.
const NodeType* bridgeOf(std::optional<Type> from, std::optional<Type> to) {
    const auto isThing = [](Type type) {
        return type == Type::surface || type == Type::mesh || type == Type::particles;
    };
    const auto isWired = [&](const InputSpec& input) { return isThing(input.type); };
    if (!from || !to || from == to || !isThing(*from) || !isThing(*to)) return nullptr;
    for (const NodeType& type : nodeTypes())
        if (type.role == NodeRole::plain && type.outputs.size() == 1 && type.outputs[0].type == *to &&
            std::ranges::count_if(type.inputs, isWired) == 1 &&
            std::ranges::find_if(type.inputs, isWired)->type == *from)
            return &type;
    return nullptr;
}

/// What leads from a node to an input that takes nothing of it as it is.
struct Bridge {
    Plug output;
    const NodeType* type;
    Plug input;
};
std::optional<Bridge> bridgeTo(const Wiring& wiring, std::string_view from, const Plug& input) {
    const std::optional<Socket> wanted = wiring.input(input);
    if (!wanted) return {};
    for (const Plug& output : outputsOf(wiring, from)) {
        const NodeType* type = bridgeOf(wiring.output(output)->type, wanted->type);
        if (!type) continue;
        const auto direct = wiring.fittingInput(output, input.node);
        if (!direct || !alike(wiring, output, *direct)) return Bridge{output, type, input};
    }
    return {};
}

/// With the node that the bridge needs, which feeds nothing yet: its id is left in `id`.
Graph bridged(const Graph& graph, std::string_view scope, const Bridge& bridge, std::string& id) {
    Edited added = addNode(graph, scope, bridge.type->id, {});
    if (added.nodes.empty()) return graph;
    id = added.nodes[0];
    const auto entry = fittingInput(added.graph, scope, bridge.output, id);
    return entry ? connect(added.graph, scope, bridge.output, *entry) : added.graph;
}

/// All inputs that this output feeds.
std::vector<Plug> fedBy(const Graph& graph, std::string_view scope, const Plug& output) {
    std::vector<Plug> fed;
    const Wiring wiring(graph, scope);
    const bool first = outputsOf(wiring, output.node).front() == output;
    for (const Node& node : nodesOf(graph, scope))
        for (const auto& [name, value] : node.inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            if (link && link->node == output.node &&
                (link->output == output.name || (first && link->output.empty())))
                fed.push_back({node.id, name});
        }
    return fed;
}

struct Stand {
    Position at, size;
    double right() const { return at[0] + size[0]; }
};
Stand standOf(const Graph& graph, std::string_view scope, std::string_view id) {
    const Wiring wiring(graph, scope);
    const uint32_t index = *wiring.find(id);
    return {nodesOf(graph, scope)[index].at.value_or(Position{}), aboutSize(wiring.scope(), index)};
}

Graph stood(Graph graph, std::string_view scope, std::string_view id, Position at) {
    for (Node& node : nodesOf(graph, scope))
        if (node.id == id) node.at = at;
    return graph;
}

/// The place, or the next one below it where the node covers no other.
Position roomBelow(const Graph& graph, std::string_view scope, std::string_view id, Position at) {
    const Wiring wiring(graph, scope);
    const std::vector<Node>& nodes = nodesOf(graph, scope);
    const Position size = aboutSize(wiring.scope(), *wiring.find(id));
    const auto covered = [&](const Node& node) {
        if (node.id == id) return false;
        const Position place = node.at.value_or(Position{});
        const Position other = aboutSize(wiring.scope(), uint32_t(&node - nodes.data()));
        return at[0] < place[0] + other[0] && place[0] < at[0] + size[0] &&
               at[1] < place[1] + other[1] + kJoinedUnder && place[1] < at[1] + size[1] + kJoinedUnder;
    };
    // Each node is passed once at most, for the place only goes down.
    for (auto node = nodes.begin(); (node = std::ranges::find_if(nodes, covered)) != nodes.end();)
        at[1] = node->at.value_or(Position{})[1] +
                aboutSize(wiring.scope(), uint32_t(node - nodes.begin()))[1] + kJoinedUnder;
    return at;
}

/// Moves what the nodes `first` lead to, themselves too, to the right until they begin at `x`.
Graph moveOn(const Graph& graph, std::string_view scope, const NodeIds& first, std::string_view except,
             double x) {
    double by = 0.0;
    for (const std::string& id : first) by = std::max(by, x - standOf(graph, scope, id).at[0]);
    std::set<std::string> after = downstream(nodesOf(graph, scope), first);
    after.erase(std::string(except));
    return by > 0.0 ? moveNodes(graph, scope, NodeIds(after.begin(), after.end()), {by, 0.0}) : graph;
}

/// Behind `to`, in all wires from the output that it takes.
Graph joinBehind(const Graph& graph, std::string_view scope, const Join& join, const std::string& id) {
    const std::vector<Plug> fed = fedBy(graph, scope, join.output);
    Graph made = connect(graph, scope, join.output, join.input);
    NodeIds next;
    std::string last = id;  // which leads on: the node, or what makes of it what is wanted
    for (const Plug& input : fed) {
        const auto exit = fittingOutput(made, scope, id, input);
        if (exit && alike(Wiring(made, scope), *exit, input)) {
            made = connect(made, scope, *exit, input);
            next.push_back(input.node);
        } else if (const auto bridge = bridgeTo(Wiring(made, scope), id, input)) {
            if (last == id) made = bridged(made, scope, *bridge, last);
            made = connect(made, scope, {last, bridge->type->outputs[0].name}, input);
            next.push_back(input.node);
        }
    }
    const Stand from = standOf(made, scope, join.output.node);
    const Position at{from.right() + kJoinedBeside, from.at[1]};
    if (next.empty()) return stood(made, scope, id, roomBelow(made, scope, id, at));
    made = stood(made, scope, id, at);
    if (last != id)
        made = stood(made, scope, last, {standOf(made, scope, id).right() + kJoinedBeside, at[1]});
    return moveOn(made, scope, next, id, standOf(made, scope, last).right() + kJoinedBeside);
}

/// Before the input, in its wire or in place of that.
Graph joinBefore(const Graph& graph, std::string_view scope, const Join& join, const std::string& id) {
    const Link* source = Wiring(graph, scope).source(join.input);
    const std::string before = source ? source->node : std::string();
    if (!before.empty())
        if (const auto entry = joinOf(graph, scope, before, id)) {
            const Graph made =
                connect(connect(graph, scope, entry->output, entry->input), scope, join.output, join.input);
            const Stand from = standOf(made, scope, before);
            const Graph placed = stood(made, scope, id, {from.right() + kJoinedBeside, from.at[1]});
            return moveOn(placed, scope, {join.input.node}, id,
                          standOf(placed, scope, id).right() + kJoinedBeside);
        }
    const Graph made = connect(graph, scope, join.output, join.input);
    const Stand target = standOf(made, scope, join.input.node), own = standOf(made, scope, id);
    return stood(made, scope, id,
                 roomBelow(made, scope, id, {target.at[0] - kJoinedBeside - own.size[0], target.at[1]}));
}

/// Before the node, in the wire of the first input that the new one can reach by a bridge, or in place of
/// that; as it was if there is none.
std::optional<Graph> joinByBridge(const Graph& graph, std::string_view scope, const std::string& id,
                                  std::string_view to) {
    const Wiring wiring(graph, scope);
    const auto index = wiring.find(to);
    if (!index || !hasKnownSockets(wiring.scope(), *index)) return {};
    for (const std::string& name : inputNames(wiring.scope(), *index)) {
        const auto bridge = bridgeTo(wiring, id, {std::string(to), name});
        if (!bridge) continue;
        const Link* source = wiring.source(bridge->input);
        if (const auto join = source ? joinOf(graph, scope, source->node, id) : std::nullopt)
            return joinBehind(graph, scope, *join, id);
        std::string between;
        Graph made = bridged(graph, scope, *bridge, between);
        made = connect(made, scope, {between, bridge->type->outputs[0].name}, bridge->input);
        Position at = standOf(made, scope, to).at;
        for (const std::string& each : {between, id}) {
            at[0] -= kJoinedBeside + standOf(made, scope, each).size[0];
            at = roomBelow(made, scope, each, at);
            made = stood(made, scope, each, at);
        }
        return made;
    }
    return {};
}

}  // namespace

std::string joinedByItself(const Graph& graph, std::string_view scope) {
    for (const Node& node : nodesOf(graph, scope))
        if (roleOf(node.type) == (scope.empty() ? NodeRole::output : NodeRole::groupOutput)) return node.id;
    return {};
}

Edited addJoined(const Graph& graph, std::string_view scope, std::string_view type, std::string_view to,
                 std::string_view group) {
    Edited added = addNode(graph, scope, type, {}, group);
    if (added.nodes.empty() || !findNode(nodesOf(graph, scope), to)) return added;
    const std::string id = added.nodes[0];
    if (const auto join = joinOf(added.graph, scope, to, id))
        added.graph = joinBehind(added.graph, scope, *join, id);
    else if (const auto feed = joinOf(added.graph, scope, id, to))
        added.graph = joinBefore(added.graph, scope, *feed, id);
    else if (auto made = joinByBridge(added.graph, scope, id, to))
        added.graph = std::move(*made);
    else {
        const Stand from = standOf(added.graph, scope, to);
        added.graph = stood(added.graph, scope, id,
                            roomBelow(added.graph, scope, id, {from.right() + kJoinedBeside, from.at[1]}));
    }
    return added;
}

Graph joinedTo(const Graph& graph, std::string_view scope, std::span<const std::string> nodes,
               std::string_view to) {
    if (!findNode(nodesOf(graph, scope), to)) return graph;
    for (const std::string& id : nodes) {
        const std::optional<Join> join = joinOf(graph, scope, id, to);
        if (join && fedBy(graph, scope, join->output).empty())
            return connect(graph, scope, join->output, join->input);
    }
    return graph;
}

}  // namespace fw::editor
