// A closed polygon in the plane as a distance that costs about as much whatever its number of corners.
//
// The distance is to the nearest edge, negative where a ray to the outside crosses an odd number of edges. A
// grid of square cells has, for each cell, the edges that can be the nearest somewhere in it, those that meet
// the cell first: an edge farther from a square's centre than the nearest one and the square's diagonal never
// is, nor one that some corner of the outline is closer than all over the square. The first grid lies about
// the outline; each further one of kOutlineLevels is twice as wide and has fewer cells. Beyond the last, a
// list of its outermost cells is used, the one in the same direction; the distance then is at most 1e-7 times
// itself too great.
//
// Each cell knows at one place of its own, as far from its edges as a few tries find one, whether that is
// inside. From there a path goes along y and then along x to the place asked for; it stays in the cell, so
// only the edges that meet the cell can cross it. An edge's side of the path's corner is one number that both
// legs use, so that rounding never counts a crossing on both or on neither.
//
// The double functions here are the reference of shaders/lib/outline.glsl, which reads the same words.
//
// Lifetime: outlines are shared and never change; an Ir keeps those that its operations sample. One that is
// in use, or was made lately, is not made again.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "graph/base/interval.h"

namespace fw {

inline constexpr int kMaxCorners = 10'000;
inline constexpr int kOutlineLevels = 12;

struct OutlineSample {
    double value, dx, dy;
};

using OutlineTexel = std::array<uint32_t, 4>;

struct Outline {
    /// `corners`: x and y of each in turn, at least one, at most kMaxCorners; finite.
    explicit Outline(std::span<const double> corners);

    std::vector<double> corners;
    /// What the device reads, floats as their bits. First the cells of all levels, rows of the lowest y
    /// first: where the cell's list begins; its length, and in the upper half how many of it meet the cell,
    /// and in the highest bit whether the cell's place is inside; the place. Then the lists: both ends of an
    /// edge.
    std::vector<OutlineTexel> texels;
    std::vector<uint32_t>
        lists;            ///< the edges of those texels that are lists, by number of their first corner
    double centre[2];     ///< of all levels, metres
    double halfWidth;     ///< of the first level
    int cells, farCells;  ///< along a side of the first level, and of each other
    double least;         ///< no value is less
    uint64_t hash;        ///< of the corners
};
using OutlinePtr = std::shared_ptr<const Outline>;

/// The outline through these corners, a new one if it is not known; see Outline.
OutlinePtr outlineThrough(std::span<const double> corners);

OutlineSample sampleOutline(const Outline& outline, double x, double y);
/// Contains every value with x and y in the intervals.
Interval sampleOutline(const Outline& outline, Interval x, Interval y);

}  // namespace fw
