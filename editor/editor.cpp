#include "editor/editor.h"

#include <algorithm>

#include "editor/commands.h"
#include "editor/document/layout.h"
#include "editor/document/paths.h"
#include "editor/panels/playback.h"
#include "editor/panels/properties.h"
#include "editor/panels/side.h"
#include "editor/preview/pinned.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "editor/timeline/fields_in_time.h"
#include "editor/viewport/widths.h"
#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

constexpr double kNoticeSeconds = 6.0;
constexpr float kLeastSide = 20.0f;      // width of the panels in units of the font's size,
constexpr float kMostLeastSide = 0.55f;  // and the part of the window that they have at most for it
constexpr float kMargin = 4.0f;          // around the parts of the window, pixels

/// Labels, names and texts may be in any language.
void wantGlyphsOf(const Graph& graph) {
    wantGlyphs(graph.path);
    for (const Frame& frame : framesOf(graph)) wantGlyphs(frame.text);
    const auto all = [](const std::vector<Node>& nodes) {
        for (const Node& node : nodes) {
            for (const std::string* text : {&node.id, &node.label, &node.code}) wantGlyphs(*text);
            for (const auto& [name, value] : node.inputs)
                if (const auto* text = std::get_if<std::string>(&value.value)) wantGlyphs(*text);
        }
    };
    all(graph.nodes);
    for (const Group& group : graph.groups) wantGlyphs(group.id), all(group.nodes);
}

void drawAnew(Editor& editor) {
    if (editor.drawn == editor.document.revision() && editor.boxes) return;
    editor.boxes.reset();
    editor.graph = std::make_shared<const Graph>(editor.document.graph());
    wantGlyphsOf(*editor.graph);
    editor.canvas.follow(*editor.graph);
    editor.boxes.emplace(*editor.graph, editor.canvas.scope);
    editor.drawn = editor.document.revision();
    const auto exists = [&](const std::string& path) {
        const auto [scope, id] = placeOf(*editor.graph, path);
        return findNode(nodesOf(*editor.graph, scope), id) != nullptr;
    };
    if (!editor.viewport.pinned.empty()) {
        std::vector<std::string> paths = pinnedNodes(editor.viewport.pinned);
        if (std::erase_if(paths, [&](const std::string& path) { return !exists(path); }) > 0)
            editor.viewport.pinned = pinnedTogether(paths);
    }
    editor.thumbnails.keepOnly(editor.shell, exists);
}

/// The inputs under the hand, as the compiler names them: in a group, those of every instance.
std::set<std::string> heldInputs(const Editor& editor) {
    std::set<std::string> held = heldBy(editor.canvas.number), named;
    held.merge(editor.panelState.heldInputs());
    held.merge(editor.viewport.gizmo.held(editor.canvas.scope));
    for (const std::string& path : held) {
        const auto [scope, input] = placeOf(*editor.graph, path);
        for (std::string& name : instancesOf(*editor.graph, scope, input)) named.insert(std::move(name));
    }
    return named;
}

/// "Document > group", each part a button back to it.
void showBreadcrumb(Editor& editor) {
    if (editor.canvas.scope.empty()) return;
    if (ImGui::SmallButton("Document")) return enter(editor, "");
    ImGui::SameLine();
    ImGui::TextUnformatted(("› " + readable(editor.canvas.scope)).c_str());
}

/// A bar that divides two parts; dragged, it changes how much the second has.
void splitter(const char* id, bool upright, float& part, float whole, float scale) {
    const float thick = 5.0f * scale;
    const ImVec2 size = upright ? ImVec2(thick, -1) : ImVec2(-1, thick);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    ImGui::InvisibleButton(id, {size.x < 0 ? room.x : size.x, size.y < 0 ? room.y : size.y});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
        ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    if (!ImGui::IsItemActive()) return;
    const ImVec2 by = ImGui::GetIO().MouseDelta;
    part = std::clamp(part + (upright ? -by.x : by.y) / whole, kLeastPart, kMostPart);
}

