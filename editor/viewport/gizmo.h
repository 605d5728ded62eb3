// Values of a node that can be dragged in the picture: places by arrows, angles by rings, factors and extents
// by boxes. What they are is read off the descriptor of the node's inputs; nothing here draws.
//
// A Lens is the picture's camera on the screen. A Handle is an input with its geometry in the picture's
// space; a drag keeps the handle as it was taken, so that what moves under the hand does not change what a
// pixel means.
#pragma once

#include <imgui.h>

#include <glm/vec2.hpp>
#include <limits>
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
    /// `angle` is one number, on an arc; `aim` a direction, held at its tip.
    enum class Kind : unsigned char { move, turn, scale, extent, angle, aim } kind = Kind::move;
    std::string node, input;      ///< no node: it has a meaning of its own, or is of one that is added
    std::vector<double> numbers;  ///< one, two or three
    int count = 3;                ///< of axes that it has: of a length with a grip the one that it lies along
    glm::dvec3 least{-std::numeric_limits<double>::infinity()};  ///< of extents and an angle
    glm::dvec3 most{std::numeric_limits<double>::infinity()};
    bool placing = false;    ///< an extent that says where something is, not how large
    glm::dvec3 origin{0.0};  ///< in the picture
    /// Of a metre along x, y and z of the node's space; of turns the axes, of unit length; of an angle from
    /// its origin to where it is 0 and 90 degrees.
    glm::dmat3 axes{1.0};
    glm::dmat3 bases{0.0};     ///< from the origin to where each axis of an extent begins
    std::string refusal = {};  ///< why it cannot be dragged; empty: it can
    std::string scene = {};    ///< a value of the scene in place of a node's: its path
    int knot = -1;             ///< of a list of knots: the one whose place it is

    /// Where the box of an extent or a factor stands, or the tip of an arrow; `length` in metres.
    glm::dvec3 tip(int axis, double length) const;
    glm::dvec3 base(int axis) const { return origin + bases[axis]; }
};

/// What a drag goes in steps of.
struct Steps {
    Steps(bool on_ = false) : on(on_) {}  // NOLINT: whether there are any says most of it
    bool on;
    double metres = 0.1, degrees = 15.0, factor = 0.1;
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
    std::optional<glm::dvec3> target = {};  ///< in the picture: what is moved goes there instead
};
HandleDrag takeHandle(const Handle& handle, int axis, const Lens& lens, ImVec2 mouse, double scale);
/// The mouse went on to there: the input's numbers now. `fine` counts a tenth.
std::vector<double> dragTo(HandleDrag& drag, const Lens& lens, ImVec2 mouse, bool fine, const Steps& steps);
/// The points of an angle's arc, from where it is 0 to what it is.
std::vector<ImVec2> arcOf(const Handle& handle, const Lens& lens);

}  // namespace fw::editor
