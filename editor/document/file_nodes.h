// Nodes for files from the desktop. Which node a file is for is told by the node library: the first that has
// an input which takes files of that ending.
#pragma once

#include "editor/document/edits.h"
#include "graph/library/node_type.h"

namespace fw::editor {

/// An input of the library that names a file.
struct FileInput {
    const NodeType* type;
    const InputSpec* input;
};

/// The first that takes files that end as this one; nothing if none does.
std::optional<FileInput> fileInputFor(std::string_view path);

/// What files there are inputs for, each kind once, in the library's order.
std::vector<const FileKind*> fileKindsOfNodes();

/// For each path, of which each has a fileInputFor(), its node, the first one's at `at`, the others below it;
/// where that makes no surface by itself, wired to one that makes a surface of it. An output of the document
/// that shows nothing yet shows the first. Those that fit into the graph (limits of graph.h).
Edited addFileNodes(const Graph& graph, std::string_view scope, std::span<const std::string> paths,
                    Position at);

/// How many nodes they are.
std::size_t fileNodeCount(std::span<const std::string> paths);
/// Width and height that they have on the canvas, about.
Position sizeOfFileNodes(std::span<const std::string> paths);

}  // namespace fw::editor