void showSide(Editor& editor, float height) {
    const float top = height * editor.panels.top;
    ImGui::BeginChild("##viewport", {0, top});
    takeKeyboard(editor, Part::viewport);
    showViewport(editor);
    ImGui::EndChild();
    splitter("##below", false, editor.panels.top, height, editor.shell.scale());
    showSidePanels(editor);
}

void showStatus(Editor& editor) {
    const PreviewResult& shown = editor.viewport.shown;
    const float room = ImGui::GetContentRegionAvail().x;
    if (ImGui::GetTime() < editor.noticeUntil)
        return ImGui::TextUnformatted(fitted(editor.notice, room).c_str());
    if (!shown.failure.empty())
        return ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(themeColor(ThemeColor::error)), "%s",
                                  fitted(shown.failure, room).c_str());
    ImGui::Text("%zu nodes", nodesOf(*editor.graph, editor.canvas.scope).size());
    if (shown.statistics.triangles > 0) {
        ImGui::SameLine();
        char words[100];
        std::snprintf(words, sizeof words, "· %u triangles · %.0f ms%s", shown.statistics.triangles,
                      shown.statistics.milliseconds, editor.preview.busy() ? " · working" : "");
        ImGui::TextDisabled("%s", fitted(words, ImGui::GetContentRegionAvail().x).c_str());
    }
}

void showCanvasPart(Editor& editor) {
    showBreadcrumb(editor);
    drawAnew(editor);
    const CanvasWishes wishes =
        showCanvas(editor.canvas, editor.document, *editor.boxes, marksOf(editor), editor.shell);
    takeDraggedPart(editor);
    if (std::exchange(editor.canvas.addsNext, false)) editor.windows.chosen = &command("node.add");
    if (wishes.add) editor.add.wish = *wishes.add, editor.add.opened = true;
    if (!wishes.enter.empty()) enter(editor, wishes.enter);
    if (!wishes.activate.empty()) pin(editor, wishes.activate);
    if (wishes.frame) editor.frameMenu = {*wishes.frame, true};
    showStartPage(editor);
    showFieldMenu(editor, wishes.field);
    showAddMenu(editor);
    showFrameMenu(editor);
}

/// The window's background from its menus down, but for the canvas, which is of the shell's own colour. A
/// software device pays for each pixel that is covered twice.
void fillAround(const Area& canvas) {
    const ImVec2 lo = {ImGui::GetWindowPos().x, canvas.lo.y - kMargin},
                 hi = {lo.x + ImGui::GetWindowWidth(), ImGui::GetWindowPos().y + ImGui::GetWindowHeight()};
    const auto fill = [](ImVec2 from, ImVec2 to) {
        ImGui::GetWindowDrawList()->AddRectFilled(from, to, ImGui::GetColorU32(ImGuiCol_WindowBg));
    };
    fill(lo, {hi.x, canvas.lo.y});
    fill({lo.x, canvas.lo.y}, {canvas.lo.x, canvas.hi.y});
    fill({canvas.hi.x, canvas.lo.y}, {hi.x, canvas.hi.y});
    fill({lo.x, canvas.hi.y}, hi);
}

}  // namespace

Editor::Editor(Shell& shell_, Graph opened, DeviceOptions device_)
    : shell(shell_),
      device(std::move(device_)),
      document(placeAll(opened)),
      preview(device, [] { Shell::wake(); }) {
    panels.next = Part::canvas;
    keymap = keymapOf(files.preferences);
    // Places that nodes lacked are no edit of the user's.
    document.markSaved();
    drawAnew(*this);
}

