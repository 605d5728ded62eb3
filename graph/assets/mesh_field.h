// Triangle meshes as fields: distances to a mesh, measured on a grid.
//
// Theory. The talk ("Advanced Procedural Rendering in DirectX 11", mesh to signed distance field) rasterises
// triangles into the slices of a grid that they can affect, keeps the nearest one at each sample with its
// sign, and fills the rest by fast sweeping. Here too, in three steps. First the *band*, samples within kBand
// cells of the surface: each triangle is measured against those around it. Then inside or outside, for the
// band alone. Then *sweeps* from slice to slice, forwards and backwards, each axis in turn: a sample tries
// the points that are nearest to the nine samples before it. The talk adds a step to the distance of the
// sample before in a row, which is far from Euclidean; handing on points along rows is still off by five
// cells for a ball of 128, since a point gets nowhere along a diagonal. A sample that nothing has reached
// takes the sign along, for between neighbours outside of the band there is no surface.
//
// The sign is that of the nearest feature's normal where the mesh is closed and oriented. That fails where
// its parts overlap, which shows: then neighbours have unlike signs though neither is as near to the surface
// as it should be. There, and where the mesh is open, has edges of more than two faces or faces that cannot
// agree, the generalized winding number decides (triangle_tree.h): a sample is inside where it exceeds one
// half. Triangles with the inside, or the outside, on both sides then bound nothing, and holes are closed
// where the winding number is one half, by *membrane* points.
//
// Everything is in the grid's units: a cell is 1, the first sample at the origin.
//
// The steps on the host are here: the reference, and what serves where there is no device. The device's are
// runtime/bake/mesh_field_baker.h.
#pragma once

#include <functional>
#include <memory>

#include "graph/assets/solid_mesh.h"
#include "graph/assets/triangle_tree.h"
#include "graph/assets/volume.h"

namespace fw {

/// How the inside of a mesh is found.
enum class MeshInside : unsigned char {
    automatic,  ///< by normals, else by the winding number, as above
    winding,    ///< by the winding number
    none,       ///< nothing is inside: the distance to the triangles, for sheets that an offset makes thick
};
inline constexpr const char* kMeshInsideNames[] = {"automatic", "winding", "none"};

struct MeshFieldRecipe {
    TriangleMeshPtr mesh;
    int resolution = 64;  ///< samples along the grid's longest side
    double margin = 0.0;  ///< metres of grid around the mesh, beyond the two cells that there are anyway
    MeshInside inside = MeshInside::automatic;
    /// Equal for equal fields.
    uint64_t key() const;
};
inline constexpr int kLeastFieldResolution = 8, kDraftFieldResolution = 32, kMostFieldResolution = 512;

/// Makes a recipe's volume, with its mesh and notes. Errors, with a message only: the mesh has no extent, or
/// encloses nothing.
using MeshFieldBaker = std::function<Result<FieldVolumePtr>(const MeshFieldRecipe&)>;

/// By what was made before and is held somewhere, else by `baker`. Stand-ins are not remembered.
Result<FieldVolumePtr> meshField(const MeshFieldRecipe& recipe, const MeshFieldBaker& baker);

/// On the host: in a mesh whose normals decide, every distance is exact.
Result<FieldVolumePtr> bakeOnHost(const MeshFieldRecipe& recipe);

/// "the mesh 'duck.glb'", as messages have it.
std::string meshName(const TriangleMesh& mesh);

/// A stand-in of few samples: the mesh's box. For whoever wants a program but not its field.
Result<FieldVolumePtr> boxInPlace(const MeshFieldRecipe& recipe);
/// A stand-in at a low resolution, made on the host.
Result<FieldVolumePtr> draftInPlace(const MeshFieldRecipe& recipe);

// ---- The steps

inline constexpr float kBand = 2.0f;  ///< cells from the surface

/// A recipe's mesh in its grid.
struct MeshInGrid {
    VolumeGrid grid;
    SolidMesh solid;        ///< positions in cells
    bool byNormals = true;  ///< whether normals decide
};

/// Of each sample, as far as it is known: the nearest point of the surface, the triangle that it is on, or
/// near for a membrane, and the distance, negative inside; kUnreached where nothing is known.
struct NearestPoints {
    std::vector<float> distance;
    std::vector<glm::vec3> point;
    std::vector<uint32_t> triangle;
};
inline constexpr float kUnreached = 1e30f;
/// A sample on a face is taken for one so many cells away from it, so that its gradient is known. On an edge,
/// or a corner, there is none.
inline constexpr float kLeastDistance = 1e-4f;

Result<MeshInGrid> meshInGrid(const MeshFieldRecipe& recipe);

/// Hands nearest points on through the grid, along each axis both ways.
void sweep(const VolumeGrid& grid, NearestPoints& nearest);
/// The direction in which the distance grows at a sample, whose nearest point is known, within so many cells
/// of the surface to be relied on: of length 1, or less where that is not one direction.
glm::vec3 awayFromSurface(const VolumeGrid& grid, const NearestPoints& nearest, const glm::ivec3& at,
                          float band = kBand);

/// Finds the inside by the winding number. Of the band, whose triangles and distances are given, only samples
/// at the solid's surface are left, with their points; those at membranes are added. False if nothing is
/// inside.
bool signByWinding(const MeshInGrid& mesh, NearestPoints& nearest);

/// The volume of a recipe whose samples are all known, with its notes.
FieldVolumePtr volumeOf(const MeshFieldRecipe& recipe, const MeshInGrid& mesh, std::vector<uint32_t> words);

/// "the mesh 'a.obj' encloses nothing …".
Error nothingInside(const MeshFieldRecipe& recipe);

}  // namespace fw
