// Nodes as text: what copying puts on the system's clipboard and what pasting reads. The text is a graph
// file's, so that a sample from a web page, a whole file or a part of one can be pasted anywhere.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

/// The nodes, the wires among them and the groups they need, as the text of a graph file.
std::string copyNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes);

/// The nodes of the text added to the scope, their middle at `at`, with fresh ids and the groups they need.
/// Takes a whole graph file, {"nodes": […]}, a list of nodes or a single node. Output nodes are left out
/// where the scope has one. Errors name the line and what was expected.
Result<Edited> pasteNodes(const Graph& graph, std::string_view scope, std::string_view text, Position at);

}  // namespace fw::editor
