// The curve editor: every component of the shown tracks as a curve over time, its keys, and the tangents of
// those that are selected.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "editor/canvas/fields.h"
#include "editor/shell/theme.h"
#include "editor/timeline/columns.h"
#include "editor/timeline/curves.h"
#include "editor/timeline/signs.h"
#include "editor/timeline/strip.h"

namespace fw::editor {

namespace {

constexpr float kTangent = 42.0f, kPoint = 3.5f, kNearPoint = 7.0f;  // pixels of the interface
constexpr float kApart = 5.0f;              // pixels of the interface between keys that are drawn as points
constexpr std::size_t kFineCurves = 8;      // so many are drawn as fine as they can be seen
constexpr std::size_t kFewKeys = 600;       // so many keys of curves are drawn one by one
constexpr std::size_t kMostCurves = 65535;  // that columns have numbers for
constexpr std::size_t kManyPieces = 10000;  // rectangles of curves: with more they are drawn more coarsely,
constexpr float kCoarsest = 3.0f;           // until cells are so large; pixels of the interface
constexpr std::size_t kFewSelected = 50;    // so many of more have their tangents shown
constexpr float kCrowd = 12.0f;             // pixels of the interface: a square with one point of many

constexpr float kDim = 0.4f;  // opacity

ImU32 dimmed(ImU32 color, bool dim) {
    ImVec4 value = ImGui::ColorConvertU32ToFloat4(color);
    if (dim) value.w *= kDim;
    return ImGui::ColorConvertFloat4ToU32(value);
}

/// As dimmed() looks on a panel, but opaque.
ImU32 dimmedOnPanel(ImU32 color, bool dim) {
    const ImVec4 on = ImGui::ColorConvertU32ToFloat4(themeColor(ThemeColor::panel)),
                 value = ImGui::ColorConvertU32ToFloat4(color);
    const auto mix = [](float a, float b) { return a + kDim * (b - a); };
    return !dim ? color
                : ImGui::ColorConvertFloat4ToU32(
                      {mix(on.x, value.x), mix(on.y, value.y), mix(on.z, value.z), 1.0f});
}

ImU32 curveColor(const Track& track, std::size_t component) {
    if (track.keys[0].value.size() > 1) return axisColor(component);
    const std::size_t dot = track.name.rfind('.');  // of "offset.y"
    const std::string end = dot == std::string::npos ? "" : track.name.substr(dot + 1);
    return end == "x" ? axisColor(0) : end == "y" ? axisColor(1) : end == "z" ? axisColor(2) : axisColor(3);
}

/// The end of a tangent: as far from its key on the screen whatever the slope is.
ImVec2 tangentEnd(const Strip& strip, const Track& track, std::size_t i, std::size_t c, KeySide side) {
    const Key& key = track.keys[i];
    const double slope = slopeAt(track, i, c, side);
    const float x = float(1.0 / strip.state.view.perPixel()),
                y = -float(slope / std::max(strip.state.values.perPixel(), 1e-300));
    const float reach = kTangent * strip.scale() / std::max(std::hypot(x, y), 1e-6f),
                way = side == KeySide::out ? reach : -reach;
    return {strip.state.view.x(key.time) + way * x, strip.state.values.y(key.value[c]) + way * y};
}

/// Whether the tangent bends anything: the segment on that side is cubic.
bool hasTangent(const Track& track, std::size_t i, KeySide side) {
    if (track.keys.size() < 2) return false;
    if (side == KeySide::out)
        return i + 1 < track.keys.size() && track.keys[i].interpolation == Interpolation::cubic;
    return i > 0 && track.keys[i - 1].interpolation == Interpolation::cubic;
}

/// Calls see(row, track) for the tracks whose curves are shown; the row chosen last comes last, on top.
template <class See>
void eachShown(const Strip& strip, See see) {
    std::optional<std::size_t> top;
    for (std::size_t row = 0; row < strip.timeline.tracks.size(); ++row) {
        const Track& track = strip.timeline.tracks[row];
        const Moved moved = movedBy(track);
        if (!strip.state.shows(moved)) continue;
        if (strip.state.row == moved)
            top = row;
        else
            see(row, track);
    }
    if (top) see(*top, strip.timeline.tracks[*top]);
}

void drawGrid(const Strip& strip) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (double value : gridValues(strip.state.values, 26.0f * strip.scale())) {
        const float y = std::floor(strip.state.values.y(value));
        list->AddLine({strip.body.lo.x, y}, {strip.body.hi.x, y},
                      themeColor(value == 0.0 ? ThemeColor::edge : ThemeColor::grid));
    }
}

void drawValues(const Strip& strip) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float size = 0.85f * ImGui::GetFontSize();
    for (double value : gridValues(strip.state.values, 26.0f * strip.scale()))
        list->AddText(ImGui::GetFont(), size,
                      {strip.body.lo.x + 3.0f, std::floor(strip.state.values.y(value) - size)},
                      themeColor(ThemeColor::quiet), numberText(value).c_str());
}

