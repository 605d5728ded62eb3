// Values of a node that can be dragged in the picture: places by arrows, angles by rings, factors and extents
// by boxes. What they are is read off the descriptor of the node's inputs; nothing here draws.
//
// A Lens is the picture's camera on the screen. A Handle is an input with its geometry in the picture's
// space; a drag keeps the handle as it was taken, so that what moves under the hand does not change what a
// pixel means.
#pragma once

#include <imgui.h>

#include <glm/vec2.hpp>
#include <optional>

#include "editor/canvas/view.h"
#include "editor/document/document.h"
#include "editor/viewport/placement.h"
#include "graph/document/scene.h"
#include "runtime/render/view.h"

namespace fw::editor {

/// Between the picture's space, metres, and the window's pixels.
struct Lens {
    Lens(const Camera& camera, const Area& place);

    /// None: it lies behind the eye.
    std::optional<ImVec2> project(const glm::dvec3& point) const;
    /// The direction in which a pixel is seen, not of unit length.
    glm::dvec3 ray(ImVec2 pixel) const;
    /// What a pixel is worth across the view at this point.
    double metresPerPixel(const glm::dvec3& point) const;

    Area place;
    glm::dvec3 eye, forward, right, up;  ///< as those of gpu::View
};

struct Handle {
    enum class Kind : unsigned char { move, turn, scale, extent } kind = Kind::move;
    std::string node, input;
    std::vector<double> numbers;  ///< one or three
    int count = 3;                ///< of axes that it has: of a length with a grip the one that it lies along
    double least = 0.0;           ///< of an extent
    glm::dvec3 origin{0.0};       ///< in the picture
    /// Of a metre along x, y and z of the node's space; of turns the axes, of unit length.
    glm::dmat3 axes{1.0};
    std::string refusal = {};  ///< why it cannot be dragged; empty: it can

    /// Where the box of an extent or a factor stands, or the tip of an arrow; `length` in metres.
    glm::dvec3 tip(int axis, double length) const;
};

/// What can be dragged of the node. `animated` are the inputs that the timeline moves, as "node.input".
std::vector<Handle> handlesOf(const Node& node, const Placement& placement,
                              const std::set<std::string>& animated);

inline constexpr int kAcrossView = 3;          ///< in place of an axis: all at once, in the picture's plane
inline constexpr double kHandlePixels = 80.0;  ///< an arrow's length, a ring's radius, times the scale

/// What is under the mouse: a handle's index, and the axis.
struct HandleHit {
    std::size_t handle = 0;
    int axis = 0;
    bool operator==(const HandleHit&) const = default;
};
/// The points of the part of a ring that faces the eye; of all of it if it is seen edge-on.
std::vector<ImVec2> ringOf(const Handle& handle, int axis, const Lens& lens, double scale);
/// Whether an axis is drawn: one that points at the eye cannot be dragged.
bool isSeen(const Handle& handle, int axis, const Lens& lens);
std::optional<HandleHit> handleAt(const std::vector<Handle>& handles, const Lens& lens, ImVec2 mouse,
                                  double scale);

struct HandleDrag {
    Handle handle;
    int axis = 0;
    double scale = 1.0;  ///< of the interface
    Hand hand = Hand::none;
    glm::dvec3 last{0.0};
    glm::dvec3 travelled{0.0};
};
HandleDrag takeHandle(const Handle& handle, int axis, const Lens& lens, ImVec2 mouse, double scale);
/// The mouse went on to there: the input's numbers now. `fine` counts a tenth; `snapped` goes in steps of
/// 0.1 m, 15 degrees, 0.1 times.
std::vector<double> dragTo(HandleDrag& drag, const Lens& lens, ImVec2 mouse, bool fine, bool snapped);

}  // namespace fw::editor
