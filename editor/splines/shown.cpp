#include "editor/splines/shown.h"

#include <algorithm>
#include <cmath>

#include "editor/shell/theme.h"
#include "editor/viewport/gizmo.h"

namespace fw::editor::splines {

namespace {

constexpr ImU32 kBehind = IM_COL32(0, 0, 0, 110), kHandleLine = IM_COL32(0xf0, 0xf0, 0xf0, 140);

/// Calls visit(metres along, place in the picture) from one end to the other, with a few places an arc.
template <class Visit>
void eachPlace(const Shown& shown, const Visit& visit) {
    for (const SpaceArc& arc : shown.spline->arcs) {
        const int steps = std::max(1, int(std::ceil(16 * arc.bend * arc.half)));
        for (int i = 0; i <= steps; ++i) {
            const double s = arc.half * (2.0 * i / steps - 1);
            visit(arc.begin + arc.half + s, shown.placement.of(placeOn(arc, s)));
        }
    }
}

}  // namespace

std::optional<Shown> shownOf(const Node& node, const Placement& placement) {
    std::optional<Knots> knots = knotsOf(node);
    if (!knots || node.muted) return std::nullopt;
    SplinePtr spline = splineOf(*knots);
    return Shown{node.id, knotsInput(node), std::move(*knots), std::move(spline), placement};
}

std::optional<double> alongAt(const Shown& shown, const Lens& lens, ImVec2 mouse, double reach) {
    if (!shown.spline) return std::nullopt;
    std::optional<double> found;
    std::optional<ImVec2> before;
    double beforeAlong = 0;
    eachPlace(shown, [&](double along, const glm::dvec3& place) {
        const std::optional<ImVec2> at = lens.project(place);
        if (at && before) {
            const double x = at->x - before->x, y = at->y - before->y, length = x * x + y * y,
                         t = length > 0 ? std::clamp(((mouse.x - before->x) * x + (mouse.y - before->y) * y) /
                                                         length,
                                                     0.0, 1.0)
                                        : 0.0,
                         far = std::hypot(mouse.x - before->x - t * x, mouse.y - before->y - t * y);
            if (far < reach) reach = far, found = beforeAlong + t * (along - beforeAlong);
        }
        before = at, beforeAlong = along;
    });
    return found;
}

void draw(const Shown& shown, const Lens& lens, ImDrawList& list, float scale) {
    if (shown.spline) {
        std::vector<ImVec2> points;
        const auto stroke = [&] {
            list.AddPolyline(points.data(), int(points.size()), kBehind, 0, 3.5f * scale);
            list.AddPolyline(points.data(), int(points.size()), themeColor(ThemeColor::active), 0,
                             1.5f * scale);
            points.clear();
        };
        eachPlace(shown, [&](double, const glm::dvec3& place) {
            const std::optional<ImVec2> at = lens.project(place);
            if (!at) return stroke();
            if (points.empty() || std::hypot(at->x - points.back().x, at->y - points.back().y) > 1.0f)
                points.push_back(*at);
        });
        stroke();
    }
    const std::size_t count = shown.knots.count();
    for (std::size_t i = 0; i < count; ++i) {
        if (!shown.knots.isHandle(i)) continue;
        const std::size_t point = i % 3 == 1 ? i - 1 : (i + 1) % count;
        const auto from = lens.project(shown.placement.of(shown.knots.at(point))),
                   to = lens.project(shown.placement.of(shown.knots.at(i)));
        if (from && to) list.AddLine(*from, *to, kHandleLine, scale);
    }
}

}  // namespace fw::editor::splines
