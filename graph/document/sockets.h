// Which inputs and outputs a node has, and of what type.
//
// Most nodes have those of their entry in the node library. The open ones have what the document says: an
// expression any input, a group node those of its group, group_input and group_output those of the group they
// stand in, seen from inside, a reroute the type of what it is fed with. All here refers to a Graph that must
// outlive it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "graph/document/graph.h"
#include "graph/library/node_type.h"

namespace fw {

struct Socket {
    std::optional<Type> type;         ///< empty if only the compiler knows, or if its declaration is wrong
    const InputSpec* spec = nullptr;  ///< of inputs of the library
};

/// Of an input that names a file: its kind. Else none.
const FileKind* fileKind(const Socket& input);

/// A group with the types of its sockets by name.
struct GroupSockets {
    const Group* group;
    std::unordered_map<std::string_view, std::optional<Type>> inputs, outputs;
};

/// The groups of a document, in its order.
struct Groups {
    explicit Groups(const Graph& graph);

    /// Index of the group that this node instances, if it is a group node and the group exists.
    std::optional<uint32_t> of(const Node& node) const;

    std::vector<GroupSockets> list;
    std::unordered_map<std::string_view, uint32_t> byId;  ///< the first of an id
};

/// The nodes among which ids are unique and links lead: those of the document, or those of a group.
struct Scope {
    Scope(const Groups& groups, const std::vector<Node>& nodes, const GroupSockets* group);

    bool is(uint32_t node, NodeRole role) const { return types[node] && types[node]->role == role; }

    const Groups& groups;
    const std::vector<Node>& nodes;
    const GroupSockets* group;                            ///< nullptr outside of groups
    std::unordered_map<std::string_view, uint32_t> byId;  ///< the first of an id
    std::vector<const NodeType*> types;             ///< of each node; nullptr if the library has none such
    std::vector<std::optional<Type>> rerouteTypes;  ///< of each node that is a reroute
};

/// Whether it is known what inputs and outputs the node has: its type exists and, of a group node, its group.
bool hasKnownSockets(const Scope& scope, uint32_t node);

/// The named input of a node with known sockets, if it has one.
std::optional<Socket> inputSocket(const Scope& scope, uint32_t node, std::string_view name);
/// The same, as a parameter or a track may set it: of an expression's inputs those with a value, whose type
/// is theirs.
std::optional<Socket> settableSocket(const Scope& scope, uint32_t node, std::string_view name);
/// The named output of a node with known sockets, the first one for an empty name, if it has one.
std::optional<Socket> outputSocket(const Scope& scope, uint32_t node, std::string_view name);

std::vector<std::string> inputNames(const Scope& scope, uint32_t node);
std::vector<std::string> outputNames(const Scope& scope, uint32_t node);
/// The ids of all nodes.
std::vector<std::string> idsOf(const Scope& scope);

/// The type that a value has by itself, in an input of an expression or a reroute: float, vec2 or vec3.
std::optional<Type> typeOfValue(const InputValue& value);

}  // namespace fw
