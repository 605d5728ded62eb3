// The viewport: what is shown of the graph, how it is looked at, and what the mouse does in it.
//
//     mouse                          does
//     left or middle drag            orbits; with Shift pans
//     right drag                     pans; with W A S D Q E flies, the mouse turning the head (Shift: faster)
//     wheel                          zooms to the cursor (or, for trackpads, pans or orbits: Scrolling)
//     (as Blender has it, or Maya and Houdini: Navigation)
//     left drag on a handle          moves, turns or scales (Shift: fine, Ctrl: in steps, or not if Snap is
//     on;
//                                    Escape: back)
//     click                          selects the node that made what is hit (Ctrl or Shift: also)
//
// Keys are rows of editor/commands.cpp that count over the picture. Lifetime: one in an Editor.
#pragma once

#include <imgui.h>

#include <string>

#include "editor/canvas/view.h"
#include "editor/preview/preview.h"
#include "editor/shell/shell.h"
#include "editor/viewport/aside.h"
#include "editor/viewport/grips.h"
#include "editor/viewport/kept_views.h"
#include "editor/viewport/orbit.h"
#include "editor/viewport/pick.h"
#include "editor/viewport/snapping.h"
#include "editor/viewport/split.h"
#include "editor/viewport/together.h"

namespace fw::editor {

struct Editor;

/// Whose way of moving the camera by the mouse. Under all of them a click selects and the wheel zooms.
enum class Navigation : unsigned char {
    usual,    ///< the table above
    blender,  ///< the middle button orbits, with Shift pans, with Ctrl zooms; the right one flies
    maya      ///< Alt and the left button orbits, the middle one pans, the right one zooms; Houdini's too
};
/// As preferences have them, in the order of Navigation; and for a person.
inline constexpr const char* kNavigationNames[] = {"usual", "blender", "maya"};
inline constexpr const char* kNavigationWords[] = {"Usual: left orbits, right pans", "As in Blender",
                                                   "As in Maya and Houdini"};

/// What the wheel does over the picture, or two fingers on a trackpad. With Ctrl it always zooms.
enum class Scrolling : unsigned char {
    zooms,   ///< to the cursor
    orbits,  ///< with Shift pans
    pans     ///< with Shift orbits
};
/// As preferences have them, in the order of Scrolling; and for a person.
inline constexpr const char* kScrollingNames[] = {"zooms", "orbits", "pans"};
inline constexpr const char* kScrollingWords[] = {"Zooms, as the wheel of a mouse", "Orbits, for trackpads",
                                                  "Pans, for trackpads"};

/// What the button that went down over the picture does until it goes up.
struct CameraDrag {
    enum class Does : unsigned char { nothing, click, orbit, pan, zoom, look } does = Does::nothing;
    int button = 0;  ///< ImGui's

    bool busy() const { return does != Does::nothing; }
};

/// What goes in steps, or to a place, while the magnet is on.
struct Snap {
    enum class To : unsigned char { grid, surface, points, vertices } to = To::grid;
    bool on = false;
    bool byZoom = false;  ///< the grid's spacing: a power of ten that is some pixels; else `metres`
    double metres = 0.1, degrees = 15.0;
};

struct Gizmo {
    Tool tool = Tool::move;
    Snap snap;
    AxesOf axes = AxesOf::numbers;
    PivotAt pivot = PivotAt::own;
    glm::dvec3 point{0.0};          ///< of PivotAt::point
    bool marks = false;             ///< lamps and the camera are shown, whatever panel is in front
    std::string part;               ///< of the scene that is held: "sun", "camera", "lights.0"; empty: nodes
    std::vector<Placing> placings;  ///< that the one handle moves; empty: each handle moves its own input
    std::optional<Graph> start;     ///< that those are moved in while they are dragged
    std::optional<SnapPlaces> features;         ///< to which a drag may go
    std::shared_ptr<const Graph> surroundings;  ///< what is seen without what is dragged
    ImVec2 askedAt;
    int asked = 0, answered = 0;  ///< questions for the surface under the mouse
    Grips grips;
    std::optional<HandleHit> hovered;
    std::optional<HandleDrag> drag;  ///< with a hand of the document
    std::vector<double> numbers;     ///< that the drag gave last
    int knot = -1;                   ///< of the spline: the one that was taken last, which has arrows
    splines::Knots knots;            ///< in which the drag moves one

