// A new node that comes wired: what the menu of nodes adds with Shift.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

/// The node that a new one is wired to where none is selected: the output, if the scope has one.
std::string joinedByItself(const Graph& graph, std::string_view scope);

/// A new node of this type, wired to `to` and beside it.
///
/// What takes what `to` gives goes behind it, into every wire that leads on from there. What does not, but
/// gives what `to` takes, goes before it: into the wire of the input that fits best, if it fits there, else
/// in its place. Wires alike in type alone count: a surface is not taken for a number. What lies to the right
/// moves on until there is room. Where only another node stands between, as one that makes a solid of
/// particles, that comes along. Without anything that fits the node is added unwired, as addNode() does.
Edited addJoined(const Graph& graph, std::string_view scope, std::string_view type, std::string_view to,
                 std::string_view group = {});

/// With a wire from the first of the nodes that gives what `to` takes, and feeds nothing yet; as it was if
/// there is none. They stay where they are.
Graph joinedTo(const Graph& graph, std::string_view scope, std::span<const std::string> nodes,
               std::string_view to);

}  // namespace fw::editor
