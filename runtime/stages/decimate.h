// Fewer triangles for the same surface: edges collapse where their quadric error (Garland and Heckbert 1997)
// is least, by meshoptimizer, as long as the measured distance from the field stays within a bound.
//
// The collapse bounds only its own estimate, so the bound that it is given is searched for: from that wished
// for up by doubling or down by halving, then between the last that held and the first that did not. What
// holds is measured as `fieldwright export --report` measures it, from the mesh to the field and from the
// field to the mesh, and counts only if the result is closed and manifold where the mesh was. Each try begins
// with the whole mesh. The same input gives the same bytes.
#pragma once

#include "runtime/measure/mesh_report.h"
#include "runtime/mesh/mesh.h"

namespace fw {

/// Leaves out what can be, and the vertices that are then not used; those that stay keep their place, normal
/// and colour. False if nothing could go, `error` metres being less than the mesh's own distance for one.
bool decimate(Mesh& mesh, double error, const MeasureOptions& measure);

/// The largest of a report's distances from the field, metres.
double farthest(const Report& report);

}  // namespace fw
