// Every finding about a document that needs no compilation of code: unknown names, values out of range, links
// that lead nowhere or do not fit, cycles of nodes and of groups, a missing output.
#pragma once

#include <vector>

#include "graph/graph.h"
#include "graph/result.h"

namespace fw {

/// All findings, errors and warnings, in the order of the document; empty if there are none. At most 1,000,
/// the last of which then says that there are more. A graph without an Error::Severity::error among them is
/// structurally sound: every type and name exists, every value fits its input, and links form no cycle.
std::vector<Error> check(const Graph& graph);

}  // namespace fw