void drawTangents(const Strip& strip, const StripHit& hit, std::size_t row, const Track& track, std::size_t i,
                  std::size_t c, ImU32 color) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 at(strip.state.view.x(track.keys[i].time), strip.state.values.y(track.keys[i].value[c]));
    for (const KeySide side : {KeySide::in, KeySide::out}) {
        if (!hasTangent(track, i, side)) continue;
        const ImVec2 end = tangentEnd(strip, track, i, c, side);
        const bool under = hit.what == StripHit::What::slope && hit.track == row && hit.key == i &&
                           hit.component == c && hit.side == side;
        list->AddLine(at, end, color, 1.0f);
        list->AddCircleFilled(end, (under ? 4.5f : 3.5f) * strip.scale(),
                              under ? themeColor(ThemeColor::active) : color, 8);
    }
}

void drawPoints(const Strip& strip, const StripHit& hit, std::size_t row, const Track& track, std::size_t c,
                ImU32 color) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const auto [first, last] = keysSeen(track, strip.state.view);
    const std::vector<double>* selected = strip.state.selection.of(movedBy(track));
    const float half = kPoint * strip.scale();
    float drawn = -1e9f;
    bool drawnSelected = false;
    for (std::size_t i = first; i < last; ++i) {
        const Key& key = track.keys[i];
        const ImVec2 at(strip.state.view.x(key.time), strip.state.values.y(key.value[c]));
        const bool chosen = selected && isAmong(*selected, key.time);
        const bool under =
            hit.what == StripHit::What::key && hit.track == row && hit.key == i && hit.component == c;
        if (at.x - drawn < kApart * strip.scale() && !under && (!chosen || drawnSelected)) continue;
        drawn = at.x, drawnSelected = chosen;
        if (at.y < strip.body.lo.y - 2.0f * half || at.y > strip.body.hi.y + 2.0f * half) continue;
        if (chosen && float(last - first) * 4.0f * half < strip.body.width())
            drawTangents(strip, hit, row, track, i, c, color);
        list->AddRectFilled({at.x - half, at.y - half}, {at.x + half, at.y + half},
                            chosen ? themeColor(ThemeColor::selected) : color);
        if (under || chosen)
            list->AddRect({at.x - half - 1.0f, at.y - half - 1.0f}, {at.x + half + 1.0f, at.y + half + 1.0f},
                          themeColor(ThemeColor::active));
    }
}

/// The square of a key, with a rim if it is selected or under the mouse.
void drawSquare(ImDrawList* list, ImVec2 at, float half, ImU32 color, bool rim) {
    if (rim)
        list->AddRectFilled({at.x - half - 1.0f, at.y - half - 1.0f},
                            {at.x + half + 1.0f, at.y + half + 1.0f}, themeColor(ThemeColor::active));
    list->AddRectFilled({at.x - half, at.y - half}, {at.x + half, at.y + half}, color);
}

bool isDim(const Strip& strip, const Track& track) {
    return strip.state.row && *strip.state.row != movedBy(track);
}

/// Curves with few keys, each by itself.
void drawFew(const Strip& strip, const StripHit& hit, std::size_t curves) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const bool fine = curves <= kFineCurves;
    std::vector<ImVec2> points;
    eachShown(strip, [&](std::size_t row, const Track& track) {
        const bool dim = isDim(strip, track);
        for (std::size_t c = 0; c < track.keys[0].value.size(); ++c) {
            const ImU32 color = dimmed(curveColor(track, c), dim);
            curvePoints(track, c, strip.state.view, strip.state.values, fine ? 1.0f : 8.0f, points);
            // Of whole pixels a piece is two triangles, otherwise six.
            list->AddPolyline(points.data(), int(points.size()), color, 0, fine && !dim ? 1.5f : 1.0f);
            drawPoints(strip, hit, row, track, c, color);
        }
    });
}

/// A point of a curve.
struct CrowdPoint {
    std::size_t row = 0, key = 0, component = 0;
    ImU32 color = 0;
};

