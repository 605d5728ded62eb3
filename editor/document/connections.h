// The wires that a node could have: for those who connect by a list instead of by hand.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

struct Connection {
    Plug output, input;
    bool operator==(const Connection&) const = default;
};

/// Every wire from or to the node that has no refusal and is not there yet. First those to nodes of `near`,
/// then those between sockets of one type, then those into inputs that nothing feeds; else in the order of
/// the document and its sockets.
std::vector<Connection> connectionsOf(const Graph& graph, std::string_view scope, std::string_view node,
                                      const std::set<std::string>& near);

}  // namespace fw::editor
