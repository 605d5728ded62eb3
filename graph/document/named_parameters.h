// The numbers of a document that whoever plays it may change, by their names.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

/// A parameter that whoever plays the graph may change: an exposed one, or a node of type parameter.
struct NamedParameter {
    std::string name;
    std::string node, input;
    double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
};

/// The name that a node of type parameter gives its input "value"; empty for any other node.
std::string_view parameterName(const Node& node);

/// All of them, the exposed ones first; of two with one name the first counts.
std::vector<NamedParameter> namedParameters(const Graph& graph);

/// The one with this name.
std::optional<NamedParameter> findParameter(const Graph& graph, std::string_view name);

/// The number or numbers that a node gives for an input, else its default; empty if there are none.
std::vector<double> inputNumbers(const Node& node, std::string_view input);

/// In what these are, as InputSpec::unit; "any" of an input that the table does not have: a group's, code's.
std::string_view unitOfInput(const Node& node, std::string_view input);

/// Sets the parameter `name` to the numbers. Errors: no such parameter (with the nearest name), another count
/// of numbers than it has, out of its range. (As a text: check/typed_parameter.h.)
Done setParameter(Graph& graph, const std::string& name, std::span<const double> numbers);

}  // namespace fw
