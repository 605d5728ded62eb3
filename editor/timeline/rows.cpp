// Rows of keys: a line for each track, a diamond for each key.
#include <algorithm>
#include <cmath>

#include "editor/shell/theme.h"
#include "editor/timeline/curves.h"
#include "editor/timeline/strip.h"

namespace fw::editor {

namespace {

constexpr float kKeyRadius = 0.3f;  // of a row's height
constexpr float kReach = 2.0f;      // pixels beyond it that still count

/// The rows that are seen: first <= i < last.
std::pair<std::size_t, std::size_t> rowsSeen(const Strip& strip) {
    const std::size_t first = std::min(strip.rowAt(strip.body.lo.y), strip.timeline.tracks.size());
    const std::size_t count = std::size_t(std::max(strip.body.height() / strip.high, 0.0f)) + 2;
    return {first, std::min(first + count, strip.timeline.tracks.size())};
}

void drawRow(const Strip& strip, const StripHit& hit, std::size_t row) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Track& track = strip.timeline.tracks[row];
    const Moved moved = movedBy(track);
    const TimeView& view = strip.state.view;
    const float middle = std::floor(strip.rowTop(row) + 0.5f * strip.high), radius = kKeyRadius * strip.high;
    if (strip.state.row == moved)
        list->AddRectFilled({strip.body.lo.x, strip.rowTop(row)},
                            {strip.body.hi.x, strip.rowTop(row) + strip.high},
                            themeColor(ThemeColor::stripe));
    list->AddLine({strip.body.lo.x, middle}, {strip.body.hi.x, middle}, themeColor(ThemeColor::grid));
    const float first = view.x(track.keys.front().time), last = view.x(track.keys.back().time);
    if (last > first)
        list->AddLine({std::max(first, strip.body.lo.x), middle}, {std::min(last, strip.body.hi.x), middle},
                      themeColor(ThemeColor::edge), 2.0f);
    const std::vector<double>* selected = strip.state.selection.of(moved);
    TimeView wider = view;
    wider.from -= strip.seconds(10.0f), wider.to += strip.seconds(10.0f);
    const auto [begin, end] = keysSeen(track, wider);
    // Of keys that lie on each other one is enough; a selected one is seen.
    constexpr float kNear = 1.0f;
    float drawn = -1e9f;
    bool drawnSelected = false;
    for (std::size_t i = begin; i < end; ++i) {
        const float x = view.x(track.keys[i].time);
        const bool chosen = selected && isAmong(*selected, track.keys[i].time);
        const bool under = hit.what == StripHit::What::key && hit.track == row && hit.key == i;
        if (x - drawn < kNear && !under && (!chosen || drawnSelected)) continue;
        drawn = x, drawnSelected = chosen;
        drawDiamond(list, {x, middle}, radius, themeColor(chosen ? ThemeColor::selected : ThemeColor::node),
                    themeColor(under || chosen ? ThemeColor::active : ThemeColor::text));
    }
}

}  // namespace

void drawRows(const Strip& strip, const StripHit& hit) {
    const auto [first, last] = rowsSeen(strip);
    for (std::size_t row = first; row < last; ++row) drawRow(strip, hit, row);
}

StripHit hitRows(const Strip& strip, ImVec2 at) {
    if (!strip.body.contains(at)) return {};
    const std::size_t row = strip.rowAt(at.y);
    if (row >= strip.timeline.tracks.size()) return {};
    const double reach = double(kKeyRadius * strip.high + kReach) * strip.state.view.perPixel();
    const auto key = keyNear(strip.timeline.tracks[row], strip.state.view.time(at.x), reach);
    if (!key) return {};
    return {StripHit::What::key, row, *key, 0};
}

}  // namespace fw::editor
