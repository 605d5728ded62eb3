// The colours, shapes and spacing of the interface: one table each.
//
// A dark scheme and a light one. Text keeps a contrast of 4.5 to what it stands on. Types differ in shape as
// well as in colour, and the colours are of Okabe and Ito's palette, which people who see few colours can
// tell apart; on light paper they are darker. What lies over a picture of the solid keeps its colours.
#pragma once

#include <imgui.h>

#include <array>
#include <optional>

#include "graph/library/node_type.h"

namespace fw::editor {

enum class Theme : unsigned char { dark, light };
/// As all that follows is; dark at the start. ImGui's own style follows before the next frame (shell.h).
void setTheme(Theme theme);
Theme theme();

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
    panel,  ///< behind the panels
    field,  ///< numbers, texts, buttons
    fieldHovered,
    fieldActive,
    header,  ///< what is chosen of a list
    headerHovered,
    grabHovered,  ///< of a scroll bar
    grabActive,
    sliderActive,
    textSelected,
    stripe,   ///< every other line of a table; a row that is chosen; over what is there
    dim,      ///< over all but a question
    beyond,   ///< over the times after the end
    plate,    ///< behind words that lie over the picture
    mark,     ///< lines and points that lie over the picture
    markRim,  ///< about these
    plotted,  ///< a field along a line, and that line
    plottedSlope,
    plottedWall,  ///< where the line is inside
    argument,     ///< text: the one that is being typed of a call
    codeWord,
    codeType,
    codeConstant,
    codeInput,
    codeFunction,
    codeNode,
    codeString,
    codeComment,
    codeNumber,       ///< of a line
    codeLine,         ///< behind the line with the cursor
    codeFound,        ///< behind what was searched for
    codeNotSelected,  ///< behind what is selected, while the keyboard is elsewhere
};
inline constexpr std::size_t kThemeColors = std::size_t(ThemeColor::codeNotSelected) + 1;
ImU32 themeColor(ThemeColor which);
/// A linear colour as it is seen, what is beyond 0 to 1 cut off.
ImU32 shownColor(const std::array<double, 3>& linear);
ImU32 categoryColor(Category category);
/// Of a socket and its wires; grey where the type is unknown.
ImU32 typeColor(std::optional<Type> type);

enum class SocketShape : unsigned char { circle, square, diamond, triangle, hexagon, pentagon };
/// Of x, y and z, wherever they are drawn; text for anything beyond.
ImU32 axisColor(std::size_t axis);
SocketShape socketShape(std::optional<Type> type);

/// ImGui's own style, for an interface of this scale.
void applyTheme(float scale);

// The grid that things stand on, in units of the font's size: times ImGui::GetFontSize() they are pixels.
inline constexpr float kGap = 0.6f;       ///< between things, and from a window's rim to them
inline constexpr float kSmallGap = 0.3f;  ///< between what belongs together
inline constexpr float kRound = 0.3f;     ///< of the corners of pictures and plates

}  // namespace fw::editor
