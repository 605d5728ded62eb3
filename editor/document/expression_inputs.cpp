#include "editor/document/expression_inputs.h"

#include <algorithm>

#include "editor/document/references.h"
#include "graph/document/input_value.h"
#include "graph/language/names.h"

namespace fw::editor {

namespace {

/// Why the expression can have no input of this name; of one that is renamed, also what else its code calls
/// so.
std::string nameProblem(const Node& node, std::string_view name, bool renames) {
    if (!isName(name)) return inQuotes(name) + " is no name: use letters, digits and '_', a letter first";
    if (node.input(name)) return "the expression has an input " + inQuotes(name) + " already";
    if (!renames) return language::nameRefusal("", {}, name);
    std::vector<std::string> inputs;
    for (const auto& [each, value] : node.inputs) inputs.push_back(each);
    return language::nameRefusal(node.code, language::namesOf(node.code, std::move(inputs)), name);
}

InputValue valueOf(Type type, std::vector<double> numbers) {
    numbers.resize(std::size_t(componentCount(type)), 0.0);
    return numbersValue(numbers);
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
    if (std::string problem = nameProblem(*found, name, false); !problem.empty())
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
    if (std::string problem = nameProblem(*found, name, true); !problem.empty())
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
    return language::renamed(code, language::namesOf(code, {std::string(from)}), to,
                             [](const auto& use) { return use.kind == language::NameUse::Kind::input; });
}

}  // namespace fw::editor
