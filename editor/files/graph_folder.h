// Where a graph's own files lie.
#pragma once

#include <filesystem>
#include <string>

#include "graph/document/graph.h"

namespace fw::editor {

/// The folder of the graph's file, absolute; empty if it has none yet.
inline std::string graphFolder(const Graph& graph) {
    std::error_code error;
    return graph.path.empty() ? std::string()
                              : std::filesystem::absolute(graph.path, error).parent_path().string();
}

}  // namespace fw::editor
