// A spline as functions of the place that cost about as much whatever its number of arcs: how far it is, and
// where a place is beside it.
//
// A grid of cells has, for each cell, the arcs that can be the nearest somewhere in it: not those that are
// farther than the nearest to its middle by the cell's diagonal, nor those than which some place of the
// spline is closer all over it. Arcs that follow each other, and along all of which the squared distance sags
// (its second derivative, 2 + 2 k n.(c - p), is above 0 for every place of the cell), make a run: in a run
// the nearest arc is found by halves, for at the end of each the spline leads either towards the place or
// away from it. The first grid is a box about the spline; each further one of kSplineLevels is a cube twice
// as wide as the one before. Beyond the last, its outermost cells are used, in the same
// direction.
//
// Beside a spline a place has the coordinates of a frame that is carried along (spline.h): across, up and
// along, those of its nearest place. At a corner across and up are stretched to the distance, so that a shape
// that is swept has a round corner; beyond an open end along goes on.
//
// These coordinates jump where two places of the spline are as near. A cell of one run is *plain*: there they
// are as smooth as the spline, and an interval in it is as tight as their slopes are. Elsewhere all that is
// known of across and up is that the distance is never less.
//
// The double functions here are the reference of shaders/lib/spline.glsl, which reads the same words.
//
// Lifetime: tables are shared and never change; an Ir keeps those that its operations sample.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "graph/base/interval.h"
#include "graph/curves/spline.h"

namespace fw {

inline constexpr int kSplineLevels = 12;
/// How many cells a side of each further level has: most of what is looked at lies in the first two.
inline constexpr int kSplineNearLevels = 2, kSplineNearCells = 20, kSplineFarCells = 10;

/// What is asked of a place.
enum class SplineChannel : unsigned char {
    distance,  ///< to the spline; of a table with a radius, to the ball that runs along it, metres
    across,    ///< along the frame's first direction, metres
    up,        ///< along its second, metres
    along,     ///< metres of the spline up to the nearest place
    share      ///< of the radius, there
};
inline constexpr int kSplineChannels = 5;

struct SplineSample {
    double value;
    glm::dvec3 slope;
};

using SplineTexel = std::array<uint32_t, 4>;
inline constexpr int kArcTexels = 7;

struct SplineTable {
    /// `radius`: of the ball where its share is 1, metres; 0: distances to the spline itself.
    SplineTable(SplinePtr spline, double radius);

    SplinePtr spline;
    double radius;
    /// What the device reads, floats as their bits. First the cells of all levels, x fastest: where the
    /// cell's runs begin; their number, and in the highest bit whether it is plain; the greatest bend and the
    /// greatest slope of the turn of its arcs. Then the runs, four a texel, each its first arc and in the
    /// upper half the number of its arcs. Then the arcs.
    std::vector<SplineTexel> texels;
    struct Run {
        uint32_t first, count;
    };
    std::vector<Run> runs;
    /// Where each arc begins, where it leads there, and the mean of the balls' slopes on both sides.
    struct Joint {
        glm::dvec3 place, leads;
        double shareSlope;
    };
    std::vector<Joint> joints;
    glm::dvec3 centre, half;  ///< of the first level, metres
    glm::ivec3 cells{1};      ///< of the first level
    double least, leastShare, mostShare, shareSlope;
    bool tapered;  ///< the ball changes
    uint64_t hash;
};
using SplineTablePtr = std::shared_ptr<const SplineTable>;

/// The table; one of the same spline and radius that is in use is not made again.
SplineTablePtr splineTable(const SplinePtr& spline, double radius);

SplineSample sampleSpline(const SplineTable& table, SplineChannel channel, const glm::dvec3& p);
/// Contains every value over a box.
Interval sampleSpline(const SplineTable& table, SplineChannel channel, const Interval* p);
/// A Lipschitz constant of the channel over a box; infinity where none is known.
double lipschitzConstant(const SplineTable& table, SplineChannel channel, const Interval* p);

}  // namespace fw
