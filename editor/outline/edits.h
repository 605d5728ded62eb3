// What a hand does to a flat outline: functions from points to points.
//
// The points are those of an input of type points, x and y one after the other, drawn in order and closed.
// Which are selected is told by their numbers; what an edit makes comes with the selection that goes on.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "editor/document/edits.h"

namespace fw::editor::outline {

inline constexpr std::size_t kLeastPoints = 3;

using Selection = std::set<std::size_t>;

struct Points {
    std::vector<double> numbers = {};  ///< x, y pairs
    Selection selected = {};
    std::size_t count() const { return numbers.size() / 2; }
    Position at(std::size_t point) const { return {numbers[2 * point], numbers[2 * point + 1]}; }
    bool operator==(const Points&) const = default;
};

/// The point nearest to this place, within `reach`.
std::optional<std::size_t> pointAt(const Points& points, Position place, double reach);

struct Spot {
    std::size_t after;  ///< the side begins at this point
    Position place;     ///< on the side
};
/// The spot of the outline nearest to this place, within `reach`.
std::optional<Spot> sideAt(const Points& points, Position place, double reach);

/// The selected points, moved; each to a multiple of `step` if that is above 0.
Points moved(Points points, Position by, double step);
/// With a point behind this one, selected alone.
Points inserted(Points points, std::size_t after, Position place);
/// With a point in the middle of each side both of whose ends are selected; they are selected too.
Points divided(Points points);
/// Without the selected points; as it was if fewer than kLeastPoints would be left.
Points removed(const Points& points);
/// The outline seen in a mirror across the y axis (`axis` 0: x changes its sign) or the x axis, in the same
/// sense of rotation.
Points flipped(const Points& points, int axis);
/// The part with the coordinate of this axis at least 0, and its mirror image: so it is alike on both sides.
/// As it was if there is no such part.
Points mirrored(const Points& points, int axis);
/// Those in the rectangle.
Selection within(const Points& points, Position lo, Position hi);

/// Twice the area: positive where the points go around counter-clockwise.
double twiceArea(const Points& points);
/// Whether two sides that are no neighbours cross or touch.
bool crossesItself(const Points& points);

}  // namespace fw::editor::outline
