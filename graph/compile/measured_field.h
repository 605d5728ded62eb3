// Any field as true distances, measured on a grid, both inside and out.
//
// What is bent, blended or scaled unevenly has values that are no distances, so that walls and offsets made
// of them are uneven. Here the distances to the surface where the field is 0 are measured, once: signs by
// intervals and samples; of samples beside the surface the nearest point, from which sweeps hand points on
// through the grid (assets/mesh_field.h), and within some cells of the surface those are bettered. A nearest
// point is found by steps along the gradient onto the surface, which from outside a crease go from one face
// to the other and end on it, and steps along the surface towards the sample; of all places on the surface
// that were come by the nearest counts.
//
// Blocks of the grid have tapes of their own (evaluate/tape.h), and blocks that the surface cannot go through
// are not sampled.
//
// Guarantees: the sign of a sample is that of the field. Distances beside a plane or a crease are exact, to
// what rounds off the field; elsewhere they are too large by parts of a cell at most.
#pragma once

#include <stop_token>

#include "graph/assets/chamfer.h"
#include "graph/assets/volume.h"
#include "graph/base/result.h"
#include "graph/ir/ir.h"

namespace fw {

struct MeasuredField {
    IrId distance = 0;        ///< reads no live parameter, and no particles that are not made
    double lipschitz = 1.0;   ///< of it, infinite where it is not known
    int resolution = 96;      ///< samples along the grid's longest side, at least kLeastFieldResolution
    double margin = 0.0;      ///< metres of grid around the solid, beyond the two cells that there are anyway
    double chamfer = 0.0;     ///< radius by which its edges are cut, metres
    int finest = resolution;  ///< samples at most, where no such field is held in memory: then a stand-in
    std::stop_token stop = {};  ///< ends the search for the solid
};

/// Errors, with a message only: the solid is unbounded or cannot be proven bounded; it would take too much;
/// cancelledError(). Null if there is no solid.
Result<FieldVolumePtr> measuredField(const Ir& ir, const MeasuredField& wish);

}  // namespace fw
