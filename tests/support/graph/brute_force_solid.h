// BruteForceSolid: what sampling on a uniform grid tells about a solid f < 0.
//
// This is an oracle for everything that the program claims about solids. It only evaluates the field at
// points and looks at the sign of the values, except where a comment says otherwise. A value that is not a
// number counts as outside. Lengths are in the document's unit.
//
// All error bounds assume that solid and empty parts are wider than a cell. Thinner parts can be missed as a
// whole. No function can detect that, so choose the grid by the solid.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "graph/base/box.h"
#include "tests/support/graph/reference_field.h"

namespace fw::test {

/// Cubic cells that fill a box. The field is sampled at their centres.
struct SampleGrid {
    Point corner{};              ///< the lowest corner of the first cell
    double step = 0.0;           ///< the side of a cell
    std::array<int, 3> cells{};  ///< along x, y and z

    std::size_t size() const { return std::size_t(cells[0]) * std::size_t(cells[1]) * std::size_t(cells[2]); }
    /// Consecutive along z, then along y.
    std::size_t index(const std::array<int, 3>& cell) const {
        return (std::size_t(cell[0]) * std::size_t(cells[1]) + std::size_t(cell[1])) * std::size_t(cells[2]) +
               std::size_t(cell[2]);
    }
    std::array<int, 3> cell(std::size_t index) const;
    bool contains(const std::array<int, 3>& cell) const;
    Point centre(const std::array<int, 3>& cell) const;
    Point centre(std::size_t index) const { return centre(cell(index)); }
    Box box() const;
};

/// The grid of `cells` cells along the longest side of `box`. It contains the box, and has the same centre.
SampleGrid gridOver(const Box& box, int cells);

/// A connected part of the inside samples.
struct BruteForceBody {
    std::size_t samples = 0;
    Box centres;  ///< around the centres of its cells
};

/// Two neighbouring cells of which exactly one is inside.
struct SignChange {
    std::size_t inside = 0, outside = 0;  ///< indices of the cells
};

struct BruteForceSolid {
    SampleGrid grid;
    std::vector<uint8_t> inside;  ///< by cell: whether its centre is inside
    std::size_t insideSamples = 0;

    /// Connected through the faces of cells (6 neighbours), largest first. Bodies that touch through less
    /// than a cell are several, and bodies that are less than a cell apart are one.
    std::vector<BruteForceBody> bodies;
    /// The number of bodies if edges and corners of cells connect too (26 neighbours).
    std::size_t bodiesByCorners = 0;
    /// Whether both ways of counting agree, so that the number of bodies does not depend on the connectivity.
    bool isBodyCountCertain() const { return bodies.size() == bodiesByCorners; }

    /// Around all inside points that were found; empty without any. Each side is touched by an inside
    /// point, so the box never exceeds the true bounds by more than rounding. It falls short of them by less
    /// than `boundsError`.
    std::optional<Box> bounds;
    double boundsError = 0.0;  ///< a cell's diagonal

    double volume = 0.0;
    /// Three standard deviations of the sampling error, from 0 up.
    double volumeError = 0.0;

    /// Whether a cell at the border of the grid is inside. The solid can then continue outside of the grid.
    bool touchesGrid = false;

    std::vector<SignChange> signChanges;
};

/// Samples the field at the centres of all cells. Cells near the surface, those with a cell of the other sign
/// among their 26 neighbours, are sampled again at a random point of each octant: these samples give the
/// volume, and also extend the bounds. Evaluations: about one for each cell and eight for each cell near the
/// surface.
BruteForceSolid sampleByBruteForce(const PointField& field, const SampleGrid& grid, uint32_t seed = 1);

/// The surface point nearest to another point.
struct NearestSurface {
    double distance = 0.0;  ///< infinite if the solid has no sign changes
    Point at{};             ///< on the surface, but for `rounding`
    /// The true distance is at most `distance` + `rounding`, and at least `distance` - `error`. The first
    /// holds whatever the solid is: there is a sign change.
    double rounding = 0.0, error = 0.0;
};

/// Searches the sign changes of the grid, refines those that could be nearest by bisection, and then looks
/// for nearer ones by sampling directions around the best. It also goes down the slope, which it finds by
/// finite differences, for the length of the value. So it finds the nearest point of a true distance even if
/// the grid misses that part of the solid.
NearestSurface nearestSurface(const PointField& field, const BruteForceSolid& solid, const Point& point,
                              uint32_t seed = 1);

}  // namespace fw::test
