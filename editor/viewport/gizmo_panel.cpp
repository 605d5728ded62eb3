// The gizmo over the picture: what the mouse does with its handles, and how they look.
#include <algorithm>

#include "editor/editor.h"
#include "editor/shell/theme.h"
#include "graph/timeline.h"

namespace fw::editor {

namespace {

using Kind = Handle::Kind;

constexpr ImU32 kAxes[] = {IM_COL32(0xe8, 0x5d, 0x5d, 255), IM_COL32(0x7c, 0xc0, 0x3c, 255),
                           IM_COL32(0x4f, 0x8f, 0xf0, 255)};
constexpr ImU32 kAtOnce = IM_COL32(0xf0, 0xf0, 0xf0, 255), kRefused = IM_COL32(0x90, 0x90, 0x90, 200),
                kShadow = IM_COL32(0, 0, 0, 110);
constexpr const char* kAxisNames[] = {"x", "y", "z"};

/// The node type that does what the tool does and nothing else; scaling is the same along all axes.
const NodeType& typeFor(Tool tool) {
    return *std::ranges::find_if(nodeTypes(), [&](const NodeType& type) {
        if (type.inputs.size() != 2 || type.inputs[0].type != Type::surface) return false;
        const InputSpec& input = type.inputs[1];
        return tool == Tool::move ? isPlace(input) : tool == Tool::turn ? isAngles(input) : isFactor(input);
    });
}

/// The input that the wire from `node` leads to in `next`, if it carries a surface.
std::optional<Plug> wireAhead(const std::vector<Node>& nodes, const std::string& node,
                              const std::string& next) {
    const NodeType* from = findNodeType(findNode(nodes, node)->type);
    const NodeType* to = findNodeType(findNode(nodes, next)->type);
    const bool makes = from && !from->outputs.empty() && from->outputs.front().type == Type::surface;
    for (const auto& [name, value] : findNode(nodes, next)->inputs) {
        const Link* link = std::get_if<Link>(&value.value);
        const int index = to ? inputIndex(*to, name) : -1;
        if (link && link->node == node &&
            (makes || (index >= 0 && to->inputs[std::size_t(index)].type == Type::surface)))
            return Plug{next, name};
    }
    return std::nullopt;
}

/// What can be dragged of the active node, or, where it has no such value, of the next node behind it that
/// moves it alone: clicking a shape takes hold of where it stands. If there is none, of one to be added.
void makeHandles(Editor& editor, Gizmo& gizmo) {
    gizmo.handles.clear(), gizmo.tools.clear(), gizmo.why.clear(), gizmo.ahead.reset();
    const Canvas& canvas = editor.canvas;
    if (canvas.active.empty()) return;
    const Graph* graph = editor.graph.get();
    std::optional<Graph> now;
    std::set<std::string> animated;
    if (const Result<Timeline> timeline = readTimeline(*graph); timeline && !timeline->tracks.empty()) {
        if (canvas.scope.empty()) animated = animatedInputs(*graph, *timeline);
        now = atTime(*graph, *timeline, timelineTime(*timeline, editor.viewport.seconds));
        graph = &*now;
    }
    const std::vector<Node>& nodes = nodesOf(*graph, canvas.scope);
    const auto way = wayToShown(*graph, canvas.scope, canvas.active, editor.viewport.pinned);
    if (!way || !findNode(nodes, canvas.active)) return;
    NodeIds all{canvas.active};
    all.insert(all.end(), way->begin(), way->end());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Node& node = *findNode(nodes, all[i]);
        const NodeType* type = findNodeType(node.type);
        const bool alone = type && std::ranges::count(type->inputs, Type::surface, &InputSpec::type) == 1;
        if (i > 0 && type && type->id != "reroute" && (!alone || !placementBy(node))) break;
        const Placement placement = placementAlong(*graph, canvas.scope, std::span(all).subspan(i + 1));
        for (Handle& handle : handlesOf(node, placement, animated)) {
            const Tool tool = handle.kind == Kind::move   ? Tool::move
                              : handle.kind == Kind::turn ? Tool::turn
                                                          : Tool::scale;
            gizmo.tools.insert(tool);
            // The first node that has some for the tool has them all.
            if (tool == gizmo.tool && (gizmo.handles.empty() || gizmo.handles.front().node == node.id))
                gizmo.handles.push_back(std::move(handle)), gizmo.why = placement.why;
        }
    }
    if (!way->empty()) gizmo.ahead = wireAhead(nodes, canvas.active, way->front());
    if (!gizmo.ahead) return;
    gizmo.tools = {Tool::move, Tool::turn, Tool::scale};
    if (!gizmo.handles.empty()) return;
    Node added;
    added.type = typeFor(gizmo.tool).id;
    const Placement placement = placementAlong(*graph, canvas.scope, *way);
    gizmo.handles = handlesOf(added, placement, {});
    gizmo.why = placement.why;
}

void followDocument(Editor& editor, Gizmo& gizmo) {
    const Viewport& view = editor.viewport;
    const Gizmo::Made made{editor.drawn, editor.canvas.scope, editor.canvas.active,
                           view.pinned,  view.seconds,        gizmo.tool};
    if (made == gizmo.made) return;
    gizmo.made = made;
    makeHandles(editor, gizmo);
}

std::string nameOf(const Editor& editor, const std::string& id) {
    const NodeBox* box = editor.boxes->find(id);
    return box ? titleOf(*box) : id;
}

/// "Move Head".
std::string doing(const Editor& editor, const Handle& handle) {
    const char* verb = handle.kind == Kind::move ? "Move " : handle.kind == Kind::turn ? "Rotate " : "Scale ";
    return verb + nameOf(editor, handle.node.empty() ? editor.canvas.active : handle.node);
}

void tell(const Editor& editor, const Gizmo& gizmo, const HandleHit& hit) {
    const Handle& handle = gizmo.handles[hit.handle];
    std::string words = doing(editor, handle);
    if (hit.axis != kAcrossView) words += std::string(" · ") + kAxisNames[hit.axis];
    words +=
        "\n" + (handle.node.empty() ? "Adds a node: " + typeFor(gizmo.tool).label : readable(handle.input));
    if (!handle.refusal.empty()) words += "\n" + handle.refusal;
    if (!gizmo.why.empty()) words += "\nIt is drawn " + gizmo.why + ".";
    ImGui::SetTooltip("%s", words.c_str());
}

void go(Editor& editor, Gizmo& gizmo, const Lens& lens) {
    const ImGuiIO& io = ImGui::GetIO();
    HandleDrag& drag = *gizmo.drag;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        editor.document.cancel();
        gizmo.drag.reset();
        return;
    }
    std::vector<double> numbers = dragTo(drag, lens, io.MousePos, io.KeyShift, io.KeyCtrl);
    if (numbers != gizmo.numbers) {
        gizmo.numbers = numbers;
        InputValue value;
        if (numbers.size() == 1)
            value.value = numbers[0];
        else
            value.value = std::move(numbers);
        editor.document.update(setInput(editor.document.graph(), editor.canvas.scope,
                                        {drag.handle.node, drag.handle.input}, std::move(value)));
    }
    if (ImGui::IsMouseDown(0)) return;
    if (gizmo.numbers == drag.handle.numbers)
        editor.document.cancel();
    else
        editor.document.end();
    gizmo.drag.reset();
}