bool exchange(Editor& editor) {
    drawAnew(editor);
    Viewport& view = editor.viewport;
    PreviewWish wish{
        .graph = editor.graph, .revision = editor.drawn, .document = view.document, .pinned = view.pinned};
    wish.held = heldInputs(editor);
    wish.seconds = view.seconds;
    wishPictures(view, wish);
    wish.view = view.view;
    wish.slice = view.slice;
    wish.leastWidth = leastWidth(view);
    wish.resolution = view.resolution;
    wish.measures = editor.panels.statistics;
    if (wish.width > 0 && wish.height > 0) editor.preview.ask(std::move(wish));
    if (const Done kept = editor.files.recovery.keep(editor.graph, editor.drawn, editor.document.unsaved());
        !kept)
        say(editor, format(kept.error()));
    const bool noticed = watchFile(editor);
    const bool thumbnail = editor.thumbnails.follow(editor.shell, editor.graph, editor.drawn,
                                                    view.shown.particles, !editor.document.held());
    std::optional<PreviewResult> result = editor.preview.take();
    if (!result || result->document != view.document) return noticed || thumbnail;
    takePictures(view, editor.shell, std::move(*result));
    return true;
}

void showEditor(Editor& editor) {
    editor.document.settleLost();
    followHands(editor);
    code::finish(editor);
    playOn(editor);
    drawAnew(editor);
    const ImGuiViewport* whole = ImGui::GetMainViewport();
    ImGui::SetNextWindowPos(whole->WorkPos);
    ImGui::SetNextWindowSize(whole->WorkSize);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kMargin, kMargin));
    ImGui::Begin("##editor", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_MenuBar |
                     ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoBackground);
    ImGui::PopStyleVar();
    if (ImGui::BeginMenuBar()) {
        showMenus(editor);
        showTabs(editor);
        ImGui::EndMenuBar();
    }
    runShortcuts(editor);
    drawAnew(editor);

    const float line = ImGui::GetTextLineHeightWithSpacing();
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float bar = 5.0f * editor.shell.scale(),
                timeline = editor.panels.timeline ? editor.panels.low * room.y : 0.0f,
                high = room.y - line - timeline;
    // However narrow the window is, panels can be read.
    const float side = std::clamp(kLeastSide * ImGui::GetFontSize() / room.x, editor.panels.side,
                                  std::max(editor.panels.side, kMostLeastSide));
    ImGui::BeginChild(
        "##canvas", {room.x * (1.0f - side), high}, false,
        ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoNav);
    followMouse(editor);
    takeKeyboard(editor, Part::canvas);
    showCanvasPart(editor);
    ImGui::EndChild();
    fillAround({ImGui::GetItemRectMin(), ImGui::GetItemRectMax()});
    ImGui::SameLine(0, 0);
    ImGui::BeginChild("##bar", {5.0f * editor.shell.scale(), high});
    splitter("##beside", true, editor.panels.side, room.x, editor.shell.scale());
    ImGui::EndChild();
    ImGui::SameLine(0, 0);
    drawAnew(editor);  // for what the canvas changed
    ImGui::BeginChild("##side", {0, high}, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    showSide(editor, high);
    ImGui::EndChild();
    if (editor.panels.timeline) {
        ImGui::BeginChild("##above", {0, bar});
        float above = 1.0f - editor.panels.low;
        splitter("##aboveTimeline", false, above, room.y, editor.shell.scale());
        editor.panels.low = std::clamp(1.0f - above, kLeastPart, kMostPart);
        ImGui::EndChild();
        ImGui::BeginChild("##timeline", {0, timeline - bar - 2.0f * ImGui::GetStyle().ItemSpacing.y});
        takeKeyboard(editor, Part::timeline);
        showTimeline(editor);
        ImGui::EndChild();
    }
    showStatus(editor);
    showFiles(editor);
    showExport(editor);
    showRender(editor);
    showWindows(editor);
    ImGui::End();
}

bool moves(const Editor& editor) {
    return editor.viewport.playing || editor.canvas.gesture.kind != CanvasGesture::Kind::none ||
           editor.canvas.number.state != NumberHand::State::none || flies(editor.viewport);
}

void apply(Editor& editor, std::string name, Edited edited) {
    editor.document.apply(std::move(name), std::move(edited.graph));
    if (!edited.nodes.empty()) editor.canvas.select(edited.nodes);
}

void say(Editor& editor, std::string words) {
    editor.notice = std::move(words);
    editor.noticeUntil = ImGui::GetTime() + kNoticeSeconds;
}

