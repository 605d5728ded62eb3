// Where nodes stand.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

/// Places for the nodes in columns from left to right along the wires, crossings kept few (Sugiyama's layers:
/// longest path, barycentres); `height` gives each node's height in canvas units. Nodes with a place in the
/// file keep their order where that costs nothing. The middle of what moves stays where it was.
Graph layOut(const Graph& graph, std::string_view scope, std::span<const std::string> nodes,
             const std::vector<double>& heights);

/// Gives a place to every node of every scope that has none, so that none covers another.
Graph placeAll(const Graph& graph);

enum class Alignment { left, middle, right, top, centre, bottom };
Graph align(const Graph& graph, std::string_view scope, std::span<const std::string> nodes, Alignment how);
/// Equal gaps, along x or y.
Graph distribute(const Graph& graph, std::string_view scope, std::span<const std::string> nodes, bool along);

}  // namespace fw::editor
