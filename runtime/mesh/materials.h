// Meshes of several materials, for formats whose triangles have one each.
//
// Such formats know a base colour for each vertex, and all else once for a group of triangles. A triangle has
// the material that the field has at its middle: there a solid of two parts has that of one of them, where
// vertices on the seam may have either's; split_materials.h cuts along the seam first. Each node that gave a
// material has groups of its own, which are called after it. What differs by less than a 256th is taken for
// one; of materials of one node that vary from place to place so finely that they are too many, what differs
// by less than twice that, and so on. A group has the mean of its triangles' materials: parts that are
// uniform keep their numbers.
#pragma once

#include <span>
#include <string>
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

/// Whether something of the program's material, beside its base colour, is not the same everywhere, or not
/// from one node.
bool hasManyMaterials(const Program& program);

inline constexpr std::size_t kMostMaterials = 64;  ///< of one node

/// Whether a mesh has a part for each of its materials: none, of whole triangles, or cut where two meet; or,
/// of one that gets textures, of whole triangles by what those do not say.
enum class MaterialParts { none, whole, cut, besideTextures };

/// A triangle's material, and who gave it: the place of a name.
struct PaintedBy {
    uint32_t painter = 0;
    Material material;
    bool operator==(const PaintedBy&) const = default;
};

/// The middle of each triangle.
std::vector<glm::vec3> middlesOf(const Mesh& mesh);

/// Gives the mesh parts, at most kMostMaterials a painter, in the order in which they first appear; one
/// material alone becomes the mesh's. Triangles of a part keep their order. `triangles` are limited to what
/// they may be, and what is not a number becomes the least of that. Parts have the names of their painters,
/// of which none is in use twice: further ones end in a number.
void partByMaterial(Mesh& mesh, std::vector<PaintedBy> triangles, std::span<const std::string> painters);
/// The same with those of the program's field, of each triangle at a place; `besideTextures`: roughness,
/// metallic and emission are those of no material.
void partByMaterial(Mesh& mesh, const Program& program, std::span<const glm::vec3> places,
                    bool besideTextures = false);

/// Of each vertex which of the program's materials it has: another number for another one. Empty if it has
/// only one, or more than kMostMaterials, which then go over into each other.
std::vector<uint32_t> materialsOfVertices(const Mesh& mesh, const Program& program);

}  // namespace fw
