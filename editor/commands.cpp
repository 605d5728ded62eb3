#include "editor/commands.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cassert>

#include "editor/canvas/keyboard.h"
#include "editor/document/clipboard.h"
#include "editor/document/layout.h"
#include "editor/panels/library.h"
#include "editor/panels/playback.h"
#include "editor/panels/properties.h"
#include "editor/panels/side.h"
#include "editor/panels/tour.h"
#include "editor/timeline/actions.h"
#include "editor/viewport/marks.h"

namespace fw::editor {

namespace {

bool always(const Editor&) { return true; }
bool anySelected(const Editor& editor) { return !editor.canvas.selection.empty(); }
bool severalSelected(const Editor& editor) { return editor.canvas.selection.size() > 1; }

NodeIds selected(const Editor& editor) {
    return {editor.canvas.selection.begin(), editor.canvas.selection.end()};
}
const Graph& graphOf(const Editor& editor) { return editor.document.graph(); }
const std::string& scopeOf(const Editor& editor) { return editor.canvas.scope; }

/// Where a node goes that was not put anywhere: under the mouse, or in the middle of what is seen; below what
/// was put there before.
ImVec2 hereOn(const Editor& editor) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return freePlace(*editor.boxes, editor.canvas.view.panel.contains(mouse)
                                        ? editor.canvas.view.toCanvas(mouse)
                                        : editor.canvas.view.middle);
}

void addHere(Editor& editor) {
    editor.add.wish = {hereOn(editor), std::nullopt, false};
    editor.add.opened = true;
}

void remove(Editor& editor, bool heal) {
    const std::size_t count = editor.canvas.selection.size();
    editor.document.apply(count == 1 ? "Delete Node" : "Delete Nodes",
                          removeNodes(graphOf(editor), scopeOf(editor), selected(editor), heal));
}

void copy(Editor& editor) { copyText(editor, copyNodes(graphOf(editor), scopeOf(editor), selected(editor))); }

void paste(Editor& editor) {
    const std::string text = pastedText(editor);
    Result<Edited> pasted = pasteNodes(graphOf(editor), scopeOf(editor), text, position(hereOn(editor)));
    if (!pasted) return say(editor, "cannot paste: " + format(pasted.error()));
    apply(editor, "Paste", std::move(*pasted));
}

void group(Editor& editor) {
    Result<Edited> grouped = groupNodes(graphOf(editor), scopeOf(editor), selected(editor));
    if (!grouped) return say(editor, "cannot group: " + grouped.error().message);
    apply(editor, "Group", std::move(*grouped));
}

bool groupActive(const Editor& editor) {
    const NodeBox* box = editor.boxes->find(editor.canvas.active);
    return box && !box->node->group.empty();
}

/// The group that is shown by the active node, else the one that one is in; empty: none.
std::string groupIdHere(const Editor& editor) {
    const NodeBox* box = editor.boxes->find(editor.canvas.active);
    return box && !box->node->group.empty() ? box->node->group : scopeOf(editor);
}
bool groupHere(const Editor& editor) { return graphOf(editor).group(groupIdHere(editor)) != nullptr; }
bool linkedHere(const Editor& editor) {
    const Group* group = graphOf(editor).group(groupIdHere(editor));
    return group && !group->file.empty();
}

void ungroupActive(Editor& editor) {
    apply(editor, "Ungroup", ungroup(graphOf(editor), scopeOf(editor), editor.canvas.active));
}

void enterOrLeave(Editor& editor) {
    const NodeBox* box = editor.boxes->find(editor.canvas.active);
    if (box && !box->node->group.empty()) return enter(editor, box->node->group);
    const std::string left = scopeOf(editor);
    enter(editor, "");
    for (const Node& node : graphOf(editor).nodes)
        if (node.group == left) editor.canvas.select({node.id});
}

void layOutNodes(Editor& editor) {
    const std::vector<Node>& nodes = nodesOf(graphOf(editor), scopeOf(editor));
    NodeIds ids = selected(editor);
    if (ids.size() < 2) {
        ids.clear();
        for (const Node& node : nodes) ids.push_back(node.id);
    }
    std::vector<double> heights;
    for (const std::string& id : ids) heights.push_back(double(editor.boxes->find(id)->area.height()));
    editor.document.apply("Lay Out Nodes", layOut(graphOf(editor), scopeOf(editor), ids, heights));
}

template <Alignment how>
void alignNodes(Editor& editor) {
    editor.document.apply("Align Nodes", align(graphOf(editor), scopeOf(editor), selected(editor), how));
}

void selectIds(Editor& editor, const std::set<std::string>& ids) {
    editor.canvas.selection = ids;
    if (!ids.contains(editor.canvas.active))
        editor.canvas.active = ids.empty() ? std::string() : *ids.begin();
}

void selectAll(Editor& editor) {
    std::set<std::string> all;
    for (const NodeBox& box : editor.boxes->nodes) all.insert(box.node->id);
    selectIds(editor, all);
}

void invert(Editor& editor) {
    std::set<std::string> others;
    for (const NodeBox& box : editor.boxes->nodes)
        if (!editor.canvas.selection.contains(box.node->id)) others.insert(box.node->id);
    selectIds(editor, others);
}

void frame(Editor& editor, bool all) {
    const bool some = !all && !editor.canvas.selection.empty();
    editor.canvas.view.frame(editor.boxes->around(some ? &editor.canvas.selection : nullptr));
}

bool pictured(const Editor& editor) { return editor.viewport.texture != nullptr; }

template <Side side>
void look(Editor& editor) {
    lookFrom(editor.viewport, side);
}

constexpr double kTurnStep = 0.1, kPanStep = 0.1;  // heights of the picture

template <int x, int y>
void turnPicture(Editor& editor) {
    editor.viewport.takeCamera();
    turn(editor.viewport.orbit, kTurnStep * x, kTurnStep * y);
}

template <int x, int y>
void panPicture(Editor& editor) {
    editor.viewport.takeCamera();
    pan(editor.viewport.orbit, kPanStep * x, kPanStep * y);
}

template <int notches>
void zoomPicture(Editor& editor) {
    editor.viewport.takeCamera();
    zoom(editor.viewport.orbit, notches, 0.0, 0.0, double(editor.viewport.aspect()));
}

template <Tool tool>
void use(Editor& editor) {
    editor.viewport.gizmo.tool = tool;
}

constexpr float kZoomStep = 1.25f, kMoveStep = 24.0f;  // canvas units

void zoom(Editor& editor, float by) {
    CanvasView& view = editor.canvas.view;
    view.zoomTo(view.zoom * by, view.panel.centre());
}

template <int x, int y, bool adds>
void stepTo(Editor& editor) {
    step(editor.canvas, *editor.boxes, {float(x), float(y)}, adds);
}

template <int x, int y>
void moveBy(Editor& editor) {
    editor.document.apply("Move Nodes", moveNodes(graphOf(editor), scopeOf(editor), selected(editor),
                                                  {double(kMoveStep) * x, double(kMoveStep) * y}));
}

bool anyActive(const Editor& editor) { return !editor.canvas.active.empty(); }

/// Its first number on the canvas; what has none there is edited in the inspector.
void editActive(Editor& editor) {
    if (typeFirstValue(editor.canvas, editor.document, *editor.boxes)) return;
    showPanel(editor, "inspector");
}

void rename(Editor& editor) {
    showPanel(editor, "inspector");
    editor.windows.renames = true;
}

constexpr float kReadable =
    0.75f;  // pixels of a canvas unit: from farther off numbers are not edited on nodes

/// A digit begins the first number of the active node, in place of Enter and the digit.
void beginNumber(Editor& editor) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.KeyCtrl || io.KeyAlt || io.KeySuper || io.InputQueueCharacters.empty()) return;
    const ImWchar first = io.InputQueueCharacters[0];
    if (first != '.' && (first < '0' || first > '9')) return;
    CanvasView& view = editor.canvas.view;
    const CanvasView before = view;
    if (!showsFields(view)) view.zoomTo(kReadable / view.scale, view.panel.centre());
    if (typeFirstValue(editor.canvas, editor.document, *editor.boxes))
        editor.canvas.number.typed.begun = char(first);
    else
        view = before;
}

