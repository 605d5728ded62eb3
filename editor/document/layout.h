// Where nodes stand.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

// Sizes of what the canvas draws, in canvas units: a node has a title and a row for each socket, two for the
// numbers of a vector.
inline constexpr float kNodeWidth = 180.0f, kWideNodeWidth = 240.0f;
inline constexpr float kTitleHeight = 26.0f, kRowHeight = 22.0f, kFoot = 6.0f;
inline constexpr float kRerouteRadius = 7.0f;

/// Width and height that a node is drawn with, about: for what is placed before it is drawn.
Position aboutSize(const Scope& scope, uint32_t node);

/// Places for the nodes in columns from left to right along the wires, crossings kept few (Sugiyama's layers:
/// longest path, barycentres); `heights` has each node's in canvas units, in the order of `nodes`. Nodes with
/// a place in the file keep their order where that costs nothing. The middle of what moves stays where it
/// was.
Graph layOut(const Graph& graph, std::string_view scope, std::span<const std::string> nodes,
             const std::vector<double>& heights);

/// Gives a place to every node of every scope that has none, so that none covers another.
Graph placeAll(const Graph& graph);

enum class Alignment { left, middle, right, top, centre, bottom };
Graph align(const Graph& graph, std::string_view scope, std::span<const std::string> nodes, Alignment how);
/// Equal gaps between the nodes, along x (`along`) or y. The first and the last stay.
Graph distribute(const Graph& graph, std::string_view scope, std::span<const std::string> nodes, bool along);

}  // namespace fw::editor
