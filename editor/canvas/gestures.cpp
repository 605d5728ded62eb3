// What the mouse does on the canvas.
#include <cmath>

#include "editor/canvas/canvas.h"
#include "editor/document/wiring.h"
#include "graph/document/unit.h"
#include "graph/library/reference.h"

namespace fw::editor {

namespace {

using Kind = CanvasGesture::Kind;
using What = Hit::What;

constexpr float kStill = 4.0f;        // pixels that a click may move
constexpr float kReach = 9.0f;        // pixels about a socket or wire that still count
constexpr float kEdge = 28.0f;        // pixels from the panel's edge, within which dragging moves the canvas
constexpr double kTooltipWait = 0.5;  // seconds that the mouse rests

bool inPolygon(const std::vector<ImVec2>& polygon, ImVec2 p) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const ImVec2 a = polygon[i], b = polygon[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
            inside = !inside;
    }
    return inside;
}

Plug plugOf(const Boxes& boxes, const Hit& hit) {
    const NodeBox& box = boxes.nodes[hit.index];
    return {box.node->id, box.rows[hit.row].name};
}

/// What one frame of gestures works on.
struct Mouse {
    Canvas& canvas;
    Document& document;
    const Boxes& boxes;
    CanvasWishes wishes = {};
    CanvasGesture& gesture = canvas.gesture;

    const ImGuiIO& io = ImGui::GetIO();
    ImVec2 at = canvas.view.toCanvas(io.MousePos);
    Hit hit = hitTest(boxes, at, kReach / canvas.view.unit());

    NodeIds chosen() const { return {canvas.selection.begin(), canvas.selection.end()}; }

    void pickNode(const std::string& id) {
        if (io.KeyShift) {
            if (canvas.selection.contains(id)) {
                canvas.selection.erase(id);
                if (canvas.active == id) canvas.active.clear();
                return;
            }
        } else if (!canvas.selection.contains(id)) {
            canvas.selection.clear();
        }
        canvas.selection.insert(id);
        canvas.active = id;
    }

    void pick(const std::set<std::string>& found) {
        if (!io.KeyShift && !io.KeyCtrl) canvas.selection.clear();
        for (const std::string& id : found) {
            if (io.KeyCtrl)
                canvas.selection.erase(id);
            else
                canvas.selection.insert(id);
        }
        if (!canvas.selection.contains(canvas.active))
            canvas.active = canvas.selection.empty() ? std::string() : *canvas.selection.rbegin();
    }

    /// `name` is what the step of undo is called, of a gesture that changes the document.
    void start(Kind kind, int button, const char* name = "") {
        gesture = {.kind = kind, .hand = document.begin(name), .button = button, .begin = at};
        gesture.trail = {at};
        gesture.base = document.graph();
    }
    /// What it did is one step.
    void finish() {
        const Hand done = gesture.hand;
        gesture = {};
        document.end(done);
    }
    void giveUp() {
        const Hand done = gesture.hand;
        gesture = {};
        document.cancel(done);
    }

    /// The wire's open end is taken up: of a wired input that wire itself, else a new one.
    void takeWire() {
        start(Kind::wire, 0, "Connect");
        gesture.plug = plugOf(boxes, hit);
        gesture.plugIsOutput = hit.what == What::output;
        const Row& row = boxes.nodes[hit.index].rows[hit.row];
        if (gesture.plugIsOutput || !row.linked) return findPartners();
        const auto wire = std::find_if(boxes.wires.begin(), boxes.wires.end(), [&](const Wire& each) {
            return each.to == hit.index && each.toRow == hit.row;
        });
        if (wire == boxes.wires.end()) return findPartners();
        const Plug input = gesture.plug;
        gesture.plug = boxes.output(*wire);
        gesture.plugIsOutput = gesture.tookOff = true;
        document.update(gesture.hand, disconnect(document.graph(), canvas.scope, input));
        findPartners();
    }

    void findPartners() {
        gesture.partners =
            Wiring(document.graph(), canvas.scope).partners(gesture.plug, gesture.plugIsOutput);
    }

