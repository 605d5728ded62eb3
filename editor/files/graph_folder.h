// Where a graph's file and its own files lie.
#pragma once

#include <filesystem>
#include <string>

#include "graph/document/graph.h"

namespace fw::editor {

inline std::string absolute(const std::string& path) {
    std::error_code error;
    return std::filesystem::absolute(path, error).lexically_normal().string();
}

/// Whether both lead to one file, which need not exist.
inline bool sameFile(const std::string& a, const std::string& b) {
    std::error_code error;
    return absolute(a) == absolute(b) || std::filesystem::equivalent(a, b, error);
}

/// The folder of the graph's file, absolute; empty if it has none yet.
inline std::string graphFolder(const Graph& graph) {
    std::error_code error;
    return graph.path.empty() ? std::string()
                              : std::filesystem::absolute(graph.path, error).parent_path().string();
}

}  // namespace fw::editor
