// Why a solid has no bounds: which of its nodes goes on without end.
//
// From the output upstream, to a surface that has no bounds either, until a node that has none though all
// surfaces that it takes have, or that takes none: a plane, a repetition without a count. Each step compiles
// the graph with another node at its output and looks for the region of that, so this is for a message alone.
#pragma once

#include <string>

#include "graph/document/graph.h"

namespace fw {

/// The id of that node, in a group as "instance/node", and its label: "'ground' (Plane)". After two dozen
/// looks, the farthest up that is known to have no bounds. Empty if nothing is connected. The graph compiles
/// to a solid that has none.
std::string endlessNode(const Graph& graph);

}  // namespace fw
