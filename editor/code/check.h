// What is wrong with a code text while it is typed: the same findings that the document has once it is
// applied.
#pragma once

#include <string_view>
#include <vector>

#include "editor/code/view.h"
#include "graph/document/graph.h"

namespace fw::editor::code {

/// The findings of check() about the code of this node, if it were `code`: parsed, resolved and lowered with
/// what feeds the node's inputs. `scope` as in edits.h. Takes as long as the document needs to be compiled.
std::vector<Error> findingsOf(Graph graph, std::string_view scope, std::string_view node,
                              std::string_view code);

/// Each at the token that it begins with.
std::vector<Mark> marksOf(const Text& text, const std::vector<Error>& findings);
/// Marks of a text before the last `changes` of its changes: they go with their lines.
void moveMarks(std::vector<Mark>& marks, const Text& text, uint64_t changes);

}  // namespace fw::editor::code
