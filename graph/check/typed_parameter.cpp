#include "graph/check/typed_parameter.h"

#include <vector>

#include "graph/base/words.h"
#include "graph/document/named_parameters.h"
#include "graph/document/unit.h"
#include "graph/language/typed_number.h"

namespace fw {

namespace {

/// The parts between commas that stand in no brackets.
std::vector<std::string_view> partsOf(std::string_view text) {
    std::vector<std::string_view> parts;
    std::size_t begin = 0;
    int depth = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        depth += (text[at] == '(') - (text[at] == ')');
        if (text[at] != ',' || depth > 0) continue;
        parts.push_back(text.substr(begin, at - begin));
        begin = at + 1;
    }
    parts.push_back(text.substr(begin));
    return parts;
}

}  // namespace

Done setParameter(Graph& graph, const std::string& name, const std::string& text) {
    if (text.empty())
        return errorAt(graph, nullptr,
                       "the parameter " + inQuotes(name) + " is given no value: write name=value");
    const std::optional<NamedParameter> target = findParameter(graph, name);
    const Node* node = target ? graph.node(target->node) : nullptr;
    const std::string_view unit = node ? unitOfInput(*node, target->input) : "any";
    std::vector<double> numbers;
    for (const std::string_view part : partsOf(text)) {
        const Result<double> number = typedNumber(part, unit, unitOf(graph));
        if (!number)
            return errorAt(graph, nullptr,
                           inQuotes(text) + " is no value for the parameter " + inQuotes(name) + ": " +
                               (part.empty() ? "write a number, or numbers with commas between them"
                                             : number.error().message));
        numbers.push_back(*number);
    }
    Done set = setParameter(graph, name, numbers);
    if (!set && numbers.size() == 2 && node && inputNumbers(*node, target->input).size() == 1) {
        Error error = set.error();
        error.message +=
            "; the decimal sign is a point: " + std::string(text).replace(text.find(','), 1, ".");
        return error;
    }
    return set;
}

}  // namespace fw
