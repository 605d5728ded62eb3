// The files that a graph's inputs and its scene name. Which inputs these are is told by the node library
// (InputSpec::file) and by what groups declare; files that code names are not among them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "graph/base/file_kind.h"
#include "graph/document/graph.h"

namespace fw {

struct NamedFile {
    std::string path;  ///< as the graph has it; not empty
    const FileKind* kind;
    bool operator==(const NamedFile&) const = default;
};

/// Each file once, in the order in which the graph names them.
std::vector<NamedFile> namedFiles(const Graph& graph);

/// Writes what `to` gives in place of each path that is not empty.
void renameFiles(Graph& graph, const std::function<std::string(const NamedFile&)>& to);

}  // namespace fw
