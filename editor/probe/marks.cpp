// The probe's point, the line that is plotted and what is measured, over the picture.
#include <cmath>
#include <cstdio>

#include "editor/controls/plate.h"
#include "editor/editor.h"
#include "editor/shell/theme.h"

namespace fw::editor {

namespace {

struct Marker {
    ImDrawList* list;
    Lens lens;
    float scale;
    ImU32 rim = themeColor(ThemeColor::markRim);

    std::optional<ImVec2> seen(const Point& p) const { return lens.project({p[0], p[1], p[2]}); }

    void dot(const Point& point, ImU32 color, float radius) const {
        const auto at = seen(point);
        if (!at) return;
        list->AddCircleFilled(*at, (radius + 1.5f) * scale, rim);
        list->AddCircleFilled(*at, radius * scale, color);
    }
    void cross(const Point& point, ImU32 color) const {
        const auto at = seen(point);
        if (!at) return;
        const float far = 9.0f * scale, near = 3.0f * scale;
        for (const auto& [x, y] : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)}) {
            const ImVec2 a(at->x + near * x, at->y + near * y), b(at->x + far * x, at->y + far * y);
            list->AddLine(a, b, rim, 4.0f * scale);
            list->AddLine(a, b, color, 2.0f * scale);
        }
    }
    void line(const Point& from, const Point& to, ImU32 color) const {
        const auto a = seen(from), b = seen(to);
        if (!a || !b) return;
        list->AddLine(*a, *b, rim, 4.0f * scale);
        list->AddLine(*a, *b, color, 2.0f * scale);
    }
    /// Words beside the middle of two points, within the picture.
    void label(const Point& from, const Point& to, const std::string& words) const {
        const auto a = seen(from), b = seen(to);
        if (!a || !b) return;
        const ImVec2 size = plateSize(words, scale);
        const Area& place = lens.place;
        const ImVec2 at(
            std::clamp(0.5f * (a->x + b->x) + 7.0f * scale, place.lo.x,
                       std::max(place.hi.x - size.x, place.lo.x)),
            std::clamp(0.5f * (a->y + b->y - size.y), place.lo.y, std::max(place.hi.y - size.y, place.lo.y)));
        showPlate(list, at, words, themeColor(ThemeColor::text), scale);
    }
};

std::string lengthWords(double length) {
    char text[40];
    std::snprintf(text, sizeof text, "%.4g m", length);
    return text;
}

/// What the tool waits for, at the picture's upper edge.
std::string hintOf(const Probe& probe) {
    switch (probe.tool) {
        case Measure::length:
            return probe.measured.size() == 1 ? "Length: click its end" : "Length: click two points";
        case Measure::wall: return probe.wallProblem.empty() ? "Wall: click the solid" : probe.wallProblem;
        case Measure::line:
            return probe.ends.size() == 1 ? "Plot: click the line's end" : "Plot: click two points";
        case Measure::nothing: break;
    }
    return {};
}

}  // namespace

void showProbeMarks(Editor& editor) {
    const Probe& probe = editor.probe;
    const Viewport& view = editor.viewport;
    if (!view.texture) return;
    const bool on = editor.panels.probe;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(view.place.lo, view.place.hi, true);
    const float scale = editor.shell.scale();
    const Marker marker{list, Lens(view.shown.seen, view.place), scale};
    const ImU32 active = themeColor(ThemeColor::active), line = themeColor(ThemeColor::plotted),
                mark = themeColor(ThemeColor::mark);
    const bool plots = on || probe.tool == Measure::line;
    if (plots && probe.ends.size() == 2) marker.line(probe.ends[0], probe.ends[1], line);
    if (plots)
        for (const Point& end : probe.ends) marker.dot(end, line, 3.5f);
    for (const Point& point : probe.measured) marker.dot(point, active, 3.5f);
    if (probe.measured.size() == 2) {
        const Segment measured{probe.measured[0], probe.measured[1]};
        marker.line(measured.from, measured.to, active);
        marker.label(measured.from, measured.to, lengthWords(measured.length()));
    }
    if (probe.wall) {
        const Segment& wall = probe.wall->line;
        marker.line(wall.from, wall.to, active);
        marker.dot(wall.from, active, 3.5f), marker.dot(wall.to, active, 3.5f);
        marker.label(wall.from, wall.to, lengthWords(wall.length()));
    }
    if (on && probe.point) marker.cross(*probe.point, probe.pinned ? active : mark);
    if (probe.tool != Measure::nothing && probe.hovered && view.hovered)
        marker.dot(*probe.hovered, mark, 2.5f);
    if (const std::string hint = hintOf(probe); !hint.empty() && view.split.hand == 0) {
        const ImVec2 size = plateSize(hint, scale);
        showPlate(list, {view.place.hi.x - size.x - 5 * scale, view.place.lo.y + 5 * scale}, hint,
                  themeColor(ThemeColor::text), scale);
    }
    list->PopClipRect();
}

}  // namespace fw::editor
