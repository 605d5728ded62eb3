// The part of check() about the nodes of one scope.

#include "graph/base/words.h"
#include "graph/document/input_value.h"
#include "graph/rules/findings.h"

namespace fw {

namespace {

Place placeOf(const Scope& scope, const Node& node) {
    return {node.place, scope.group ? scope.group->group->id + "/" + node.id : node.id, {}};
}

void checkId(const Scope& scope, uint32_t i, Findings& findings) {
    const Node& node = scope.nodes[i];
    const Place place = placeOf(scope, node);
    if (!isId(node.id))
        findings.error(
            place, inQuotes(node.id) + " is no id for a node: use a-z, 0-9 and '_', beginning with a letter");
    const uint32_t first = scope.byId.at(node.id);
    if (first != i)
        findings.error(place, "two nodes have the id " + inQuotes(node.id) +
                                  firstInLine(scope.nodes[first].place) + ": rename one");
}

/// The type, and the keys that go with some types only.
void checkType(const Scope& scope, uint32_t i, Findings& findings) {
    const Node& node = scope.nodes[i];
    const Place place = placeOf(scope, node);
    if (!scope.types[i])
        return findings.error(place,
                              "unknown node type " + inQuotes(node.type) + findings.hintType(node.type));
    const std::string& type = scope.types[i]->id;
    const NodeRole role = scope.types[i]->role;
    if ((role == NodeRole::groupInput || role == NodeRole::groupOutput) && !scope.group)
        findings.error(place, "a node of type '" + type + "' belongs inside a group: remove it here");
    if (role == NodeRole::output && scope.group)
        findings.error(place, "a node of type '" + type + "' belongs outside of groups: use '" +
                                  idOf(NodeRole::groupOutput) + "' here");
    if (role == NodeRole::group && node.group.empty())
        findings.error(place, "the node does not say which group it shows: add \"group\": \"name\"");
    else if (role == NodeRole::group && !scope.groups.of(node)) {
        std::vector<std::string> ids;
        if (!findings.full())
            for (const GroupSockets& group : scope.groups.list) ids.push_back(group.group->id);
        findings.error(place, "there is no group " + inQuotes(node.group) + findings.hint(node.group, ids));
    }
    if (role == NodeRole::expression && node.code.find_first_not_of(" \t\r\n") == std::string::npos)
        findings.error(place, "the expression has no code: add \"code\": \"return length(p) - 1.0;\"");
    if (role != NodeRole::expression && !node.code.empty())
        findings.warning(place, "\"code\" has no effect on a node of type '" + type + "'");
    if (role != NodeRole::group && !node.group.empty())
        findings.warning(place, "\"group\" has no effect on a node of type '" + type + "'");
}

/// A link to an input of type `wanted`, empty if that is unknown.
void checkLink(const Scope& scope, const Place& place, std::optional<Type> wanted, const Link& link,
               Findings& findings) {
    const auto found = scope.byId.find(link.node);
    if (found == scope.byId.end()) {
        const std::string hint = findings.full() ? "" : findings.hint(link.node, idsOf(scope));
        return findings.error(
            place, "there is no node " + inQuotes(link.node) + (scope.group ? " in this group" : "") + hint);
    }
    const uint32_t source = found->second;
    if (!hasKnownSockets(scope, source)) return;
    const std::optional<Socket> from = outputSocket(scope, source, link.output);
    if (!from) {
        const std::vector<std::string> names = outputNames(scope, source);
        const std::string node = "node " + inQuotes(link.node);
        if (names.empty())
            return findings.error(
                place, node + " of type '" + scope.types[source]->id + "' has no output to link to");
        return findings.error(place, node + " has no output " + inQuotes(link.output) +
                                         findings.hint(link.output, names, "; it has " + listed(names)));
    }
    if (!wanted || !from->type || converts(*from->type, *wanted)) return;
    findings.error(place, "node " + inQuotes(link.node) + " gives " + std::string(typeName(*from->type)) +
                              " but this input takes " + std::string(typeName(*wanted)) + ": expected " +
                              std::string(expectedOf(*wanted)));
}

/// What the name of a file tells; whether it is there is seen where it is read.
void checkFile(const Place& place, const FileKind& kind, const std::string& path, Findings& findings) {
    if (path.empty() || kind.byContent || endsAs(kind, path)) return;
    Error error = wrongEnding(path, kind);
    findings.error(place, std::move(error.message), error.code);
}

void checkInput(const Scope& scope, uint32_t i, const std::string& name, const InputValue& value,
                Findings& findings) {
    Place place = placeOf(scope, scope.nodes[i]);
    place.at = value.at;
    place.input = name;
    const bool known = hasKnownSockets(scope, i);
    std::optional<Socket> socket = known ? inputSocket(scope, i, name) : Socket{};
    if (!socket) {
        const std::vector<std::string> names = inputNames(scope, i);
        findings.error(
            place,
            "unknown input of a node of type '" + scope.types[i]->id + "'" +
                findings.hint(name, names, names.empty() ? "; it has none" : "; it has " + listed(names)));
        socket = Socket{};
    }
    if (scope.is(i, NodeRole::expression) && !isName(name))
        findings.error(
            place,
            inQuotes(name) + " is no name in code: use letters, digits and '_', beginning with a letter");
    if (const Link* link = std::get_if<Link>(&value.value))
        return checkLink(scope, place, socket->type, *link, findings);
    if (socket->type) {
        if (auto problem = valueProblem(*socket->type, socket->spec, value))
            findings.error(place, std::move(*problem));
        else if (const FileKind* kind = fileKind(*socket))
            checkFile(place, *kind, std::get<std::string>(value.value), findings);
    } else if (scope.is(i, NodeRole::expression) || (scope.is(i, NodeRole::reroute) && name == "value")) {
        const std::optional<Type> type = typeOfValue(value);
        if (!type)
            findings.error(place, "expected a number, [x, y], [x, y, z] or a link, not " + describe(value));
        else if (auto problem = valueProblem(*type, nullptr, value))
            findings.error(place, std::move(*problem));
    }
}

/// Inputs that only a link can fill and that have none.
void checkUnconnected(const Scope& scope, uint32_t i, Findings& findings) {
    const Node& node = scope.nodes[i];
    const NodeType& type = *scope.types[i];
    const auto missing = [&](const std::string& name, std::optional<Type> wanted) {
        if (!wanted || node.input(name)) return;
        Place place = placeOf(scope, node);
        place.input = name;
        if (wanted == Type::surface)
            findings.warning(place, "the input is not connected: it counts as empty space");
        if (wanted == Type::mesh || wanted == Type::particles || wanted == Type::spline)
            findings.error(place,
                           "the input is not connected: link a node that gives " +
                               std::string(wanted == Type::mesh        ? "a mesh"
                                           : wanted == Type::particles ? "particles"
                                                                       : "a spline"),
                           Error::Code::unfinished);
    };
    if (type.role == NodeRole::output) {
        const bool linked = std::any_of(node.inputs.begin(), node.inputs.end(), [](const auto& input) {
            return std::holds_alternative<Link>(input.second.value);
        });
        if (!linked && !scope.group)
            findings.warning(placeOf(scope, node),
                             "nothing is connected to the output: it shows empty space");
    } else if (type.role == NodeRole::reroute) {
        if (!node.input("value"))
            findings.warning(placeOf(scope, node),
                             "nothing is connected to the reroute: what it feeds keeps its default");
    } else if (type.role == NodeRole::groupOutput) {
        for (const GroupOutput& output : scope.group->group->outputs)
            missing(output.name, typeNamed(output.type));
    } else if (const auto group = scope.groups.of(node)) {
        for (const GroupInput& input : scope.groups.list[*group].group->inputs)
            missing(input.name, typeNamed(input.type));
    } else {
        // Particles need nothing to collide with.
        const bool free = type.category == Category::particles;
        for (const InputSpec& spec : type.inputs)
            if (spec.value.kind == InputDefault::Kind::none && !(free && spec.type == Type::surface))
                missing(spec.name, spec.type);
    }
}

void checkCycles(const Scope& scope, Findings& findings) {
    Edges edges(scope.nodes.size());
    std::vector<std::vector<uint32_t>> inputs(scope.nodes.size());  // the input behind each edge
    for (uint32_t i = 0; i < scope.nodes.size(); ++i)
        for (uint32_t k = 0; k < scope.nodes[i].inputs.size(); ++k)
            if (const Link* link = std::get_if<Link>(&scope.nodes[i].inputs[k].second.value))
                if (const auto found = scope.byId.find(link->node); found != scope.byId.end()) {
                    edges[i].push_back(found->second);
                    inputs[i].push_back(k);
                }
    const auto id = [&](uint32_t i) { return std::string_view(scope.nodes[i].id); };
    walk(
        edges,
        [&](const std::vector<uint32_t>& stack, uint32_t edge) {
            const Node& node = scope.nodes[stack.back()];
            const auto& [name, value] = node.inputs[inputs[stack.back()][edge]];
            Place place = placeOf(scope, node);
            place.at = value.at;
            place.input = name;
            std::vector<std::string_view> names;
            if (!findings.full()) names = cycleNames(stack, edges[stack.back()][edge], id);
            std::reverse(names.begin(),
                         names.end());  // the walk goes to the sources, a reader along the wires
            findings.error(place, "the nodes form a cycle: " + arrows(names) + "; remove one of these links");
        },
        [](uint32_t) {});
}

}  // namespace

void checkNodes(const Scope& scope, Findings& findings) {
    for (uint32_t i = 0; i < scope.nodes.size(); ++i) {
        checkId(scope, i, findings);
        checkType(scope, i, findings);
        for (const auto& [name, value] : scope.nodes[i].inputs) checkInput(scope, i, name, value, findings);
        if (hasKnownSockets(scope, i) && !scope.nodes[i].muted) checkUnconnected(scope, i, findings);
    }
    checkCycles(scope, findings);
}

void checkEnds(const Scope& scope, Findings& findings) {
    const NodeRole role = scope.group ? NodeRole::groupOutput : NodeRole::output;
    const std::string& type = idOf(role);
    const Node* first = nullptr;
    for (uint32_t i = 0; i < scope.nodes.size(); ++i) {
        if (!scope.is(i, role)) continue;
        if (first)
            findings.error(placeOf(scope, scope.nodes[i]),
                           std::string("a ") + (scope.group ? "group" : "graph") + " has one node of type '" +
                               type + "', and " + inQuotes(first->id) + " is one already: remove this one");
        else
            first = &scope.nodes[i];
    }
    if (first) return;
    if (!scope.group)
        findings.error(
            {},
            "the graph has no node of type 'output': add one and link its input \"surface\" to what is "
            "to be seen",
            Error::Code::unfinished);
    else if (!scope.group->group->outputs.empty())
        findings.error({scope.group->group->place, scope.group->group->id, {}},
                       "the group has outputs but no node of type 'group_output': add one",
                       Error::Code::unfinished);
}

}  // namespace fw
