// What an edit made worse: for edits that bring nodes or groups from elsewhere, where the rules of the format
// are too many to go through one by one.
#pragma once

#include <optional>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw::editor {

/// The first error of checkStructure() about `next` that it does not report about `graph`. What only says
/// that something is still missing, an output or a link to a mesh, or names a file of another kind, is no
/// such error.
std::optional<Error> newError(const Graph& graph, const Graph& next);

/// How many errors of that kind there are.
std::size_t errorCount(const Graph& graph);

/// Whether `next` breaks a limit of graph.h, or has a group in itself, and `graph` did not. Costs less than
/// newError() while there are no groups.
bool outgrows(const Graph& graph, const Graph& next);

}  // namespace fw::editor
