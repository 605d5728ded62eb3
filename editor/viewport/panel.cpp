// The picture of what the graph makes, and the camera that it is seen by.
#include <algorithm>
#include <cmath>

#include "editor/controls/plate.h"
#include "editor/editor.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "editor/viewport/camera_path.h"
#include "editor/viewport/ground.h"
#include "editor/viewport/widths.h"
#include "graph/document/unit.h"

namespace fw::editor {

namespace {

constexpr std::pair<uint32_t, const char*> kViews[] = {
    {RENDER_PICTURE, "Lit"},     {RENDER_AMBIENT, "Ambient occlusion"},
    {RENDER_NORMALS, "Normals"}, {RENDER_BASE, "Colours"},
    {RENDER_SHADOW, "Shadow"},   {RENDER_STEPS, "Steps"},
    {RENDER_SLICE, "Slice"},     {RENDER_EXACTNESS, "Exactness"},
    {RENDER_CELLS, "Cells"},     {RENDER_THICKNESS, "Thickness"},
    {RENDER_GAP, "Gap"},         {RENDER_WIREFRAME, "Wireframe"},
    {RENDER_POINTS, "Points"},   {RENDER_SPHERES, "Spheres"}};
constexpr float kPictureGap = 2.0f;  // pixels between pictures, times the scale
constexpr int kResolutions[] = {0, 32, 64, 128, 192, 256, 384, 512};

/// Where the plane is that the field is shown on.
void showSlice(Viewport& view, const LengthUnit& lengths, float unit) {
    constexpr const char* kPlanes[] = {"Across the view", "Across x", "Across y", "Across z"};
    ImGui::SetNextItemWidth(140 * unit);
    int chosen = view.slice.axis + 1;
    if (ImGui::Combo("##plane", &chosen, kPlanes, int(std::size(kPlanes)))) view.slice.axis = chosen - 1;
    float reach = 0.0f;
    for (std::size_t i = 0; i < 3; ++i)
        if (view.slice.axis < 0 || view.slice.axis == int(i))
            reach = std::max(reach, 0.5f * float(view.shown.region.hi[i] - view.shown.region.lo[i]));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-FLT_MIN);
    const std::string format = std::string("%.3f ") + lengths.name + " from the middle";
    ImGui::SliderFloat("##place", &view.slice.at, -reach, reach, format.c_str());
}

void showChoices(Editor& editor) {
    Viewport& view = editor.viewport;
    const float unit = editor.shell.scale();
    const auto chosen = std::ranges::find(kViews, view.view, &std::pair<uint32_t, const char*>::first);
    ImGui::SetNextItemWidth(140 * unit);
    if (ImGui::BeginCombo("##view", chosen->second)) {
        for (const auto& [id, name] : kViews)
            if (ImGui::Selectable(name, id == view.view)) view.view = id;
        ImGui::EndCombo();
    }
    besideIfFits(110 * unit);
    ImGui::SetNextItemWidth(110 * unit);
    const auto cells = [](int count) {
        return count == 0 ? std::string("As exported") : std::to_string(count) + " cells";
    };
    if (ImGui::BeginCombo("##cells", cells(view.resolution).c_str())) {
        for (int count : kResolutions)
            if (ImGui::Selectable(cells(count).c_str(), count == view.resolution)) view.resolution = count;
        ImGui::EndCombo();
    }
    if (const bool split = view.split.count > 1; split || view.ownCamera) {
        const char* label = split ? "Reset views" : "Reset view";
        besideIfFits(label);
        if (ImGui::Button(label)) {
            if (split)
                resetEyes(view);
            else
                view.ownCamera = false;
        }
    }
    if (!view.pinned.empty()) {
        const float room = ImGui::GetContentRegionAvail().x - 2.0f * ImGui::GetStyle().FramePadding.x;
        const std::string words =
            fitted("Showing " + view.pinned, room - ImGui::CalcTextSize(" ×").x) + " ×##pinned";
        besideIfFits(words.c_str());
        if (ImGui::Button(words.c_str())) view.pinned.clear();
    }
    if (view.view == RENDER_SLICE || view.view == RENDER_EXACTNESS)
        showSlice(view, unitOf(editor.document.graph()), unit);
    if (showsWidths(view.view)) chooseLeastWidth(editor);
}

/// Words over the picture, top left.
void caption(const Area& place, const char* text, ImU32 color, float scale) {
    const float gap = 3.0f * scale, room = plateSize({}, scale).x;
    showPlate(ImGui::GetWindowDrawList(), {place.lo.x + gap, place.lo.y + gap + 2.0f * scale},
              fitted(text, place.width() - 2.0f * gap - room), color, scale);
}

/// The room that the pictures have; the hand goes to the one under a mouse that does something.
void layPictures(Editor& editor, const Area& room) {
    Viewport& view = editor.viewport;
    const ImGuiIO& io = ImGui::GetIO();
    const bool does = io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f || io.MouseWheel != 0.0f ||
                      io.MouseWheelH != 0.0f || ImGui::IsAnyMouseDown();
    const bool free = !view.drag.busy() && !view.gizmo.drag && !editor.document.held();
    const auto places = placesOf(room, view.split.count, std::floor(kPictureGap * editor.shell.scale()));
    std::size_t hand = view.split.hand;
    for (std::size_t i = 0; i < view.split.count; ++i) {
        const Borrowed borrowed(view, i);
        view.place = places[i];
        view.hovered = false;
        if (view.place.width() < 1.0f || view.place.height() < 1.0f) continue;
        ImGui::SetCursorScreenPos(view.place.lo);
        ImGui::PushID(int(i));
        ImGui::InvisibleButton("##picture", {view.place.width(), view.place.height()},
                               ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                                   ImGuiButtonFlags_MouseButtonRight);
        ImGui::PopID();
        view.hovered = ImGui::IsItemHovered();
        ImGui::SetItemAllowOverlap();  // by the buttons of the gizmo
        if (view.hovered && does && free) hand = i;
    }
    takeHand(view, hand);
}

/// What is seen in one of them.
void showPicture(Editor& editor) {
    const Viewport& view = editor.viewport;
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (view.texture)
        list->AddImage(view.texture, view.place.lo, view.place.hi);
    else
        list->AddRectFilled(view.place.lo, view.place.hi, themeColor(ThemeColor::canvas));
    showGround(editor);
    showWidthScale(editor);
    showGizmo(editor);
    showCameraPath(editor);
    showProbeMarks(editor);
}

/// What the first one is busy with, or why it is not what the graph says.
void showState(Editor& editor) {
    const Borrowed borrowed(editor.viewport, 0);
    const Viewport& view = editor.viewport;
    const Area& place = view.place;
    const float scale = editor.shell.scale();
    if (const std::optional<double> share = editor.preview.baking())
        caption(place,
                ("measuring distances to the mesh, " + std::to_string(int(100.0 * *share)) + " %").c_str(),
                themeColor(ThemeColor::text), scale);
    else if (const std::optional<double> steps = editor.preview.simulating())
        caption(place, ("simulating up to here, " + std::to_string(int(100.0 * *steps)) + " %").c_str(),
                themeColor(ThemeColor::text), scale);
    else if (view.texture && !view.shown.current)
        caption(place, "showing the last valid version", themeColor(ThemeColor::warning), scale);
    else if (!view.texture)
        caption(place,
                view.shown.findings.empty() ? "making the first picture …"
                                            : "the graph has problems: see the list",
                themeColor(ThemeColor::text), scale);
}

}  // namespace

