// A triangle mesh made ready to bound a solid: its topology found, its faces turned alike.
//
// Vertices with equal coordinates become one; triangles that have no third corner then, and copies of others,
// go. A *part* is what hangs together by edges of two triangles. The triangles of a part are turned to agree,
// as most of them have it; where every part is closed, each is turned outwards, except the walls of cavities.
//
// Normals are those of Bærentzen and Aanæs ("Signed Distance Computation Using the Angle Weighted
// Pseudonormal", 2005): of faces, of edges the sum of two, of vertices weighted by angle. Whether a point is
// inside then follows from the normal of the feature that is nearest to it, if the mesh is closed and
// oriented.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "graph/assets/triangle_mesh.h"

namespace fw {

/// What a mesh was found to be.
struct MeshFindings {
    std::size_t collapsed = 0;  ///< triangles with two equal corners
    std::size_t copies = 0;     ///< of triangles, with the same corners in the same order
    std::size_t openEdges = 0;  ///< of one triangle
    std::size_t crowded = 0;    ///< triangles' sides at edges of more than two
    std::size_t turned = 0;     ///< triangles that went against their neighbours
    std::size_t oneSided = 0;   ///< parts whose triangles cannot agree
    std::size_t parts = 0;
    bool insideOut = false;  ///< all of it was

    bool closed() const { return openEdges == 0 && crowded == 0; }
    bool oriented() const { return closed() && oneSided == 0; }
    /// "12 open edges, 3 faces that were turned": empty for a closed mesh that was oriented.
    std::string text() const;
};

inline constexpr uint32_t kNoMate = ~0u, kManyMates = ~0u - 1;

struct SolidMesh {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;  ///< three a triangle
    std::vector<uint32_t> source;   ///< of each triangle: the one of the file's mesh that it is
    /// Of each side of a triangle, 3 t + k from corner k to the next: the other triangle's side on the same
    /// edge; kNoMate where there is none, kManyMates where there are more.
    std::vector<uint32_t> mates;
    double volume = 0.0;  ///< of closed meshes, cubic metres
    MeshFindings found;

    std::array<glm::dvec3, 3> corners(std::size_t triangle) const {
        const uint32_t* corner = &indices[3 * triangle];
        return {glm::dvec3(positions[corner[0]]), glm::dvec3(positions[corner[1]]),
                glm::dvec3(positions[corner[2]])};
    }
};

/// Of nearestOnTriangle()'s features: the face, its sides ab, bc, ca, its corners a, b, c. Of length 1, or 0.
using FeatureNormals = std::array<glm::vec3, 7>;

SolidMesh solidMesh(const TriangleMesh& mesh);
/// For each triangle of an oriented mesh.
std::vector<FeatureNormals> featureNormals(const SolidMesh& solid);

}  // namespace fw
