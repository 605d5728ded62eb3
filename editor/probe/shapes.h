// What clicks on a solid measure beside lengths: angles, circles, and how the surface bends.
//
// The curvature is the field's own: of the gradient's direction n, how it turns along the surface. With H the
// field's second derivatives, from differences of its gradient, and P = 1 - n nᵀ, the eigenvalues of
// P H P / |gradient| across n are the principal curvatures of the level set (Goldman, Curvature formulas for
// implicit curves and surfaces, 2005), whether the field is a distance or not.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "graph/evaluate/evaluate.h"
#include "graph/library/units.h"

namespace fw::editor {

/// At the second point, from the first to the third; degrees. None if it is at one of them.
std::optional<double> angleOf(const std::array<Point, 3>& points);

struct Circle {
    Point centre{};
    double radius = 0.0;
    Point across{}, along{};  ///< of unit length, in its plane
};
/// Through the points; none if they lie on a line.
std::optional<Circle> circleThrough(const std::array<Point, 3>& points);

/// Principal curvatures, one over a length: positive where the solid bulges, the greater first by amount.
struct Bend {
    double most = 0.0, least = 0.0;
};
/// At a point of the surface of a solid of about this size; none where the field has no gradient.
std::optional<Bend> bendAt(const Tape& tape, const Point& surface, double size);
/// "Radius 5 mm", "Radii 5 mm and 8 mm", "Radius 5 mm, hollow", "Flat" of a solid of that size.
std::string bendWords(const Bend& bend, double size, const LengthUnit& lengths);

}  // namespace fw::editor
