// A curve's box: the curve on a grid, its points, and the selected point's values.
#include <algorithm>
#include <cmath>

#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/ramps/gestures.h"
#include "editor/shell/theme.h"
#include "graph/document/input_value.h"

namespace fw::editor::ramps {

namespace {

constexpr float kReachOfPoint = 8.0f;  // pixels from a point to the mouse
constexpr float kPixelsOfPiece = 3.0f;

/// A step of 1, 2 or 5 times a power of ten, at least so wide.
double gridStep(double least) {
    const double ten = std::pow(10.0, std::floor(std::log10(least)));
    for (const double times : {1.0, 2.0, 5.0})
        if (ten * times >= least) return ten * times;
    return 10.0 * ten;
}

void drawGrid(ImDrawList* list, const Sheet& sheet, float apart) {
    const ImU32 color = themeColor(ThemeColor::grid), zero = themeColor(ThemeColor::quiet);
    const double across = gridStep(sheet.x.span() * double(apart / sheet.place.width())),
                 up = gridStep(sheet.y.span() * double(apart / sheet.place.height()));
    for (double k = std::ceil(sheet.x.lo / across); k * across <= sheet.x.hi; ++k) {
        const float x = std::floor(sheet.toScreen(k * across, 0.0).x);
        list->AddLine({x, sheet.place.lo.y}, {x, sheet.place.hi.y}, k == 0.0 ? zero : color);
    }
    for (double k = std::ceil(sheet.y.lo / up); k * up <= sheet.y.hi; ++k) {
        const float y = std::floor(sheet.toScreen(0.0, k * up).y);
        list->AddLine({sheet.place.lo.x, y}, {sheet.place.hi.x, y}, k == 0.0 ? zero : color);
    }
}

void drawCurve(ImDrawList* list, const Shown& shown, const Sheet& sheet, float scale) {
    const auto pieces = std::size_t(std::max(sheet.place.width() / (kPixelsOfPiece * scale), 8.0f));
    const std::vector<double> heights =
        curveValues(shown.list, shown.interpolation, shown.ends, sheet.x.lo, sheet.x.hi, pieces);
    std::vector<ImVec2> line;
    for (std::size_t i = 0; i < heights.size(); ++i)
        line.push_back(
            sheet.toScreen(sheet.x.lo + sheet.x.span() * double(i) / double(pieces - 1),
                           // Far beyond the box, where no pixel is to tell it from farther off.
                           std::clamp(heights[i], sheet.y.lo - sheet.y.span(), sheet.y.hi + sheet.y.span())));
    list->AddPolyline(line.data(), int(line.size()), themeColor(ThemeColor::text), 0, 1.5f * scale);
}

/// Where the selected point is.
void showPoint(const Shown& shown, std::size_t at) {
    Editor& editor = shown.editor;
    ImGui::SetNextItemWidth(shown.width);
    editNumbers(
        editor, "##place", shown.list.entry(at),
        {.speed = std::max(placesOf(shown.list).span(), heightsOf(shown.list).span()) / 250.0}, "Move Point",
        [&editor, list = shown.list, at, scope = shown.scope, plug = Plug{shown.node, shown.input}](
            const Graph& graph, std::span<const double> to) {
            const Edited next = replaced(list, at, to);
            editor.panelState.ramp.selected = next.entry;
            return setInput(graph, scope, plug, listValue(next.list.type, next.list.numbers));
        },
        shown.path());
}

/// Some room to both sides, so that what is beyond the ends is seen.
Range withRoom(const Range& range) { return {range.lo - 0.1 * range.span(), range.hi + 0.1 * range.span()}; }

}  // namespace

void showCurve(const Shown& shown) {
    ImGui::PushID("curve");
    const RampHand& hand = shown.editor.panelState.ramp;
    const bool mine = hand.does != RampHand::Does::nothing && hand.input == shown.path();
    const float scale = shown.editor.shell.scale(), em = ImGui::GetFontSize();
    const ImVec2 lo = ImGui::GetCursorScreenPos();
    const Area whole{lo, {lo.x + shown.width, lo.y + std::clamp(0.5f * shown.width, 6.0f * em, 10.0f * em)}};
    const Sheet sheet{whole, mine ? hand.x : withRoom(placesOf(shown.list)),
                      mine ? hand.y : heightsOf(shown.list), true};
    const bool active = followHand(shown, sheet, whole, kReachOfPoint * scale);

    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(whole.lo, whole.hi, ImGui::GetColorU32(ImGuiCol_FrameBg));
    list->PushClipRect(whole.lo, whole.hi, true);
    drawGrid(list, sheet, 2.0f * em);
    drawCurve(list, shown, sheet, scale);
    const auto selected = selectedOf(shown);
    for (std::size_t i = 0; i < shown.list.count(); ++i) {
        const ImVec2 c = sheet.toScreen(shown.list.entry(i)[0], shown.list.entry(i)[1]);
        const float half = (selected == i ? 5.0f : 4.0f) * scale;
        list->AddRectFilled({c.x - half, c.y - half}, {c.x + half, c.y + half},
                            themeColor(selected == i ? ThemeColor::active : ThemeColor::node));
        list->AddRect({c.x - half, c.y - half}, {c.x + half, c.y + half}, themeColor(ThemeColor::text));
    }
    list->PopClipRect();
    list->AddRect(whole.lo, whole.hi, themeColor(active ? ThemeColor::active : ThemeColor::edge));

    // What is seen, rounded as it is drawn: across, and from below up.
    const auto range = [](const char* name, const Range& r) {
        return std::string(name) + " " + numberText(rounded(r.lo, r, 100.0)) + " … " +
               numberText(rounded(r.hi, r, 100.0));
    };
    ImGui::TextDisabled("%s", range("x", sheet.x).c_str());
    const std::string up = range("y", sheet.y);
    ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x < ImGui::CalcTextSize(up.c_str()).x) ImGui::NewLine();
    ImGui::TextDisabled("%s", up.c_str());
    if (selected) showPoint(shown, *selected);
    showAddAndRemove(shown);
    const auto button = [&](const char* words, const char* tip) {
        ImGui::SameLine();
        if (ImGui::GetContentRegionAvail().x < ImGui::CalcTextSize(words).x + em) ImGui::NewLine();
        const bool pressed = ImGui::Button(words);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
        return pressed;
    };
    if (button("Reverse", "The other way around"))
        shown.apply("Reverse Curve", reversed(shown.list), shown.list.count() - 1 - selected.value_or(0));
    if (button("Even", "All points as far from each other, across"))
        shown.apply("Distribute Points", distributed(shown.list), selected.value_or(0));
    ImGui::PopID();
}

}  // namespace fw::editor::ramps
