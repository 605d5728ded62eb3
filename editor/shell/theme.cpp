#include "editor/shell/theme.h"

#include <array>

namespace fw::editor {

namespace {

constexpr ImU32 rgb(unsigned hex) { return IM_COL32((hex >> 16) & 255u, (hex >> 8) & 255u, hex & 255u, 255); }

// By ThemeColor.
constexpr ImU32 kColors[] = {
    rgb(0x1b1d21),  // canvas
    rgb(0x282b30),  // grid
    rgb(0x2e3238),  // node
    rgb(0x4a4f57),  // edge
    rgb(0xe6e8eb),  // text
    rgb(0xa3abb5),  // quiet
    rgb(0xf4f5f7),  // onTitle
    rgb(0x56b4e9),  // selected: sky blue
    rgb(0xf0e442),  // active: yellow
    rgb(0xff8a5c),  // error: vermillion, lighter, for it is text too
    rgb(0xf5b335),  // warning: orange, lighter
};
static_assert(std::size(kColors) == std::size_t(ThemeColor::warning) + 1);

// By Category: deep, so that a canvas of many nodes is calm and the light title stands out; and differing in
// lightness too, so that everyone tells them apart (theme_test.cpp measures it).
constexpr ImU32 kCategoryColors[] = {
    rgb(0x1771a0),  // shape
    rgb(0x597286),  // shape2d
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
    ImU32 color;
    SocketShape shape;
};

// By Type, of Okabe and Ito's palette and white. Types of one shape differ in how light they are, which
// everyone sees.
constexpr TypeStyle kTypeStyles[] = {
    {rgb(0xd55e00), SocketShape::triangle},  // boolean: vermillion
    {rgb(0x009e73), SocketShape::square},    // integer: bluish green
    {rgb(0x56b4e9), SocketShape::circle},    // scalar: sky blue
    {rgb(0xf0e442), SocketShape::diamond},   // vec2: yellow
    {rgb(0xcc79a7), SocketShape::diamond},   // vec3: reddish purple
    {rgb(0xe69f00), SocketShape::hexagon},   // surface: orange
    {rgb(0xd8dce2), SocketShape::square},    // string
    {rgb(0xf0e442), SocketShape::triangle},  // points: yellow
    {rgb(0xe69f00), SocketShape::square},    // stops: orange
    {rgb(0xf4f4f4), SocketShape::hexagon},   // image
    {rgb(0x3d8fd1), SocketShape::hexagon},   // mesh: blue, lighter
    {rgb(0xf4f4f4), SocketShape::circle},    // particles
};
static_assert(std::size(kTypeStyles) == kTypes);
constexpr TypeStyle kUnknown = {rgb(0x8c939c), SocketShape::circle};

const TypeStyle& styleOf(std::optional<Type> type) {
    return type ? kTypeStyles[std::size_t(*type)] : kUnknown;
}

ImVec4 faded(ImU32 color, float alpha) {
    ImVec4 value = ImGui::ColorConvertU32ToFloat4(color);
    value.w = alpha;
    return value;
}

}  // namespace

ImU32 themeColor(ThemeColor which) { return kColors[std::size_t(which)]; }
ImU32 categoryColor(Category category) { return kCategoryColors[std::size_t(category)]; }
ImU32 typeColor(std::optional<Type> type) { return styleOf(type).color; }
ImU32 axisColor(std::size_t axis) {
    constexpr ImU32 kAxes[] = {rgb(0xe85d5d), rgb(0x7cc03c), rgb(0x4f8ff0)};
    return axis < std::size(kAxes) ? kAxes[axis] : themeColor(ThemeColor::text);
}
SocketShape socketShape(std::optional<Type> type) { return styleOf(type).shape; }

void applyTheme(float scale) {
    const ImU32 canvas = themeColor(ThemeColor::canvas), node = themeColor(ThemeColor::node),
                edge = themeColor(ThemeColor::edge), text = themeColor(ThemeColor::text),
                accent = themeColor(ThemeColor::selected);
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

    ImVec4* colors = style.Colors;
    ImGui::StyleColorsDark(&style);
    const ImVec4 field = faded(rgb(0x3a3f46), 1), fieldHovered = faded(rgb(0x474d56), 1),
                 fieldActive = faded(rgb(0x2c5a78), 1), panel = faded(rgb(0x24272c), 1);
    colors[ImGuiCol_Text] = faded(text, 1);
    colors[ImGuiCol_TextDisabled] = faded(themeColor(ThemeColor::quiet), 1);
    colors[ImGuiCol_WindowBg] = panel;
    colors[ImGuiCol_ChildBg] = {0, 0, 0, 0};
    colors[ImGuiCol_PopupBg] = faded(node, 1);
    colors[ImGuiCol_Border] = faded(edge, 1);
    colors[ImGuiCol_FrameBg] = colors[ImGuiCol_Button] = field;
    colors[ImGuiCol_FrameBgHovered] = colors[ImGuiCol_ButtonHovered] = fieldHovered;
    colors[ImGuiCol_FrameBgActive] = colors[ImGuiCol_ButtonActive] = fieldActive;
    colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgCollapsed] = faded(canvas, 1);
    colors[ImGuiCol_TitleBgActive] = field;
    colors[ImGuiCol_MenuBarBg] = faded(canvas, 1);
    colors[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
    colors[ImGuiCol_ScrollbarGrab] = faded(edge, 1);
    colors[ImGuiCol_ScrollbarGrabHovered] = faded(rgb(0x5d646e), 1);
    colors[ImGuiCol_ScrollbarGrabActive] = faded(rgb(0x707884), 1);
    colors[ImGuiCol_CheckMark] = colors[ImGuiCol_SliderGrab] = faded(accent, 1);
    colors[ImGuiCol_SliderGrabActive] = faded(rgb(0x8fd0f5), 1);
    colors[ImGuiCol_Header] = faded(rgb(0x2a4a5f), 1);
    colors[ImGuiCol_HeaderHovered] = faded(rgb(0x33566d), 1);
    colors[ImGuiCol_HeaderActive] = fieldActive;
    colors[ImGuiCol_Separator] = faded(edge, 1);
    colors[ImGuiCol_SeparatorHovered] = colors[ImGuiCol_SeparatorActive] = faded(accent, 1);
    colors[ImGuiCol_ResizeGrip] = faded(edge, 0.5f);
    colors[ImGuiCol_ResizeGripHovered] = colors[ImGuiCol_ResizeGripActive] = faded(accent, 1);
    colors[ImGuiCol_Tab] = colors[ImGuiCol_TabUnfocused] = faded(canvas, 1);
    colors[ImGuiCol_TabHovered] = fieldHovered;
    colors[ImGuiCol_TabActive] = colors[ImGuiCol_TabUnfocusedActive] = field;
    colors[ImGuiCol_PlotLines] = colors[ImGuiCol_PlotHistogram] = faded(accent, 1);
    colors[ImGuiCol_PlotLinesHovered] = colors[ImGuiCol_PlotHistogramHovered] =
        faded(themeColor(ThemeColor::active), 1);
    colors[ImGuiCol_TableHeaderBg] = field;
    colors[ImGuiCol_TableBorderStrong] = colors[ImGuiCol_TableBorderLight] = faded(edge, 1);
    colors[ImGuiCol_TableRowBgAlt] = {1, 1, 1, 0.03f};
    colors[ImGuiCol_TextSelectedBg] = faded(rgb(0x2b6894), 1);
    colors[ImGuiCol_DragDropTarget] = faded(themeColor(ThemeColor::active), 1);
    colors[ImGuiCol_NavHighlight] = faded(accent, 1);
    colors[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.5f};
    ImGui::GetStyle() = style;
}

}  // namespace fw::editor
