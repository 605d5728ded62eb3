// What a document must obey before any of its code is compiled: unknown names, values out of range, links
// that lead nowhere or do not fit, cycles of nodes and of groups, a missing output.
#pragma once

#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

/// The findings of check() that need no compilation, at most 1,000. A graph without an Error::Severity::error
/// among them is structurally sound: every type and name exists, every value fits its input, links and groups
/// form no cycle, and groups expand to bounded depth and size.
std::vector<Error> checkStructure(const Graph& graph);

/// Whether an error, not only warnings, is among the findings.
bool hasErrors(const std::vector<Error>& findings);

}  // namespace fw