    /// What the loose end would be connected to here, and in `refused` why it may not.
    std::optional<Plug> target() {
        gesture.refused.clear();
        const bool wantsInput = gesture.plugIsOutput;
        if (hit.what == (wantsInput ? What::input : What::output)) {
            const Plug plug = plugOf(boxes, hit);
            gesture.refused = wantsInput ? refusal(document.graph(), canvas.scope, gesture.plug, plug)
                                         : refusal(document.graph(), canvas.scope, plug, gesture.plug);
            return plug;
        }
        const bool onNode = hit.what == What::node || hit.what == What::title || hit.what == What::field ||
                            hit.what == What::input || hit.what == What::output;
        if (!onNode || boxes.nodes[hit.index].node->id == gesture.plug.node) return std::nullopt;
        const std::string& id = boxes.nodes[hit.index].node->id;
        const std::optional<Plug> plug =
            wantsInput ? fittingInput(document.graph(), canvas.scope, gesture.plug, id)
                       : fittingOutput(document.graph(), canvas.scope, id, gesture.plug);
        if (!plug) gesture.refused = titleOf(boxes.nodes[hit.index]) + " has no socket that fits";
        return plug;
    }

    void dropWire() {
        const std::optional<Plug> plug = target();
        if (plug && gesture.refused.empty()) {
            document.update(gesture.hand, gesture.plugIsOutput
                                              ? connect(document.graph(), canvas.scope, gesture.plug, *plug)
                                              : connect(document.graph(), canvas.scope, *plug, gesture.plug));
        } else if (gesture.refused.empty() && hit.what != What::node && hit.what != What::title &&
                   hit.what != What::field) {
            // Over the canvas: a wire that was taken off stays off, a new one asks what is to be added.
            if (!gesture.tookOff) wishes.add = {at, gesture.plug, gesture.plugIsOutput};
        } else if (!gesture.refused.empty()) {
            return giveUp();
        }
        finish();
    }

    /// What was pressed is moved from now on.
    void beginMove() {
        gesture.kind = Kind::move;
        gesture.hand = document.begin(canvas.selection.size() > 1 ? "Move Nodes" : "Move Node");
    }

    Position moved() const {
        ImVec2 by(at.x - gesture.begin.x, at.y - gesture.begin.y);
        if (io.KeyCtrl) by = {std::round(by.x / 24.0f) * 24.0f, std::round(by.y / 24.0f) * 24.0f};
        return position(by);
    }

    void move() { document.update(gesture.hand, moveNodes(gesture.base, canvas.scope, chosen(), moved())); }

    /// The node goes into the wire, to the right of where it comes from, and what it leads to moves on until
    /// there is room.
    void dropOn(const Wire& wire, const NodeBox& box) {
        constexpr float kApart = 40.0f;
        const NodeBox &from = boxes.nodes[wire.from], &to = boxes.nodes[wire.to];
        const NodeIds one = {box.node->id};
        Graph made = dropOnWire(document.graph(), canvas.scope, boxes.input(wire), one[0]);
        if (made == document.graph()) return;
        const float right = std::max(0.0f, from.area.hi.x + kApart - box.area.lo.x),
                    on = std::max(0.0f, box.area.hi.x + right + kApart - to.area.lo.x);
        const auto beside = [&](const NodeBox& other) {
            return other.area.lo.y < box.area.hi.y && box.area.lo.y < other.area.hi.y;
        };
        if (right > 0.0f && beside(from)) made = moveNodes(made, canvas.scope, one, {double(right), 0});
        // What is already beyond it, or leads backwards, stays.
        if (on > 0.0f && beside(to) && to.area.hi.x > from.area.lo.x) {
            const std::set<std::string> after = downstream(nodesOf(made, canvas.scope), NodeIds{to.node->id});
            made = moveNodes(made, canvas.scope, NodeIds(after.begin(), after.end()), {double(on), 0});
        }
        document.update(gesture.hand, std::move(made));
    }