/// Alt by itself goes to the menus, but not when it was held for something else.
void keepMenusClosed() {
    if (ImGui::GetIO().KeyAlt && (pressedNow() || ImGui::IsAnyMouseDown()))
        ImGui::GetCurrentContext()->NavWindowingToggleLayer = false;
}

template <std::size_t count>
void split(Editor& editor) {
    splitInto(editor, count);
}
bool isSplit(const Editor& editor) { return editor.viewport.split.count > 1; }

bool manyTabs(const Editor& editor) { return editor.tabs.all.size() > 1; }

using enum Heard;
constexpr Command kCommands[] = {
    {"file.new", "File", "New", "Ctrl+N", everywhere, always, newDocument},
    {"file.open", "File", "Open …", "Ctrl+O", everywhere, always, askForFile},
    {"file.samples", "File", "Samples …", "", everywhere, always, [](Editor& e) { e.files.samples.opening = true; }},
    {"file.recovered", "File", "Recovered work …", "", everywhere,
     [](const Editor& e) { return !e.files.left.empty(); }, [](Editor& e) { e.files.offers = true; }},
    {"file.versions", "File", "Versions …", "", everywhere,
     [](const Editor& e) { return !e.document.graph().path.empty(); }, offerVersions},
    {"file.missing", "File", "Missing files …", "", everywhere, always, openMissingFiles},
    {"file.save", "File", "Save", "Ctrl+S", everywhere, always,
     [](Editor& e) { e.files.next = Files::Next::none, save(e); }},
    {"file.save_as", "File", "Save as …", "Ctrl+Shift+S", everywhere, always, saveAs},
    {"file.export", "File", "Export …", "Ctrl+E", everywhere, always, openExport},
    {"file.render", "File", "Render …", "Ctrl+Shift+E", everywhere, always, openRender},
    {"edit.undo", "Edit", "Undo", "Ctrl+Z", everywhere, [](const Editor& e) { return e.document.canUndo(); },
     [](Editor& e) { e.document.undo(); }},
    {"edit.redo", "Edit", "Redo", "Ctrl+Shift+Z Ctrl+Y", everywhere, [](const Editor& e) { return e.document.canRedo(); },
     [](Editor& e) { e.document.redo(); }},
    {"timeline.cut", "Timeline", "Cut keys", "Ctrl+X", timeline, anyKeys, cutSelectedKeys},
    {"timeline.copy", "Timeline", "Copy keys", "Ctrl+C", timeline, anyKeys, copySelectedKeys},
    {"timeline.paste", "Timeline", "Paste keys", "Ctrl+V", timeline, timelineOpen, pasteKeysHere},
    {"timeline.duplicate", "Timeline", "Duplicate keys", "Ctrl+D", timeline, anyKeys, duplicateSelectedKeys},
    {"timeline.delete", "Timeline", "Delete keys", "Delete X", timeline, anyKeys, deleteSelectedKeys},
    {"timeline.select_all", "Timeline", "Select all keys", "Ctrl+A", timeline, timelineOpen, selectAllKeys, true},
    {"timeline.invert", "Timeline", "Invert selection of keys", "Ctrl+I", timeline, timelineOpen, invertKeys},
    {"timeline.earlier", "Timeline", "A frame earlier", "Left", timeline, anyKeys, [](Editor& e) { nudgeKeys(e, -1); },
     true},
    {"timeline.later", "Timeline", "A frame later", "Right", timeline, anyKeys, [](Editor& e) { nudgeKeys(e, 1); }},
    {"timeline.much_earlier", "Timeline", "Ten frames earlier", "Shift+Left", timeline, anyKeys,
     [](Editor& e) { nudgeKeys(e, -10); }},
    {"timeline.much_later", "Timeline", "Ten frames later", "Shift+Right", timeline, anyKeys,
     [](Editor& e) { nudgeKeys(e, 10); }},
    {"timeline.next_key", "Timeline", "Go to the next key", "Up", timeline, timelineOpen,
     [](Editor& e) { goToKey(e, 1); }, true},
    {"timeline.previous_key", "Timeline", "Go to the key before", "Down", timeline, timelineOpen,
     [](Editor& e) { goToKey(e, -1); }},
    {"timeline.marker", "Timeline", "Add or rename marker", "M", timeline, timelineOpen, addMarkerHere, true},
    {"timeline.next_marker", "Timeline", "Go to the next marker", "Ctrl+Right", timeline, timelineOpen,
     [](Editor& e) { goToMarker(e, 1); }},
    {"timeline.previous_marker", "Timeline", "Go to the marker before", "Ctrl+Left", timeline, timelineOpen,
     [](Editor& e) { goToMarker(e, -1); }},
    {"timeline.all", "Timeline", "Show all times", "Home", timeline, timelineOpen, showAllTimes, true},
    {"timeline.selection", "Timeline", "Show the selected keys", "F", timeline, timelineOpen, showSelectedTimes},
    {"timeline.curves", "Timeline", "Curves or keys", "Ctrl+Tab", timeline, timelineOpen, toggleCurves},
    {"edit.cut", "Edit", "Cut", "Ctrl+X", canvas, anySelected, [](Editor& e) { copy(e), remove(e, false); }, true},
    {"edit.copy", "Edit", "Copy", "Ctrl+C", canvas, anySelected, copy},
    {"edit.paste", "Edit", "Paste", "Ctrl+V", canvas, always, paste},
    {"edit.duplicate", "Edit", "Duplicate", "Ctrl+D", canvas, anySelected,
     [](Editor& e) { apply(e, "Duplicate", duplicate(graphOf(e), scopeOf(e), selected(e), false)); }, true},
    {"edit.duplicate_wired", "Edit", "Duplicate with inputs", "Ctrl+Shift+D", canvas, anySelected,
     [](Editor& e) { apply(e, "Duplicate", duplicate(graphOf(e), scopeOf(e), selected(e), true)); }},
    {"edit.delete", "Edit", "Delete", "Delete X", canvas, anySelected, [](Editor& e) { remove(e, false); }},
    {"edit.delete_heal", "Edit", "Delete and heal wires", "Ctrl+Delete Ctrl+Shift+X", canvas, anySelected,
     [](Editor& e) { remove(e, true); }},
    {"edit.select_all", "Edit", "Select all", "Ctrl+A", canvas, always, selectAll, true},
    {"edit.invert", "Edit", "Invert selection", "Ctrl+I", canvas, always, invert},
    {"edit.upstream", "Edit", "Select what feeds it", "L", canvas, anySelected,
     [](Editor& e) { selectIds(e, upstream(nodesOf(graphOf(e), scopeOf(e)), selected(e))); }},
    {"edit.downstream", "Edit", "Select what it feeds", "Shift+L", canvas, anySelected,
     [](Editor& e) { selectIds(e, downstream(nodesOf(graphOf(e), scopeOf(e)), selected(e))); }},
    {"edit.preferences", "Edit", "Preferences …", "Ctrl+Comma", everywhere, always,
     [](Editor& e) { e.windows.preferences.opened = true; }, true},
    {"node.add", "Node", "Add …", "Shift+A Tab", canvas, always, addHere},
    {"node.connect", "Node", "Connect …", "J", canvas, anyActive, offerConnections},
    {"node.edit", "Node", "Edit value", "Enter PadEnter", canvas, anyActive, editActive},
    {"node.rename", "Node", "Rename", "F2", canvas, anyActive, rename},
    {"node.code", "Node", "Code in a large window", "F4", canvas,
     [](const Editor& e) {
         const NodeBox* box = e.boxes->find(e.canvas.active);
         return e.code.large || (box && roleOf(box->node->type) == NodeRole::expression);
     },
     code::toggleWindow},
    {"node.mute", "Node", "Mute", "M", canvas, anySelected,
     [](Editor& e) { e.document.apply("Mute", toggleMuted(graphOf(e), scopeOf(e), selected(e))); }, true},
    {"node.collapse", "Node", "Collapse", "H", canvas, anySelected,
     [](Editor& e) { e.document.apply("Collapse", toggleCollapsed(graphOf(e), scopeOf(e), selected(e))); }},
    {"node.thumbnail", "Node", "Thumbnail", "Shift+P", canvas, anySelected,
     [](Editor& e) {
         for (const std::string& id : e.canvas.selection) e.thumbnails.toggle(e.shell, pathOf(e, id));
     }},
    {"node.swap", "Node", "Swap inputs", "Alt+S", canvas, anyActive,
     [](Editor& e) { e.document.apply("Swap Inputs", swapInputs(graphOf(e), scopeOf(e), e.canvas.active)); }},
    {"node.group", "Node", "Group", "Ctrl+G", canvas, anySelected, group, true},
    {"node.ungroup", "Node", "Ungroup", "Ctrl+Shift+G", canvas, groupActive, ungroupActive},
    {"node.enter", "Node", "Enter or leave group", "Ctrl+Tab", canvas,
     [](const Editor& e) { return groupActive(e) || !e.canvas.scope.empty(); }, enterOrLeave},
    {"node.link", "Node", "Group to a file …", "", canvas, groupHere,
     [](Editor& e) { askToLink(e, groupIdHere(e)); }},
    {"node.update_link", "Node", "Update group from its file", "", canvas, linkedHere,
     [](Editor& e) { updateGroup(e, groupIdHere(e)); }},
    {"node.write_link", "Node", "Write group to its file", "", canvas, linkedHere,
     [](Editor& e) { writeGroup(e, groupIdHere(e)); }},
    {"node.unlink", "Node", "Make group local", "", canvas, linkedHere,
     [](Editor& e) { unlinkGroup(e, groupIdHere(e)); }},
    {"node.keep", "Node", "Keep in the library …", "Ctrl+K", canvas, anySelected, keepInLibrary},
    {"node.frame", "Node", "Comment frame", "Ctrl+J", canvas, anySelected,
     [](Editor& e) { e.document.apply("Add Frame", frameNodes(graphOf(e), scopeOf(e), selected(e))); }},
    {"node.layout", "Node", "Lay out", "Ctrl+L", canvas, always, layOutNodes, true},
    {"node.align_left", "Node", "Align left sides", "", canvas, severalSelected, alignNodes<Alignment::left>},
    {"node.align_right", "Node", "Align right sides", "", canvas, severalSelected, alignNodes<Alignment::right>},
    {"node.align_top", "Node", "Align tops", "", canvas, severalSelected, alignNodes<Alignment::top>},
    {"node.align_bottom", "Node", "Align bottoms", "", canvas, severalSelected, alignNodes<Alignment::bottom>},
    {"node.spread_x", "Node", "Equal gaps across", "", canvas, severalSelected,
     [](Editor& e) {
         e.document.apply("Distribute Nodes", distribute(graphOf(e), scopeOf(e), selected(e), true));
     }},
    {"node.spread_y", "Node", "Equal gaps down", "", canvas, severalSelected,
     [](Editor& e) {
         e.document.apply("Distribute Nodes", distribute(graphOf(e), scopeOf(e), selected(e), false));
     }},
    {"picture.frame", "Picture", "Frame the solid", "F", picture, pictured, frameSolid},
    {"picture.reset", "Picture", "Back to the scene's camera", "Home 0 Pad0", picture, pictured,
     [](Editor& e) { e.viewport.ownCamera = false; }},
    {"picture.to_scene", "Picture", "Make it the scene's camera", "Ctrl+Alt+0 Ctrl+Alt+Pad0", picture, pictured,
     keepAsSceneCamera},
    {"picture.projection", "Picture", "Orthographic", "5 Pad5", picture, pictured,
     [](Editor& e) { changeProjection(e.viewport); }, true},
    {"picture.grid", "Picture", "Grid", "Shift+G", picture, always, [](Editor& e) { e.viewport.grid = !e.viewport.grid; }},
    {"picture.keep_view", "Picture", "Keep this view", "Ctrl+B", picture, pictured, keepView},
    {"picture.next_view", "Picture", "Next kept view", "B", picture,
     [](const Editor& e) { return !e.viewport.kept.views.empty(); }, goToNextView},
    {"picture.next_picture", "Picture", "Hand to the next picture", "V", picture, isSplit,
     [](Editor& e) { takeHand(e.viewport, (e.viewport.split.hand + 1) % e.viewport.split.count); }},
    {"picture.front", "Picture", "From the front", "1 Pad1", picture, pictured, look<Side::front>, true},
    {"picture.back", "Picture", "From the back", "Ctrl+1 Ctrl+Pad1", picture, pictured, look<Side::back>},
    {"picture.right", "Picture", "From the right", "3 Pad3", picture, pictured, look<Side::right>},
    {"picture.left", "Picture", "From the left", "Ctrl+3 Ctrl+Pad3", picture, pictured, look<Side::left>},
    {"picture.top", "Picture", "From the top", "7 Pad7", picture, pictured, look<Side::top>},
    {"picture.bottom", "Picture", "From the bottom", "Ctrl+7 Ctrl+Pad7", picture, pictured, look<Side::bottom>},
    {"picture.turn_left", "Picture", "Turn left", "Alt+Left Pad4", picture, pictured, turnPicture<-1, 0>, true},
    {"picture.turn_right", "Picture", "Turn right", "Alt+Right Pad6", picture, pictured, turnPicture<1, 0>},
    {"picture.turn_up", "Picture", "Turn up", "Alt+Up Pad8", picture, pictured, turnPicture<0, 1>},
    {"picture.turn_down", "Picture", "Turn down", "Alt+Down Pad2", picture, pictured, turnPicture<0, -1>},
    {"picture.pan_left", "Picture", "Pan left", "Shift+Alt+Left Ctrl+Pad4", picture, pictured, panPicture<-1, 0>},
    {"picture.pan_right", "Picture", "Pan right", "Shift+Alt+Right Ctrl+Pad6", picture, pictured, panPicture<1, 0>},
    {"picture.pan_up", "Picture", "Pan up", "Shift+Alt+Up Ctrl+Pad8", picture, pictured, panPicture<0, 1>},
    {"picture.pan_down", "Picture", "Pan down", "Shift+Alt+Down Ctrl+Pad2", picture, pictured, panPicture<0, -1>},
    {"picture.nearer", "Picture", "Nearer", "Equal PadPlus", picture, pictured, zoomPicture<1>},
    {"picture.farther", "Picture", "Farther", "Minus PadMinus", picture, pictured, zoomPicture<-1>},
    {"picture.shading", "Picture", "Next shading", "Z", picture, pictured, [](Editor& e) { shadeNext(e.viewport); },
     true},
    {"picture.move", "Picture", "Move", "W", picture, pictured, use<Tool::move>, true},
    {"picture.rotate", "Picture", "Rotate", "E", picture, pictured, use<Tool::turn>},
    {"picture.scale", "Picture", "Scale", "R", picture, pictured, use<Tool::scale>},
    {"picture.measure", "Picture", "Measure a length", "Shift+M", picture, pictured,
     [](Editor& e) { useMeasure(e, Measure::length); }, true},
    {"picture.angle", "Picture", "Measure an angle", "Shift+N", picture, pictured,
     [](Editor& e) { useMeasure(e, Measure::angle); }},
    {"picture.radius", "Picture", "Measure a radius", "Shift+R", picture, pictured,
     [](Editor& e) { useMeasure(e, Measure::radius); }},
    {"picture.wall", "Picture", "Measure a wall", "Shift+T", picture, pictured,
     [](Editor& e) { useMeasure(e, Measure::wall); }},
    {"picture.line", "Picture", "Plot along a line", "Shift+K", picture, pictured,
     [](Editor& e) { useMeasure(e, Measure::line); }},
    {"picture.clear", "Picture", "Clear what is measured", "Escape", picture, canClearProbe, clearProbe},
    {"picture.snap", "Picture", "Snap", "Shift+Tab", picture, pictured,
     [](Editor& e) {
         bool& on = e.viewport.gizmo.snap.on;
         on = !on;
         say(e, on ? "Snap: drags in the picture go in steps, or to a place" : "Snap is off");
     }},
    {"picture.axes", "Picture", "Other axes", "X", picture, pictured,
     [](Editor& e) {
         constexpr const char* kSaid[] = {"Axes: those of the numbers", "Axes: the world's", "Axes: the node's own"};
         const int next = (int(e.viewport.gizmo.axes) + 1) % 3;
         e.viewport.gizmo.axes = AxesOf(next);
         say(e, kSaid[next]);
     }},
    {"picture.pivot", "Picture", "Other pivot", "", picture, pictured,
     [](Editor& e) {
         constexpr const char* kSaid[] = {"Pivot: each node's own place", "Pivot: the middle of what is selected",
                                          "Pivot: the origin", "Pivot: a point, set in the picture's Options"};
         const int next = (int(e.viewport.gizmo.pivot) + 1) % 4;
         e.viewport.gizmo.pivot = PivotAt(next);
         say(e, kSaid[next]);
     }},
    {"picture.marks", "Picture", "Lamps and camera", "", picture, pictured,
     [](Editor& e) { e.viewport.gizmo.marks = !e.viewport.gizmo.marks; }},
    {"view.frame", "View", "Frame selection", "F", canvas, always, [](Editor& e) { frame(e, false); }},
    {"view.frame_all", "View", "Frame all", "Home", canvas, always, [](Editor& e) { frame(e, true); }},
    {"view.costs", "View", "Costs on the nodes", "", everywhere, always, [](Editor& e) { e.canvas.costs = !e.canvas.costs; }},
    {"view.exactness", "View", "Exactness on the wires", "", everywhere, always,
     [](Editor& e) { e.canvas.exactness = !e.canvas.exactness; }},
    {"view.probe", "View", "Probe", "Alt+P", everywhere, always, toggleProbe},
    {"view.minimap", "View", "Minimap", "", everywhere, always, [](Editor& e) { e.canvas.minimap = !e.canvas.minimap; }},
    {"view.pin", "View", "Show the node's own field", "Ctrl+Shift+P Slash PadSlash", canvas, anyActive, pinSelected},
    {"view.zoom_in", "View", "Zoom in", "Equal PadPlus", canvas, always, [](Editor& e) { zoom(e, kZoomStep); }},
    {"view.zoom_out", "View", "Zoom out", "Minus PadMinus", canvas, always,
     [](Editor& e) { zoom(e, 1.0f / kZoomStep); }},
    {"view.split", "View", "Split the picture", "Ctrl+Alt+Q", everywhere, always,
     [](Editor& e) { splitInto(e, isSplit(e) ? 1 : e.viewport.split.last); }, true},
    {"view.one_picture", "View", "One picture", "", everywhere, always, split<1>},
    {"view.two_pictures", "View", "Two pictures", "", everywhere, always, split<2>},
    {"view.three_pictures", "View", "Three pictures", "", everywhere, always, split<3>},
    {"view.four_pictures", "View", "Four pictures", "", everywhere, always, split<4>},
    {"view.play", "View", "Play or pause", "Alt+A Ctrl+Space", everywhere, always, togglePlay, true},
    {"view.timeline", "View", "Timeline", "Ctrl+T", everywhere, always,
     [](Editor& e) {
         e.panels.timeline = !e.panels.timeline;
         e.panels.next = e.panels.timeline ? Part::timeline : Part::canvas;
     },
     true},
    {"view.inspector", "View", "Inspector", "", everywhere, always, [](Editor& e) { togglePanel(e, "inspector"); }},
    {"view.outliner", "View", "Outliner", "", everywhere, always, [](Editor& e) { togglePanel(e, "outliner"); }},
    {"view.problems", "View", "Problems", "", everywhere, always, [](Editor& e) { togglePanel(e, "problems"); }},
    {"view.parameters", "View", "Parameters", "", everywhere, always, [](Editor& e) { togglePanel(e, "parameters"); }},
    {"view.scene", "View", "Scene", "", everywhere, always, [](Editor& e) { togglePanel(e, "scene"); }},
    {"view.statistics", "View", "Statistics", "", everywhere, always, [](Editor& e) { togglePanel(e, "statistics"); }},
    {"view.history", "View", "History", "Ctrl+H", everywhere, always, [](Editor& e) { togglePanel(e, "history"); }},
    {"view.library", "View", "Library", "", everywhere, always, [](Editor& e) { togglePanel(e, "library"); }},
    {"view.next_panel", "View", "Next panel", "Ctrl+PageDown", everywhere, always, [](Editor& e) { turnPanels(e, 1); },
     true},
    {"view.previous_panel", "View", "Previous panel", "Ctrl+PageUp", everywhere, always,
     [](Editor& e) { turnPanels(e, -1); }},
    {"view.next_part", "View", "Keyboard to the next part", "F6", everywhere, always, [](Editor& e) { turnParts(e, 1); }},
    {"view.previous_part", "View", "Keyboard to the part before", "Shift+F6", everywhere, always,
     [](Editor& e) { turnParts(e, -1); }},
    {"view.to_canvas", "View", "Keyboard to the canvas", "Alt+1", everywhere, always,
     [](Editor& e) { e.panels.next = Part::canvas; }},
    {"view.to_viewport", "View", "Keyboard to the viewport", "Alt+2", everywhere, always,
     [](Editor& e) { e.panels.next = Part::viewport; }},
    {"view.to_side", "View", "Keyboard to the panel", "Alt+3", everywhere, always,
     [](Editor& e) { e.panels.next = Part::side; }},
    {"help.node", "Help", "Page of the node", "F1", everywhere, always, openReference},
    {"help.find", "Help", "Find a command …", "F3", everywhere, always,
     [](Editor& e) { e.windows.palette.opened = true; }},
    {"help.shortcuts", "Help", "Shortcuts", "Shift+F1", everywhere, always,
     [](Editor& e) { e.windows.shortcuts = true; }},
    {"help.tutorial", "Help", "Tutorial", "", everywhere, always,
     [](Editor& e) { openDocument(e, "editor-tutorial.md"); }},
    {"help.tour", "Help", "Tour", "", everywhere, always, startTour},
    {"help.about", "Help", "About …", "", everywhere, always, [](Editor& e) { e.windows.about = true; }, true},
    {"canvas.left", "", "Node to the left", "Left", canvas, always, stepTo<-1, 0, false>},
    {"canvas.right", "", "Node to the right", "Right", canvas, always, stepTo<1, 0, false>},
    {"canvas.up", "", "Node above", "Up", canvas, always, stepTo<0, -1, false>},
    {"canvas.down", "", "Node below", "Down", canvas, always, stepTo<0, 1, false>},
    {"canvas.add_left", "", "Select also to the left", "Shift+Left", canvas, always, stepTo<-1, 0, true>},
    {"canvas.add_right", "", "Select also to the right", "Shift+Right", canvas, always, stepTo<1, 0, true>},
    {"canvas.add_up", "", "Select also above", "Shift+Up", canvas, always, stepTo<0, -1, true>},
    {"canvas.add_down", "", "Select also below", "Shift+Down", canvas, always, stepTo<0, 1, true>},
    {"canvas.move_left", "", "Move to the left", "Ctrl+Left", canvas, anySelected, moveBy<-1, 0>},
    {"canvas.move_right", "", "Move to the right", "Ctrl+Right", canvas, anySelected, moveBy<1, 0>},
    {"canvas.move_up", "", "Move up", "Ctrl+Up", canvas, anySelected, moveBy<0, -1>},
    {"canvas.move_down", "", "Move down", "Ctrl+Down", canvas, anySelected, moveBy<0, 1>},
    {"file.next_document", "File", "Next document", "Alt+PageDown", everywhere, manyTabs, [](Editor& e) { turnTabs(e, 1); },
     true},
    {"file.last_document", "File", "Previous document", "Alt+PageUp", everywhere, manyTabs, [](Editor& e) { turnTabs(e, -1); }},
    {"file.close", "File", "Close", "Ctrl+W", everywhere, always, [](Editor& e) { proceed(e, Files::Next::close); }},
    {"file.quit", "File", "Quit", "Ctrl+Q", everywhere, always, [](Editor& e) { proceed(e, Files::Next::quit); }, true},
};

