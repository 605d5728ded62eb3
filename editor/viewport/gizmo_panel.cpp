// The gizmo over the picture: what the mouse does with its handles, and how they look.
#include <algorithm>
#include <cmath>

#include "editor/editor.h"
#include "editor/panels/properties.h"
#include "editor/shell/theme.h"
#include "editor/viewport/marks.h"
#include "graph/document/input_value.h"
#include "graph/document/unit.h"

namespace fw::editor {

namespace {

using Kind = Handle::Kind;

constexpr ImU32 kAtOnce = IM_COL32(0xf0, 0xf0, 0xf0, 255), kRefused = IM_COL32(0x90, 0x90, 0x90, 200),
                kShadow = IM_COL32(0, 0, 0, 110);
constexpr float kAbove = 140.0f;  // canvas units
constexpr const char* kAxisNames[] = {"x", "y", "z"};

void followDocument(Editor& editor, Gizmo& gizmo) {
    const Viewport& view = editor.viewport;
    const auto& [scope, selection, active] =
        std::tie(editor.canvas.scope, editor.canvas.selection, editor.canvas.active);
    // Another node is chosen, or the marks are gone: no part of the scene is held any more.
    if (active != gizmo.made.node || selection != gizmo.made.selection || !marksAreShown(editor))
        gizmo.part.clear();
    if (active != gizmo.made.node || scope != gizmo.made.scope) gizmo.knot = -1;
    const Gizmo::Made made{editor.drawn, scope,      active,      view.pinned, view.seconds, gizmo.tool,
                           selection,    gizmo.axes, gizmo.pivot, gizmo.point, gizmo.part,   gizmo.knot};
    // What moves several stays as it was taken.
    if (made == gizmo.made || (gizmo.drag && gizmo.start)) return;
    gizmo.made = made;
    gizmo.placings.clear();
    if (!gizmo.part.empty()) {
        std::set<std::string> animated;
        if (const Timeline* timeline = timelineOf(editor))
            for (const Track& track : timeline->tracks)
                if (track.target == Track::Target::scene) animated.insert(track.name);
        gizmo.grips = {};
        gizmo.grips.tools = {Tool::move};
        gizmo.grips.handles = handlesOf(sceneNow(editor), gizmo.part, view.shown.region, animated);
        return;
    }
    gizmo.grips = gripsOf(*editor.graph, made.scope, made.node, made.pinned, made.seconds, made.tool);
    for (Handle& handle : gizmo.grips.handles)
        if (handle.knot >= 0 && handle.knot == gizmo.knot) handle.count = 3;
    if (gizmo.grips.spline) return;
    const bool alone = selection.size() < 2 && gizmo.pivot == PivotAt::own;
    if (alone && (gizmo.axes == AxesOf::numbers || gizmo.tool == Tool::scale)) return;
    gizmo.placings = placingsOf(*editor.graph, scope, selection, made.pinned, made.seconds, made.tool);
    if (gizmo.placings.empty()) return;
    gizmo.grips.handles = {
        handleTogether(gizmo.placings, active, made.tool, gizmo.axes, gizmo.pivot, gizmo.point)};
    gizmo.grips.tools = {Tool::move, Tool::turn, Tool::scale};
}

std::string nameOf(const Editor& editor, const std::string& id) {
    const NodeBox* box = editor.boxes->find(id);
    return box ? titleOf(*box) : id;
}

/// "Move Head", of the node that is selected.
std::string doing(const Editor& editor, const Handle& handle) {
    if (!handle.scene.empty()) {
        for (const Mark& mark : marksOf(sceneNow(editor), editor.viewport.shown.region))
            if (handle.scene.starts_with(mark.part))
                return (handle.kind == Handle::Kind::aim                                  ? "Aim "
                        : handle.kind == Handle::Kind::move && handle.input == "position" ? "Move "
                        : handle.kind == Handle::Kind::move                               ? "Aim "
                                                                                          : "Resize ") +
                       mark.name;
        return "Set Scene";
    }
    const char* verb = handle.kind == Kind::move                               ? "Move "
                       : handle.kind == Kind::turn || handle.kind == Kind::aim ? "Rotate "
                       : handle.placing                                        ? "Move "
                                                                               : "Scale ";
    const std::size_t count = editor.viewport.gizmo.placings.size();
    if (count > 1) return verb + std::to_string(count) + " Nodes";
    return verb + nameOf(editor, editor.canvas.active);
}

std::string whichKnot(const Gizmo& gizmo, int knot) {
    const splines::Knots& knots = gizmo.grips.spline->knots;
    if (knots.isHandle(std::size_t(knot))) return "Handle";
    const bool end = !knots.closed && (knot == 0 || std::size_t(knot) + 1 == knots.count());
    return "Point " + std::to_string(knots.kind == SplineKind::bezier ? knot / 3 + 1 : knot + 1) +
           "; double-click removes it" + (end ? ", Ctrl and drag adds one" : "");
}

void tell(const Editor& editor, const Gizmo& gizmo, const HandleHit& hit) {
    const Handle& handle = gizmo.grips.handles[hit.handle];
    std::string words = doing(editor, handle);
    if (hit.axis != kAcrossView && handle.count == 3) words += std::string(" · ") + kAxisNames[hit.axis];
    if (!handle.scene.empty())
        words += handle.input.empty() ? "" : "\n" + readable(handle.input);
    else if (!gizmo.placings.empty())
        words += gizmo.pivot == PivotAt::own ? "\nEach about its own place" : "";
    else if (handle.knot >= 0)
        words += "\n" + whichKnot(gizmo, handle.knot);
    else if (handle.node.empty())
        words += "\nAdds a node: " + typeFor(gizmo.tool).label;
    else
        words += "\n" + readable(handle.input) +
                 (handle.node == editor.canvas.active ? "" : " of " + nameOf(editor, handle.node));
    if (!handle.refusal.empty()) words += "\n" + handle.refusal;
    if (!gizmo.grips.why.empty()) words += "\nIt is drawn " + gizmo.grips.why + ".";
    ImGui::SetTooltip("%s", words.c_str());
}

bool snaps(const Gizmo& gizmo) { return gizmo.snap.on != ImGui::GetIO().KeyCtrl; }

/// What a drag goes in steps of: while the magnet is on, or off and Ctrl is held.
Steps stepsNow(const Gizmo& gizmo, const Lens& lens, const Handle& handle) {
    Steps steps = snaps(gizmo);
    constexpr double kGridPixels = 8.0;
    steps.metres =
        gizmo.snap.byZoom
            ? std::pow(10.0, std::ceil(std::log10(kGridPixels * lens.metresPerPixel(handle.origin))))
            : gizmo.snap.metres;
    steps.degrees = gizmo.snap.degrees;
    return steps;
}

/// The nodes that what is dragged moves.
std::set<std::string> draggedNodes(const Gizmo& gizmo) {
    std::set<std::string> nodes;
    for (const Placing& placing : gizmo.placings) nodes.insert(placing.node);
    if (!gizmo.drag->handle.node.empty()) nodes.insert(gizmo.drag->handle.node);
    return nodes;
}

/// What is seen without what is dragged: nothing is fed by it.
std::shared_ptr<const Graph> withoutNodes(const Graph& graph, const std::string& scope,
                                          const std::set<std::string>& nodes) {
    Graph rest = graph;
    for (const Node& node : nodesOf(graph, scope))
        for (const auto& [name, value] : node.inputs)
            if (const Link* link = std::get_if<Link>(&value.value); link && nodes.contains(link->node))
                rest = disconnect(rest, scope, {node.id, name});
    return std::make_shared<const Graph>(std::move(rest));
}

/// The place that what is moved goes to: on the surface under the mouse, or the nearest of the features.
void aimAtPlace(Editor& editor, Gizmo& gizmo, const Lens& lens) {
    HandleDrag& drag = *gizmo.drag;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (drag.handle.kind != Kind::move || !snaps(gizmo) || gizmo.snap.to == Snap::To::grid) {
        drag.target.reset();
        return;
    }
    if (gizmo.snap.to == Snap::To::points || gizmo.snap.to == Snap::To::vertices) {
        constexpr float kReach = 18.0f;  // pixels, times the scale
        if (!gizmo.features) {
            const auto placesBy = gizmo.snap.to == Snap::To::points ? featuresOf : meshVertices;
            gizmo.features.emplace(placesBy(editor.document.graph(), editor.canvas.scope, draggedNodes(gizmo),
                                            editor.viewport.pinned, editor.viewport.seconds));
        }
        drag.target = gizmo.features->near(lens, mouse, kReach * editor.shell.scale());
        return;
    }
    if (!gizmo.surroundings)
        gizmo.surroundings = withoutNodes(editor.document.graph(), editor.canvas.scope, draggedNodes(gizmo));
    else if (mouse.x == gizmo.askedAt.x && mouse.y == gizmo.askedAt.y)
        return;
    gizmo.askedAt = mouse;
    Viewport& view = editor.viewport;
    Seen seen = seenNow(editor, gizmo.surroundings);
    seen.revision = 0;  // of the surroundings, which stay as they are
    const glm::dvec2 at = inPicture(view, mouse);
    view.aside.ask([&picker = view.picker, seen = std::move(seen), at, hand = drag.hand,
                    number = ++gizmo.asked]() -> Aside::Answer {
        std::optional<glm::dvec3> place;
        try {
            if (const auto hit = picker.hit(seen, at.x, at.y))
                place = glm::dvec3((*hit)[0], (*hit)[1], (*hit)[2]);
        } catch (const std::exception&) {  // then it moves as without
        }
        return [place, hand, number](Editor& to) {
            Gizmo& taken = to.viewport.gizmo;
            if (!taken.drag || taken.drag->hand != hand) return;
            taken.answered = number;
            if (place) taken.drag->target = place;
            Shell::wake();  // the mouse may have let go already
        };
    });
}

Graph withKnots(const Editor& editor, const Plug& plug, const splines::Knots& knots) {
    return setInput(editor.document.graph(), editor.canvas.scope, plug,
                    listValue(Type::knots, knots.numbers));
}

void go(Editor& editor, Gizmo& gizmo, const Lens& lens) {
    const ImGuiIO& io = ImGui::GetIO();
    HandleDrag& drag = *gizmo.drag;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        editor.document.cancel(drag.hand);
        gizmo.drag.reset();
        return;
    }
    aimAtPlace(editor, gizmo, lens);
    std::vector<double> numbers =
        dragTo(drag, lens, io.MousePos, io.KeyShift, stepsNow(gizmo, lens, drag.handle));
    if (numbers != gizmo.numbers) {
        gizmo.numbers = numbers;
        if (!drag.handle.scene.empty())
            editor.document.update(drag.hand,
                                   withSceneNumbers(editor.document.graph(), drag.handle, numbers));
        else if (drag.handle.knot >= 0)
            editor.document.update(
                drag.hand,
                withKnots(editor, {drag.handle.node, drag.handle.input},
                          splines::moved(gizmo.knots, std::size_t(drag.handle.knot), vectorOf(numbers))));
        else if (gizmo.start)
            editor.document.update(drag.hand, moved(*gizmo.start, editor.canvas.scope, gizmo.placings,
                                                    motionOf(drag.handle, drag.axis, numbers, gizmo.pivot)));
        else
            editor.document.update(drag.hand,
                                   setInput(editor.document.graph(), editor.canvas.scope,
                                            {drag.handle.node, drag.handle.input}, numbersValue(numbers)));
    }
    if (ImGui::IsMouseDown(0) || gizmo.asked != gizmo.answered) return;
    if (gizmo.numbers == drag.handle.numbers)
        editor.document.cancel(drag.hand);
    else
        editor.document.end(drag.hand);
    gizmo.drag.reset();
}

void take(Editor& editor, Gizmo& gizmo, HandleDrag drag) {
    drag.hand = editor.document.begin(doing(editor, drag.handle));
    gizmo.start.reset();
    gizmo.surroundings.reset();
    gizmo.features.reset();
    gizmo.asked = gizmo.answered = 0;
    if (!drag.handle.scene.empty()) {
        // Its numbers are the scene's: nothing is added.
    } else if (drag.handle.knot >= 0) {
        gizmo.knot = drag.handle.knot;
    } else if (!gizmo.placings.empty()) {
        gizmo.start = withPlacings(editor.document.graph(), editor.canvas.scope, gizmo.placings);
        if (!gizmo.start) return editor.document.cancel(drag.hand);  // the document is full
        editor.document.update(drag.hand, *gizmo.start);
    } else if (drag.handle.node.empty()) {
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

/// What the mouse does with a spline's points and with the spline; nothing where it is on neither.
std::optional<bool> followSpline(Editor& editor, Gizmo& gizmo, const Lens& lens) {
    const splines::Shown& shown = *gizmo.grips.spline;
    const Plug plug{shown.node, shown.input};
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double scale = double(editor.shell.scale());
    const auto takeKnot = [&](const splines::Inserted& with) {
        const glm::dvec3 at = with.knots.at(with.knot);
        Handle handle{.node = shown.node, .input = shown.input, .numbers = {at.x, at.y, at.z}};
        handle.knot = int(with.knot);
        handle.origin = shown.placement.of(at);
        handle.axes = shown.placement.linear;
        gizmo.knots = with.knots;
        take(editor, gizmo, takeHandle(handle, kAcrossView, lens, mouse, scale));
        return true;
    };
    if (gizmo.hovered) {
        const Handle& handle = gizmo.grips.handles[gizmo.hovered->handle];
        if (handle.knot < 0 || !handle.refusal.empty()) return std::nullopt;
        gizmo.knots = shown.knots;
        const auto knot = std::size_t(handle.knot);
        if (ImGui::IsMouseDoubleClicked(0)) {
            splines::Knots rest = splines::removed(shown.knots, knot);
            if (rest != shown.knots) {
                gizmo.knot = -1;
                editor.document.apply("Remove Point", withKnots(editor, plug, rest));
            }
            return true;
        }
        const bool end = knot == 0 || knot + 1 == shown.knots.count();
        if (end && ImGui::IsMouseClicked(0) && ImGui::GetIO().KeyCtrl)
            if (auto with = splines::extended(shown.knots, knot != 0)) {
                // It begins at the end that it is pulled out of.
                const glm::dvec3 at = shown.knots.at(knot);
                with->knots = splines::moved(std::move(with->knots), with->knot, at);
                return takeKnot(*with);
            }
        return std::nullopt;
    }
    constexpr double kNearSpline = 7.0;  // pixels, times the scale
    const auto along = splines::alongAt(shown, lens, mouse, kNearSpline * scale);
    if (!along) return std::nullopt;
    ImGui::SetTooltip("Drag: a new point");
    if (!ImGui::IsMouseClicked(0)) return false;
    if (const auto with = splines::inserted(shown.knots, *along)) return takeKnot(*with);
    return std::nullopt;
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
        if (handle.kind == Kind::angle) {
            const std::vector<ImVec2> arc = arcOf(handle, lens);
            list->AddPolyline(arc.data(), int(arc.size()), kShadow, 0, thick + 2.0f * scale);
            list->AddPolyline(arc.data(), int(arc.size()), color, 0, thick);
        }
        const auto from = lens.project(handle.base(axis)),
                   to = lens.project(
                       handle.tip(axis, kHandlePixels * double(scale) * lens.metresPerPixel(handle.origin)));
        if (!from || !to) return;
        if (handle.kind == Kind::move || handle.kind == Kind::aim) return arrow(*from, *to, color, thick);
        line(*from, *to, color, thick);
        box(*to, color);
    }
};

void draw(const Editor& editor, const Gizmo& gizmo, const Lens& lens) {
    const Viewport& view = editor.viewport;
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(view.place.lo, view.place.hi, true);
    const Brush brush{list, lens, editor.shell.scale()};
    if (gizmo.grips.spline && gizmo.grips.handles.size() > 0 && gizmo.grips.handles[0].knot >= 0)
        splines::draw(*gizmo.grips.spline, lens, *list, brush.scale);
    for (std::size_t i = 0; i < gizmo.grips.handles.size(); ++i) {
        const Handle& handle = gizmo.grips.handles[i];
        const bool dragged = gizmo.drag && gizmo.drag->handle.input == handle.input &&
                             gizmo.drag->handle.knot == handle.knot &&
                             gizmo.drag->handle.scene == handle.scene;
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
            const bool small = handle.knot >= 0 && gizmo.grips.spline &&
                               gizmo.grips.spline->knots.isHandle(std::size_t(handle.knot));
            const float radius = (lit(kAcrossView) ? 7.0f : small ? 3.5f : 5.0f) * brush.scale;
            list->AddCircleFilled(*at, radius + brush.scale, kShadow);
            list->AddCircleFilled(*at, radius, colorOf(kAcrossView, kAtOnce));
        }
    }
    list->PopClipRect();
}

/// What the magnet draws to, the axes, the pivot, and what else is seen.
void showOptions(Editor& editor, Gizmo& gizmo) {
    const float scale = editor.shell.scale();
    Snap& snap = gizmo.snap;
    const auto either = [](const char* label, auto& value, auto choice) {
        if (ImGui::RadioButton(label, value == choice)) value = choice;
    };
    const auto number = [&](const char* label, double& value, double least, const char* format) {
        ImGui::SetNextItemWidth(80 * scale);
        double typed = value;
        if (ImGui::InputDouble(label, &typed, 0.0, 0.0, format) && typed >= least) value = typed;
    };
    ImGui::TextDisabled("Snap to");
    either("Grid", snap.to, Snap::To::grid);
    ImGui::SameLine();
    either("Surface", snap.to, Snap::To::surface);
    ImGui::SameLine();
    either("Centres and ends", snap.to, Snap::To::points);
    ImGui::SameLine();
    either("Vertices", snap.to, Snap::To::vertices);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Of triangle meshes from files");
    ImGui::Checkbox("Grid as seen", &snap.byZoom);
    if (!snap.byZoom) {
        ImGui::SameLine();
        number((std::string(unitOf(editor.document.graph()).name) + "##grid").c_str(), snap.metres, 1e-4,
               "%.4g");
    }
    for (const double degrees : {5.0, 15.0, 45.0}) {
        either((std::to_string(int(degrees)) + "°").c_str(), snap.degrees, degrees);
        ImGui::SameLine();
    }
    number("°##angle", snap.degrees, 0.01, "%.4g");
    ImGui::Separator();
    ImGui::TextDisabled("Axes");
    either("Of its numbers", gizmo.axes, AxesOf::numbers);
    ImGui::SameLine();
    either("World", gizmo.axes, AxesOf::world);
    ImGui::SameLine();
    either("Its own", gizmo.axes, AxesOf::own);
    ImGui::TextDisabled("Pivot");
    either("Each its own", gizmo.pivot, PivotAt::own);
    ImGui::SameLine();
    either("Middle", gizmo.pivot, PivotAt::selection);
    ImGui::SameLine();
    either("Origin", gizmo.pivot, PivotAt::world);
    either("Point", gizmo.pivot, PivotAt::point);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(200 * scale);
    if (ImGui::InputScalarN("##point", ImGuiDataType_Double, &gizmo.point.x, 3, nullptr, nullptr, "%.4g"))
        gizmo.pivot = PivotAt::point;
    ImGui::Separator();
    ImGui::Checkbox("Lamps and camera", &gizmo.marks);
}

/// Small buttons at the picture's left edge; whether the mouse is on one.
void showTools(Editor& editor, Gizmo& gizmo) {
    constexpr std::pair<Tool, const char*> kTools[] = {
        {Tool::move, "Move"}, {Tool::turn, "Rotate"}, {Tool::scale, "Scale"}};
    const float scale = editor.shell.scale(), high = ImGui::GetTextLineHeightWithSpacing() + 2 * scale;
    ImVec2 at(editor.viewport.place.lo.x + 8 * scale, editor.viewport.place.hi.y - 5 * high - 6 * scale);
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
    const ImVec2 size(60 * scale, high - 2 * scale);
    ImGui::SetCursorScreenPos(at);
    ImGui::PushStyleColor(ImGuiCol_Button,
                          ImGui::GetStyleColorVec4(gizmo.snap.on ? ImGuiCol_ButtonActive : ImGuiCol_Button));
    if (ImGui::Button("Snap", size)) gizmo.snap.on = !gizmo.snap.on;
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Drags go in steps, or to a place; Ctrl does the opposite");
    ImGui::SetCursorScreenPos({at.x, at.y + high});
    if (ImGui::Button("Options", size)) ImGui::OpenPopup("##gizmo");
    if (ImGui::BeginPopup("##gizmo")) {
        showOptions(editor, gizmo);
        ImGui::EndPopup();
    }
}

}  // namespace

