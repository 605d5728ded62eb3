// A graph that shows one of its nodes instead of its output.
#pragma once

#include <string_view>

#include "graph/document/graph.h"
#include "graph/evaluate/evaluate.h"

namespace fw::editor {

/// Where a node is looked at whose solid has no bounds, if nothing better is known; metres.
inline constexpr Box kUnbounded = {{-2, -2, -2}, {2, 2, 2}};

/// The graph with its output's surface taken from the first output of the node at `path` (paths.h), and an
/// output node added if there is none. A node in a group is seen as in the document's first instance of that
/// group, or with the defaults of the group's inputs if there is none. The graph as it is if it has no such
/// node, or that node is an output itself.
Graph showingNode(const Graph& graph, std::string_view path);

}  // namespace fw::editor