/// Save, quit and their like end the typing, which then reaches the document before they run.
void leaveTextFor(Editor& editor) {
    for (const auto& [shortcut, command] : editor.keymap) {
        if (std::string_view(command->menu) != "File" || !shortcut.ctrl || !pressed(shortcut)) continue;
        ImGui::ClearActiveID();
        editor.windows.chosen = command;
        return;
    }
}

/// Whether what the command shows or hides is there.
bool shows(const Command& command, const Editor& editor) {
    const std::string_view id = command.id;
    if (id == "view.minimap") return editor.canvas.minimap;
    if (id == "view.costs") return editor.canvas.costs;
    if (id == "view.exactness") return editor.canvas.exactness;
    if (id == "picture.measure") return editor.probe.tool == Measure::length;
    if (id == "picture.angle") return editor.probe.tool == Measure::angle;
    if (id == "picture.radius") return editor.probe.tool == Measure::radius;
    if (id == "picture.wall") return editor.probe.tool == Measure::wall;
    if (id == "picture.line") return editor.probe.tool == Measure::line;
    if (id == "picture.grid") return editor.viewport.grid;
    if (id == "picture.projection") return editor.viewport.ownCamera && editor.viewport.orthographic;
    const std::size_t pictures = editor.viewport.split.count;
    if (id == "view.split") return isSplit(editor);
    if (id == "view.one_picture") return pictures == 1;
    if (id == "view.two_pictures") return pictures == 2;
    if (id == "view.three_pictures") return pictures == 3;
    if (id == "view.four_pictures") return pictures == 4;
    if (id == "view.timeline") return editor.panels.timeline;
    for (const SidePanel& panel : sidePanels())
        if (id == std::string("view.") + panel.id) return editor.panels.*panel.open;
    return false;
}

}  // namespace

