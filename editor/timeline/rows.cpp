// Rows of keys: a line for each track, a diamond for each key.
#include <algorithm>
#include <cmath>

#include "editor/shell/theme.h"
#include "editor/timeline/curves.h"
#include "editor/timeline/signs.h"
#include "editor/timeline/strip.h"

namespace fw::editor {

namespace {

constexpr float kKeyRadius = 0.3f;      // of a row's height
constexpr float kReach = 2.0f;          // pixels beyond it that still count
constexpr float kBunch = 0.75f;         // of the radius: keys that are nearer to each other have one sign
constexpr std::size_t kFewSigns = 150;  // so many are drawn with soft edges

/// The rows that are seen: first <= i < last.
std::pair<std::size_t, std::size_t> rowsSeen(const Strip& strip) {
    const std::size_t first = std::min(strip.rowAt(strip.body.lo.y), strip.timeline.tracks.size());
    const std::size_t count = std::size_t(std::max(strip.body.height() / strip.high, 0.0f)) + 2;
    return {first, std::min(first + count, strip.timeline.tracks.size())};
}

float keyRadius(const Strip& strip) { return kKeyRadius * strip.high; }
float rowMiddle(const Strip& strip, std::size_t row) {
    return std::floor(strip.rowTop(row) + 0.5f * strip.high);
}

void drawRow(const Strip& strip, std::size_t row) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const Track& track = strip.timeline.tracks[row];
    const TimeView& view = strip.state.view;
    const float middle = rowMiddle(strip, row);
    if (strip.state.row == movedBy(track))
        list->AddRectFilled({strip.body.lo.x, strip.rowTop(row)},
                            {strip.body.hi.x, strip.rowTop(row) + strip.high},
                            themeColor(ThemeColor::stripe));
    list->AddLine({strip.body.lo.x, middle}, {strip.body.hi.x, middle}, themeColor(ThemeColor::grid));
    const float first = view.x(track.keys.front().time), last = view.x(track.keys.back().time);
    if (last > first)
        list->AddLine({std::max(first, strip.body.lo.x), middle}, {std::min(last, strip.body.hi.x), middle},
                      themeColor(ThemeColor::edge), 2.0f);
}

std::vector<KeySign> signsOfRow(const Strip& strip, std::size_t row, std::vector<KeyMark>& marks) {
    const Track& track = strip.timeline.tracks[row];
    const std::vector<double>* selected = strip.state.selection.of(movedBy(track));
    TimeView wider = strip.state.view;
    wider.from -= strip.seconds(10.0f), wider.to += strip.seconds(10.0f);
    const auto [begin, end] = keysSeen(track, wider);
    marks.clear();
    for (std::size_t i = begin; i < end; ++i) {
        const double time = track.keys[i].time;
        marks.push_back({strip.state.view.x(time), selected && isAmong(*selected, time)});
    }
    return signsOf(marks, kBunch * keyRadius(strip));
}

/// A diamond as long as its keys; of many without soft edges, which are most of its triangles.
void drawSign(ImDrawList* list, const KeySign& sign, float middle, float radius, ImU32 edge, bool many) {
    const ImU32 fill = themeColor(sign.chosen ? ThemeColor::selected : ThemeColor::node);
    const bool one = sign.first == sign.last;
    if (one && !many) return drawDiamond(list, {sign.first, middle}, radius, fill, edge);
    const auto shape = [&](float r, ImU32 color) {
        const ImVec2 corners[] = {{sign.first - r, middle}, {sign.first, middle - r},
                                  {sign.last, middle - r},  {sign.last + r, middle},
                                  {sign.last, middle + r},  {sign.first, middle + r}};
        const ImVec2 diamond[] = {corners[0], corners[1], corners[3], corners[4]};
        list->AddConvexPolyFilled(one ? diamond : corners, one ? 4 : 6, color);
    };
    const ImDrawListFlags flags = list->Flags;
    if (many) list->Flags &= ~ImDrawListFlags_AntiAliasedFill;
    shape(radius + 1.0f, edge);
    shape(radius - 1.0f, fill);
    list->Flags = flags;
}

}  // namespace

void drawRows(const Strip& strip, const StripHit& hit) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const auto [first, last] = rowsSeen(strip);
    const float radius = keyRadius(strip);
    std::vector<std::vector<KeySign>> signs;
    std::vector<KeyMark> marks;
    std::size_t count = 0;
    for (std::size_t row = first; row < last; ++row) {
        drawRow(strip, row);
        count += signs.emplace_back(signsOfRow(strip, row, marks)).size();
    }
    // Those that are selected lie on top.
    for (const bool chosen : {false, true})
        for (std::size_t row = first; row < last; ++row)
            for (const KeySign& sign : signs[row - first])
                if (sign.chosen == chosen)
                    drawSign(list, sign, rowMiddle(strip, row), radius,
                             themeColor(chosen ? ThemeColor::active : ThemeColor::text), count > kFewSigns);
    if (hit.what != StripHit::What::key) return;
    const Track& track = strip.timeline.tracks[hit.track];
    const double time = track.keys[hit.key].time;
    const bool chosen = strip.state.selection.contains(movedBy(track), time);
    drawDiamond(list, {strip.state.view.x(time), rowMiddle(strip, hit.track)}, radius,
                themeColor(chosen ? ThemeColor::selected : ThemeColor::node), themeColor(ThemeColor::active));
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