void shadeNext(Viewport& viewport) {
    const auto at = std::ranges::find(kViews, viewport.view, &std::pair<uint32_t, const char*>::first);
    viewport.view = kViews[std::size_t(at - std::begin(kViews) + 1) % std::size(kViews)].first;
}

void showViewport(Editor& editor) {
    Viewport& view = editor.viewport;
    followKeptViews(editor);
    showChoices(editor);
    const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    if (room.x < 1.0f || room.y < 1.0f) {
        for (std::size_t i = 0; i < view.split.count; ++i) {
            const Borrowed borrowed(view, i);
            view.hovered = false;
        }
        return;
    }
    layPictures(editor, {at, {at.x + room.x, at.y + room.y}});
    const ImGuiIO& io = ImGui::GetIO();
    const bool measures = editor.probe.tool != Measure::nothing && !view.gizmo.drag;
    if (measures) view.gizmo.hovered.reset();
    if (view.texture && (measures || !followGizmo(editor)) && navigate(view) && !takeProbeClick(editor))
        pickUnderMouse(editor, io.KeyCtrl || io.KeyShift);
    followProbe(editor);
    if (const Aside::Answer answer = view.aside.take()) answer(editor);
    for (std::size_t i = 0; i < view.split.count; ++i) {
        const Borrowed borrowed(view, i);
        showPicture(editor);
    }
    showState(editor);
    if (view.split.count > 1)
        ImGui::GetWindowDrawList()->AddRect(view.place.lo, view.place.hi, themeColor(ThemeColor::active),
                                            0.0f, 0, editor.shell.scale());
}

}  // namespace fw::editor
