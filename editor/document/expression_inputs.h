// The inputs of an expression node, which its document names: added, renamed, given another type.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

/// The types that an input can have by its value.
inline constexpr Type kExpressionTypes[] = {Type::scalar, Type::vec2, Type::vec3};

/// One more input, of zeros. Error: no name, one that is taken, too many inputs.
Result<Graph> addExpressionInput(const Graph& graph, std::string_view scope, std::string_view node,
                                 std::string_view name, Type type);
/// Another name for an input; the code, parameters and tracks follow. Error as above, and where the code
/// means something else by the name.
Result<Graph> renameExpressionInput(const Graph& graph, std::string_view scope, const Plug& input,
                                    std::string_view name);
/// Zeros of the type in place of its value, which keeps as many of its numbers as fit.
Graph setExpressionType(const Graph& graph, std::string_view scope, const Plug& input, Type type);

/// The code with another name in place of an input's, wherever it stands for the input: not where it is a
/// component ("a.x"), in a comment, or a variable that hides it.
std::string renamedInCode(std::string_view code, std::string_view from, std::string_view to);

}  // namespace fw::editor