    /// A single unwired node that was let go of on a wire goes into it.
    void endMove() {
        if (canvas.selection.size() == 1 && io.KeyCtrl == false) {
            const NodeBox* box = boxes.find(*canvas.selection.begin());
            const auto wired = [&](const Wire& wire) {
                return boxes.nodes[wire.from].node == box->node || boxes.nodes[wire.to].node == box->node;
            };
            if (box && std::none_of(boxes.wires.begin(), boxes.wires.end(), wired)) {
                const Area area = box->area;
                for (const Wire& wire : boxes.wires) {
                    const Curve path = curve(boxes.start(wire), boxes.end(wire));
                    const bool over =
                        path.crosses({area.lo.x, area.centre().y}, {area.hi.x, area.centre().y}) ||
                        path.crosses({area.centre().x, area.lo.y}, {area.centre().x, area.hi.y});
                    if (!over) continue;
                    dropOn(wire, *box);
                    break;
                }
            }
        }
        finish();
    }

    /// A frame moves with all that it holds, or changes its size by its corner.
    void dragFrame(bool corner) {
        const std::vector<Frame> before = framesOf(gesture.base);
        if (gesture.frame >= before.size()) return;
        Frame frame = before[gesture.frame];
        const Position by = moved();
        Graph next = gesture.base;
        if (corner) {
            frame.size = {std::max(80.0, frame.size[0] + by[0]), std::max(60.0, frame.size[1] + by[1])};
        } else {
            NodeIds held;
            for (const Node& node : nodesOf(gesture.base, canvas.scope)) {
                if (!node.at) continue;
                const double x = (*node.at)[0] - frame.at[0], y = (*node.at)[1] - frame.at[1];
                if (x >= 0 && y >= 0 && x < frame.size[0] && y < frame.size[1]) held.push_back(node.id);
            }
            next = moveNodes(next, canvas.scope, held, by);
            frame.at = {frame.at[0] + by[0], frame.at[1] + by[1]};
        }
        document.update(gesture.hand, setFrame(next, gesture.frame, frame));
    }

    /// Wires that the trail crosses.
    std::vector<Wire> crossed() const {
        std::vector<Wire> found;
        for (const Wire& wire : boxes.wires) {
            const Curve path = curve(boxes.start(wire), boxes.end(wire));
            for (std::size_t i = 1; i < gesture.trail.size(); ++i)
                if (path.crosses(gesture.trail[i - 1], gesture.trail[i])) {
                    found.push_back(wire);
                    break;
                }
        }
        return found;
    }

    void cut() {
        Graph next = document.graph();
        for (const Wire& wire : crossed()) next = disconnect(next, canvas.scope, boxes.input(wire));
        document.apply("Cut Wires", std::move(next));
    }

    void rerouteCrossed() {
        Graph next = document.graph();
        NodeIds made;
        for (const Wire& wire : crossed()) {
            const Curve path = curve(boxes.start(wire), boxes.end(wire));
            std::optional<ImVec2> place;
            for (std::size_t i = 1; i < gesture.trail.size() && !place; ++i)
                place = path.crossing(gesture.trail[i - 1], gesture.trail[i]);
            Edited edited = addReroute(next, canvas.scope, boxes.input(wire), position(*place));
            next = std::move(edited.graph);
            made.insert(made.end(), edited.nodes.begin(), edited.nodes.end());
        }
        if (made.empty()) return;
        document.apply("Add Reroute", std::move(next));
        canvas.select(made);
    }

    /// From the node where the drag began to the one where it ends, by the first sockets that fit.
    void connectLazily() {
        const Hit start = hitTest(boxes, gesture.begin, kReach / canvas.view.unit());
        const auto nodeOf = [&](const Hit& on) -> const NodeBox* {
            const bool none = on.what == What::nothing || on.what == What::wire || on.what == What::frame ||
                              on.what == What::frameTitle || on.what == What::frameCorner;
            return none ? nullptr : &boxes.nodes[on.index];
        };
        const NodeBox *from = nodeOf(start), *to = nodeOf(hit);
        if (!from || !to || from == to) return;
        for (const Row& row : from->rows) {
            if (!row.output) continue;
            const Plug output{from->node->id, row.name};
            const auto input = fittingInput(document.graph(), canvas.scope, output, to->node->id);
            if (!input) continue;
            document.apply("Connect", connect(document.graph(), canvas.scope, output, *input));
            return;
        }
    }

