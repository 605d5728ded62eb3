// From the picture to the canvas: what was hit is selected there.
#include "editor/editor.h"
#include "editor/viewport/pick.h"

namespace fw::editor {

namespace {

/// The node of the scope shown through which the path leads; none if it does not lead there.
std::optional<std::string> inScope(const Editor& editor, const std::vector<std::string>& path) {
    const Graph& graph = editor.document.graph();
    std::string scope;
    for (const std::string& id : path) {
        if (scope == editor.canvas.scope) return id;
        const Node* instance = findNode(nodesOf(graph, scope), id);
        if (!instance || !graph.group(instance->group)) break;
        scope = instance->group;
    }
    return std::nullopt;
}

void selectHit(Editor& editor, const std::vector<std::string>& path, bool besides) {
    if (path.empty()) return;
    const std::optional<std::string> id = inScope(editor, path);
    if (!id) return reveal(editor, path.front());
    const NodeBox* box = editor.boxes ? editor.boxes->find(*id) : nullptr;
    if (!box) return;  // removed since
    if (!besides) editor.canvas.selection.clear();
    editor.canvas.selection.insert(*id);
    editor.canvas.active = *id;
    CanvasView& view = editor.canvas.view;
    if (!view.seen().contains(box->area.centre())) view.middle = box->area.centre();
}

}  // namespace

void pickUnderMouse(Editor& editor, bool besides) {
    Viewport& viewport = editor.viewport;
    const ImVec2 mouse = ImGui::GetIO().MousePos, middle = viewport.place.centre();
    const double x = double((mouse.x - middle.x) / (0.5f * viewport.place.width())),
                 y = double((middle.y - mouse.y) / (0.5f * viewport.place.height()));
    Seen seen{.graph = editor.graph,
              .pinned = viewport.pinned,
              .seconds = viewport.seconds,
              .region = viewport.shown.region,
              .camera = viewport.shown.seen,
              .aspect = double(viewport.aspect())};
    viewport.aside.ask([seen = std::move(seen), x, y, besides]() -> Aside::Answer {
        return [path = pick(seen, x, y), besides](Editor& to) { selectHit(to, path, besides); };
    });
}

}  // namespace fw::editor
