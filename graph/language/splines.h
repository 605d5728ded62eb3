// Functions of the field language that make splines and look places up beside them.
//
// Argument types are those of the table of built-ins, which lists these.
#pragma once

#include <span>

#include "graph/language/value.h"

namespace fw::language {

/// Of knots, a kind's name, whether it is closed, and the radius of rounded corners.
Result<Value> splineThroughKnots(Lowering& state, std::span<const Value> arguments);
/// Of its radius, that of its top, its height, its turns, and whether it is left-handed.
Result<Value> splineOfHelixAt(Lowering& state, std::span<const Value> arguments);
/// Of a file's path, a part, the path's number from 1, the size of the page (0: by the file), and whether it
/// is reversed.
Result<Value> splineOfDrawing(Lowering& state, std::span<const Value> arguments);

/// From a place, a spline and a radius where the spline's share is 1: how far the place is from the balls.
/// Exact outside where the radius is a known number, or the same all along; else the distance to the spline
/// less the radius at the nearest place.
Result<Value> splineDistance(Lowering& state, std::span<const Value> arguments);
/// Across, up and along (curves/spline_table.h).
Result<Value> splinePlace(Lowering& state, std::span<const Value> arguments);
/// The share of the radius at the nearest place.
Result<Value> splineShare(Lowering& state, std::span<const Value> arguments);
Result<Value> splineLength(Lowering& state, std::span<const Value> arguments);
Result<Value> splineClosed(Lowering& state, std::span<const Value> arguments);

}  // namespace fw::language
