// A ramp's bar: its colours, a handle under each stop, and the selected stop's values.
#include <algorithm>
#include <cmath>

#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/ramps/gestures.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "graph/document/input_value.h"

namespace fw::editor::ramps {

namespace {

constexpr float kReachOfStop = 6.0f;  // pixels from a stop to the mouse
constexpr int kPiecesOfBar = 12;

/// A house with its tip at the place, in the stop's colour.
void drawHandle(ImDrawList* list, ImVec2 tip, float half, ImU32 fill, bool selected) {
    const ImVec2 corners[] = {tip,
                              {tip.x + half, tip.y + half},
                              {tip.x + half, tip.y + 2.6f * half},
                              {tip.x - half, tip.y + 2.6f * half},
                              {tip.x - half, tip.y + half}};
    list->AddConvexPolyFilled(corners, 5, fill);
    list->AddPolyline(corners, 5, themeColor(selected ? ThemeColor::active : ThemeColor::text),
                      ImDrawFlags_Closed, (selected ? 0.45f : 0.2f) * half);
}

/// The position and the colour of the selected stop.
void showStop(const Shown& shown, std::size_t at) {
    Editor& editor = shown.editor;
    const Range range = placesOf(shown.list);
    std::vector<double> color(shown.list.entry(at).begin() + 1, shown.list.entry(at).end());
    const Touched touched = pickColor("##color", color);
    follow(
        editor, "##color", touched, "Set Colour of Stop",
        [&] {
            List next = shown.list;
            std::ranges::copy(color, next.numbers.begin() + std::ptrdiff_t(next.size() * at) + 1);
            return shown.with(next);
        },
        shown.path());
    ImGui::SameLine();
    ImGui::SetNextItemWidth(shown.width - 1.6f * ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x);
    editNumbers(
        editor, "##position", shown.list.entry(at).first(1), {.speed = range.span() / 250.0}, "Move Stop",
        [&editor, list = shown.list, at, scope = shown.scope, plug = Plug{shown.node, shown.input}](
            const Graph& graph, std::span<const double> to) {
            const Edited next = moved(list, at, to[0]);
            editor.panelState.ramp.selected = next.entry;
            return setInput(graph, scope, plug, listValue(next.list.type, next.list.numbers));
        },
        shown.path());
}

void showPresets(const Shown& shown) {
    if (!ImGui::BeginPopup("presets")) return;
    const float high = ImGui::GetTextLineHeight(), wide = 8.0f * ImGui::GetFontSize();
    for (const Preset& preset : presets()) {
        if (ImGui::Selectable(std::string(preset.name).c_str(), false, 0, {1.8f * wide, high}))
            shown.apply("Take Preset", stretched(preset, placesOf(shown.list)), 0);
        const ImVec2 hi(ImGui::GetItemRectMax().x, ImGui::GetItemRectMin().y + high);
        drawRamp(ImGui::GetWindowDrawList(), {hi.x - wide, hi.y - high}, hi,
                 {Type::stops, {preset.stops.begin(), preset.stops.end()}}, "linear", {0.0, 1.0},
                 kPiecesOfBar);
    }
    ImGui::EndPopup();
}

void showTools(const Shown& shown) {
    showAddAndRemove(shown);
    const auto button = [&](const char* words, const char* tip) {
        besideIfFits(words);
        const bool pressed = ImGui::Button(words);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
        return pressed;
    };
    const std::size_t selected = selectedOf(shown).value_or(0);
    if (button("Reverse", "The other way around"))
        shown.apply("Reverse Ramp", reversed(shown.list), shown.list.count() - 1 - selected);
    if (button("Even", "All stops as far from each other"))
        shown.apply("Distribute Stops", distributed(shown.list), selected);
    if (button("Presets …", "Ramps to begin with, between the ends of this one")) ImGui::OpenPopup("presets");
    showPresets(shown);
}

}  // namespace

void drawRamp(ImDrawList* list, ImVec2 lo, ImVec2 hi, const List& stops, std::string_view interpolation,
              const Range& range, int pieces) {
    if (stops.count() == 0 || stops.count() > kMostStops) return;
    const auto x = [&](double at) {
        return std::clamp(lo.x + float((at - range.lo) / range.span()) * (hi.x - lo.x), lo.x, hi.x);
    };
    const auto color = [&](std::size_t i) {
        return shownColor({stops.entry(i)[1], stops.entry(i)[2], stops.entry(i)[3]});
    };
    const std::size_t last = stops.count() - 1;
    list->AddRectFilled(lo, {x(stops.at(0)), hi.y}, color(0));
    list->AddRectFilled({x(stops.at(last)), lo.y}, hi, color(last));
    for (std::size_t i = 0; i < last; ++i) {
        const double from = stops.at(i), wide = stops.at(i + 1) - from;
        if (interpolation == "constant") {
            list->AddRectFilled({x(from), lo.y}, {x(from + wide), hi.y}, color(i));
            continue;
        }
        for (int k = 0; k < pieces && wide > 0.0; ++k) {
            const double a = from + wide * k / pieces, b = from + wide * (k + 1) / pieces;
            // At the next stop itself another colour may begin.
            const ImU32 left = shownColor(colorAt(stops, interpolation, a)),
                        right = k + 1 < pieces ? shownColor(colorAt(stops, interpolation, b)) : color(i + 1);
            list->AddRectFilledMultiColor({x(a), lo.y}, {x(b), hi.y}, left, right, right, left);
        }
    }
}

void showRamp(const Shown& shown) {
    ImGui::PushID("ramp");
    const RampHand& hand = shown.editor.panelState.ramp;
    const bool mine = hand.does != RampHand::Does::nothing && hand.input == shown.path();
    const float scale = shown.editor.shell.scale(), half = 5.0f * scale, high = ImGui::GetFrameHeight(),
                words = ImGui::GetTextLineHeight();
    const ImVec2 lo = ImGui::GetCursorScreenPos();
    const Area whole{lo, {lo.x + shown.width, lo.y + high + 2.6f * half + words}};
    // With room for the handles at the ends.
    const Sheet sheet{{{lo.x + half, lo.y}, {whole.hi.x - half, lo.y + high}},
                      mine ? hand.x : placesOf(shown.list),
                      {},
                      false};
    const bool active = followHand(shown, sheet, whole, kReachOfStop * scale);

    ImDrawList* list = ImGui::GetWindowDrawList();
    drawRamp(list, sheet.place.lo, sheet.place.hi, shown.list, shown.interpolation, sheet.x, kPiecesOfBar);
    list->AddRect(sheet.place.lo, sheet.place.hi, themeColor(active ? ThemeColor::active : ThemeColor::edge));
    const auto selected = selectedOf(shown);
    const auto handle = [&](std::size_t i) {
        const auto entry = shown.list.entry(i);
        drawHandle(list, sheet.toScreen(entry[0]), half, shownColor({entry[1], entry[2], entry[3]}),
                   selected == i);
    };
    for (std::size_t i = 0; i < shown.list.count(); ++i)
        if (selected != i) handle(i);
    if (selected) handle(*selected);
    const std::string from = numberText(sheet.x.lo), to = numberText(sheet.x.hi);
    const float below = whole.hi.y - words;
    list->AddText({lo.x, below}, themeColor(ThemeColor::quiet), from.c_str());
    list->AddText({whole.hi.x - ImGui::CalcTextSize(to.c_str()).x, below}, themeColor(ThemeColor::quiet),
                  to.c_str());

    if (selected)
        showStop(shown, *selected);
    else {
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("%zu stop%s", shown.list.count(), shown.list.count() == 1 ? "" : "s");
    }
    showTools(shown);
    ImGui::PopID();
}

}  // namespace fw::editor::ramps
