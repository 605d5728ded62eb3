// Groups that come with nodes from elsewhere: from the clipboard, a part of the library, another file.
#pragma once

#include <vector>

#include "graph/document/graph.h"

namespace fw::editor {

/// The groups that the nodes show, and those that these show, in the order of `groups`.
std::vector<Group> groupsFor(const std::vector<Node>& nodes, const std::vector<Group>& groups);

/// The groups of `from` that `to` lacks are added to it, under another id where one of that id is another
/// group; the nodes of `from` follow.
void addGroups(Graph& from, Graph& to);

}  // namespace fw::editor