std::span<const Command> commands() { return kCommands; }

const Command& command(std::string_view id) {
    const auto found = std::ranges::find(kCommands, id, &Command::id);
    assert(found != std::end(kCommands));
    return *found;
}

std::string labelOf(const Command& command, const Editor& editor) {
    const std::string_view id = command.id;
    std::string label = command.label;
    if (id == "edit.undo" && editor.document.canUndo()) label += " " + editor.document.undoName();
    if (id == "edit.redo" && editor.document.canRedo()) label += " " + editor.document.redoName();
    return label;
}

void runShortcuts(Editor& editor) {
    const ImGuiIO& io = ImGui::GetIO();
    keepMenusClosed();
    if (const Command* chosen = std::exchange(editor.windows.chosen, nullptr); chosen && chosen->can(editor))
        return chosen->run(editor);
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return;
    if (io.WantTextInput) return leaveTextFor(editor);
    if (editor.document.held() || editor.viewport.drag.busy()) return;
    // Space asks for the menu when it goes up, if nothing was panned with it.
    const int space = ImGui::GetKeyIndex(ImGuiKey_Space);
    if (ImGui::IsKeyPressed(space, false))
        editor.canvas.spacePans = io.NavActive || io.KeyCtrl || io.KeyShift || io.KeyAlt;
    const bool panel = editor.panels.keyboard == Part::side || editor.panels.keyboard == Part::timeline;
    if (ImGui::IsKeyReleased(space) && !std::exchange(editor.canvas.spacePans, false) && !panel &&
        !editor.outline.focused)
        addHere(editor);
    const bool picture = anyHovered(editor.viewport) || editor.panels.keyboard == Part::viewport;
    const auto heard = [&](const Command& command, const Shortcut& shortcut) {
        if (editor.outline.focused && command.heard != Heard::everywhere) return false;
        if (command.heard == Heard::picture) return picture;
        if (command.heard == Heard::timeline && (picture || editor.panels.keyboard != Part::timeline))
            return false;
        return !panelsSteer(shortcut) && !(panel && command.heard == Heard::canvas);
    };
    for (const auto& [shortcut, command] : editor.keymap)
        if (pressed(shortcut) && heard(*command, shortcut) && command->can(editor))
            return command->run(editor);
    if (!panel && !picture && !editor.outline.focused && anyActive(editor) &&
        !isOverAny(editor.viewport, io.MousePos))
        beginNumber(editor);
    leavePanels(editor);
}

