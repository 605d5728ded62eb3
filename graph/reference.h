// The reference of the node library, generated from its table: docs/nodes.md and `fieldwright nodes`.
//
// docs/nodes.md is the committed output of `fieldwright nodes --markdown`; a test fails when it is not
// current.
#pragma once

#include <string>

#include "graph/node_type.h"

namespace fw {

/// The reference page: every node type by category, with its inputs, defaults, ranges and outputs.
std::string nodesMarkdown();

/// The same as one JSON object, {"nodes": [{"id", "label", "category", "doc", "inputs", "outputs", …}]}, for
/// other programs. Absent keys mean: no range on that side, no unit, nothing by default.
std::string nodesJson();

/// "exact", "exact outside", "exact inside", "a bound", "distorted by up to 1.41" or "distorted".
std::string exactnessText(const Exactness& exactness);
/// Class of the node's surface with its default settings, fed with exact surfaces; empty for nodes that make
/// no surface.
std::string exactnessText(const NodeType& type);

}  // namespace fw
