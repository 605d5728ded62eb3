#include "graph/document/sockets.h"

namespace fw {

namespace {

/// The only output of an expression or a reroute, unless the library names it.
constexpr std::string_view kOnlyOutput = "value";

template <class Sockets>
std::optional<Socket> declared(const Sockets& sockets, std::string_view name) {
    const auto found = sockets.find(name);
    if (found == sockets.end()) return {};
    return Socket{found->second};
}

template <class Entries>
std::vector<std::string> namesOf(const Entries& entries) {
    std::vector<std::string> names;
    for (const auto& entry : entries) names.push_back(entry.name);
    return names;
}

/// A reroute has the type of what it is fed with, through any number of reroutes.
void resolveReroutes(Scope& scope) {
    scope.rerouteTypes.resize(scope.nodes.size());
    std::vector<char> seen(scope.nodes.size(), false);
    std::vector<uint32_t> chain;
    for (uint32_t start = 0; start < scope.nodes.size(); ++start) {
        chain.clear();
        std::optional<Type> type;
        for (uint32_t i = start; scope.types[i];) {
            if (!scope.is(i, NodeRole::reroute)) break;
            if (seen[i]) {  // resolved before, or, in a cycle, of no type
                type = scope.rerouteTypes[i];
                break;
            }
            seen[i] = true;
            chain.push_back(i);
            const InputValue* value = scope.nodes[i].input("value");
            if (!value) break;
            const Link* link = std::get_if<Link>(&value->value);
            if (!link) {
                type = typeOfValue(*value);
                break;
            }
            const auto next = scope.byId.find(link->node);
            if (next == scope.byId.end()) break;
            i = next->second;
            if (!hasKnownSockets(scope, i) || scope.is(i, NodeRole::reroute)) continue;
            if (const auto socket = outputSocket(scope, i, link->output)) type = socket->type;
        }
        for (const uint32_t i : chain) scope.rerouteTypes[i] = type;
    }
}

}  // namespace

Groups::Groups(const Graph& graph) {
    list.reserve(graph.groups.size());
    for (const Group& group : graph.groups) {
        byId.try_emplace(group.id, static_cast<uint32_t>(list.size()));
        GroupSockets& sockets = list.emplace_back(GroupSockets{&group, {}, {}});
        for (const GroupInput& input : group.inputs)
            sockets.inputs.try_emplace(input.name, typeNamed(input.type));
        for (const GroupOutput& output : group.outputs)
            sockets.outputs.try_emplace(output.name, typeNamed(output.type));
    }
}

std::optional<uint32_t> Groups::of(const Node& node) const {
    if (roleOf(node.type) != NodeRole::group) return {};
    const auto found = byId.find(node.group);
    if (found == byId.end()) return {};
    return found->second;
}

Scope::Scope(const Groups& allGroups, const std::vector<Node>& its, const GroupSockets* inGroup)
    : groups(allGroups), nodes(its), group(inGroup) {
    byId.reserve(nodes.size());
    types.reserve(nodes.size());
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        byId.try_emplace(nodes[i].id, i);
        types.push_back(findNodeType(nodes[i].type));
    }
    resolveReroutes(*this);
}

const FileKind* fileKind(const Socket& input) {
    if (input.spec) return input.spec->file;
    return input.type == Type::image ? &kPictureFile : nullptr;  // as a group declares it
}

bool hasKnownSockets(const Scope& scope, uint32_t node) {
    const NodeType* type = scope.types[node];
    if (!type) return false;
    if (type->role == NodeRole::groupInput || type->role == NodeRole::groupOutput)
        return scope.group != nullptr;
    return type->role != NodeRole::group || scope.groups.of(scope.nodes[node]).has_value();
}

std::optional<Socket> inputSocket(const Scope& scope, uint32_t node, std::string_view name) {
    const NodeType& type = *scope.types[node];
    if (type.role == NodeRole::expression) return Socket{};
    if (type.role == NodeRole::reroute && name == "value") return Socket{};
    if (type.role == NodeRole::groupOutput) return declared(scope.group->outputs, name);
    if (const auto group = scope.groups.of(scope.nodes[node]))
        return declared(scope.groups.list[*group].inputs, name);
    const int index = inputIndex(type, name);
    if (index < 0) return {};
    const InputSpec& spec = type.inputs[static_cast<std::size_t>(index)];
    return Socket{spec.type, &spec};
}

std::optional<Socket> settableSocket(const Scope& scope, uint32_t node, std::string_view name) {
    std::optional<Socket> socket = inputSocket(scope, node, name);
    if (!socket || !scope.is(node, NodeRole::expression)) return socket;
    const InputValue* value = scope.nodes[node].input(name);
    if (!value) return std::nullopt;
    socket->type = typeOfValue(*value);
    return socket;
}

std::optional<Socket> outputSocket(const Scope& scope, uint32_t node, std::string_view name) {
    const NodeType& type = *scope.types[node];
    const auto firstOr = [name](const auto& entries) {
        return name.empty() && !entries.empty() ? std::string_view(entries[0].name) : name;
    };
    if (type.role == NodeRole::groupInput)
        return declared(scope.group->inputs, firstOr(scope.group->group->inputs));
    if (const auto index = scope.groups.of(scope.nodes[node])) {
        const GroupSockets& group = scope.groups.list[*index];
        return declared(group.outputs, firstOr(group.group->outputs));
    }
    if (type.role == NodeRole::expression || type.role == NodeRole::reroute) {
        const std::string_view only =
            type.outputs.empty() ? kOnlyOutput : std::string_view(type.outputs[0].name);
        if (!name.empty() && name != only) return {};
        return type.role == NodeRole::reroute ? Socket{scope.rerouteTypes[node]} : Socket{};
    }
    for (const OutputSpec& spec : type.outputs)
        if (name.empty() || spec.name == name) return Socket{spec.type};
    return {};
}

std::vector<std::string> inputNames(const Scope& scope, uint32_t node) {
    const NodeType& type = *scope.types[node];
    if (type.role == NodeRole::reroute) return {"value"};
    if (type.role == NodeRole::groupOutput) return namesOf(scope.group->group->outputs);
    if (const auto group = scope.groups.of(scope.nodes[node]))
        return namesOf(scope.groups.list[*group].group->inputs);
    if (type.role != NodeRole::expression) return namesOf(type.inputs);
    std::vector<std::string> names;
    for (const auto& [name, value] : scope.nodes[node].inputs) names.push_back(name);
    return names;
}

std::vector<std::string> outputNames(const Scope& scope, uint32_t node) {
    const NodeType& type = *scope.types[node];
    if (type.role == NodeRole::groupInput) return namesOf(scope.group->group->inputs);
    if (const auto group = scope.groups.of(scope.nodes[node]))
        return namesOf(scope.groups.list[*group].group->outputs);
    if (type.outputs.empty() && (type.role == NodeRole::expression || type.role == NodeRole::reroute))
        return {std::string(kOnlyOutput)};
    return namesOf(type.outputs);
}

std::vector<std::string> idsOf(const Scope& scope) {
    std::vector<std::string> ids;
    ids.reserve(scope.nodes.size());
    for (const Node& node : scope.nodes) ids.push_back(node.id);
    return ids;
}

std::optional<Type> typeOfValue(const InputValue& value) {
    if (std::holds_alternative<double>(value.value)) return Type::scalar;
    const auto* numbers = std::get_if<std::vector<double>>(&value.value);
    if (!numbers || value.entry > 0) return {};
    if (numbers->size() == 2) return Type::vec2;
    if (numbers->size() == 3) return Type::vec3;
    return {};
}

}  // namespace fw
