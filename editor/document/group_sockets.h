// The inputs and outputs of a group, edited in every place at once: the group's declaration, the wires at its
// ends inside, the values and wires of all its instances, and parameters and tracks that lead to them.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

enum class GroupSide : unsigned char { inputs, outputs };

/// A socket behind the others. Error: no name, one that is taken, too many.
Result<Graph> addSocket(const Graph& graph, std::string_view group, GroupSide side, std::string_view name,
                        Type type);
/// Without the socket and the wires at it.
Graph removeSocket(const Graph& graph, std::string_view group, GroupSide side, std::string_view name);
/// Error: no name, or one that is taken.
Result<Graph> renameSocket(const Graph& graph, std::string_view group, GroupSide side, std::string_view name,
                           std::string_view to);
/// Another type. Values that are not of it go, and wires that it cannot have.
Graph setSocketType(const Graph& graph, std::string_view group, GroupSide side, std::string_view name,
                    Type type);
/// The socket as the one with this index.
Graph moveSocket(const Graph& graph, std::string_view group, GroupSide side, std::string_view name,
                 std::size_t to);
/// What an instance's input has that gives none.
Graph setSocketDefault(const Graph& graph, std::string_view group, std::string_view input,
                       std::optional<InputValue> value);

}  // namespace fw::editor
