#include "editor/viewport/ground.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "editor/controls/plate.h"
#include "editor/editor.h"
#include "editor/shell/theme.h"
#include "editor/viewport/projection.h"
#include "graph/base/words.h"
#include "graph/document/unit.h"

namespace fw::editor {

namespace {

constexpr double kLeastCell = 24.0;  // pixels
constexpr int kCellsAround = 30, kMostCellsAround = 200, kCellsAPiece = 5;
constexpr double kMostBar = 120.0;    // pixels, times the scale,
constexpr double kMostBarPart = 0.3;  // and of the picture's width

ImU32 faded(ImU32 color, double alpha) {
    return (color & ~IM_COL32_A_MASK) | (ImU32(std::lround(255.0 * alpha)) << IM_COL32_A_SHIFT);
}

/// The two axes of the plane.
std::pair<int, int> planeOf(std::optional<Side> side) {
    if (side == Side::front || side == Side::back) return {0, 1};
    if (side == Side::left || side == Side::right) return {2, 1};
    return {0, 2};
}

void drawGrid(const Editor& editor, const Lens& lens) {
    const Viewport& view = editor.viewport;
    const auto& t = view.shown.seen.target;
    const bool flat = view.ownCamera && view.orthographic;
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (const GridLine& line :
         gridOf(lens, {t[0], t[1], t[2]}, flat ? sideOf(view.orbit) : std::nullopt).lines) {
        const auto from = lens.project(line.from), to = lens.project(line.to);
        if (!from || !to) continue;
        const ImU32 color = line.axis ? axisColor(std::size_t(line.along)) : themeColor(ThemeColor::text);
        const double alpha = line.shown * (line.axis ? 0.8 : line.strong ? 0.35 : 0.16);
        list->AddLine(*from, *to, faded(color, alpha), (line.axis ? 1.5f : 1.0f) * editor.shell.scale());
    }
}

/// A bar of a round length, its right end and its foot there.
void drawBar(const Editor& editor, const Lens& lens, ImVec2 end) {
    const float scale = editor.shell.scale(), tall = 5.0f * scale;
    const auto& t = editor.viewport.shown.seen.target;
    const double pixel = lens.metresPerPixel({t[0], t[1], t[2]});
    const double most = std::min(kMostBar * double(scale), kMostBarPart * double(lens.place.width()));
    const double length = roundDown125(most * pixel);
    const std::string words = lengthWords(length, unitOf(*editor.graph));
    const float wide = float(length / pixel), pad = 5.0f * scale;
    const ImVec2 text = ImGui::CalcTextSize(words.c_str());
    const float room = std::max(wide, text.x);
    if (end.y - text.y - tall - 2 * pad < lens.place.lo.y) return;  // there is none for it
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({end.x - room - 2 * pad, end.y - text.y - tall - 2 * pad}, end,
                        themeColor(ThemeColor::plate), 4 * scale);
    const ImU32 ink = themeColor(ThemeColor::text);
    const ImVec2 right(end.x - pad, end.y - pad), left(right.x - wide, right.y);
    list->AddLine(left, right, ink, 1.5f * scale);
    list->AddLine(left, {left.x, left.y - tall}, ink, 1.5f * scale);
    list->AddLine(right, {right.x, right.y - tall}, ink, 1.5f * scale);
    list->AddText({right.x - text.x, right.y - tall - text.y}, ink, words.c_str());
}

}  // namespace

Grid gridOf(const Lens& lens, const glm::dvec3& target, std::optional<Side> side) {
    const auto [a, b] = planeOf(side);
    Grid grid;
    const double pixel = lens.metresPerPixel(target);
    grid.spacing = roundUp125(kLeastCell * pixel);
    const double pixels = 0.5 * std::hypot(double(lens.place.width()), double(lens.place.height()));
    const int around =
        side ? std::min(int(pixels * pixel / grid.spacing) + 2, kMostCellsAround) : kCellsAround;
    const long middle[] = {std::lround(target[a] / grid.spacing), std::lround(target[b] / grid.spacing)};
    const auto at = [&](double u, double v) {
        glm::dvec3 point(0.0);
        point[a] = u * grid.spacing, point[b] = v * grid.spacing;
        return point;
    };
    // In pieces, of which those behind the eye are not drawn, and those far away are faint.
    const int piece = side ? 2 * around : kCellsAPiece;
    for (int i = -around; i <= around; ++i)
        for (int k = -around; k < around; k += piece) {
            const double away = std::hypot(double(i), double(k) + 0.5 * piece) / around;
            const double shown = side ? 1.0 : std::max(1.0 - away * away, 0.0);
            if (shown <= 0.0) continue;
            const int to = std::min(k + piece, around);
            for (const bool along : {true, false}) {  // along a, along b
                const long across = middle[along ? 1 : 0] + i, from = middle[along ? 0 : 1];
                GridLine line{.from = along ? at(double(from + k), double(across))
                                            : at(double(across), double(from + k)),
                              .to = along ? at(double(from + to), double(across))
                                          : at(double(across), double(from + to)),
                              .along = along ? a : b,
                              .axis = across == 0,
                              .strong = across % 10 == 0,
                              .shown = shown};
                grid.lines.push_back(line);
            }
        }
    return grid;
}

std::string lengthWords(double length, const LengthUnit& of) {
    if (&of == lengthUnit("in")) return shortNumber(length) + " in";
    const double metres = length * of.metres;
    constexpr std::pair<double, const char*> kUnits[] = {{1e3, "km"}, {1.0, "m"}, {1e-2, "cm"}, {1e-3, "mm"}};
    const auto unit =
        std::ranges::find_if(kUnits, [&](const auto& each) { return metres >= each.first * (1.0 - 1e-9); });
    const auto& [size, name] = unit == std::end(kUnits) ? kUnits[3] : *unit;
    char text[32];
    std::snprintf(text, sizeof text, "%g %s", metres / size, name);
    return text;
}

void showGround(Editor& editor) {
    const Viewport& view = editor.viewport;
    if (!view.texture) return;
    const Lens lens(view.shown.seen, view.place);
    const float scale = editor.shell.scale(), pad = 5.0f * scale;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(view.place.lo, view.place.hi, true);
    if (view.grid) drawGrid(editor, lens);
    const auto fits = [&](const std::string& text) {
        const ImVec2 size = plateSize(text, scale);
        return size.x + pad < view.place.width() && size.y + pad < view.place.height();
    };
    std::string words = wordsOf(view, editor.document.graph());
    if (!fits(words)) words.erase(std::min(words.find(" · "), words.size()));  // the side alone
    if (!fits(words)) return list->PopClipRect();
    const ImVec2 size = plateSize(words, scale),
                 from(view.place.hi.x - pad - size.x, view.place.hi.y - pad - size.y);
    showPlate(list, from, words, themeColor(ThemeColor::text), scale);
    if (view.ownCamera && view.orthographic) drawBar(editor, lens, {from.x + size.x, from.y - pad});
    list->PopClipRect();
}

}  // namespace fw::editor
