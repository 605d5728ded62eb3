// Moving about in the viewport: functions on the orbit of runtime/window/viewer.h, without ImGui.
//
// Drags are in heights of the picture, rightwards and upwards; places in it are from -1 to 1, y upwards, and
// `aspect` is its width by its height.
#pragma once

#include <array>

#include "runtime/window/viewer.h"

namespace fw::editor {

using Vector = std::array<double, 3>;

/// The camera's axes, of unit length.
struct Axes {
    Vector right, up, back;
};
Axes axesOf(const Orbit& orbit);

/// Turns about the target: what is in front follows the mouse.
void turn(Orbit& orbit, double dx, double dy);
/// What is at the target's distance stays under the mouse.
void pan(Orbit& orbit, double dx, double dy);
/// Nearer for notches above 0; what is at the target's distance under (x, y) stays there.
void zoom(Orbit& orbit, double notches, double x, double y, double aspect);
/// Turns about the eye, in place of the target.
void look(Orbit& orbit, double dx, double dy);
/// Goes along the camera's axes (W and S, D and A, E and Q: each -1 to 1) for so many seconds; the distance
/// to the target in one second, five times as far if `fast`.
void fly(Orbit& orbit, double forward, double right, double up, double seconds, bool fast);

enum class Side : unsigned char { front, back, right, left, top, bottom };
/// Looks at the target from a side, from the same distance. The front is +z's; seen from the top and from the
/// bottom, -z is up.
void lookFrom(Orbit& orbit, Side side);
/// Looks at a ball from where it fills the picture, along the same direction. `radius` is in metres.
void frame(Orbit& orbit, const Vector& centre, double radius, double aspect);

}  // namespace fw::editor
