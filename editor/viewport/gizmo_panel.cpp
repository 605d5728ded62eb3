// The gizmo over the picture: what the mouse does with its handles, and how they look.
#include <algorithm>

#include "editor/editor.h"
#include "editor/shell/theme.h"
#include "graph/document/input_value.h"

namespace fw::editor {

namespace {

using Kind = Handle::Kind;

constexpr ImU32 kAtOnce = IM_COL32(0xf0, 0xf0, 0xf0, 255), kRefused = IM_COL32(0x90, 0x90, 0x90, 200),
                kShadow = IM_COL32(0, 0, 0, 110);
constexpr float kAbove = 140.0f;  // canvas units
constexpr const char* kAxisNames[] = {"x", "y", "z"};

void followDocument(Editor& editor, Gizmo& gizmo) {
    const Viewport& view = editor.viewport;
    const Gizmo::Made made{editor.drawn, editor.canvas.scope, editor.canvas.active,
                           view.pinned,  view.seconds,        gizmo.tool};
    if (made == gizmo.made) return;
    gizmo.made = made;
    gizmo.grips = gripsOf(*editor.graph, made.scope, made.node, made.pinned, made.seconds, made.tool);
}

std::string nameOf(const Editor& editor, const std::string& id) {
    const NodeBox* box = editor.boxes->find(id);
    return box ? titleOf(*box) : id;
}

/// "Move Head", of the node that is selected.
std::string doing(const Editor& editor, const Handle& handle) {
    const char* verb = handle.kind == Kind::move ? "Move " : handle.kind == Kind::turn ? "Rotate " : "Scale ";
    return verb + nameOf(editor, editor.canvas.active);
}

void tell(const Editor& editor, const Gizmo& gizmo, const HandleHit& hit) {
    const Handle& handle = gizmo.grips.handles[hit.handle];
    std::string words = doing(editor, handle);
    if (hit.axis != kAcrossView && handle.count == 3) words += std::string(" · ") + kAxisNames[hit.axis];
    if (handle.node.empty())
        words += "\nAdds a node: " + typeFor(gizmo.tool).label;
    else
        words += "\n" + readable(handle.input) +
                 (handle.node == editor.canvas.active ? "" : " of " + nameOf(editor, handle.node));
    if (!handle.refusal.empty()) words += "\n" + handle.refusal;
    if (!gizmo.grips.why.empty()) words += "\nIt is drawn " + gizmo.grips.why + ".";
    ImGui::SetTooltip("%s", words.c_str());
}

void go(Editor& editor, Gizmo& gizmo, const Lens& lens) {
    const ImGuiIO& io = ImGui::GetIO();
    HandleDrag& drag = *gizmo.drag;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        editor.document.cancel(drag.hand);
        gizmo.drag.reset();
        return;
    }
    std::vector<double> numbers = dragTo(drag, lens, io.MousePos, io.KeyShift, io.KeyCtrl);
    if (numbers != gizmo.numbers) {
        gizmo.numbers = numbers;
        editor.document.update(drag.hand,
                               setInput(editor.document.graph(), editor.canvas.scope,
                                        {drag.handle.node, drag.handle.input}, numbersValue(numbers)));
    }
    if (ImGui::IsMouseDown(0)) return;
    if (gizmo.numbers == drag.handle.numbers)
        editor.document.cancel(drag.hand);
    else
        editor.document.end(drag.hand);
    gizmo.drag.reset();
}

void take(Editor& editor, Gizmo& gizmo, HandleDrag drag) {
    drag.hand = editor.document.begin(doing(editor, drag.handle));
    if (drag.handle.node.empty()) {
        const NodeBox *from = editor.boxes->find(editor.canvas.active),
                      *to = editor.boxes->find(gizmo.grips.ahead->node);
        // Above the wire: there it hides neither of the two.
        const ImVec2 a = from->area.lo, b = to->area.lo;
        Edited added =
            insertOnWire(editor.document.graph(), editor.canvas.scope, *gizmo.grips.ahead,
                         typeFor(gizmo.tool).id, position({0.5f * (a.x + b.x), std::min(a.y, b.y) - kAbove}));
        if (added.nodes.empty()) return editor.document.cancel(drag.hand);  // the document is full
        drag.handle.node = added.nodes.front();
        editor.document.update(drag.hand, std::move(added.graph));
    }
    gizmo.numbers = drag.handle.numbers;
    gizmo.drag = std::move(drag);
    editor.viewport.takeCamera();  // else a picture that is framed anew would move what is seen
}

struct Brush {
    ImDrawList* list;
    const Lens& lens;
    float scale;

