// The curve editor: every component of the shown tracks as a curve over time, its keys, and the tangents of
// those that are selected.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "editor/canvas/fields.h"
#include "editor/shell/theme.h"
#include "editor/timeline/curves.h"
#include "editor/timeline/strip.h"

namespace fw::editor {

namespace {

constexpr float kTangent = 42.0f, kPoint = 3.5f, kNearPoint = 7.0f;  // pixels of the interface
constexpr float kApart = 5.0f;          // pixels of the interface between keys that are drawn as points
constexpr std::size_t kFineCurves = 8;  // so many are drawn as fine as they can be seen

ImU32 dimmed(ImU32 color, bool dim) {
    ImVec4 value = ImGui::ColorConvertU32ToFloat4(color);
    if (dim) value.w *= 0.4f;
    return ImGui::ColorConvertFloat4ToU32(value);
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

}  // namespace

void drawCurves(const Strip& strip, const StripHit& hit) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(strip.body.lo, strip.body.hi, true);
    drawGrid(strip);
    std::size_t count = 0;
    eachShown(strip, [&](std::size_t, const Track& track) { count += track.keys[0].value.size(); });
    // Many curves are drawn more coarsely: together they hide what a single one would tell.
    const float grain = std::clamp(float(count) / float(kFineCurves), 1.0f, 8.0f);
    std::vector<ImVec2> points;
    eachShown(strip, [&](std::size_t row, const Track& track) {
        const bool dim = strip.state.row && *strip.state.row != movedBy(track);
        for (std::size_t c = 0; c < track.keys[0].value.size(); ++c) {
            const ImU32 color = dimmed(curveColor(track, c), dim);
            curvePoints(track, c, strip.state.view, strip.state.values, grain, points);
            list->AddPolyline(points.data(), int(points.size()), color, 0, dim ? 1.0f : 1.5f);
            drawPoints(strip, hit, row, track, c, color);
        }
    });
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