namespace {

void showMenu(Editor& editor, const char* menu) {
    if (!ImGui::BeginMenu(menu)) return;
    for (const Command& command : kCommands) {
        if (std::string_view(command.menu) != menu) continue;
        if (command.separated) ImGui::Separator();
        const std::string all = keysOf(command, editor.files.preferences);
        const std::string first = all.substr(0, all.find(' '));
        if (ImGui::MenuItem(labelOf(command, editor).c_str(), first.c_str(), shows(command, editor),
                            command.can(editor)))
            command.run(editor);
        if (std::string_view(command.id) == "file.open") showRecent(editor);
        if (std::string_view(command.id) == "picture.next_view") showKeptViews(editor);
    }
    ImGui::EndMenu();
}

}  // namespace

void showMenus(Editor& editor) {
    constexpr const char* kMenus[] = {"File", "Edit", "Node", "View", "Picture", "Timeline", "Help"};
    constexpr const char* kRest = "…";
    const auto widthOf = [](const char* label) {
        return ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().ItemSpacing.x;
    };
    float room = ImGui::GetContentRegionAvail().x, all = 0.0f;
    for (const char* menu : kMenus) all += widthOf(menu);
    // Those for which there is no room are in the last one.
    std::size_t shown = std::size(kMenus);
    if (all > room)
        for (shown = 0, room -= widthOf(kRest); shown < std::size(kMenus); ++shown)
            if ((room -= widthOf(kMenus[shown])) < 0.0f) break;
    for (std::size_t i = 0; i < shown; ++i) showMenu(editor, kMenus[i]);
    if (shown == std::size(kMenus) || !ImGui::BeginMenu(kRest)) return;
    for (std::size_t i = shown; i < std::size(kMenus); ++i) showMenu(editor, kMenus[i]);
    ImGui::EndMenu();
}

}  // namespace fw::editor
