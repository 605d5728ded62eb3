// Small meshes with known topology, volume and area.
#pragma once

#include <glm/vec3.hpp>

#include "runtime/mesh/mesh.h"

namespace fw::test {

/// Corners (0,0,0), (1,0,0), (0,1,0), (0,0,1): volume 1/6.
Mesh tetrahedron();
/// [-1,1]^3 with shared corners, two triangles a side: 8 vertices, volume 8, area 24.
Mesh cube();
/// Around the y axis, `around` by `across` quads cut in two; with unit normals.
Mesh torus(int around, int across, double majorRadius = 1.0, double minorRadius = 0.25);
/// Vertex colours that vary over the mesh, from its positions.
void paint(Mesh& mesh);
/// Both, unconnected.
Mesh join(const Mesh& a, const Mesh& b);
Mesh moved(Mesh mesh, glm::vec3 offset);
/// Every triangle with three vertices of its own, as in an STL.
Mesh unshared(const Mesh& mesh);
/// Swaps two corners of one triangle.
void flip(Mesh& mesh, std::size_t triangle);

}  // namespace fw::test
