#include "editor/document/expression_inputs.h"

#include <algorithm>
#include <cctype>

#include "editor/document/references.h"

namespace fw::editor {

namespace {

bool inName(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::string nameProblem(const Node& node, std::string_view name) {
    if (!isName(name)) return inQuotes(name) + " is no name: use letters, digits and '_', a letter first";
    return node.input(name) ? "the expression has an input " + inQuotes(name) + " already" : "";
}

InputValue valueOf(Type type, std::vector<double> numbers) {
    numbers.resize(std::size_t(componentCount(type)), 0.0);
    InputValue value;
    if (numbers.size() == 1)
        value.value = numbers[0];
    else
        value.value = std::move(numbers);
    return value;
}

Node* expression(Graph& graph, std::string_view scope, std::string_view id) {
    for (Node& node : nodesOf(graph, scope))
        if (node.id == id) return roleOf(node.type) == NodeRole::expression ? &node : nullptr;
    return nullptr;
}

}  // namespace

Result<Graph> addExpressionInput(const Graph& graph, std::string_view scope, std::string_view node,
                                 std::string_view name, Type type) {
    Graph result = graph;
    Node* found = expression(result, scope, node);
    if (!found) return graph;
    if (std::string problem = nameProblem(*found, name); !problem.empty())
        return Error{.message = std::move(problem), .node = found->id};
    if (found->inputs.size() >= kMaxSockets)
        return Error{.message = "an expression has at most " + std::to_string(kMaxSockets) + " inputs",
                     .node = found->id};
    found->set(name, valueOf(type, {}));
    return result;
}

Result<Graph> renameExpressionInput(const Graph& graph, std::string_view scope, const Plug& input,
                                    std::string_view name) {
    Graph result = graph;
    Node* found = expression(result, scope, input.node);
    if (!found || input.name == name) return graph;
    if (std::string problem = nameProblem(*found, name); !problem.empty())
        return Error{.message = std::move(problem), .node = found->id};
    for (auto& [each, value] : found->inputs)
        if (each == input.name) each = name;
    found->code = renamedInCode(found->code, input.name, name);
    if (scope.empty())
        redirect(result, [&](const Plug& plug) {
            return plug == input ? std::optional(Plug{input.node, std::string(name)}) : std::nullopt;
        });
    return result;
}

Graph setExpressionType(const Graph& graph, std::string_view scope, const Plug& input, Type type) {
    Graph result = graph;
    Node* found = expression(result, scope, input.node);
    const InputValue* value = found ? found->input(input.name) : nullptr;
    if (!value) return graph;
    std::vector<double> numbers;
    if (const auto* number = std::get_if<double>(&value->value)) numbers = {*number};
    if (const auto* list = std::get_if<std::vector<double>>(&value->value)) numbers = *list;
    found->set(input.name, valueOf(type, std::move(numbers)));
    return result;
}

std::string renamedInCode(std::string_view code, std::string_view from, std::string_view to) {
    std::string result;
    for (std::size_t at = 0; at < code.size();) {
        if (!inName(code[at])) {
            result += code[at++];
            continue;
        }
        std::size_t end = at;
        while (end < code.size() && inName(code[end])) ++end;
        const std::string_view word = code.substr(at, end - at);
        // What follows a dot is a component, unless the dot ends a number ("2.*a" has none before the name).
        const bool component = at > 0 && code[at - 1] == '.';
        result += word == from && !component ? to : word;
        at = end;
    }
    return result;
}

}  // namespace fw::editor
