// Exposed parameters: inputs of the document's nodes that whoever plays the graph may change, each under a
// name. Edits as in edits.h; `index` is that of Graph::parameters.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

/// Why this input cannot be exposed: "it is linked". Empty if it can.
std::string exposureRefusal(const Graph& graph, const Plug& input);
/// The parameter that drives the input, if one does.
std::optional<std::size_t> parameterOf(const Graph& graph, const Plug& input);

/// One more parameter, named after the input and with its range. It has no exposureRefusal.
Graph exposeInput(const Graph& graph, const Plug& input);
/// Without the parameter. Tracks that moved it move the input itself from then on.
Graph removeParameter(const Graph& graph, std::size_t index);
/// Tracks of the parameter follow. Error: an empty name, one with '=', one that is taken.
Result<Graph> renameParameter(const Graph& graph, std::size_t index, std::string name);
/// None: no bound of its own. A minimum above the maximum moves the other one along.
Graph setParameterMin(const Graph& graph, std::size_t index, std::optional<double> min);
Graph setParameterMax(const Graph& graph, std::size_t index, std::optional<double> max);
/// The parameter stands at `to` afterwards.
Graph moveParameter(const Graph& graph, std::size_t index, std::size_t to);

}  // namespace fw::editor
