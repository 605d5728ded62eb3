// Finding a node type by what a person types, and by what they took before.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/library/node_type.h"

namespace fw::editor {

/// What other programs call the type of this id: Blender, Houdini, Substance, OpenSCAD, hg_sdf. Lower-case
/// words parted by blanks; empty for most.
std::string_view otherNames(std::string_view type);

/// What something is called.
struct SearchedNames {
    std::string label;  ///< as it is shown
    std::string id = {}, others = {}, category = {}, doc = {};
};
inline constexpr int kNoMatch = 100;
/// How well these are what was typed, 0 the best; `kNoMatch` if one of its words, in whatever order, is in
/// none of them.
int match(std::string_view typed, const SearchedNames& names);

/// Those of `among` that the words match, the best first: a label that begins so, a word of it that does,
/// another name, the category, its page, letters in that order. Of those that match alike, ids in `recent`
/// come first, in their order. All of them for no words, in their order.
std::vector<const NodeType*> findTypes(std::string_view typed, std::span<const NodeType* const> among,
                                       std::span<const std::string> recent = {});

/// At most `count` of `among`: ids in `recent` first, in their order, then those that graphs have most of.
std::vector<const NodeType*> usualTypes(std::span<const NodeType* const> among,
                                        std::span<const std::string> recent, std::size_t count);

}  // namespace fw::editor
