// The camera under mouse and keys.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "editor/document/scene_edits.h"
#include "editor/editor.h"
#include "editor/viewport/projection.h"

namespace fw::editor {

namespace {

using Does = CameraDrag::Does;

constexpr float kStill = 3.0f;         // pixels that a click may move
constexpr double kLongestStep = 0.05;  // seconds of flying between two frames

/// 1, 0 or -1 for two keys against each other. Letters are named as shortcuts name them.
double either(char forward, char back) {
    return double(ImGui::IsKeyDown(forward)) - double(ImGui::IsKeyDown(back));
}
bool anyFlyKey() {
    return std::ranges::any_of(std::string_view("WASDQE"), [](char key) { return ImGui::IsKeyDown(key); });
}

constexpr double kHeightsPerNotch = 0.05;  // of the picture, that what scrolls goes for a notch
constexpr double kZoomNotches = 12.0;      // of the wheel, that a drag over the picture's height is worth

/// What a button does when it goes down: ImGui's 0 is the left one, 1 the right one, 2 the middle one.
Does doneBy(Navigation navigation, int button) {
    const ImGuiIO& io = ImGui::GetIO();
    const Does turns = io.KeyShift ? Does::pan : Does::orbit;
    switch (navigation) {
        case Navigation::usual: return button == 0 ? Does::click : button == 1 ? Does::pan : turns;
        case Navigation::blender:
            return button == 0 ? Does::click : button == 1 ? Does::look : io.KeyCtrl ? Does::zoom : turns;
        case Navigation::maya:
            if (!io.KeyAlt) return button == 0 ? Does::click : button == 1 ? Does::look : Does::nothing;
            return button == 0 ? Does::orbit : button == 1 ? Does::zoom : Does::pan;
    }
    return Does::nothing;
}

void begin(Viewport& viewport) {
    for (int button = 0; button < 3; ++button)
        if (ImGui::IsMouseClicked(button)) viewport.drag = {doneBy(viewport.navigation, button), button};
}

/// What the wheel does, or two fingers on a trackpad: parts of notches along both axes.
void scroll(Viewport& viewport) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool zooms = viewport.scrolling == Scrolling::zooms || io.KeyCtrl;
    if (zooms && io.MouseWheel == 0.0f) return;
    viewport.takeCamera();
    if (zooms) {
        const ImVec2 middle = viewport.place.centre();
        return zoom(viewport.orbit, double(io.MouseWheel),
                    double((io.MousePos.x - middle.x) / (0.5f * viewport.place.width())),
                    double((middle.y - io.MousePos.y) / (0.5f * viewport.place.height())),
                    double(viewport.aspect()));
    }
    // What lies under the fingers goes along with them: down for a notch below 0.
    const double dx = kHeightsPerNotch * double(io.MouseWheelH),
                 dy = kHeightsPerNotch * double(io.MouseWheel);
    if ((viewport.scrolling == Scrolling::pans) != io.KeyShift)
        pan(viewport.orbit, dx, dy);
    else
        turn(viewport.orbit, dx, dy);
}

void drag(Viewport& viewport) {
    const ImGuiIO& io = ImGui::GetIO();
    CameraDrag& hand = viewport.drag;
    if (hand.does == Does::click && ImGui::IsMouseDragging(hand.button, kStill))
        hand.does = viewport.navigation != Navigation::usual ? Does::nothing
                    : io.KeyShift                            ? Does::pan
                                                             : Does::orbit;
    if (hand.does == Does::nothing) return;
    if (hand.button == 1 && anyFlyKey()) hand.does = Does::look;
    if (hand.does == Does::click) return;
    const double side = std::max(double(viewport.place.height()), 1.0), dx = double(io.MouseDelta.x) / side,
                 dy = double(-io.MouseDelta.y) / side;
    if (dx == 0.0 && dy == 0.0 && !flies(viewport)) return;
    viewport.takeCamera();
    if (hand.does == Does::orbit) turn(viewport.orbit, dx, dy);
    if (hand.does == Does::pan) pan(viewport.orbit, dx, dy);
    if (hand.does == Does::look) look(viewport.orbit, dx, dy);
    if (hand.does == Does::zoom)
        zoom(viewport.orbit, kZoomNotches * (dx + dy), 0.0, 0.0, double(viewport.aspect()));
    if (flies(viewport))
        fly(viewport.orbit, either('W', 'S'), either('D', 'A'), either('E', 'Q'),
            std::min(double(io.DeltaTime), kLongestStep), io.KeyShift);
}

}  // namespace

int Viewport::width() const {
    return place.width() < 1.0f ? 0 : std::clamp(int(place.width()), kLeastPictureSide, kMostPictureSide);
}
int Viewport::height() const {
    return place.height() < 1.0f ? 0 : std::clamp(int(place.height()), kLeastPictureSide, kMostPictureSide);
}

void Viewport::takeCamera() {
    if (!ownCamera) {
        orbit = Orbit::from(shown.seen);
        orthographic = isParallel(orbit);
        if (orthographic) orbit = throughLensOf(orbit, Camera{}.fov);
    }
    ownCamera = true;
    awaits.reset();
}

Camera Viewport::camera() const { return ownCamera ? own() : shown.seen; }

void Viewport::forget(Shell& shell) {
    takeHand(*this, 0);
    if (texture) shell.forget(std::exchange(texture, nullptr));
    for (Pane& pane : split.panes)
        if (ImTextureID other = std::exchange(pane, {}).texture; other && &pane != &split.panes[0])
            shell.forget(other);
    shown = {};
    pinned.clear();
    resetEyes(*this);
    slice = {};
    leastWidth = 0.0f;
    seconds = 0.0;
    kept = {};
    playing = false;
    drag = {};
    gizmo.hovered.reset(), gizmo.drag.reset();
    gizmo.part.clear();
    aside.forget();
    ++document;
}

bool flies(const Viewport& viewport) {
    return viewport.drag.busy() && viewport.drag.button == 1 && anyFlyKey();
}

bool navigate(Viewport& viewport) {
    const ImGuiIO& io = ImGui::GetIO();
    if (viewport.shown.picture.width == 0) return false;  // there is nothing to start from
    if (viewport.hovered && !viewport.drag.busy()) begin(viewport);
    if (viewport.hovered && (io.MouseWheel != 0.0f || io.MouseWheelH != 0.0f)) scroll(viewport);
    if (!viewport.drag.busy()) return false;
    drag(viewport);
    if (ImGui::IsMouseDown(viewport.drag.button)) return false;
    const bool clicked = viewport.drag.does == Does::click;
    viewport.drag = {};
    return clicked;
}

void changeProjection(Viewport& viewport) {
    viewport.takeCamera();
    viewport.orthographic = !viewport.orthographic;
}

void keepAsSceneCamera(Editor& editor) {
    Viewport& viewport = editor.viewport;
    const Camera camera = viewport.camera();
    Graph next = setSceneCamera(editor.document.graph(), camera);
    if (!readScene(next.scene)) return say(editor, "the scene cannot be read: see the list of problems");
    editor.document.apply("Set Camera", std::move(next));
    viewport.ownCamera = false;
    viewport.shown.seen = camera;  // the next picture's
    viewport.handed = camera, viewport.handedIn = editor.document.revision();
}

void lookFrom(Viewport& viewport, Side side) {
    viewport.takeCamera();
    lookFrom(viewport.orbit, side);
}

}  // namespace fw::editor
