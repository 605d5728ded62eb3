#include "editor/document/wiring.h"

#include <algorithm>

#include "graph/base/words.h"

namespace fw::editor {

namespace {

/// Inputs of these types hold what is written into them; there is nothing to wire to them.
bool takesNoWire(Type type) { return type == Type::string || entrySize(type) > 0 || type == Type::image; }

const GroupSockets* socketsOf(const Groups& groups, std::string_view scope) {
    const auto found = groups.byId.find(scope);
    return scope.empty() || found == groups.byId.end() ? nullptr : &groups.list[found->second];
}

/// Whether one of the sockets of a group, in its order, has a type for which use() holds.
template <class Entries, class Use>
bool anyType(const Entries& entries, Use use) {
    return std::ranges::any_of(entries, [&](const auto& entry) { return use(typeNamed(entry.type)); });
}

}  // namespace

Wiring::Wiring(const Graph& graph, std::string_view scope)
    : groups(graph), its(groups, nodesOf(graph, scope), socketsOf(groups, scope)) {}

std::optional<uint32_t> Wiring::find(std::string_view node) const {
    const auto found = its.byId.find(node);
    return found == its.byId.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Socket> Wiring::output(const Plug& plug) const {
    const auto node = find(plug.node);
    return node && hasKnownSockets(its, *node) ? outputSocket(its, *node, plug.name) : std::nullopt;
}

std::optional<Socket> Wiring::input(const Plug& plug) const {
    const auto node = find(plug.node);
    return node && hasKnownSockets(its, *node) ? inputSocket(its, *node, plug.name) : std::nullopt;
}

const Link* Wiring::source(const Plug& plug) const {
    const auto node = find(plug.node);
    const InputValue* value = node ? its.nodes[*node].input(plug.name) : nullptr;
    return value ? std::get_if<Link>(&value->value) : nullptr;
}

Link Wiring::linkFrom(const Plug& plug) const {
    const auto node = find(plug.node);
    const bool only = node && hasKnownSockets(its, *node) && outputNames(its, *node).size() == 1;
    return {plug.node, only ? "" : plug.name};
}

std::string Wiring::mismatch(const Plug& from, const Plug& to) const {
    const auto source = find(from.node), target = find(to.node);
    if (!source) return "there is no node " + inQuotes(from.node);
    if (!target) return "there is no node " + inQuotes(to.node);
    const std::optional<Socket> socket = output(from), wanted = input(to);
    if (!socket)
        return "node " + inQuotes(from.node) +
               (from.name.empty() ? std::string(" has no output") : " has no output " + inQuotes(from.name));
    if (!socket->type && its.is(*source, NodeRole::expression) && wanted && wanted->type &&
        componentCount(*wanted->type) == 0 && !takesNoWire(*wanted->type))
        return "an expression gives no " + std::string(typeName(*wanted->type));
    return typeRefusal(socket->type, to);
}

std::string Wiring::refusal(const Plug& from, const Plug& to) const {
    const auto source = find(from.node), target = find(to.node);
    if (!source || !target || !output(from)) return mismatch(from, to);
    // Up the wires from the output: a way to the input's node would close a cycle.
    constexpr uint32_t kUnseen = ~0u;
    std::vector<uint32_t> next(its.nodes.size(), kUnseen),
        open{*source};  // the node that each was found from
    next[*source] = *source;
    while (!open.empty() && next[*target] == kUnseen) {
        const uint32_t node = open.back();
        open.pop_back();
        for (const auto& [name, value] : its.nodes[node].inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            const auto before = link ? find(link->node) : std::nullopt;
            if (!before || next[*before] != kUnseen) continue;
            next[*before] = node;
            open.push_back(*before);
        }
    }
    if (next[*target] != kUnseen) {
        std::vector<std::string_view> names{from.node};
        for (uint32_t node = *target; node != *source; node = next[node]) names.push_back(its.nodes[node].id);
        names.push_back(from.node);
        return "a cycle: " + arrows(names);
    }
    return mismatch(from, to);
}

std::set<Plug> Wiring::partners(const Plug& plug, bool plugIsOutput) const {
    std::set<Plug> found;
    const std::string ends[] = {plug.node};
    const std::set<std::string> cyclic =
        plugIsOutput ? upstream(its.nodes, ends) : downstream(its.nodes, ends);
    for (uint32_t node = 0; node < its.nodes.size(); ++node) {
        const std::string& id = its.nodes[node].id;
        if (cyclic.contains(id) || !hasKnownSockets(its, node)) continue;
        for (const std::string& name : plugIsOutput ? inputNames(its, node) : outputNames(its, node)) {
            Plug other{id, name};
            if ((plugIsOutput ? mismatch(plug, other) : mismatch(other, plug)).empty())
                found.insert(std::move(other));
        }
    }
    return found;
}

std::string Wiring::typeRefusal(std::optional<Type> from, const Plug& to) const {
    const auto node = find(to.node);
    if (!node || !hasKnownSockets(its, *node)) return "the inputs of " + inQuotes(to.node) + " are unknown";
    std::vector<uint32_t> rerouted;
    return typeRefusal(from, *node, to.name, rerouted);
}

std::string Wiring::typeRefusal(std::optional<Type> from, uint32_t node, std::string_view name,
                                std::vector<uint32_t>& rerouted) const {
    const std::optional<Socket> socket = inputSocket(its, node, name);
    if (!socket) return "node " + inQuotes(its.nodes[node].id) + " has no input " + inQuotes(name);
    if (socket->type) {
        if (takesNoWire(*socket->type))
            return "an input of type " + std::string(typeName(*socket->type)) + " takes no wire";
        if (!from || converts(*from, *socket->type)) return {};
        return std::string(typeName(*from)) + " is no " + std::string(typeName(*socket->type));
    }
    if (its.is(node, NodeRole::expression)) {
        if (!isName(name)) return inQuotes(name) + " is no name in code";
        return from && componentCount(*from) == 0 ? "code takes no " + std::string(typeName(*from)) : "";
    }
    if (!its.is(node, NodeRole::reroute) || !from) return {};
    // What a reroute passes on must suit all that it feeds.
    if (std::ranges::find(rerouted, node) != rerouted.end()) return {};
    rerouted.push_back(node);
    for (uint32_t i = 0; i < its.nodes.size(); ++i)
        for (const auto& [input, value] : its.nodes[i].inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            if (!link || find(link->node) != node || !hasKnownSockets(its, i)) continue;
            const std::string problem = typeRefusal(from, i, input, rerouted);
            if (problem.empty()) continue;
            return its.is(i, NodeRole::reroute) ? problem : problem + ", which the reroute leads to";
        }
    return {};
}

std::optional<Plug> Wiring::fittingInput(const Plug& from, std::string_view node) const {
    const auto target = find(node);
    const std::optional<Socket> given = output(from);
    if (!target || !given || !hasKnownSockets(its, *target)) return {};
    enum { freeAndSame, freeAndConverted, linkedAndSame, linkedAndConverted, none };
    int best = none;
    std::optional<Plug> chosen;
    for (const std::string& name : inputNames(its, *target)) {
        Plug plug{std::string(node), name};
        if (!refusal(from, plug).empty()) continue;
        const std::optional<Socket> socket = settableSocket(its, *target, name);
        const bool sameType = !given->type || !socket || !socket->type || socket->type == given->type;
        const int rank = (source(plug) ? linkedAndSame : freeAndSame) + (sameType ? 0 : 1);
        if (rank < best) best = rank, chosen = std::move(plug);
    }
    if (best == freeAndSame || !its.is(*target, NodeRole::expression)) return chosen;
    std::string name = "a";  // code may have one more input
    for (int i = 2; its.nodes[*target].input(name); ++i) name = "a" + std::to_string(i);
    Plug fresh{std::string(node), name};
    return refusal(from, fresh).empty() ? std::optional(fresh) : chosen;
}

std::optional<Plug> Wiring::fittingOutput(std::string_view node, const Plug& to) const {
    const auto from = find(node);
    if (!from || !hasKnownSockets(its, *from)) return {};
    const std::optional<Socket> wanted = input(to);
    std::optional<Plug> chosen;
    for (const std::string& name : outputNames(its, *from)) {
        const Plug plug{std::string(node), name};
        if (!refusal(plug, to).empty()) continue;
        const bool sameType = !wanted || !wanted->type || output(plug)->type == wanted->type;
        if (!chosen || sameType) chosen = plug;
        if (sameType) break;
    }
    return chosen;
}

bool Wiring::fits(const NodeType& type, const Plug& plug, bool plugIsOutput) const {
    if (type.role == NodeRole::group)
        return false;  // its sockets are those of a group, which the type does not tell
    const Group* group = its.group ? its.group->group : nullptr;
    if (!plugIsOutput) {
        const auto may = [&](std::optional<Type> from) { return typeRefusal(from, plug).empty(); };
        if (type.role == NodeRole::groupInput) return group && anyType(group->inputs, may);
        if (type.role == NodeRole::expression)
            return may({}) && !(input(plug) && input(plug)->type && componentCount(*input(plug)->type) == 0);
        if (type.role == NodeRole::reroute) return may({});
        return std::ranges::any_of(type.outputs, [&](const OutputSpec& spec) { return may(spec.type); });
    }
    const std::optional<Socket> from = output(plug);
    if (!from) return false;
    const auto may = [&](std::optional<Type> to) {
        return to && !takesNoWire(*to) && (!from->type || converts(*from->type, *to));
    };
    if (type.role == NodeRole::groupOutput) return group && anyType(group->outputs, may);
    if (type.role == NodeRole::expression) return !from->type || componentCount(*from->type) > 0;
    if (type.role == NodeRole::reroute) return true;
    return std::ranges::any_of(type.inputs, [&](const InputSpec& spec) { return may(spec.type); });
}

bool canAdd(const Graph& graph, std::string_view scope, const NodeType& type) {
    const bool inGroup = !scope.empty();
    if (type.role == NodeRole::groupInput) return inGroup;
    if (type.role != NodeRole::output && type.role != NodeRole::groupOutput) return true;
    if (inGroup != (type.role == NodeRole::groupOutput)) return false;
    return std::ranges::none_of(nodesOf(graph, scope),
                                [&](const Node& node) { return node.type == type.id; });
}

void unlink(Node& node, std::string_view input, std::optional<Type> fed) {
    if (roleOf(node.type) != NodeRole::expression)
        return void(std::erase_if(node.inputs, [&](const auto& entry) { return entry.first == input; }));
    const auto count = fed == Type::vec3 ? 3u : fed == Type::vec2 ? 2u : 1u;
    if (count == 1)
        node.set(input, {0.0});
    else
        node.set(input, {std::vector<double>(count, 0.0)});
}

std::string refusal(const Graph& graph, std::string_view scope, const Plug& output, const Plug& input) {
    return Wiring(graph, scope).refusal(output, input);
}

std::optional<Plug> fittingInput(const Graph& graph, std::string_view scope, const Plug& output,
                                 std::string_view node) {
    return Wiring(graph, scope).fittingInput(output, node);
}

std::optional<Plug> fittingOutput(const Graph& graph, std::string_view scope, std::string_view node,
                                  const Plug& input) {
    return Wiring(graph, scope).fittingOutput(node, input);
}

std::vector<const NodeType*> typesThatFit(const Graph& graph, std::string_view scope, const Plug& plug,
                                          bool plugIsOutput) {
    const Wiring wiring(graph, scope);
    std::vector<const NodeType*> types;
    for (const NodeType& type : nodeTypes())
        if (canAdd(graph, scope, type) && wiring.fits(type, plug, plugIsOutput)) types.push_back(&type);
    return types;
}

}  // namespace fw::editor
