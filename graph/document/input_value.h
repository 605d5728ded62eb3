// Values of inputs: those made of numbers, and whether one from a file fits the input it is given to.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "graph/document/graph.h"
#include "graph/library/node_type.h"

namespace fw {

/// One number, or the list of several, as an input holds them.
InputValue numbersValue(std::span<const double> numbers);

/// The entries of a list of this type, as an input holds them.
InputValue listValue(Type type, std::vector<double> numbers);

/// What is wrong with `value` for an input of this type: its kind, a component out of range or not finite,
/// what orderProblem() finds, a word that is none of the options. `spec` adds the ranges and options of a
/// library input; it may be null. Empty if the value fits. Not for links.
std::optional<std::string> valueProblem(Type type, const InputSpec* spec, const InputValue& value);

/// What an input of this type can be given: "three numbers [x, y, z] or a link".
std::string_view expectedOf(Type type);

/// "the number 3", "an array of 2 numbers", "a link to 'ball'".
std::string describe(const InputValue& value);

}  // namespace fw
