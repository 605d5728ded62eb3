// How the ruler, the markers and the bar of the selection look.
#include <algorithm>
#include <cmath>

#include "editor/shell/theme.h"
#include "editor/timeline/strip.h"

namespace fw::editor {

namespace {

constexpr float kLabelApart = 62.0f, kFlag = 5.0f, kBarGrip = 5.0f;  // pixels of the interface

ImU32 seeThrough(ImU32 color, float alpha) {
    ImVec4 value = ImGui::ColorConvertU32ToFloat4(color);
    value.w *= alpha;
    return ImGui::ColorConvertFloat4ToU32(value);
}

}  // namespace

std::size_t Strip::rowAt(float y) const {
    const float row = std::floor((y - body.lo.y + state.scroll) / high);
    return row < 0.0f ? timeline.tracks.size() : std::size_t(row);
}

std::vector<double> Strip::markerTimes() const {
    std::vector<double> times;
    for (const Marker& marker : timeline.markers) times.push_back(marker.time);
    return times;
}

double Strip::timeUnderMouse() const {
    const double time = snappedTime(state.view.time(ImGui::GetIO().MousePos.x), timeline.framesPerSecond,
                                    markerTimes(), seconds(kBarGrip), ImGui::GetIO().KeyAlt);
    return std::max(time, 0.0);
}

void drawDiamond(ImDrawList* list, ImVec2 c, float r, ImU32 fill, ImU32 edge) {
    list->AddQuadFilled({c.x, c.y - r}, {c.x + r, c.y}, {c.x, c.y + r}, {c.x - r, c.y}, fill);
    list->AddQuad({c.x, c.y - r}, {c.x + r, c.y}, {c.x, c.y + r}, {c.x - r, c.y}, edge, 1.5f);
}

void drawRuler(const Strip& strip) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const TimeView& view = strip.state.view;
    const Area& ruler = strip.ruler;
    const float high = ruler.height(), end = std::min(view.x(strip.timeline.length), ruler.hi.x);
    list->AddRectFilled({std::max(view.x(0.0), ruler.lo.x), ruler.lo.y}, {end, ruler.hi.y},
                        themeColor(ThemeColor::node));
    if (strip.timeline.range) {
        const float from = std::max(view.x(strip.timeline.range->from), ruler.lo.x),
                    to = std::min(view.x(strip.timeline.range->to), ruler.hi.x);
        if (from < to) {
            list->AddRectFilled({from, ruler.lo.y}, {to, ruler.hi.y},
                                seeThrough(themeColor(ThemeColor::warning), 0.22f));
            list->AddRectFilled({from, ruler.lo.y}, {to, ruler.lo.y + 3.0f * strip.scale()},
                                themeColor(ThemeColor::warning));
        }
    }
    for (const RulerMark& mark :
         rulerMarks(view, strip.timeline.framesPerSecond, strip.state.frames, kLabelApart * strip.scale())) {
        const float x = std::floor(view.x(mark.time));
        const float up = mark.label.empty() ? 0.88f : 0.78f;  // below the words
        list->AddLine({x, ruler.lo.y + up * high}, {x, ruler.hi.y}, themeColor(ThemeColor::quiet));
        if (!mark.label.empty())
            list->AddText({x + 3.0f, ruler.lo.y + 4.0f * strip.scale()}, themeColor(ThemeColor::quiet),
                          mark.label.c_str());
    }
}

void drawMarkers(const Strip& strip) {
    if (strip.markers.height() < 1.0f) return;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const TimeView& view = strip.state.view;
    const float flag = kFlag * strip.scale();
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < strip.timeline.markers.size(); ++i) order.push_back(i);
    std::ranges::sort(order, {}, [&](std::size_t i) { return strip.timeline.markers[i].time; });
    const auto hovered = strip.hovered ? markerAt(strip, ImGui::GetIO().MousePos) : std::nullopt;
    for (std::size_t n = 0; n < order.size(); ++n) {
        const Marker& marker = strip.timeline.markers[order[n]];
        const float x = std::floor(view.x(marker.time));
        if (x > strip.markers.hi.x) break;
        const float next = n + 1 < order.size() ? view.x(strip.timeline.markers[order[n + 1]].time) - flag
                                                : strip.markers.hi.x;
        if (std::max(next, x) < strip.markers.lo.x) continue;
        const ImU32 color =
            hovered == order[n] ? themeColor(ThemeColor::active) : themeColor(ThemeColor::warning);
        list->AddLine({x, strip.markers.lo.y}, {x, strip.body.hi.y}, seeThrough(color, 0.35f));
        list->AddTriangleFilled({x - flag, strip.markers.lo.y + 2.0f}, {x + flag, strip.markers.lo.y + 2.0f},
                                {x, strip.markers.hi.y - 4.0f}, color);
        const float left = x + flag + 6.0f;
        const ImVec4 clip(std::max(left, strip.markers.lo.x), strip.markers.lo.y,
                          std::min(next - 2.0f, strip.markers.hi.x), strip.markers.hi.y);
        if (clip.z > clip.x)
            list->AddText(nullptr, 0.0f, {left, strip.markers.lo.y + 4.0f}, color, marker.name.c_str(),
                          nullptr, 0.0f, &clip);
    }
}

