// Meshes of several materials, for formats whose triangles have one each.
//
// Such formats know a base colour for each vertex, and all else once for a group of triangles. A triangle has
// the material that the field has at its middle: there a solid of two parts has that of one of them, where
// vertices on the seam may have either's. What differs by less than a 256th is taken for one; of materials
// that vary from place to place so finely that they are too many, what differs by less than twice that, and
// so on. A group has the mean of its triangles' materials: parts that are uniform keep their numbers.
#pragma once

#include <vector>

#include "graph/compile/program.h"
#include "runtime/mesh/mesh.h"

namespace fw {

/// Volume and area of a solid, from its triangles in any order.
struct SolidSize {
    double volume = 0;  ///< m3; above the origin's cone, so only that of a closed surface means something
    double area = 0;    ///< m2

    void add(glm::vec3 a, glm::vec3 b, glm::vec3 c);
    /// The mean length of straight lines within, 4 volume / area (Cauchy; Dirac 1943 for any shape), metres:
    /// of a thin shell about twice its thickness. 0 where the triangles enclose nothing.
    float meanChord() const;
};
SolidSize sizeOf(const Mesh& mesh);

/// Light passes through some triangles.
bool transmits(const Mesh& mesh);

/// Whether something of the program's material, beside its base colour, is not the same everywhere.
bool hasManyMaterials(const Program& program);

inline constexpr std::size_t kMostMaterials = 64;

/// Gives the mesh parts, at most kMostMaterials, in the order in which they first appear; one material alone
/// becomes the mesh's. Triangles of a part keep their order. `ofTriangles` are limited to what they may be,
/// and what is not a number becomes the least of that.
void partByMaterial(Mesh& mesh, std::vector<Material> ofTriangles);
/// The same with those of the program's field.
void partByMaterial(Mesh& mesh, const Program& program);

}  // namespace fw