    void press() {
        if (hasMinimap(canvas, boxes) && minimapArea(canvas.view).contains(io.MousePos)) {
            start(Kind::map, 0);
            gesture.map = minimapShows(canvas, boxes);
        } else if (ImGui::IsKeyDown(ImGui::GetKeyIndex(ImGuiKey_Space))) {
            start(Kind::pan, 0);
            canvas.spacePans = true;
        } else if (io.KeyAlt) {
            start(Kind::lasso, 0);
        } else if (hit.what == What::output || hit.what == What::input) {
            takeWire();
        } else if (hit.what == What::title || hit.what == What::node) {
            start(Kind::press, 0);
            gesture.node = boxes.nodes[hit.index].node->id;
        } else if (hit.what == What::frameTitle || hit.what == What::frameCorner) {
            const bool title = hit.what == What::frameTitle;
            start(title ? Kind::frame : Kind::corner, 0, title ? "Move Frame" : "Resize Frame");
            gesture.frame = hit.index;
        } else if (hit.what != What::field) {
            start(Kind::box, 0);
        }
    }

    void pressRight() {
        if (io.KeyCtrl) return start(Kind::cut, 1);
        if (io.KeyShift) return start(Kind::reroute, 1);
        if (io.KeyAlt) return start(Kind::lazy, 1);
        const Row* row = hit.what == What::field ? &boxes.nodes[hit.index].rows[hit.row] : nullptr;
        if (row && canvas.scope.empty() && row->typed())
            wishes.field = {boxes.nodes[hit.index].node->id, row->name};
        else
            wishes.add = {at, std::nullopt, false};
    }

    /// A press that did not become a drag.
    void click() {
        const std::string id = gesture.node;
        finish();
        if (!io.KeyShift) canvas.selection.clear();
        pickNode(id);
        if (io.KeyCtrl && io.KeyShift) wishes.activate = id;
    }

