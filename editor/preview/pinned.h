// A graph that shows one of its nodes instead of its output.
#pragma once

#include <string_view>

#include "graph/graph.h"

namespace fw::editor {

/// The graph with its output's surface taken from the first output of this node of the document, and an
/// output node added if there is none. The graph as it is if it has no such node, or that node is an output
/// itself.
Graph showingNode(const Graph& graph, std::string_view node);

}  // namespace fw::editor
