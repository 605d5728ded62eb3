// The reference of the node library, generated from its table: docs/nodes.md and `fieldwright nodes`.
//
// docs/nodes.md is the committed output of `fieldwright nodes --markdown`; a test fails when it is not
// current.
#pragma once

#include <string>

#include "graph/library/node_type.h"

namespace fw {

/// The reference page: every node type by category, with its inputs, defaults, ranges and outputs.
std::string nodesMarkdown();

/// The same as one JSON object, {"nodes": [{"id", "label", "category", "doc", "inputs", "outputs", …}]}, for
/// other programs. Absent keys mean: no range on that side, no unit, no file, nothing by default.
std::string nodesJson();

/// The page's entry of one node type.
std::string nodeMarkdown(const NodeType& type);

/// "exact", "exact outside", "exact inside", "a bound", "distorted by up to 1.41" or "distorted".
std::string exactnessText(const Exactness& exactness);
/// "at most 2.31-Lipschitz", rounded up.
std::string lipschitzText(double constant);
/// What the page says of an input: "float", "choice"; "0, 1, 0 m", "position"; " From 0 to 1.", " Choices:
/// …", " Files: …". Names in it stand in backticks.
std::string typeText(const InputSpec& input);
std::string defaultText(const InputSpec& input);
std::string rangeText(const InputSpec& input);

/// Where the node stands in the page, as links have it: "nodes.md#infinite-cylinder".
std::string referenceLink(const NodeType& type);

/// Class of the node's surface with its default settings, fed with exact surfaces; empty for nodes that make
/// no surface.
std::string exactnessText(const NodeType& type);

}  // namespace fw
