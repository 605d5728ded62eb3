// Nodes for meshes that come from files.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

/// For each path a mesh_file and, wired to it, a mesh_to_field: the first pair at `at`, the others below it.
/// An output of the document that shows nothing yet shows the first. Those that fit into the graph (limits of
/// graph.h).
Edited addMeshes(const Graph& graph, std::string_view scope, std::span<const std::string> paths, Position at);

/// Width and height that so many pairs have on the canvas, about.
Position sizeOfMeshPairs(std::size_t count);

}  // namespace fw::editor