/// The points of many keys, one in each small square, all that are selected before the others.
void drawCrowdedPoints(const Strip& strip, const StripHit& hit) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float half = kPoint * strip.scale();
    std::vector<PointMark> marks;
    std::vector<CrowdPoint> points;
    std::size_t selectedKeys = 0;
    eachShown(strip, [&](std::size_t row, const Track& track) {
        const auto [first, last] = keysSeen(track, strip.state.view);
        const std::vector<double>* selected = strip.state.selection.of(movedBy(track));
        // Of keys closer than their signs the curve tells enough.
        const bool signs = float(last - first) * kApart * strip.scale() < strip.body.width();
        const bool dim = isDim(strip, track);
        for (std::size_t i = first; i < last; ++i) {
            const Key& key = track.keys[i];
            const bool chosen = selected && isAmong(*selected, key.time);
            if (!chosen && !signs) continue;
            selectedKeys += chosen;
            for (std::size_t c = 0; c < key.value.size(); ++c) {
                marks.push_back({{strip.state.view.x(key.time), strip.state.values.y(key.value[c])}, chosen});
                points.push_back({row, i, c, dimmedOnPanel(curveColor(track, c), dim)});
            }
        }
    });
    for (const std::size_t i : thinned(marks, strip.body.lo, strip.body.hi, kCrowd * strip.scale())) {
        const auto [at, chosen] = marks[i];
        const CrowdPoint& point = points[i];
        const Track& track = strip.timeline.tracks[point.row];
        if (chosen && selectedKeys <= kFewSelected)
            drawTangents(strip, hit, point.row, track, point.key, point.component, point.color);
        drawSquare(list, at, half, chosen ? themeColor(ThemeColor::selected) : point.color, chosen);
    }
    if (hit.what != StripHit::What::key) return;
    const Track& track = strip.timeline.tracks[hit.track];
    const Key& key = track.keys[hit.key];
    const std::vector<double>* selected = strip.state.selection.of(movedBy(track));
    drawSquare(list, {strip.state.view.x(key.time), strip.state.values.y(key.value[hit.component])}, half,
               selected && isAmong(*selected, key.time) ? themeColor(ThemeColor::selected)
                                                        : curveColor(track, hit.component),
               true);
}

/// Curves with many keys: what is seen of all of them together, the coarser the more there is of it.
void drawCrowd(const Strip& strip, const StripHit& hit, std::size_t curves) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    std::vector<ImU32> colors{0};
    eachShown(strip, [&](std::size_t, const Track& track) {
        for (std::size_t c = 0; c < track.keys[0].value.size(); ++c)
            colors.push_back(dimmedOnPanel(curveColor(track, c), isDim(strip, track)));
    });
    if (colors.size() > kMostCurves) colors.resize(kMostCurves);
    const float scale = std::max(std::round(strip.scale()), 1.0f);
    std::vector<ColumnPiece> pieces;
    for (float side = curves <= kFineCurves ? 1.0f : 2.0f; side <= kCoarsest; ++side) {
        Columns columns = emptyColumns(strip.body.lo, strip.body.hi, side * scale);
        std::size_t next = 1;
        eachShown(strip, [&](std::size_t, const Track& track) {
            const std::size_t first = std::exchange(next, next + track.keys[0].value.size());
            if (next <= colors.size())
                paintCurves(columns, track, strip.state.view, strip.state.values, uint16_t(first));
        });
        pieces = piecesOf(columns);
        if (pieces.size() <= kManyPieces) break;
    }
    for (const ColumnPiece& piece : pieces) list->AddRectFilled(piece.lo, piece.hi, colors[piece.curve]);
    drawCrowdedPoints(strip, hit);
}

}  // namespace

void drawCurves(const Strip& strip, const StripHit& hit) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(strip.body.lo, strip.body.hi, true);
    drawGrid(strip);
    std::size_t curves = 0, keys = 0;
    eachShown(strip, [&](std::size_t, const Track& track) {
        const auto [first, last] = keysSeen(track, strip.state.view);
        const std::size_t count = track.keys[0].value.size();
        curves += count, keys += (last - first) * count;
    });
    if (keys <= kFewKeys)
        drawFew(strip, hit, curves);
    else
        drawCrowd(strip, hit, curves);
    drawValues(strip);
    list->PopClipRect();
}

StripHit hitCurves(const Strip& strip, ImVec2 at) {
    StripHit found;
    if (!strip.body.contains(at)) return found;
    float best = kNearPoint * strip.scale();
    const double reach = double(best + kTangent * strip.scale()) * strip.state.view.perPixel();
    const auto consider = [&](ImVec2 place, const StripHit& hit) {
        const float off = std::hypot(place.x - at.x, place.y - at.y);
        if (off <= best) best = off, found = hit;
    };
    eachShown(strip, [&](std::size_t row, const Track& track) {
        TimeView near = strip.state.view;
        near.from = strip.state.view.time(at.x) - reach, near.to = strip.state.view.time(at.x) + reach;
        const auto [first, last] = keysSeen(track, near);
        const std::vector<double>* selected = strip.state.selection.of(movedBy(track));
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t c = 0; c < track.keys[i].value.size(); ++c) {
                const Key& key = track.keys[i];
                consider({strip.state.view.x(key.time), strip.state.values.y(key.value[c])},
                         {StripHit::What::key, row, i, c});
                if (!selected || !isAmong(*selected, key.time)) continue;
                for (const KeySide side : {KeySide::in, KeySide::out})
                    if (hasTangent(track, i, side))
                        consider(tangentEnd(strip, track, i, c, side),
                                 {StripHit::What::slope, row, i, c, side});
            }
    });
    return found;
}

}  // namespace fw::editor
