// The copies of which a solid consists (graph/compile/copies.h), as one mesh and the places where it is.
//
// The solid's mesh is cut into what touches nowhere. The map of places is asked over each piece: where it is
// one similarity, the piece belongs to the copy that is there; pieces of one map are one copy. What is copied
// is meshed by itself, in cells that are no larger in any copy than the solid's. Then each copy is checked:
// points of that mesh, carried to the copy, must lie on the solid's surface with the solid's material, and
// points of its pieces on the surface of what is copied; and it must be whole within the region. So copies
// that a border cuts, that run into each other, or that differ in colour are found out, whatever makes them.
// Pieces without a copy stay a mesh.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "graph/compile/copies.h"
#include "runtime/mesh/mesh.h"

namespace fw {

/// A mesh with the field that it was made of.
struct MeshedField {
    Mesh mesh;
    Program program;  ///< for the host
    double cellSize = 0;
};

struct CopiedMesh {
    Mesh mesh;                      ///< of what is copied, in its own space
    std::vector<CopyPlace> places;  ///< of each copy, in the order of the solid's triangles
    Mesh rest;                      ///< what of the solid is in none of them
    std::string why;                ///< there is a rest, as a clause; empty without
};

/// Meshes what is copied, in such cells. Errors are for the user.
using MeshContent = std::function<Result<MeshedField>(double cellSize)>;

/// `region`: that the solid's mesh was cut to, if it was given. Of fewer than two copies, no places and all
/// is rest.
CopiedMesh copiedMesh(const MeshedField& solid, const Program& map, const std::optional<Box>& region,
                      const MeshContent& meshContent);

/// One of the solids of a document.
struct MeshedSolid {
    std::string name;   ///< of its node; empty: as the file
    Mesh mesh;          ///< all of it, but for its copies
    CopiedMesh copied;  ///< without places of what has no copies
};
/// Whether one is in another, by more than `depth` metres: `document` is the union of all. Some points of
/// each, and of each copy, are looked at.
bool reachInto(const std::vector<MeshedSolid>& solids, const Program& document, double depth);

/// From the space of what is copied into the solid's.
glm::dmat4 matrixOf(const CopyPlace& place);

}  // namespace fw
