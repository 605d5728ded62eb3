// Creases of a mesh: vertices on them are doubled, so that each side is shaded by itself.
//
// A mesh with one normal for each vertex shades a box's edge as if it were round. Here the triangles about a
// vertex fall into sides: two that share an edge at the vertex are of one side if they meet at less than the
// crease angle. A vertex with one side keeps its normal, which is the field's; otherwise each side gets a
// vertex of its own at the same place, with the mean of its triangles' normals, weighted by their angles
// there (Thürmer and Wüthrich 1998).
#pragma once

#include "runtime/mesh/mesh.h"

namespace fw {

inline constexpr float kCreaseDegrees = 30.0f;

/// Doubles what lies on creases. Triangles keep their order, vertices their places; copies follow behind.
void splitCreases(Mesh& mesh, float degrees = kCreaseDegrees);

}  // namespace fw
