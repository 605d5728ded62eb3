// NodeFields: what each node of a scope gives, as fields over space, for tools that inspect a graph.
//
// The nodes that the output needs are lowered as for a program, and the roots of all their outputs are kept
// instead of the output's alone. A node's field is a function of the same position as the whole graph's, so
// its value at a position is what flows there through its wires. Particles have no field of their own.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "graph/compile/compile.h"

namespace fw {

class GraphLowering;

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
/// Only nodes that the output needs, or the document's node `besides`, if there is one. Without meshes,
/// muted nodes and nodes that failed. Errors: the first of the structure's.
Result<NodeFields> compileNodeFields(const Graph& graph, const std::string& prefix,
                                     const std::string& besides = {}, const CompileOptions& options = {});

/// The nodes of the document for an empty `prefix`, else those of the group's instance that it leads to;
/// nullptr if the prefix leads to no group.
const std::vector<Node>* nodesInScope(const Graph& graph, std::string_view prefix);

enum class FieldSelection : unsigned char {
    ownFields,  ///< no meshes, no muted nodes
    all,        ///< also fields that meshes are made from, and those that muted nodes pass on
};
/// The fields of a scope's nodes that `lowering` has lowered, as roots in its Ir.
std::vector<NodeField> gatherNodeFields(const Graph& graph, const GraphLowering& lowering,
                                        const std::string& prefix, FieldSelection selection);

}  // namespace fw