std::set<std::string> Gizmo::held(const std::string& scope) const {
    if (!drag || !drag->handle.scene.empty()) return {};
    if (start) {
        std::set<std::string> inputs;
        for (const Placing& placing : placings)
            for (const std::string* input : {&placing.place, &placing.angles, &placing.factor})
                if (!input->empty())
                    inputs.insert((scope.empty() ? "" : scope + "/") + placing.node + "." + *input);
        return inputs;
    }
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
    if (gizmo.grips.spline && gizmo.part.empty() && gizmo.tool == Tool::move && !editor.document.held())
        if (const std::optional<bool> taken = followSpline(editor, gizmo, lens)) return *taken;
    if (!gizmo.hovered) return followMarks(editor);
    tell(editor, gizmo, *gizmo.hovered);
    if (!ImGui::IsMouseClicked(0)) return false;
    const Handle& handle = gizmo.grips.handles[gizmo.hovered->handle];
    if (handle.refusal.empty() && !editor.document.held())
        take(editor, gizmo, takeHandle(handle, gizmo.hovered->axis, lens, mouse, scale));
    return true;
}

void showGizmo(Editor& editor) {
    Viewport& view = editor.viewport;
    if (!view.texture) return;
    showMarks(editor);
    draw(editor, view.gizmo, Lens(view.shown.seen, view.place));
    const bool tools = !view.gizmo.grips.tools.empty() || marksAreShown(editor);
    if (tools && view.split.hand == 0) showTools(editor, view.gizmo);
}

}  // namespace fw::editor
