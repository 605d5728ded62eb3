// The colours and shapes of the interface: one table each.
//
// A dark scheme. Text keeps a contrast of 4.5 to what it stands on. Types differ in shape as well as in
// colour, and the colours are of Okabe and Ito's palette, which people who see few colours can tell apart.
#pragma once

#include <imgui.h>

#include <optional>

#include "graph/library/node_type.h"

namespace fw::editor {

enum class ThemeColor : unsigned char {
    canvas,  ///< behind the nodes
    grid,
    node,  ///< a node's body
    edge,  ///< about a node, a panel
    text,
    quiet,    ///< text that matters less
    onTitle,  ///< text on a category's colour
    selected,
    active,  ///< selected last; pinned
    error,
    warning,
};
ImU32 themeColor(ThemeColor which);
ImU32 categoryColor(Category category);
/// Of a socket and its wires; grey where the type is unknown.
ImU32 typeColor(std::optional<Type> type);

enum class SocketShape : unsigned char { circle, square, diamond, triangle, hexagon };
/// Of x, y and z, wherever they are drawn; text for anything beyond.
ImU32 axisColor(std::size_t axis);
SocketShape socketShape(std::optional<Type> type);

/// ImGui's own style, for an interface of this scale.
void applyTheme(float scale);

}  // namespace fw::editor
