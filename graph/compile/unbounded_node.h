// UnboundedNode: the node that makes a solid unbounded, for error messages.
//
// The graph is lowered once. The search starts at the output and goes upstream from node to node, each of
// which has a field that is not bounded, and ends at one whose surface inputs are all bounded, or that has
// none: a plane, a repetition without a count. Groups are entered; reroutes and muted nodes are passed.
//
// If several inputs are not bounded, the search follows one of them. It prefers an unbounded operand of the
// node's outermost minimum, because the node's solid contains it. Otherwise it takes the first in the order
// of the inputs, so for `subtract` the solid that is cut.
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "graph/bounds/region.h"
#include "graph/document/graph.h"

namespace fw {

struct UnboundedNode {
    std::string path;                   ///< the node's id, in groups "instance/node"
    std::string label;                  ///< the node's own; may be empty
    std::string typeLabel;              ///< "Plane"
    Extent extent = Extent::unbounded;  ///< or unproven
    Box unproven;                       ///< as Region::unproven
    /// False if the search ended early: the node is not bounded, but the cause may be upstream of it.
    bool isCause = true;
};

struct UnboundedNodeOptions {
    double time = 0.0;        ///< seconds, as CompileOptions::time
    double maxSeconds = 3.0;  ///< no field is searched after that; a search that has begun is finished
    std::stop_token stop = {};
};

/// Nothing if no node upstream of the output is found to be unbounded, if the graph does not compile, or if
/// stopped.
std::optional<UnboundedNode> findUnboundedNode(const Graph& graph, const UnboundedNodeOptions& options = {});

/// "node 'ground' (Plane) is unbounded", "node 'w' (Warp) cannot be proven bounded: there may be solid
/// between (x y z) and (x y z)".
std::string describe(const UnboundedNode& node);

/// "there may be solid between (x y z) and (x y z)".
std::string describeUnproven(const Box& unproven);

}  // namespace fw
