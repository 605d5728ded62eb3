#include "editor/viewport/widths.h"

#include <string>

#include "editor/controls/plate.h"
#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "editor/viewport/ground.h"
#include "graph/bounds/region.h"
#include "graph/document/unit.h"
#include "runtime/render/view.h"

namespace fw::editor {

namespace {

constexpr float kScaleWide = 210.0f, kScaleHigh = 8.0f;  // pixels at scale 1
constexpr double kDragged = 0.02;                        // of the width, by a pixel

ImU32 scaleColor(float times) {
    const glm::vec3 color = gpu::widthColor(times);
    return ImGui::GetColorU32({color.x, color.y, color.z, 1.0f});
}

}  // namespace

float leastWidth(const Viewport& viewport) {
    if (!showsWidths(viewport.view)) return 0.0f;
    if (viewport.leastWidth > 0.0f) return viewport.leastWidth;
    return usualWidth(float(longestSide(viewport.shown.region)));
}

void chooseLeastWidth(Editor& editor) {
    Viewport& view = editor.viewport;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("At least");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(110 * editor.shell.scale());
    const double width = double(leastWidth(view));
    dragNumbers(editor, "##least", std::span(&width, 1),
                {.min = 0.0, .max = 1e9, .speed = kDragged * width, .unit = "m"},
                [&view](std::span<const double> to) { view.leastWidth = float(to[0]); });
}

void showWidthScale(const Editor& editor) {
    const Viewport& view = editor.viewport;
    if (!showsWidths(view.view) || !view.texture) return;
    const float scale = editor.shell.scale(), pad = 6.0f * scale, third = kScaleWide * scale / 3.0f;
    const float line = ImGui::GetTextLineHeight(), bar = kScaleHigh * scale;
    const ImVec2 size(3.0f * third + 2.0f * pad, 2.0f * line + bar + 3.0f * pad);
    if (size.x + pad > view.place.width() || size.y + pad > view.place.height()) return;
    const ImVec2 lo(view.place.lo.x + pad, view.place.hi.y - pad - size.y);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(lo, {lo.x + size.x, lo.y + size.y}, themeColor(ThemeColor::plate), 4.0f * scale);
    const ImU32 ink = themeColor(ThemeColor::text);
    const ImVec2 at(lo.x + pad, lo.y + pad);
    list->AddText(at, ink,
                  view.view == RENDER_GAP ? "Gaps; grey: nothing faces" : "Walls; grey: nothing faces");
    const float top = at.y + line + 0.5f * pad;
    constexpr float kTimes[] = {0.0f, 1.0f, 2.0f, RENDER_MOST_WIDTHS};
    const LengthUnit& unit = unitOf(editor.document.graph());
    for (int i = 0; i < 3; ++i) {
        const float left = at.x + float(i) * third;
        const ImU32 from = scaleColor(kTimes[i]), to = scaleColor(i == 0 ? 0.999f : kTimes[i + 1]);
        list->AddRectFilledMultiColor({left, top}, {left + third, top + bar}, from, to, to, from);
        const std::string words = lengthWords(double(kTimes[i + 1] * leastWidth(view)), unit);
        const ImVec2 wide = ImGui::CalcTextSize(words.c_str());
        const float middle = i == 2 ? left + third - wide.x : left + third - 0.5f * wide.x;
        list->AddText({middle, top + bar + 0.5f * pad}, ink, words.c_str());
    }
}

}  // namespace fw::editor
