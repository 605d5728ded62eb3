// From the picture to the canvas: what was hit is selected there.
#include "editor/document/paths.h"
#include "editor/editor.h"
#include "editor/viewport/pick.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fw::editor {

namespace {

/// The node of the scope shown that the path leads to or through; empty if it does not lead there.
std::string inScope(const Editor& editor, const std::string& path) {
    for (std::size_t end = path.find('/');; end = path.find('/', end + 1)) {
        const auto [scope, id] = placeOf(editor.document.graph(), std::string_view(path).substr(0, end));
        if (scope == editor.canvas.scope) return id;
        if (end == std::string::npos) break;
    }
    return {};
}

void selectHit(Editor& editor, const std::string& path, bool besides) {
    if (path.empty()) return;
    const std::string id = inScope(editor, path);
    if (id.empty()) return reveal(editor, path.substr(0, path.find('/')));
    const NodeBox* box = editor.boxes ? editor.boxes->find(id) : nullptr;
    if (!box) return;  // removed since
    if (!besides) editor.canvas.selection.clear();
    editor.canvas.selection.insert(id);
    editor.canvas.active = id;
    CanvasView& view = editor.canvas.view;
    if (!view.seen().contains(box->area.centre())) view.middle = box->area.centre();
}

/// As near as the ball about these points is seen.
void frameBox(Viewport& viewport, const Box& box, const Placement& placement) {
    glm::dvec3 lo(INFINITY), hi(-INFINITY);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner = placement.of(
            {i & 1 ? box.hi[0] : box.lo[0], i & 2 ? box.hi[1] : box.lo[1], i & 4 ? box.hi[2] : box.lo[2]});
        lo = glm::min(lo, corner), hi = glm::max(hi, corner);
    }
    const glm::dvec3 middle = 0.5 * (lo + hi);
    viewport.takeCamera();
    frame(viewport.orbit, {middle.x, middle.y, middle.z}, std::max(0.5 * glm::distance(lo, hi), 1e-3),
          double(viewport.aspect()));
}

}  // namespace

void frameSolid(Editor& editor) {
    Viewport& viewport = editor.viewport;
    const std::string& node = editor.canvas.active;
    const auto way = editor.canvas.scope.empty() && !node.empty()
                         ? wayToShown(*editor.graph, "", node, viewport.pinned)
                         : std::nullopt;
    if (!way || way->empty()) return frameBox(viewport, viewport.shown.region, {});
    const std::size_t picture = viewport.split.hand;
    viewport.aside.ask(
        [graph = editor.graph, node, way = *way, seconds = viewport.seconds, picture]() -> Aside::Answer {
            return [box = solidOf(*graph, node, seconds), placement = placementAlong(*graph, "", way),
                    picture](Editor& to) {
                const Borrowed borrowed(to.viewport, picture);
                if (box)
                    frameBox(to.viewport, *box, placement);
                else
                    frameBox(to.viewport, to.viewport.shown.region, {});
            };
        });
}

Seen seenNow(const Editor& editor, std::shared_ptr<const Graph> graph) {
    const Viewport& viewport = editor.viewport;
    return {.graph = graph ? std::move(graph) : editor.graph,
            .revision = editor.document.revision(),
            .pinned = viewport.pinned,
            .seconds = viewport.seconds,
            .region = viewport.shown.region,
            .camera = viewport.shown.seen,
            .aspect = double(viewport.aspect()),
            .particles = viewport.shown.particles};
}

glm::dvec2 inPicture(const Viewport& viewport, ImVec2 pixel) {
    const ImVec2 middle = viewport.place.centre();
    return {double((pixel.x - middle.x) / (0.5f * viewport.place.width())),
            double((middle.y - pixel.y) / (0.5f * viewport.place.height()))};
}

void pickUnderMouse(Editor& editor, bool besides) {
    Viewport& viewport = editor.viewport;
    viewport.gizmo.part.clear();
    const glm::dvec2 at = inPicture(viewport, ImGui::GetIO().MousePos);
    const double x = at.x, y = at.y;
    Seen seen = seenNow(editor);
    viewport.aside.ask([&picker = viewport.picker, seen = std::move(seen), x, y, besides]() -> Aside::Answer {
        return [path = picker.pick(seen, x, y), besides](Editor& to) { selectHit(to, path, besides); };
    });
}

}  // namespace fw::editor