    void during() {
        const bool up = !ImGui::IsMouseDown(gesture.button);
        const float far = std::hypot(at.x - gesture.begin.x, at.y - gesture.begin.y) * canvas.view.unit();
        if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) && gesture.kind != Kind::pan)
            return giveUp();
        switch (gesture.kind) {
            case Kind::none: return;
            case Kind::press:
                if (far > kStill) {
                    if (!canvas.selection.contains(gesture.node)) pickNode(gesture.node);
                    beginMove();
                    return move();
                }
                if (up) click();
                return;
            case Kind::pan: canvas.view.pan(io.MouseDelta); break;
            case Kind::move:
                if (up) return endMove();
                return move();
            case Kind::frame:
            case Kind::corner: dragFrame(gesture.kind == Kind::corner); break;
            case Kind::map: {
                const Area place = minimapArea(canvas.view), &all = gesture.map;
                const float scale = all.width() / place.width();
                const ImVec2 in = place.nearest(io.MousePos);
                canvas.view.middle = {all.lo.x + (in.x - place.lo.x) * scale,
                                      all.lo.y + (in.y - place.lo.y) * scale};
                break;
            }
            case Kind::wire:
                if (up) return dropWire();
                target();
                return;
            case Kind::box: {
                if (!up) return;
                Area area{gesture.begin, gesture.begin};
                area.add(at);
                std::set<std::string> found;
                if (far > kStill)
                    for (const NodeBox& box : boxes.nodes)
                        if (box.area.overlaps(area)) found.insert(box.node->id);
                pick(found);
                break;
            }
            case Kind::lasso:
            case Kind::cut:
            case Kind::reroute:
            case Kind::lazy: {
                const ImVec2 last = gesture.trail.back();
                if (std::hypot(at.x - last.x, at.y - last.y) * canvas.view.unit() > 2.0f)
                    gesture.trail.push_back(at);
                if (!up) return;
                if (gesture.kind == Kind::cut) cut();
                if (gesture.kind == Kind::reroute) rerouteCrossed();
                if (gesture.kind == Kind::lazy) connectLazily();
                if (gesture.kind == Kind::lasso) {
                    std::set<std::string> found;
                    for (const NodeBox& box : boxes.nodes)
                        if (inPolygon(gesture.trail, box.area.centre())) found.insert(box.node->id);
                    pick(found);
                }
                break;
            }
        }
        if (up) finish();
    }

    /// Dragging to the panel's edge shows more of the canvas.
    void moveAtEdge() {
        if (gesture.kind != Kind::wire && gesture.kind != Kind::move && gesture.kind != Kind::box) return;
        const Area& panel = canvas.view.panel;
        const auto push = [](float place, float lo, float hi) {
            return place < lo + kEdge ? lo + kEdge - place : place > hi - kEdge ? hi - kEdge - place : 0.0f;
        };
        const float speed = 8.0f * io.DeltaTime;
        canvas.view.pan({speed * std::clamp(push(io.MousePos.x, panel.lo.x, panel.hi.x), -60.0f, 60.0f),
                         speed * std::clamp(push(io.MousePos.y, panel.lo.y, panel.hi.y), -60.0f, 60.0f)});
    }

    /// Type of what the wire carries; of a surface how far its distance can be trusted, and whose fault it
    /// is.
    void describeWire(const Wire& wire, const CanvasMarks& marks) const {
        const NodeBox& from = boxes.nodes[wire.from];
        const Row& row = from.rows[wire.fromRow];
        std::string text = titleOf(from) + " › " + titleOf(boxes.nodes[wire.to]);
        if (row.type) text += "\n" + std::string(typeName(*row.type));
        const NodeExactness* exactness = row.type == Type::surface ? marks.exactness(from.node->id) : nullptr;
        if (exactness) {
            const auto& [trust, spoiledBy] = *exactness;
            text += ", distance: " + exactnessText(trust);
            if (!trust.exact()) text += "\nnot exact since " + spoiledBy;
        }
        if (canvas.exactness)
            text += "\n\nPlain: exact. Dashes: a bound. Dots: may be steeper than a distance.";
        ImGui::SetTooltip("%s", text.c_str());
    }

    void hover(const CanvasMarks& marks) const {
        if (!gesture.refused.empty()) return ImGui::SetTooltip("%s", gesture.refused.c_str());
        if (gesture.kind != Kind::none || hit.what == What::nothing ||
            ImGui::GetTime() - canvas.restedSince < kTooltipWait)
            return;
        if (hit.what == What::wire) { return describeWire(boxes.wires[hit.index], marks); }
        if (hit.what == What::frame || hit.what == What::frameTitle || hit.what == What::frameCorner) return;
        const NodeBox& box = boxes.nodes[hit.index];
        if (hit.what == What::input || hit.what == What::output || hit.what == What::field)
            return ImGui::SetTooltip("%s", describe(box.rows[hit.row], unitOf(document.graph())).c_str());
        if (hit.what != What::title) return;
        const auto finding = marks.findings.find(box.node->id);
        if (finding != marks.findings.end()) return ImGui::SetTooltip("%s", finding->second->message.c_str());
        if (box.type)
            ImGui::SetTooltip("%s (%s)\n%s", box.type->label.c_str(), box.node->id.c_str(),
                              box.type->doc.c_str());
    }
};

}  // namespace

void Canvas::select(const NodeIds& nodes) {
    selection = {nodes.begin(), nodes.end()};
    active = nodes.empty() ? std::string() : nodes.back();
}

void Canvas::follow(const Graph& graph) {
    if (!scope.empty() && !graph.group(scope)) scope.clear(), selection.clear(), frameNext = true;
    std::set<std::string> there;
    for (const Node& node : nodesOf(graph, scope)) there.insert(node.id);
    std::erase_if(selection, [&](const std::string& id) { return !there.contains(id); });
    if (!there.contains(active)) active.clear();
}

bool showsFields(const CanvasView& view) { return view.unit() >= 0.6f; }

