#include "editor/shell/theme.h"

#include <algorithm>
#include <cmath>

#include "graph/assets/image.h"

namespace fw::editor {

namespace {

constexpr ImU32 rgb(unsigned hex) { return IM_COL32((hex >> 16) & 255u, (hex >> 8) & 255u, hex & 255u, 255); }
constexpr ImU32 black(unsigned alpha) { return IM_COL32(0, 0, 0, alpha); }
constexpr ImU32 white(unsigned alpha) { return IM_COL32(255, 255, 255, alpha); }

struct Shade {
    ImU32 dark, light;
};

// By ThemeColor.
constexpr Shade kColors[] = {
    {rgb(0x1b1d21), rgb(0xe6e8eb)},  // canvas
    {rgb(0x282b30), rgb(0xd9dce1)},  // grid
    {rgb(0x2e3238), rgb(0xfbfbfc)},  // node
    {rgb(0x4a4f57), rgb(0xb0b6bf)},  // edge
    {rgb(0xe6e8eb), rgb(0x1c2024)},  // text
    {rgb(0xa3abb5), rgb(0x525a64)},  // quiet
    {rgb(0xf4f5f7), rgb(0xf4f5f7)},  // onTitle
    {rgb(0x56b4e9), rgb(0x0068b8)},  // selected: sky blue; blue
    {rgb(0xf0e442), rgb(0xc96f00)},  // active: yellow; orange
    {rgb(0xff8a5c), rgb(0xb01818)},  // error: vermillion, lighter, for it is text too; red, deep
    {rgb(0xf5b335), rgb(0x7a4d00)},  // warning: orange, lighter; brown
    {rgb(0x24272c), rgb(0xf1f2f4)},  // panel
    {rgb(0x3a3f46), rgb(0xdfe2e6)},  // field
    {rgb(0x474d56), rgb(0xd0d5dc)},  // fieldHovered
    {rgb(0x2c5a78), rgb(0xb9d9ee)},  // fieldActive
    {rgb(0x2a4a5f), rgb(0xc8e1f2)},  // header
    {rgb(0x33566d), rgb(0xb5d6ec)},  // headerHovered
    {rgb(0x5d646e), rgb(0x979fa9)},  // grabHovered
    {rgb(0x707884), rgb(0x7c858f)},  // grabActive
    {rgb(0x8fd0f5), rgb(0x3d9bd1)},  // sliderActive
    {rgb(0x2b6894), rgb(0xc3dff3)},  // textSelected
    {white(14), black(12)},          // stripe
    {black(128), black(90)},         // dim
    {black(70), black(28)},          // beyond
    {black(170), IM_COL32(0xfb, 0xfb, 0xfc, 225)},                     // plate
    {rgb(0xffffff), rgb(0xffffff)},                                    // mark
    {black(150), black(150)},                                          // markRim
    {rgb(0x56b4e9), rgb(0x0b72b5)},                                    // plotted: sky blue
    {rgb(0xe69f00), rgb(0xb96f00)},                                    // plottedSlope: orange
    {IM_COL32(0x56, 0xb4, 0xe9, 50), IM_COL32(0x0b, 0x72, 0xb5, 40)},  // plottedWall
    {rgb(0xf0e442), rgb(0x1c2024)},                                    // argument
    {rgb(0xd3a4ee), rgb(0x7b2fa6)},                                    // codeWord
    {rgb(0x62c8d6), rgb(0x00606e)},                                    // codeType
    {rgb(0xf2b77c), rgb(0x8f4a00)},                                    // codeConstant
    {rgb(0xf0e06a), rgb(0x6b5c00)},                                    // codeInput
    {rgb(0x8cc8f2), rgb(0x0a5a9c)},                                    // codeFunction
    {rgb(0x7fd9a6), rgb(0x0f6636)},                                    // codeNode
    {rgb(0xe5a3a3), rgb(0xa03030)},                                    // codeString
    {rgb(0x949ca6), rgb(0x59616a)},                                    // codeComment
    {rgb(0x7d8590), rgb(0x59616a)},                                    // codeNumber
    {rgb(0x262a31), rgb(0xdcdfe4)},                                    // codeLine
    {rgb(0x5c4a1c), rgb(0xf7e3ad)},                                    // codeFound
    {rgb(0x3a4450), rgb(0xd0d5dc)},                                    // codeNotSelected
};
static_assert(std::size(kColors) == kThemeColors);

Theme current = Theme::dark;
ImU32 now(const Shade& shade) { return current == Theme::light ? shade.light : shade.dark; }

// By Category: deep, so that a canvas of many nodes is calm and the light title stands out; and differing in
// lightness too, so that everyone tells them apart (theme_test.cpp measures it).
constexpr ImU32 kCategoryColors[] = {
    rgb(0x1771a0),  // shape
    rgb(0x597286),  // shape2d
    rgb(0x002060),  // spline
    rgb(0xa85824),  // combine
    rgb(0x4a4593),  // domain
    rgb(0x0a5c39),  // field
    rgb(0x50525c),  // maths
    rgb(0x772e6f),  // material
    rgb(0x534500),  // mesh
    rgb(0x8a1f2b),  // particles
    rgb(0x746861),  // structure
};
static_assert(std::size(kCategoryColors) == kCategories);

struct TypeStyle {
    Shade color;
    SocketShape shape;
};

// By Type, of Okabe and Ito's palette and white, or black. Types of one shape differ in how light they are,
// which everyone sees.
constexpr TypeStyle kTypeStyles[] = {
    {{rgb(0xd55e00), rgb(0xd55e00)}, SocketShape::triangle},  // boolean: vermillion
    {{rgb(0x009e73), rgb(0x00935f)}, SocketShape::square},    // integer: bluish green
    {{rgb(0x56b4e9), rgb(0x0b72b5)}, SocketShape::circle},    // scalar: sky blue
    {{rgb(0xf0e442), rgb(0x6b5600)}, SocketShape::diamond},   // vec2: yellow
    {{rgb(0xcc79a7), rgb(0xd0509f)}, SocketShape::diamond},   // vec3: reddish purple
    {{rgb(0xe69f00), rgb(0xb96f00)}, SocketShape::hexagon},   // surface: orange
    {{rgb(0xd8dce2), rgb(0x23282e)}, SocketShape::square},    // string
    {{rgb(0xf0e442), rgb(0x3a3000)}, SocketShape::triangle},  // points: yellow
    {{rgb(0xe69f00), rgb(0x7a3b00)}, SocketShape::square},    // stops: orange, darker
    {{rgb(0x009e73), rgb(0x00935f)}, SocketShape::pentagon},  // knots: bluish green
    {{rgb(0xf4f4f4), rgb(0x22262c)}, SocketShape::hexagon},   // image
    {{rgb(0x3d8fd1), rgb(0x1a5ca8)}, SocketShape::hexagon},   // mesh: blue
    {{rgb(0xf4f4f4), rgb(0x30363d)}, SocketShape::circle},    // particles
    {{rgb(0x40f0e0), rgb(0x004030)}, SocketShape::pentagon},  // spline: turquoise; a dark green
};
static_assert(std::size(kTypeStyles) == kTypes);
constexpr TypeStyle kUnknown = {{rgb(0x8c939c), rgb(0x707780)}, SocketShape::circle};

const TypeStyle& styleOf(std::optional<Type> type) {
    return type ? kTypeStyles[std::size_t(*type)] : kUnknown;
}

ImVec4 value(ThemeColor which, float alpha = 1.0f) {
    ImVec4 color = ImGui::ColorConvertU32ToFloat4(themeColor(which));
    color.w *= alpha;
    return color;
}

}  // namespace

void setTheme(Theme theme) { current = theme; }
Theme theme() { return current; }

ImU32 themeColor(ThemeColor which) { return now(kColors[std::size_t(which)]); }

ImU32 shownColor(const std::array<double, 3>& linear) {
    const auto channel = [](double value) {
        return unsigned(std::lround(255.0 * encodeSrgb(std::clamp(value, 0.0, 1.0))));
    };
    return IM_COL32(channel(linear[0]), channel(linear[1]), channel(linear[2]), 255);
}

ImU32 categoryColor(Category category) { return kCategoryColors[std::size_t(category)]; }
ImU32 typeColor(std::optional<Type> type) { return now(styleOf(type).color); }
ImU32 axisColor(std::size_t axis) {
    constexpr Shade kAxes[] = {
        {rgb(0xe85d5d), rgb(0xc62f2f)}, {rgb(0x7cc03c), rgb(0x3a7f00)}, {rgb(0x4f8ff0), rgb(0x1f63d0)}};
    return axis < std::size(kAxes) ? now(kAxes[axis]) : themeColor(ThemeColor::text);
}
SocketShape socketShape(std::optional<Type> type) { return styleOf(type).shape; }

void applyTheme(float scale) {
    ImGuiStyle style;
    style.WindowPadding = {8, 8};
    style.FramePadding = {6, 3};
    style.ItemSpacing = {8, 5};
    style.ItemInnerSpacing = {6, 4};
    style.ScrollbarSize = 12;
    style.GrabMinSize = 10;
    style.WindowRounding = style.PopupRounding = 5;
    style.FrameRounding = style.GrabRounding = style.TabRounding = style.ChildRounding = 3;
    style.ScrollbarRounding = 6;
    style.WindowBorderSize = style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.DisabledAlpha = 0.6f;
    style.ScaleAllSizes(scale);

    if (current == Theme::light)
        ImGui::StyleColorsLight(&style);
    else
        ImGui::StyleColorsDark(&style);
    ImVec4* colors = style.Colors;
    using Color = ThemeColor;
    colors[ImGuiCol_Text] = value(Color::text);
    colors[ImGuiCol_TextDisabled] = value(Color::quiet);
    colors[ImGuiCol_WindowBg] = value(Color::panel);
    colors[ImGuiCol_ChildBg] = {0, 0, 0, 0};
    colors[ImGuiCol_PopupBg] = value(Color::node);
    colors[ImGuiCol_Border] = value(Color::edge);
    colors[ImGuiCol_FrameBg] = colors[ImGuiCol_Button] = value(Color::field);
    colors[ImGuiCol_FrameBgHovered] = colors[ImGuiCol_ButtonHovered] = value(Color::fieldHovered);
    colors[ImGuiCol_FrameBgActive] = colors[ImGuiCol_ButtonActive] = value(Color::fieldActive);
    colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgCollapsed] = value(Color::canvas);
    colors[ImGuiCol_TitleBgActive] = value(Color::field);
    colors[ImGuiCol_MenuBarBg] = value(Color::canvas);
    colors[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
    colors[ImGuiCol_ScrollbarGrab] = value(Color::edge);
    colors[ImGuiCol_ScrollbarGrabHovered] = value(Color::grabHovered);
    colors[ImGuiCol_ScrollbarGrabActive] = value(Color::grabActive);
    colors[ImGuiCol_CheckMark] = colors[ImGuiCol_SliderGrab] = value(Color::selected);
    colors[ImGuiCol_SliderGrabActive] = value(Color::sliderActive);
    colors[ImGuiCol_Header] = value(Color::header);
    colors[ImGuiCol_HeaderHovered] = value(Color::headerHovered);
    colors[ImGuiCol_HeaderActive] = value(Color::fieldActive);
    colors[ImGuiCol_Separator] = value(Color::edge);
    colors[ImGuiCol_SeparatorHovered] = colors[ImGuiCol_SeparatorActive] = value(Color::selected);
    colors[ImGuiCol_ResizeGrip] = value(Color::edge, 0.5f);
    colors[ImGuiCol_ResizeGripHovered] = colors[ImGuiCol_ResizeGripActive] = value(Color::selected);
    colors[ImGuiCol_Tab] = colors[ImGuiCol_TabUnfocused] = value(Color::canvas);
    colors[ImGuiCol_TabHovered] = value(Color::fieldHovered);
    colors[ImGuiCol_TabActive] = colors[ImGuiCol_TabUnfocusedActive] = value(Color::field);
    colors[ImGuiCol_PlotLines] = colors[ImGuiCol_PlotHistogram] = value(Color::selected);
    colors[ImGuiCol_PlotLinesHovered] = colors[ImGuiCol_PlotHistogramHovered] = value(Color::active);
    colors[ImGuiCol_TableHeaderBg] = value(Color::field);
    colors[ImGuiCol_TableBorderStrong] = colors[ImGuiCol_TableBorderLight] = value(Color::edge);
    colors[ImGuiCol_TableRowBgAlt] = value(Color::stripe, 0.6f);
    colors[ImGuiCol_TextSelectedBg] = value(Color::textSelected);
    colors[ImGuiCol_DragDropTarget] = value(Color::active);
    colors[ImGuiCol_NavHighlight] = value(Color::selected);
    colors[ImGuiCol_ModalWindowDimBg] = value(Color::dim);
    ImGui::GetStyle() = style;
}

}  // namespace fw::editor
