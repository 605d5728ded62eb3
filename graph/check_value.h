// Whether a value from a file fits the input it is given to; and the words of check()'s messages.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graph/graph.h"
#include "graph/node_type.h"

namespace fw {

/// What is wrong with `value` for an input of this type: its kind, a component out of range or not finite, a
/// word that is none of the options. `spec` adds the ranges and options of a library input; it may be null.
/// Empty if the value fits. Not for links.
std::optional<std::string> valueProblem(Type type, const InputSpec* spec, const InputValue& value);

/// What an input of this type can be given: "three numbers [x, y, z] or a link".
std::string_view expectedOf(Type type);

/// "the number 3", "an array of 2 numbers", "a link to 'ball'".
std::string describe(const InputValue& value);

/// A number for reading, six digits.
std::string shortNumber(double value);

/// "a, b, c", cut after 40.
std::string listed(const std::vector<std::string>& names);

/// "a -> b -> c -> a"; a long one is shortened in the middle.
std::string arrows(const std::vector<std::string_view>& names);

}  // namespace fw
