// What each node of a scope gives, as fields over space: for whoever looks into a graph.
//
// The nodes that what is shown needs are lowered as for a program, and instead of the output's roots those of
// all their outputs are kept. A node's field is a function of the same position as the whole's, so its value
// at a place is what flows there through its wires. Meshes, particles and muted nodes have no field of their
// own.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "graph/compile/compile.h"

namespace fw {

/// One output of a node.
struct NodeField {
    std::string node, output;  ///< the node's id in its scope
    Type type = Type::scalar;  ///< one with components
    /// The first componentCount(type) count.
    std::array<IrId, kSurfaceComponents> roots{};
    Exactness exactness = kExact;  ///< of a surface
};

struct NodeFields {
    Ir ir;
    std::vector<NodeField> fields;    ///< in the order of the document's nodes, of each its outputs
    std::vector<LiveParameter> live;  ///< as Program::live
};

/// Of the document's nodes for an empty `prefix`; else of the group's instance that it leads to, "tower/".
/// Only nodes that the output needs, or the document's node `besides`, if there is one. Nodes that failed are
/// left out. Errors: the first of the structure's.
Result<NodeFields> compileNodeFields(const Graph& graph, const std::string& prefix,
                                     const std::string& besides = {}, const CompileOptions& options = {});

}  // namespace fw