void enter(Editor& editor, std::string scope) {
    editor.document.settle();
    editor.canvas.scope = std::move(scope);
    editor.canvas.select({});
    editor.canvas.frameNext = true;
    editor.drawn = 0;  // who shows the boxes of this frame may go on with them
}

void pin(Editor& editor, const std::string& id) {
    std::string path = pathOf(editor, id);
    editor.viewport.pinned = editor.viewport.pinned == path ? std::string() : std::move(path);
}

void pinSelected(Editor& editor) {
    const std::vector<Node>& nodes = nodesOf(*editor.graph, editor.canvas.scope);
    std::vector<std::string> paths;
    for (const std::string& id : editor.canvas.selection)
        if (const Node* node = findNode(nodes, id); node && makesSurface(*node))
            paths.push_back(pathOf(editor, id));
    if (paths.size() < 2) return pin(editor, editor.canvas.active);
    std::string together = pinnedTogether(paths);
    editor.viewport.pinned = editor.viewport.pinned == together ? std::string() : std::move(together);
}

namespace {

/// By node of the scope shown, its part of what a sample of the field costs: of a group what is in it.
std::map<std::string, double, std::less<>> costsOf(const Editor& editor) {
    std::map<std::string, double, std::less<>> costs;
    double all = 0.0;
    for (const NodeEffort& effort : editor.viewport.shown.efforts) {
        all += effort.sample;
        // Of "tower/window/pane" the node here is the one whose place is in the scope shown.
        for (std::size_t end = 0; end != std::string::npos;) {
            end = effort.node.find('/', end + 1);
            const auto [scope, id] = placeOf(*editor.graph, std::string_view(effort.node).substr(0, end));
            if (scope != editor.canvas.scope) continue;
            costs[id] += effort.sample;
            break;
        }
    }
    for (auto& [id, cost] : costs) cost /= std::max(all, 1.0);
    return costs;
}

}  // namespace

CanvasMarks marksOf(Editor& editor) {
    CanvasMarks marks;
    const PreviewResult& shown = editor.viewport.shown;
    const auto here = [&](std::string_view path) {
        auto [scope, id] = placeOf(*editor.graph, path);
        return scope == editor.canvas.scope ? std::move(id) : std::string();
    };
    for (const std::string& path : pinnedNodes(editor.viewport.pinned)) marks.pinned.insert(here(path));
    marks.spoiledBy = here(shown.spoiledBy);
    for (const auto& [path, thumbnail] : editor.thumbnails.shown)
        if (std::string id = here(path); !id.empty()) marks.thumbnails.emplace(std::move(id), &thumbnail);
    marks.exactness = [&editor](const std::string& id) { return exactnessOf(editor, id); };
    for (const std::vector<Error>* some : {&editor.files.groups.findings(), &shown.findings})
        for (const Error& finding : *some) {
            const std::string id = here(finding.node);
            if (id.empty()) continue;
            const Error*& worst = marks.findings[id];
            if (!worst || finding.severity == Error::Severity::error) worst = &finding;
        }
    marks.animated = movedFields(editor);
    if (editor.canvas.costs) marks.costs = costsOf(editor);
    if (editor.panels.probe) marks.values = &editor.probe.values;
    return marks;
}

const NodeExactness* exactnessOf(const Editor& editor, const std::string& id) {
    std::vector<std::string> paths = instancesOf(*editor.graph, editor.canvas.scope, id);
    std::ranges::sort(paths);
    for (const std::string& path : paths)
        if (const auto known = editor.viewport.shown.exactness.find(path);
            known != editor.viewport.shown.exactness.end())
            return &known->second;
    return nullptr;
}

void reveal(Editor& editor, std::string_view path) {
    const auto [scope, id] = placeOf(editor.document.graph(), path);
    if (scope != editor.canvas.scope) enter(editor, scope);
    drawAnew(editor);
    const NodeBox* box = editor.boxes->find(id);
    if (!box) return;
    editor.canvas.select({id});
    editor.canvas.frameNext = false;
    editor.canvas.view.middle = box->area.centre();
}

}  // namespace fw::editor