void take(Editor& editor, Gizmo& gizmo, HandleDrag drag) {
    editor.document.begin(doing(editor, drag.handle));
    if (drag.handle.node.empty()) {
        const NodeBox *from = editor.boxes->find(editor.canvas.active),
                      *to = editor.boxes->find(gizmo.ahead->node);
        const ImVec2 a = from->area.lo, b = to->area.lo;
        Edited added =
            insertOnWire(editor.document.graph(), editor.canvas.scope, *gizmo.ahead, typeFor(gizmo.tool).id,
                         position({0.5f * (a.x + b.x), 0.5f * (a.y + b.y)}));
        if (added.nodes.empty()) return editor.document.cancel();  // the document is full
        drag.handle.node = added.nodes.front();
        editor.document.update(std::move(added.graph));
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
    for (std::size_t i = 0; i < gizmo.handles.size(); ++i) {
        const Handle& handle = gizmo.handles[i];
        const bool dragged = gizmo.drag && gizmo.drag->handle.input == handle.input;
        const auto lit = [&](int axis) {
            return gizmo.drag ? dragged && gizmo.drag->axis == axis : gizmo.hovered == HandleHit{i, axis};
        };
        const auto colorOf = [&](int axis, ImU32 plain) {
            return !handle.refusal.empty() ? kRefused : lit(axis) ? themeColor(ThemeColor::active) : plain;
        };
        for (int axis = 0; axis < 3; ++axis) brush.axis(handle, axis, colorOf(axis, kAxes[axis]), lit(axis));
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
        ImGui::BeginDisabled(!gizmo.tools.contains(tool));
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
    if (gizmo.drag) {
        go(editor, gizmo, lens);
        return true;
    }
    if (!view.hovered || view.drag.busy()) return false;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    gizmo.hovered = handleAt(gizmo.handles, lens, mouse, scale);
    if (!gizmo.hovered) return false;
    tell(editor, gizmo, *gizmo.hovered);
    if (!ImGui::IsMouseClicked(0)) return false;
    const Handle& handle = gizmo.handles[gizmo.hovered->handle];
    if (handle.refusal.empty() && !editor.document.inGesture())
        take(editor, gizmo, takeHandle(handle, gizmo.hovered->axis, lens, mouse, scale));
    return true;
}

void showGizmo(Editor& editor) {
    Viewport& view = editor.viewport;
    if (!view.texture || view.gizmo.tools.empty()) return;
    draw(editor, view.gizmo, Lens(view.shown.seen, view.place));
    showTools(editor, view.gizmo);
}

}  // namespace fw::editor
