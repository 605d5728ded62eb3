// Random graphs that show one node, to test its claim about its field.
//
// The node's parameters are random within their ranges, the ends included. Its surface inputs are random
// solids: off-centre, turned, larger than a cell of a repetition, and often themselves only bounds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "graph/document/graph.h"
#include "graph/library/node_type.h"

namespace fw::test {

/// Files that a node may read, by paths relative to the graph.
struct ClaimFiles {
    std::string graph;    ///< path of the graph file; it need not exist
    std::string picture;  ///< for an image input
    std::string mesh;     ///< for a mesh input
};

/// Whether claimGraph() can feed this node type: it returns a surface and needs no particles.
bool hasClaimGraph(const NodeType& type);

/// A graph whose output shows the node "tested" of this type. The same for the same seed. `variant` selects
/// the entry of each enum input in turn, so that successive variants visit all of them.
Graph claimGraph(const NodeType& type, uint32_t seed, int variant, const ClaimFiles& files);

}  // namespace fw::test
