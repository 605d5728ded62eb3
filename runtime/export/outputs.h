// Outputs that would replace what the work reads, or each other, or that cannot be written are refused before
// any of it is done, whatever their names look like: links and other paths to the same file are seen through.
#pragma once

#include <string>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

/// Refuses outputs that would replace the graph or each other.
Done checkDistinct(const std::string& graph, const std::vector<std::string>& outputs);

/// The files that the graph names, and those that these name in turn (buffers of a glTF, materials of an
/// OBJ), of those that are there.
std::vector<std::string> filesRead(const Graph& graph);

/// Refuses outputs that would replace one of these files.
Done checkReplacesNone(const std::vector<std::string>& read, const std::vector<std::string>& outputs);

/// Refuses outputs that cannot be created where they are wanted, as OutputFile::open().
Done checkCanBeWritten(const std::vector<std::string>& outputs);

}  // namespace fw
