// A graph that shows one of its nodes, or several together, instead of its output.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/document/graph.h"
#include "graph/evaluate/evaluate.h"

namespace fw::editor {

/// Where a node is looked at whose solid has no bounds, if nothing better is known; metres.
inline constexpr Box kUnbounded = {{-2, -2, -2}, {2, 2, 2}};

/// What is pinned, as one text: the nodes' paths (paths.h), "ball + box". They are of one scope.
std::string pinnedTogether(std::span<const std::string> paths);
/// The paths in such a text; none in an empty one.
std::vector<std::string> pinnedNodes(std::string_view pinned);
/// Whether the node of a scope can be shown together with others: it makes a surface.
bool makesSurface(const Node& node);

/// The graph with its output's surface taken from the first output of the node at `pinned`, or the union of
/// several, and an output node added if there is none. A node in a group is seen as in the document's first
/// instance of that group, or with the defaults of the group's inputs if there is none. The graph as it is if
/// it has no such node, or that node is an output itself.
Graph showingNode(const Graph& graph, std::string_view pinned);

}  // namespace fw::editor