    void line(ImVec2 a, ImVec2 b, ImU32 color, float thick) const {
        list->AddLine(a, b, kShadow, thick + 2.0f * scale);
        list->AddLine(a, b, color, thick);
    }
    void arrow(ImVec2 from, ImVec2 to, ImU32 color, float thick) const {
        const float dx = to.x - from.x, dy = to.y - from.y, length = std::max(std::hypot(dx, dy), 1e-3f);
        const ImVec2 along(dx / length, dy / length);
        const float head = 11.0f * scale, half = 5.0f * scale;
        const ImVec2 base(to.x - head * along.x, to.y - head * along.y);
        line(from, base, color, thick);
        list->AddTriangleFilled(to, {base.x - half * along.y, base.y + half * along.x},
                                {base.x + half * along.y, base.y - half * along.x}, color);
    }
    void box(ImVec2 at, ImU32 color) const {
        const float half = 5.0f * scale;
        list->AddRectFilled({at.x - half - 1, at.y - half - 1}, {at.x + half + 1, at.y + half + 1}, kShadow);
        list->AddRectFilled({at.x - half, at.y - half}, {at.x + half, at.y + half}, color);
    }
    void axis(const Handle& handle, int axis, ImU32 color, bool lit) const {
        const float thick = (lit ? 3.5f : 2.0f) * scale;
        if (handle.kind == Kind::turn) {
            const std::vector<ImVec2> ring = ringOf(handle, axis, lens, double(scale));
            list->AddPolyline(ring.data(), int(ring.size()), kShadow, 0, thick + 2.0f * scale);
            list->AddPolyline(ring.data(), int(ring.size()), color, 0, thick);
            return;
        }
        if (!isSeen(handle, axis, lens)) return;
        const auto from = lens.project(handle.origin),
                   to = lens.project(
                       handle.tip(axis, kHandlePixels * double(scale) * lens.metresPerPixel(handle.origin)));
        if (!from || !to) return;
        if (handle.kind == Kind::move) return arrow(*from, *to, color, thick);
        line(*from, *to, color, thick);
        box(*to, color);
    }
};

void draw(const Editor& editor, const Gizmo& gizmo, const Lens& lens) {
    const Viewport& view = editor.viewport;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(view.place.lo, view.place.hi, true);
    const Brush brush{list, lens, editor.shell.scale()};
    for (std::size_t i = 0; i < gizmo.grips.handles.size(); ++i) {
        const Handle& handle = gizmo.grips.handles[i];
        const bool dragged = gizmo.drag && gizmo.drag->handle.input == handle.input;
        const auto lit = [&](int axis) {
            return gizmo.drag ? dragged && gizmo.drag->axis == axis : gizmo.hovered == HandleHit{i, axis};
        };
        const auto colorOf = [&](int axis, ImU32 plain) {
            return !handle.refusal.empty() ? kRefused : lit(axis) ? themeColor(ThemeColor::active) : plain;
        };
        for (int axis = 0; axis < handle.count; ++axis)
            brush.axis(handle, axis,
                       colorOf(axis, handle.count == 1 ? kAtOnce : axisColor(std::size_t(axis))), lit(axis));
        const auto at = lens.project(handle.origin);
        if (handle.kind == Kind::move && at) {
            const float radius = (lit(kAcrossView) ? 7.0f : 5.0f) * brush.scale;
            list->AddCircleFilled(*at, radius + brush.scale, kShadow);
            list->AddCircleFilled(*at, radius, colorOf(kAcrossView, kAtOnce));
        }
    }
    list->PopClipRect();
}

/// Small buttons at the picture's left edge; whether the mouse is on one.
void showTools(Editor& editor, Gizmo& gizmo) {
    constexpr std::pair<Tool, const char*> kTools[] = {
        {Tool::move, "Move"}, {Tool::turn, "Rotate"}, {Tool::scale, "Scale"}};
    const float scale = editor.shell.scale(), high = ImGui::GetTextLineHeightWithSpacing() + 2 * scale;
    ImVec2 at(editor.viewport.place.lo.x + 8 * scale, editor.viewport.place.hi.y - 3 * high - 6 * scale);
    for (const auto& [tool, name] : kTools) {
        ImGui::SetCursorScreenPos(at);
        const bool chosen = tool == gizmo.tool;
        ImGui::BeginDisabled(!gizmo.grips.tools.contains(tool));
        ImGui::PushStyleColor(ImGuiCol_Button,
                              ImGui::GetStyleColorVec4(chosen ? ImGuiCol_ButtonActive : ImGuiCol_Button));
        if (ImGui::Button(name, {60 * scale, high - 2 * scale})) gizmo.tool = tool;
        ImGui::PopStyleColor();
        ImGui::EndDisabled();
        at.y += high;
    }
}

}  // namespace

std::set<std::string> Gizmo::held(const std::string& scope) const {
    if (!drag) return {};
    return {(scope.empty() ? "" : scope + "/") + drag->handle.node + "." + drag->handle.input};
}

bool followGizmo(Editor& editor) {
    Viewport& view = editor.viewport;
    Gizmo& gizmo = view.gizmo;
    followDocument(editor, gizmo);
    const Lens lens(view.shown.seen, view.place);
    const double scale = double(editor.shell.scale());
    gizmo.hovered.reset();
    if (gizmo.drag && !editor.document.hold(gizmo.drag->hand)) gizmo.drag.reset();
    if (gizmo.drag) {
        go(editor, gizmo, lens);
        return true;
    }
    if (!view.hovered || view.drag.busy()) return false;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    gizmo.hovered = handleAt(gizmo.grips.handles, lens, mouse, scale);
    if (!gizmo.hovered) return false;
    tell(editor, gizmo, *gizmo.hovered);
    if (!ImGui::IsMouseClicked(0)) return false;
    const Handle& handle = gizmo.grips.handles[gizmo.hovered->handle];
    if (handle.refusal.empty() && !editor.document.held())
        take(editor, gizmo, takeHandle(handle, gizmo.hovered->axis, lens, mouse, scale));
    return true;
}

void showGizmo(Editor& editor) {
    Viewport& view = editor.viewport;
    if (!view.texture || view.gizmo.grips.tools.empty()) return;
    draw(editor, view.gizmo, Lens(view.shown.seen, view.place));
    showTools(editor, view.gizmo);
}

}  // namespace fw::editor