CanvasWishes showCanvas(Canvas& canvas, Document& document, const Boxes& boxes, const CanvasMarks& marks,
                        const Shell& shell) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    canvas.view.panel = {at, {at.x + std::max(room.x, 1.0f), at.y + std::max(room.y, 1.0f)}};
    canvas.view.scale = shell.scale();
    if (canvas.frameNext) canvas.view.frame(boxes.around()), canvas.frameNext = false;
    CanvasGesture& gesture = canvas.gesture;
    if (gesture.kind != Kind::none && !document.hold(gesture.hand)) gesture = {};
    canvas.number.follow(document);
    const uint64_t revision = document.revision();
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsWindowHovered() && canvas.view.panel.contains(io.MousePos);
    Mouse mouse{canvas, document, boxes};
    canvas.lit.clear();
    if (hovered && gesture.kind == Kind::none && mouse.hit.what == What::wire)
        canvas.lit = wayThrough(boxes, mouse.hit.index);
    drawCanvas(canvas, boxes, marks, shell);

    // Fields above the drawing; the first that changes the document ends what the others stand on.
    const bool idle = gesture.kind == Kind::none;
    const float size = shell.fonts().crisp(kTextSize * canvas.view.unit());
    if (showsFields(canvas.view)) {
        ImGui::PushClipRect(canvas.view.panel.lo, canvas.view.panel.hi, true);
        const Area seen = canvas.view.seen();
        std::vector<const NodeBox*> shown;
        for (const NodeBox& box : boxes.nodes)
            if (box.area.overlaps(seen)) shown.push_back(&box);
        for (std::size_t n = 0; n < shown.size(); ++n)
            for (const Row& row : shown[n]->rows) {
                const auto moved = marks.animated.empty() || row.fields == 0
                                       ? marks.animated.end()
                                       : marks.animated.find(shown[n]->node->id + "." + row.name);
                for (int i = 0; i < row.fields; ++i) {
                    const Area field = shown[n]->field(row, i);
                    // Nodes lie above each other in their order, and their fields with them.
                    const auto covers = [&](const NodeBox* above) { return above->area.overlaps(field); };
                    const bool typed =
                        canvas.number.is(inputPath(canvas.scope, {shown[n]->node->id, row.name}), i);
                    if (!typed && std::any_of(shown.begin() + std::ptrdiff_t(n) + 1, shown.end(), covers))
                        continue;
                    const NumberLook look{canvas.view.toScreen(field), shell.fonts().of(size), size,
                                          hovered && idle};
                    if (showField(canvas.number, document, canvas.scope, *shown[n], row, i, look,
                                  moved == marks.animated.end() ? nullptr : &moved->second))
                        canvas.addsNext = true;
                }
            }
        ImGui::PopClipRect();
    }
    if (document.revision() != revision) return {};

    if (io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f) canvas.restedSince = ImGui::GetTime();
    const bool editing = canvas.number.state != NumberHand::State::none;
    if (hovered && io.MouseWheel != 0.0f && !editing)
        canvas.view.zoomTo(canvas.view.zoom * std::pow(kWheel, io.MouseWheel), io.MousePos);
    if (gesture.kind != Kind::none) {
        mouse.moveAtEdge();
        mouse.during();
        if (gesture.kind != Kind::none) mouse.hover(marks);  // why a wire cannot be dropped here
    } else if (hovered && !editing) {
        const Hit& hit = mouse.hit;
        mouse.hover(marks);
        if (ImGui::IsMouseDoubleClicked(0) && hit.what == What::frameTitle) {
            mouse.wishes.frame = hit.index;
        } else if (ImGui::IsMouseDoubleClicked(0) && (hit.what == What::title || hit.what == What::node)) {
            mouse.wishes.enter = boxes.nodes[hit.index].node->group;
            if (mouse.wishes.enter.empty()) mouse.press();
        } else if (ImGui::IsMouseClicked(0)) {
            mouse.press();
        } else if (ImGui::IsMouseClicked(1)) {
            mouse.pressRight();
        } else if (ImGui::IsMouseClicked(2)) {
            mouse.start(Kind::pan, 2);
        }
    }
    return std::move(mouse.wishes);
}

}  // namespace fw::editor
