// What a mesh is measured against: the field that it was made of, and points of the surface itself.
//
// From the mesh to the surface, a point is led along the field's gradient by Newton's steps until it stands
// on the surface; how far it went bounds its distance from above. From the surface to the mesh, points are
// found without regard to the mesh: straight lines along the axes, a jittered grid of them across the region,
// are halved until interval arithmetic rules each piece out or a sign change is bracketed and closed in on.
// So parts that the mesh has missed count too, down to the pieces' least length. Where intervals say nothing,
// as of a fine noise, the rest of a line is sampled at that length instead. Lines along
// one axis cross a surface as often as it is seen from there, so a point of normal n stands for 1 / (|nx| +
// |ny| + |nz|) of the area that lines along all three find it for.
#pragma once

#include "graph/compile/compile.h"
#include "runtime/measure/mesh_report.h"

namespace fw {

/// How many points a field is asked for: all, where something relies on them; or, of a field that takes long,
/// as many as some seconds allow, down to some hundred.
enum class Points { all, affordable };

/// The measures of the program's field, on the CPU in double. The faces of `region`, where a solid that
/// leaves it was closed, count as surface for points of the mesh. Refers to `program`.
MeasureOptions measureOf(const Program& program, const Box& region, Points points = Points::all);

/// Points of the surface f = 0 within the region: some `lines` lines are looked along. The same input gives
/// the same points.
std::vector<SurfacePoint> surfacePoints(const Program& program, const Box& region, int lines,
                                        Points points = Points::all);

}  // namespace fw
