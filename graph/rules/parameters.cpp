#include "graph/base/words.h"
#include "graph/document/named_parameters.h"
#include "graph/rules/findings.h"

namespace fw {

namespace {

void checkParameter(const ExposedParameter& parameter, const Scope& top, Findings& findings) {
    const Place place{parameter.place, parameter.node, parameter.input};
    const std::string label = "parameter " + inQuotes(parameter.name);
    if (parameter.name.empty() || parameter.name.find('=') != std::string::npos)
        findings.error(place, label + ": a name is not empty and has no '='");
    if (parameter.min && parameter.max && !(*parameter.min <= *parameter.max))
        findings.error(place, label + ": its min " + shortNumber(*parameter.min) + " is above its max " +
                                  shortNumber(*parameter.max));
    const auto found = top.byId.find(parameter.node);
    if (found == top.byId.end()) {
        const std::string hint = findings.full() ? "" : findings.hint(parameter.node, idsOf(top));
        return findings.error(place, label + ": there is no node " + inQuotes(parameter.node) + hint);
    }
    const uint32_t i = found->second;
    if (!hasKnownSockets(top, i)) return;
    const InputValue* value = top.nodes[i].input(parameter.input);
    const std::optional<Socket> socket = settableSocket(top, i, parameter.input);
    if (!socket) {
        const std::vector<std::string> names = inputNames(top, i);
        return findings.error(
            place, label + ": node " + inQuotes(parameter.node) + " has no input " +
                       inQuotes(parameter.input) +
                       findings.hint(parameter.input, names,
                                     names.empty() ? "; it has none" : "; it has " + listed(names)));
    }
    if (value && std::holds_alternative<Link>(value->value))
        return findings.warning(place, label + " has no effect: the input is linked");
    if (socket->type && (componentCount(*socket->type) == 0 || *socket->type == Type::surface))
        return findings.error(place, label + ": an input of type " + std::string(typeName(*socket->type)) +
                                         " cannot be a parameter");
    if (const double* number = value ? std::get_if<double>(&value->value) : nullptr)
        if (*number < parameter.min.value_or(*number) || *number > parameter.max.value_or(*number))
            findings.warning(place, label + ": the input's value " + shortNumber(*number) +
                                        " is outside of the parameter's range");
}

/// A parameter node, which is a constant as well.
void checkParameter(const Node& node, Findings& findings) {
    const Place place{node.place, node.id, {}};
    const std::string name(parameterName(node));
    if (node.input("name") && (name.empty() || name.find('=') != std::string::npos))
        findings.warning(place, "nobody can change it: " +
                                    std::string(name.empty() ? "it has no name" : "its name has a '='") +
                                    ": give it one by its input 'name'");
    const auto isLinked = [&](const char* input) {
        const InputValue* value = node.input(input);
        return value && std::holds_alternative<Link>(value->value);
    };
    const std::vector<double> min = inputNumbers(node, "min"), max = inputNumbers(node, "max");
    if (!isLinked("min") && !isLinked("max") && min.size() == 1 && max.size() == 1 && min[0] > max[0])
        findings.warning(place, "its min " + shortNumber(min[0]) + " is above its max " +
                                    shortNumber(max[0]) + ": exchange them");
}

}  // namespace

void checkParameters(const Graph& graph, const Scope& top, Findings& findings) {
    std::unordered_map<std::string_view, const ExposedParameter*> byName;
    for (const ExposedParameter& parameter : graph.parameters) {
        const auto [present, added] = byName.try_emplace(parameter.name, &parameter);
        if (!added)
            findings.error({parameter.place, parameter.node, parameter.input},
                           "two parameters are named " + inQuotes(parameter.name) +
                               firstInLine(present->second->place) + ": rename one");
        checkParameter(parameter, top, findings);
    }
    std::unordered_map<std::string_view, const Node*> nodesByName;
    for (const Node& node : graph.nodes) {
        if (roleOf(node.type) != NodeRole::parameter) continue;
        checkParameter(node, findings);
        const std::string_view name = parameterName(node);
        const bool reached = std::ranges::any_of(graph.parameters, [&](const ExposedParameter& each) {
            return each.node == node.id && each.input == "value";
        });
        if (name.empty() || reached) continue;
        const bool exposed = byName.contains(name);
        if (const auto [first, added] = nodesByName.try_emplace(name, &node); exposed || !added)
            findings.warning(
                {node.place, node.id, {}},
                "nobody can change it: " +
                    std::string(exposed ? "a parameter" : "node " + inQuotes(first->second->id)) +
                    " has the name " + inQuotes(name) + " as well: rename one");
    }
}

}  // namespace fw
