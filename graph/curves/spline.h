// Curves in space, with a radius and a twist along them: splines.
//
// Whatever a spline is drawn by, it becomes arcs (space_arc.h): a curve is halved until the two arcs that
// share its ends and the directions there (a biarc; Bolton 1975, in space as Sharrock 1987) are as close to
// it as kSplineTolerance; the error of a half is about an eighth. Arcs meet without a corner where the curve
// has none, so tubes are as smooth as curves are, and their distances need no search along the curve.
//
// A frame is carried along that turns as little as it can (Bishop 1975; Wang et al. 2008): along an arc it
// keeps still in the arc's own directions, and where two meet at a corner it is turned with the direction. A
// closed spline's frame comes back turned by some angle, which is spread evenly along it. Twist is added.
//
// Lifetime: splines are shared and never change.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/result.h"
#include "graph/curves/space_arc.h"
#include "graph/outlines/path.h"

namespace fw {

inline constexpr double kSplineTolerance = 4e-6;  ///< of its size
inline constexpr std::size_t kMostSpaceArcs = 20'000;
inline constexpr std::size_t kMostKnots = 4096;

struct Spline {
    std::vector<SpaceArc> arcs;  ///< in order; the balls' radii are shares of the one that a tube is given
    bool closed = false;
    double length = 0;  ///< metres
    /// Of one through knots: how far along each is that it goes through, metres; of a closed one the first
    /// once more. Those that are upon the one before are left away.
    std::vector<double> knots = {};
    uint64_t hash = 0;      ///< of the arcs
    std::string file = {};  ///< absolute path; empty if it was not read from one
};
using SplinePtr = std::shared_ptr<const Spline>;

/// A place that a spline is drawn by.
struct Knot {
    glm::dvec3 place{0};  ///< metres
    double radius = 1;    ///< share of a tube's radius, and of the size of what is swept, at least 0
    double twist = 0;     ///< radians, of what is swept about the direction of the spline
};

enum class SplineKind : unsigned char {
    smooth,    ///< a curve through all (centripetal Catmull-Rom: Yuksel et al. 2011)
    straight,  ///< lines from one to the next
    bezier     ///< cubic Bézier curves: a place, two handles, a place, two handles, …
};

/// Those of a list of numbers, five each: x, y, z, radius and twist, which are degrees there.
std::vector<Knot> knotsFrom(std::span<const double> numbers);
/// "straight" and "bezier"; smooth for any other word.
SplineKind splineKindNamed(std::string_view word);

/// The spline through knots; null if there are fewer than two places. Radii and twists change smoothly from
/// knot to knot, never beyond what they are there. `bend`: of straight ones, the radius of the arcs that
/// round the corners off, less where the lines are too short. Errors, with a message only: too many knots or
/// arcs; a number of handles that does not fit.
Result<SplinePtr> splineThrough(std::span<const Knot> knots, SplineKind kind, bool closed, double bend = 0);

/// Around the y axis, from y = 0 upwards; it begins on the x axis, towards -z if `right` (as a common screw
/// does), else towards +z.
struct Helix {
    double radius = 0.5, topRadius = 0.5;  ///< where it begins and ends, metres
    double height = 1;                     ///< metres, any sign
    double turns = 3;                      ///< above 0
    bool right = true;
};
Result<SplinePtr> splineOfHelix(const Helix& helix);

/// A flat path as a spline in the plane z = 0; null if it has no length.
Result<SplinePtr> splineAlong(const Contour& contour);

}  // namespace fw
