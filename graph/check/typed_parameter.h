// The value of a parameter as it is typed: by --set, and in the tables of sweeps.
#pragma once

#include <string>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

/// Sets the parameter `name` (named_parameters.h) to the numbers in `text`: "1.5", "3mm" or "1,2,3", each as
/// typedNumber() has it for what the parameter moves. Errors: no such parameter (with the nearest name), what
/// is no number, or no length, out of its range.
Done setParameter(Graph& graph, const std::string& name, const std::string& text);

}  // namespace fw
