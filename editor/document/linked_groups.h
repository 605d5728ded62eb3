// Groups that live in a file of their own and are used by many documents.
//
// A document holds a whole copy of each (Group::file, Group::taken), so that it can be opened, exported and
// sent without the file, and gives the same bytes until its owner takes what has changed. Which of the two
// was changed is told by digests: that of the copy, that of the file, and `taken`, which both had when they
// were last the same. Such a file is a graph that shows the group: it opens in the editor like any other.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

/// The graph that shows the group, as the text of a file: an instance of it, an output if it gives a surface,
/// and the groups in it.
std::string textOfGroup(const Graph& graph, std::string_view group);

/// A graph, and the group in it that it is there to show.
struct ShownGroup {
    Graph graph;
    std::string group;
};
/// Of a file's text: the group of its first node that is an instance of one. Errors: as parseGraph(); it
/// shows none.
Result<ShownGroup> groupShownBy(std::string_view text, const std::string& path);

/// 16 hexadecimal digits of all that the group is, with the groups in it, whatever these are called and
/// whatever files they are linked to. Empty: there is no such group.
std::string digestOf(const Graph& graph, std::string_view group);

/// The group as the one that `from` shows. Its instances keep what the new one has too; groups that it alone
/// had go. Error: the graph cannot have it, as where it is within itself.
Result<Graph> withGroupOf(const Graph& graph, std::string_view group, const ShownGroup& from);

/// The group as a copy of this file, of which it now is the same; of none for an empty path.
Graph linked(const Graph& graph, std::string_view group, std::string file);

/// How a copy and its file stand to each other.
enum class LinkState : unsigned char { same, fileChanged, changedHere, bothChanged };
LinkState linkState(const std::string& taken, const std::string& here, const std::string& inFile);

}  // namespace fw::editor
