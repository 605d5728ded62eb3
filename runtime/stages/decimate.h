// Fewer triangles for the same surface (collapse.h), as long as the measured distance from the field stays
// within a bound, or down to a number of them.
//
// The bound is kept twice. While vertices go, points of the mesh and of the field's surface may be no farther
// from the triangles, and points of the triangles no farther from the field. What is left is then measured as
// `fieldwright export --report` measures it, from the mesh to the field and from the field to the mesh; if
// some place is beyond the bound after all, it is done again from the start within nine tenths of that. Where
// the mesh was farther away already it gets no farther, and the rest goes on. The same input gives the same
// bytes.
#pragma once

#include "runtime/measure/mesh_report.h"
#include "runtime/mesh/mesh.h"

namespace fw {

struct DecimateWish {
    double error = 0;           ///< metres that mesh and surface may be apart; 0: any
    std::size_t triangles = 0;  ///< at most so many are enough; 0: as few as the error allows
};

/// Leaves out what can be, until one of the wishes is met, and the vertices that are then not used; those
/// that stay keep their place, normal and colour. `measure` is asked if there is an error. `labels` are as
/// CollapseLimits has them. False if nothing could go. Not for a mesh that has parts.
bool decimate(Mesh& mesh, const DecimateWish& wish, const MeasureOptions& measure,
              std::span<const uint32_t> labels = {});

}  // namespace fw
