#include "graph/document/named_parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "graph/base/words.h"
#include "graph/document/input_value.h"
#include "graph/library/node_type.h"

namespace fw {

std::vector<double> inputNumbers(const Node& node, std::string_view input) {
    const InputValue* value = node.input(input);
    if (value) {
        if (const auto* number = std::get_if<double>(&value->value)) return {*number};
        if (const auto* numbers = std::get_if<std::vector<double>>(&value->value)) return *numbers;
    }
    const NodeType* type = findNodeType(node.type);
    const int index = type ? inputIndex(*type, input) : -1;
    return index < 0 ? std::vector<double>{} : type->inputs[index].value.numbers;
}

std::string_view unitOfInput(const Node& node, std::string_view input) {
    const NodeType* type = findNodeType(node.type);
    const int index = type ? inputIndex(*type, input) : -1;
    return index < 0 ? std::string_view("any") : type->inputs[std::size_t(index)].unit;
}

namespace {

/// The number with as few digits as name it.
std::string shortest(double number) {
    char digits[32];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

NamedParameter named(const ExposedParameter& parameter) {
    NamedParameter result{parameter.name, parameter.node, parameter.input};
    result.min = parameter.min.value_or(result.min), result.max = parameter.max.value_or(result.max);
    return result;
}

NamedParameter named(const Node& node) {
    NamedParameter result{std::string(parameterName(node)), node.id, "value"};
    if (const auto least = inputNumbers(node, "min"); !least.empty()) result.min = least[0];
    if (const auto most = inputNumbers(node, "max"); !most.empty()) result.max = most[0];
    return result;
}

}  // namespace

std::string_view parameterName(const Node& node) {
    const InputValue* name = roleOf(node.type) == NodeRole::parameter ? node.input("name") : nullptr;
    const std::string* text = name ? std::get_if<std::string>(&name->value) : nullptr;
    return text ? std::string_view(*text) : std::string_view();
}

std::vector<NamedParameter> namedParameters(const Graph& graph) {
    std::vector<NamedParameter> list;
    for (const ExposedParameter& parameter : graph.parameters) list.push_back(named(parameter));
    for (const Node& node : graph.nodes)
        if (!parameterName(node).empty()) list.push_back(named(node));
    return list;
}

std::optional<NamedParameter> findParameter(const Graph& graph, std::string_view name) {
    for (const ExposedParameter& parameter : graph.parameters)
        if (parameter.name == name) return named(parameter);
    for (const Node& node : graph.nodes)
        if (!name.empty() && parameterName(node) == name) return named(node);
    return std::nullopt;
}

Done setParameter(Graph& graph, const std::string& name, std::span<const double> numbers) {
    const std::optional<NamedParameter> target = findParameter(graph, name);
    Node* const node = target ? graph.node(target->node) : nullptr;
    if (!node) {
        std::vector<std::string> names;
        for (const NamedParameter& parameter : namedParameters(graph)) names.push_back(parameter.name);
        const std::string near = nearestName(name, names);
        return errorAt(graph, nullptr,
                       "the graph has no parameter " + inQuotes(name) +
                           (!near.empty()   ? ": did you mean " + inQuotes(near) + "?"
                            : names.empty() ? ": it exposes none"
                                            : ": it has " + listed(names)));
    }
    const std::size_t count = inputNumbers(*node, target->input).size();
    if (count > 0 && count != numbers.size())
        return errorAt(graph, node,
                       "the parameter " + inQuotes(name) + " takes " +
                           (count == 1 ? "one number" : std::to_string(count) + " numbers") + ", not " +
                           std::to_string(numbers.size()));
    for (double number : numbers)
        if (number < target->min || number > target->max)
            return errorAt(graph, node,
                           "the parameter " + inQuotes(name) + " takes values from " + shortest(target->min) +
                               " to " + shortest(target->max));
    node->set(target->input, numbersValue(numbers));
    return done();
}

}  // namespace fw
