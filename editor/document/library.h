// Finding a node type by what a person types.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "graph/library/node_type.h"

namespace fw::editor {

/// Those of `among` that the words match, the best first: a label that begins so, a word of it that does, an
/// alias, the category, letters in that order. All of them for no words, in their order.
std::vector<const NodeType*> findTypes(std::string_view words, std::span<const NodeType* const> among);

}  // namespace fw::editor
