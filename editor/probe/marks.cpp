// The probe's point, the line that is plotted and what is measured, over the picture.
#include <cmath>
#include <numbers>

#include "editor/controls/plate.h"
#include "editor/editor.h"
#include "editor/shell/theme.h"
#include "graph/document/unit.h"

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

constexpr int kPiecesOfCircle = 96;

/// The points of a length, an angle or a radius, and what they come to.
void showShape(const Marker& marker, const Probe& probe, const std::string& words, ImU32 color) {
    const std::vector<Point>& points = probe.measured;
    if (points.empty()) return;
    const auto circle =
        probe.what == Measure::radius && probe.three() ? circleThrough(*probe.three()) : std::nullopt;
    if (circle) {
        Point last{};
        for (int i = 0; i <= kPiecesOfCircle; ++i) {
            const double turn = 2.0 * std::numbers::pi * i / kPiecesOfCircle;
            Point next;
            for (std::size_t a = 0; a < 3; ++a)
                next[a] = circle->centre[a] + circle->radius * (std::cos(turn) * circle->across[a] +
                                                                std::sin(turn) * circle->along[a]);
            if (i > 0) marker.line(last, next, color);
            last = next;
        }
    } else if (probe.what != Measure::radius) {
        for (std::size_t i = 0; i + 1 < points.size(); ++i) marker.line(points[i], points[i + 1], color);
    }
    for (const Point& point : points) marker.dot(point, color, 3.5f);
    if (words.empty()) return;
    if (circle) return marker.label(circle->centre, circle->centre, words);
    const Point& corner = probe.what == Measure::angle ? points[1] : points[0];
    marker.label(corner, probe.what == Measure::length ? points[1] : corner, words);
}

/// What the tool waits for, at the picture's upper edge.
std::string hintOf(const Probe& probe) {
    // Points that are missing, of what was begun.
    const std::size_t there = probe.what == probe.tool ? probe.measured.size() : 0, left = 3 - there;
    switch (probe.tool) {
        case Measure::length: return there == 1 ? "Length: click its end" : "Length: click two points";
        case Measure::angle:
            return left == 2   ? "Angle: click the corner"
                   : left == 1 ? "Angle: click its other side"
                               : "Angle: click a point of one side";
        case Measure::radius:
            return left == 2   ? "Radius: two more are a circle"
                   : left == 1 ? "Radius: click the circle's last point"
                               : "Radius: click the solid";
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
    const LengthUnit& lengths = unitOf(*editor.graph);
    showShape(marker, probe, shapeWords(probe, sizeSeen(editor), lengths), active);
    if (probe.wall) {
        const Segment& wall = probe.wall->line;
        marker.line(wall.from, wall.to, active);
        marker.dot(wall.from, active, 3.5f), marker.dot(wall.to, active, 3.5f);
        marker.label(wall.from, wall.to, withSign(wall.length(), "m", lengths));
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
