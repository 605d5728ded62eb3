// Questions about the solid of a field that exactness rules ask: where it lies, and whether it is symmetric.
//
// The answers are proofs: "yes" holds for every point of space within kFarthest (bounds/region.h), "no"
// means only that no proof was found. A field with live parameters or particles has no proof, for its solid
// moves.
//
// All searches in space go through one function, searchSolid() in solid_query.cpp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "graph/base/box.h"
#include "graph/ir/ir.h"

namespace fw {

/// Whether {distance < kHair} is inside the half-space dot(normal, p) <= offset, up to 2 kHair. The hair
/// keeps solids without volume (a ball of radius 0) from passing for nothing. `normal` has unit length.
bool isWithin(const Ir& ir, IrId distance, const Point& normal, double offset);
inline constexpr double kHair = 1e-9;  ///< metres

/// A box around {distance < level}; an inverted one (lo > hi) if that is empty, nullopt if no box is found.
std::optional<Box> levelBounds(const Ir& ir, IrId distance, double level);

/// Whether the value of `root` is the same at p and at p with the sign of this coordinate changed.
bool isMirrored(const Ir& ir, IrId root, int axis);

/// Points of the solid (distance < -kHair), with the live parameters at these values. Found by sampling the
/// solid's bounds, clipped to `within`: few or none may be found where there are some.
std::vector<Point> pointsOfSolid(const Ir& ir, IrId distance, std::span<const double> parameters,
                                 const Box& within);
/// The bounds of the solid; of one without any a cube around the origin.
Box solidBounds(const Ir& ir, IrId distance, std::span<const double> parameters);

}  // namespace fw
