// The part of a document that makes what a node gives: by it is told whether that is still what it was.
#pragma once

#include <string>
#include <string_view>

#include "graph/document/graph.h"

namespace fw {

/// The node with this id, all that it is made from, and the groups and tracks that have part in that; as a
/// document, without what bears on nothing: places, labels, inputs that have their default, caches. What
/// tracks move is as at the timeline's start. Equal parts make the same, of files with the same content.
Graph partBehind(const Graph& graph, std::string_view node);

/// How such a part differs from what it was, in words: "node 'water' has spacing 0.05, and had 0.04".
std::string differenceOf(const Graph& was, const Graph& is);

}  // namespace fw
