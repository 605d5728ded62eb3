// Every finding about a document: unknown names, values out of range, links that lead nowhere or do not fit,
// cycles of nodes and of groups, a missing output, code that does not compile.
#pragma once

#include <vector>

#include "graph/graph.h"
#include "graph/result.h"

namespace fw {

/// All findings, errors and warnings; empty if there are none. At most 1,000 of the structure, the last of
/// which then says that there are more. Code is compiled only where the structure is sound.
std::vector<Error> check(const Graph& graph);

/// The findings of check() that need no compilation. A graph without an Error::Severity::error among them is
/// structurally sound: every type and name exists, every value fits its input, links and groups form no
/// cycle, and groups expand to bounded depth and size.
std::vector<Error> checkStructure(const Graph& graph);

/// Whether an error, not only warnings, is among the findings.
bool hasErrors(const std::vector<Error>& findings);

}  // namespace fw
