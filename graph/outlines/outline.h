// A closed outline in the plane as a distance that costs about as much whatever its number of arcs.
//
// The distance is to the nearest arc (arc.h), negative where a ray to the outside crosses an odd number of
// them. A grid of square cells has, for each cell, the arcs that can be the nearest somewhere in it, those
// that meet the cell first: an arc farther from a square's centre than the nearest one and the square's
// diagonal never is, nor one that some end of another is closer than all over the square. The first grid is a
// rectangle about the outline; each further one of kOutlineLevels is a square twice as wide as the one
// before, of fewer cells. Beyond the last, a list of its outermost cells is used, the one in the same
// direction; the distance then is at most 1e-7 times itself too great.
//
// Each cell knows at one place of its own, as far from its arcs as a few tries find one, whether that is
// inside. From there a path goes along y and then along x to the place asked for; it stays in the cell, so
// only the arcs that meet the cell can cross it, each of a leg's once, for they are plain. An arc's side of
// the path's corner is one number that both legs use, so that rounding never counts a crossing on both or on
// neither.
//
// The double functions here are the reference of shaders/lib/outline.glsl, which reads the same words.
//
// Lifetime: outlines are shared and never change; an Ir keeps those that its operations sample.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/interval.h"
#include "graph/base/result.h"
#include "graph/outlines/arc.h"

namespace fw {

inline constexpr int kMaxCorners = 10'000;
inline constexpr std::size_t kMostArcs = 0x7FFF;
inline constexpr int kOutlineLevels = 12;

struct OutlineSample {
    double value, dx, dy;
};

using OutlineTexel = std::array<uint32_t, 4>;

struct Outline {
    /// `arcs`: plain ones, at least one, at most kMostArcs; finite. `isInside` tells the sides of places that
    /// lie on none of them; without it arcs that a ray crosses are counted.
    explicit Outline(std::vector<Arc> arcs, const std::function<bool(glm::dvec2)>& isInside = {});

    std::vector<Arc> arcs;
    bool straight;  ///< all of them
    /// What the device reads, floats as their bits. First the cells of all levels, rows of the lowest y
    /// first: where the cell's list begins; its length, and in the upper half how many of it meet the cell,
    /// and in the highest bit whether the cell's place is inside; the place. Then the lists: both ends of an
    /// arc, and, unless all are straight, its normal at the first end, its bend and 0.
    std::vector<OutlineTexel> texels;
    std::vector<uint32_t> lists;  ///< the numbers of the arcs of those texels that are lists
    glm::dvec2 lo, hi;            ///< of the arcs, metres
    glm::dvec2 centre;            ///< of all levels, metres
    glm::dvec2 half;              ///< of the first level: half its width and height
    int cells, rows, farCells;    ///< along x and y of the first level, and along a side of each other
    double least;                 ///< no value is less
    uint64_t hash;                ///< of the arcs
    std::string file = {};        ///< absolute path; empty if it was not read from one
    double scale = 1;             ///< of a drawing: how long its unit is by its file, metres
    std::vector<std::string> remarks = {};  ///< of a drawing: what was left away, a sentence each
};
using OutlinePtr = std::shared_ptr<const Outline>;

/// The outline that `make` makes, null if there is nothing to see; one with this key that is in use, or was
/// made lately, is not made again.
Result<OutlinePtr> keptOutline(const std::string& key, const std::function<Result<OutlinePtr>()>& make);

/// A key of words and numbers, to the last bit of each.
std::string outlineKey(std::initializer_list<std::string_view> words, std::span<const double> numbers);

/// The closed polygon through `corners`, x and y of each in turn, at least one, at most kMaxCorners; finite.
OutlinePtr outlineThrough(std::span<const double> corners);

OutlineSample sampleOutline(const Outline& outline, double x, double y);
/// Contains every value with x and y in the intervals.
Interval sampleOutline(const Outline& outline, Interval x, Interval y);
/// A Lipschitz constant of the distance over the rectangle: 1, or infinity where it leaves the cells.
double lipschitzConstant(const Outline& outline, Interval x, Interval y);

}  // namespace fw