std::optional<std::size_t> markerAt(const Strip& strip, ImVec2 at) {
    if (!strip.markers.contains(at)) return std::nullopt;
    std::optional<std::size_t> found;
    float best = 1e9f;
    for (std::size_t i = 0; i < strip.timeline.markers.size(); ++i) {
        const Marker& marker = strip.timeline.markers[i];
        const float x = strip.state.view.x(marker.time);
        const float wide = ImGui::CalcTextSize(marker.name.c_str()).x + 2.0f * kFlag * strip.scale();
        if (at.x < x - kFlag * strip.scale() || at.x > x + wide) continue;
        if (const float off = std::abs(at.x - x); off < best) best = off, found = i;
    }
    return found;
}

void drawBar(const Strip& strip) {
    if (strip.state.selection.size() < 2) return;
    const auto [first, last] = strip.state.selection.span();
    if (last - first <= kSameTime) return;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float x0 = strip.state.view.x(first), x1 = strip.state.view.x(last);
    const float top = strip.bar.lo.y + 1.0f, bottom = strip.bar.hi.y - 1.0f, grip = kBarGrip * strip.scale();
    const BarPart part = strip.hovered ? barAt(strip, ImGui::GetIO().MousePos) : BarPart::nothing;
    const auto lit = [&](BarPart of) {
        return themeColor(part == of ? ThemeColor::active : ThemeColor::selected);
    };
    list->AddRectFilled({x0, top + 1.0f}, {x1, bottom - 1.0f}, seeThrough(lit(BarPart::middle), 0.6f));
    list->AddRectFilled({x0 - grip, top}, {x0, bottom}, lit(BarPart::first));
    list->AddRectFilled({x1, top}, {x1 + grip, bottom}, lit(BarPart::last));
}

BarPart barAt(const Strip& strip, ImVec2 at) {
    if (!strip.bar.contains(at) || strip.state.selection.size() < 2) return BarPart::nothing;
    const auto [first, last] = strip.state.selection.span();
    if (last - first <= kSameTime) return BarPart::nothing;
    const float grip = kBarGrip * strip.scale(), x0 = strip.state.view.x(first),
                x1 = strip.state.view.x(last);
    if (at.x >= x0 - grip - 2.0f && at.x <= x0 + 1.0f) return BarPart::first;
    if (at.x >= x1 - 1.0f && at.x <= x1 + grip + 2.0f) return BarPart::last;
    return at.x > x0 && at.x < x1 ? BarPart::middle : BarPart::nothing;
}

void drawTimes(const Strip& strip) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize(), end = std::floor(strip.state.view.x(strip.timeline.length)),
                now = std::floor(strip.state.view.x(strip.editor.viewport.seconds));
    const float top = strip.ruler.lo.y, bottom = strip.body.hi.y;
    if (end < strip.body.hi.x)
        list->AddRectFilled({std::max(end, strip.body.lo.x), strip.bar.lo.y}, {strip.body.hi.x, bottom},
                            themeColor(ThemeColor::beyond));
    list->AddLine({end, top}, {end, bottom}, themeColor(ThemeColor::edge), 2.0f);
    list->AddLine({now, top}, {now, bottom}, themeColor(ThemeColor::active), 2.0f);
    list->AddTriangleFilled({now - 0.4f * em, top}, {now + 0.4f * em, top}, {now, top + 0.6f * em},
                            themeColor(ThemeColor::active));
}

}  // namespace fw::editor
