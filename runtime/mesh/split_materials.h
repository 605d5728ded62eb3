// A mesh cut along the borders of its materials, so that every triangle is of one of them.
//
// A vertex has the material of the node that gave it there: its painter. On an edge whose ends differ a place
// is found where the painter changes, by halving, and becomes a vertex; triangles are cut from such place to
// such place, one with three painters also from its middle. An edge is cut once for both of its triangles, so
// a closed mesh stays closed, a manifold one manifold, and its shape is the same. Where the border runs
// through a vertex, as along a crease that has one, that vertex goes with either side and no sliver is cut
// off. A vertex on a border is doubled, so that each side has the base colour that the field has just beyond.
//
// Borders that enter and leave a triangle by the same edge are not seen. Materials of one node that vary, by
// a ramp or an image, have no border.
#pragma once

#include <vector>

#include "graph/compile/program.h"
#include "runtime/mesh/mesh.h"

namespace fw {

/// Cuts triangles of a mesh without parts whose vertices are shared wherever they meet. Triangles keep their
/// order, those of a cut one stand together. Returns for each a place that has its material.
std::vector<glm::vec3> splitMaterials(Mesh& mesh, const Program& program);

}  // namespace fw