    /// What the grips were made for.
    struct Made {
        uint64_t revision = 0;
        std::string scope, node, pinned;
        double seconds = 0.0;
        Tool tool = Tool::move;
        std::set<std::string> selection = {};
        AxesOf axes = AxesOf::numbers;
        PivotAt pivot = PivotAt::own;
        glm::dvec3 point{0.0};
        std::string part = {};
        int knot = -1;
        bool operator==(const Made&) const = default;
    } made;

    /// The input that the hand moves, as heldBy() of numbers.
    std::set<std::string> held(const std::string& scope) const;
};

/// What a document is shown of, and how it is looked at: by the eye of the picture that has the hand, and by
/// those of the others.
struct DocumentLook : Eye {
    Eyes eyes = firstEyes();  ///< but for the one that has the hand
    uint32_t view = RENDER_PICTURE;
    std::string pinned;    ///< the nodes shown, as in pinned.h; empty: the output
    Slice slice;           ///< of the views on a plane
    float leastWidth = 0;  ///< of the views of widths; 0: the usual one
    int resolution = 0;    ///< cells; 0: the graph's
    double seconds = 0.0;  ///< on the timeline
    KeptViews kept;
};

/// What the viewport shows and how: of pictures that it is split in, the one that has the hand.
struct Viewport : DocumentLook {
    Split split;
    bool playing = false;
    uint64_t document = 0;  ///< another number for another document
    ImTextureID texture = nullptr;
    PreviewResult shown = {};  ///< the last result, seen by the camera of this picture

    Navigation navigation = Navigation::usual;  ///< of the preferences
    Scrolling scrolling = Scrolling::zooms;     ///< of the preferences
    bool grid = false;                          ///< ground.h
    Area place;                                 ///< of the picture, pixels of the window
    bool hovered = false;
    CameraDrag drag;
    Gizmo gizmo;
    Picker picker;  ///< the thread's aside
    Aside aside{[] { Shell::wake(); }};

    /// Pixels that the picture should have; 0 before the first frame.
    int width() const;
    int height() const;
    float aspect() const { return place.width() / std::max(place.height(), 1.0f); }
    /// Moves on from what is seen.
    void takeCamera();
    /// That of the own camera; else what was seen last.
    Camera camera() const;
    /// Nothing is seen until there is a picture of another document.
    void forget(Shell& shell);
};

/// The camera follows the mouse, and the keys of flying; whether that was a click.
bool navigate(Viewport& viewport);
/// Whether the camera moves without further input.
bool flies(const Viewport& viewport);

/// Orthographic rather than in perspective, or the other way round.
void changeProjection(Viewport& viewport);
/// What is seen becomes what the scene's camera sees, and is seen through it: one step of undo.
void keepAsSceneCamera(Editor& editor);
/// Looks from a side at what it looks at.
void lookFrom(Viewport& viewport, Side side);
/// Shows the next of the views that the panel lists.
void shadeNext(Viewport& viewport);
/// As near as all of the solid is seen, or what the selected node alone makes.
void frameSolid(Editor& editor);
/// The mouse on the selected node's handles: whether it has one. Before showGizmo(), which draws them.
bool followGizmo(Editor& editor);
void showGizmo(Editor& editor);
/// Looks for the node whose shape is under the mouse, and selects it when it is found: in place of what is
/// selected, or besides.
void pickUnderMouse(Editor& editor, bool besides);
/// What is seen, of another graph than the document's if one is given, for the picker.
Seen seenNow(const Editor& editor, std::shared_ptr<const Graph> graph = {});
/// A pixel of the window as a place in the picture, from -1 to 1, y upwards.
glm::dvec2 inPicture(const Viewport& viewport, ImVec2 pixel);

}  // namespace fw::editor
