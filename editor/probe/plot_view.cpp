#include "editor/probe/plot_view.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "editor/canvas/view.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

constexpr float kMostOff = 1.0f;  // of the gradient's length from 1, at the lower plot's edges

std::string plotNumber(double number) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g", number);
    return text;
}

/// One of the two plots: a frame, and what its ordinates lie between.
struct PlotFrame {
    ImDrawList* list;
    Area area;
    double length, least, most;

    float x(double metres) const { return area.lo.x + float(metres / length) * area.width(); }
    float y(double value) const {
        const double part = (std::clamp(value, least, most) - least) / (most - least);
        return area.hi.y - float(part) * area.height();
    }
    void background() const {
        list->AddRectFilled(area.lo, area.hi, themeColor(ThemeColor::canvas));
        list->AddRect(area.lo, area.hi, themeColor(ThemeColor::edge));
    }
    /// The samples, with gaps where they are no numbers.
    void curve(const std::vector<double>& places, const std::vector<double>& values, double by, ImU32 color,
               float thick) const {
        std::vector<ImVec2> points;
        const auto draw = [&] {
            if (points.size() > 1) list->AddPolyline(points.data(), int(points.size()), color, 0, thick);
            points.clear();
        };
        for (std::size_t i = 0; i < places.size(); ++i)
            if (std::isfinite(values[i]))
                points.push_back({x(places[i]), y(values[i] - by)});
            else
                draw();
        draw();
    }
    void word(ImVec2 at, const std::string& text, ImU32 color) const {
        list->AddText(at, color, text.c_str());
    }
};

}  // namespace

void showPlot(const Plot& plot, const char* unit, float scale) {
    const double length = plot.line.length();
    if (!(length > 0.0)) return ImGui::TextDisabled("The line has no length.");
    double least = 0.0, most = 0.0;
    for (double value : plot.values)
        if (std::isfinite(value)) least = std::min(least, value), most = std::max(most, value);
    const double room = std::max(0.08 * (most - least), 1e-9);
    const float wide = std::max(ImGui::GetContentRegionAvail().x, 60.0f * scale), high = 130.0f * scale,
                low = 50.0f * scale, gap = 4.0f * scale, line = ImGui::GetTextLineHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("##plot", {wide, high + gap + low + line + gap});
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const PlotFrame values{list, {at, {at.x + wide, at.y + high}}, length, least - room, most + room};
    const PlotFrame slopes{list,
                           {{at.x, at.y + high + gap}, {at.x + wide, at.y + high + gap + low}},
                           length,
                           double(-kMostOff),
                           double(kMostOff)};
    const ImU32 quiet = themeColor(ThemeColor::quiet), text = themeColor(ThemeColor::text);
    values.background(), slopes.background();
    list->PushClipRect(values.area.lo, values.area.hi, true);
    const float zero = values.y(0.0);
    for (const Stretch& wall : plot.walls)
        list->AddRectFilled({values.x(wall.from), values.area.lo.y}, {values.x(wall.to), values.area.hi.y},
                            themeColor(ThemeColor::plottedWall));
    list->AddLine({at.x, zero}, {at.x + wide, zero}, quiet);
    values.curve(plot.places, plot.values, 0.0, themeColor(ThemeColor::plotted), 1.5f * scale);
    for (double place : plot.crossings) list->AddCircleFilled({values.x(place), zero}, 3.5f * scale, text);
    // Thicknesses where they have room; all of them are in the list below.
    float free = at.x;
    for (const Stretch& wall : plot.walls) {
        const std::string words = plotNumber(wall.thickness()) + " " + unit;
        const float size = ImGui::CalcTextSize(words.c_str()).x,
                    x = std::clamp(values.x(0.5 * (wall.from + wall.to)) - 0.5f * size, at.x + 2 * scale,
                                   at.x + wide - size - 2 * scale);
        if (x < free) continue;
        values.word({x, values.area.hi.y - line - 2 * scale}, words, text);
        free = x + size + 6 * scale;
    }
    list->PopClipRect();
    list->PushClipRect(slopes.area.lo, slopes.area.hi, true);
    const float one = slopes.y(0.0);
    list->AddLine({at.x, one}, {at.x + wide, one}, quiet);
    slopes.curve(plot.places, plot.slopes, 1.0, themeColor(ThemeColor::plottedSlope), 1.5f * scale);
    slopes.word({at.x + 4 * scale, slopes.area.lo.y + 1 * scale}, "gradient - 1", quiet);
    list->PopClipRect();
    values.word({at.x + 4 * scale, values.area.lo.y + 1 * scale}, plotNumber(most) + " " + unit, quiet);
    const std::string end = plotNumber(length) + " " + unit;
    values.word({at.x, slopes.area.hi.y + 1 * scale}, "0", quiet);
    values.word({at.x + wide - ImGui::CalcTextSize(end.c_str()).x, slopes.area.hi.y + 1 * scale}, end, quiet);
    if (!hovered) return;
    const double part = std::clamp(double((ImGui::GetIO().MousePos.x - at.x) / wide), 0.0, 1.0);
    const auto i = std::size_t(std::lround(part * double(plot.places.size() - 1)));
    list->AddLine({values.x(plot.places[i]), at.y}, {values.x(plot.places[i]), slopes.area.hi.y}, quiet);
    ImGui::SetTooltip("at %.4g %s: %.6g, gradient %.4g", plot.places[i], unit, plot.values[i],
                      plot.slopes[i]);
}

}  // namespace fw::editor
