// Graph files: JSON text to document and back.
//
// Reading judges form alone: JSON syntax, the type of every known key, the limits of graph.h. It stops at the
// first error, which names file, line and column, unless it is asked for what can be read. Whether the nodes
// make sense is for check(). A format newer than kFormatVersion is refused; an older one, and node types
// under a former name, are brought up to date.
//
// Writing is canonical: keys in a fixed order, defaults left out, numbers as short as they round-trip, a node
// on one line where it fits. So reading what was written and writing it again gives the same bytes, and a
// small edit is a small diff.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

/// What the names of graph files end with.
inline constexpr std::string_view kGraphEnding = ".field.json";

/// The document in `text` (UTF-8). `path` names it in errors and becomes Graph::path. Unknown keys are kept,
/// and each adds a warning to `warnings`, which may be null.
Result<Graph> parseGraph(std::string_view text, std::string path, std::vector<Error>* warnings);

/// What could be read of a text, and what was found in it.
struct PartialGraph {
    Graph graph;
    std::vector<Error> findings = {};  ///< errors: what was left out and why; warnings as of parseGraph
    bool whole = false;                ///< there is no error: parseGraph gives the same
    bool any = false;                  ///< the text is a graph, whatever of it was left out
};

/// As parseGraph, but leaves out what is not as it should be: the value of a key, an input, or a node, group
/// or parameter that makes no sense without what is wrong with it. Nothing is read of a text that is no JSON,
/// no graph, or of a newer format.
PartialGraph parseWhatCanBeRead(std::string_view text, std::string path);

/// The content of the file, or a little more than kMaxFileBytes of it.
Result<std::string> readGraphText(const std::string& path);

/// The document in the file at `path`.
Result<Graph> readGraph(const std::string& path, std::vector<Error>* warnings);

/// The document as the text of a file. JSON has no NaN and no infinity: NaN is written as 0, an infinity as
/// the largest number of its sign (saveGraph refuses both).
std::string writeGraph(const Graph& graph);

/// Writes the document to `path` by way of a temporary file beside it, so that a failure at any moment leaves
/// the former file whole. An existing file keeps its permissions, a symbolic link stays one.
Done saveGraph(const Graph& graph, const std::string& path);

}  // namespace fw
