// Tangents of a mesh with texture coordinates, as MikkTSpace has them.
//
// Whoever reads a normal map must use the same tangents as who made it; glTF names those of Mikkelsen's
// "Simulation of Wrinkled Surfaces Revisited" (2008), with v running up. The tangent of a vertex is the mean
// of its triangles' directions in which u grows, each laid into the plane that its normal stands upon and
// weighted by the triangle's angle there, seen along that normal. The bitangent is cross(normal, tangent) *
// w.
//
// Here the triangles about a vertex are one fan and none is turned over (unwrap.h), so that w is 1 and the
// groups of the original are the vertices.
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace fw {

/// One for each vertex, xyz of unit length; of one without a triangle that has an area, any that is
/// perpendicular to its normal. The mesh has normals and uvs.
std::vector<glm::vec4> tangentsOf(const Mesh& mesh);

}  // namespace fw
