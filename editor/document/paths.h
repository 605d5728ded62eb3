// Paths of nodes, as findings and live inputs name them: the node's id, before it what leads into the groups
// that it stands in, "tower/window". The document's findings name a group, whose nodes every instance
// shares; the compiler names the instances, each of which has nodes of its own.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "graph/document/graph.h"

namespace fw::editor {

/// The scope (a group's id; empty: the document) and the node that a path of either kind names.
std::pair<std::string, std::string> placeOf(const Graph& graph, std::string_view path);
/// What the compiler calls a node of the scope, or an input "node.input" of one: a path for every instance,
/// none if the group has none. Groups that hold themselves are left out.
std::vector<std::string> instancesOf(const Graph& graph, std::string_view scope, std::string_view node);

}  // namespace fw::editor
