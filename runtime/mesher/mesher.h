// From a field to indexed triangles in device memory: marching cubes over sparse bricks.
//
// The pipeline is that of Matt Swoboda's "Advanced Procedural Rendering in DirectX 11" (GDC 2012): compact
// what is active with a histopyramid, make one vertex for each active grid edge, find a triangle's vertices
// through an edge -> vertex lookup, dispatch and draw indirectly, read no count back before the end.
// Deviations:
//  * The grid is sparse. Interval arithmetic over the field drops bricks of 8^3 cells (and, on long grids,
//  first
//    blocks of 64^3), and no sample is stored: only signs are, 9x9 bits a plane of a brick.
//  * Active edges, active cells and even the number of triangles come from bit operations, 32 cells at a
//  time;
//    an edge's vertex is a base and a population count, not an entry of a volume.
//  * A vertex is the root of the field on its edge, found by evaluating it again, with the field's exact
//  gradient for normal.
//  * The table is derived from a rule that makes every surface closed, oriented and manifold
//  (marching_cubes_table.h).
//  * On software devices signs become triangles on the host (connect.h), to the same bytes.
//  * Places come from prefix sums alone, so that the same input gives the same bytes on every run.
//
// A sample is inside if f < 0; zero and NaN are outside. Outside the region everything is: a surface that
// leaves the region is closed on its boundary (`capped`). Vertices keep a distance from grid points (about
// 1e-4 cells), so that no triangle collapses. Sharp edges are bevelled by up to a cell.
//
// Dual contouring shares all of it up to the points on the edges and their normals. A vertex then stands for
// each patch of surface in a cell, where the planes of its edges meet (shaders/mesher/contour.comp), and each
// active edge gives two triangles between the four patches about it: creases and corners are sharp. A patch
// is a polygon of the same table, so this surface is closed, oriented and manifold too, once the rare faces
// have been seen to at which two patches meet twice (pinches.h). Triangles may cut each other where
// the field bends at the scale of a cell.
//
// A region can be meshed in tiles of whole blocks, each by a run of its own. Bricks and samples are numbered
// and placed as in the whole, so that the tiles' triangles are the whole's, to the bit. A tile has vertices
// on all its faces; on its far ones they come from one layer of bricks of the tiles beyond. Nothing is closed
// between tiles. Of dual contouring a tile is a brick larger all round, so that all is there about what is
// its own (quad_tiles.h).
//
// Lifetime: pipelines belong to a structure (a field's text), buffers to a resolution (they grow when a mesh
// needs more and hold the last mesh), the configuration to one run.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "graph/compile/compile.h"
#include "runtime/gpu/commands.h"
#include "runtime/gpu/field_buffers.h"
#include "runtime/mesh/mesh.h"
#include "shaders/shared.h"
// after shared.h
#include "shaders/mesher/mesher.h"

namespace fw {

class MesherHost;

inline constexpr int kMesherBlock = 64, kMesherBrick = 8;  ///< cells along each side

/// Blocks of a region's grid, in which samples are numbered from 0, outside the region, to
/// cells + 2.
struct MesherTile {
    glm::ivec3 begin{0}, end{0};  ///< the end is not of it; 0 where it reaches the grid's end
};

struct MesherConfig {
    glm::vec3 origin{-1.0f};         ///< least corner of the region, metres
    glm::vec3 cellSize{2.0f / 128};  ///< metres along each axis
    glm::ivec3 cells{128};           ///< of the region along each axis, any number from 1 to kMostMesherCells
    FieldBuffers field = {};         ///< but for its lists, which the mesher makes
    const Families* families = nullptr;  ///< of the field, where it has some
    bool sparse = true;    ///< bricks that intervals show to be empty are not sampled; the same mesh, sooner
    bool pruned = true;    ///< a brick evaluates only the members that can matter in it; likewise
    MesherTile tile = {};  ///< of the region, the whole by default
    MeshMethod method = MeshMethod::marchingCubes;
    bool colors = false;  ///< also the base colour at each vertex
    /// Software devices make triangles of signs on the host (connect.h); the same bytes, sooner.
    bool connectOnHost = true;
    MesherHost* host = nullptr;  ///< evaluates the field instead of kernels, which then need not be built
    /// Of the field's code at a point, in additions (effort.h): passes over so much that they would take long
    /// go in parts (commands.h), the host asking for counts in between.
    double weight = 0;
    bool timed = false;  ///< fill MesherResult::stages (see commands.h for what that costs)
};

inline constexpr int kMostMesherCells = 8000;  ///< along one axis: bricks are numbered with ten bits

/// The kernels for one field. Most do not depend on it and are shared between fields; those that only long
/// grids or large meshes need are built at their first use.
struct MesherPipelines {
    std::vector<std::shared_ptr<Pipeline>> all;  ///< in the order of kernels.h; some may be empty
    std::string field;
};

/// Compiles the kernels, with `colors` the one for colours too. `field` is the text that answers #include
/// "field.glsl", empty for the default field. What does not depend on the field is taken from `previous`.
MesherPipelines createMesherPipelines(const Device& device, std::string field, bool colors = false,
                                      const MesherPipelines& previous = {}, CompileTimes* times = nullptr,
                                      Compile when = Compile::now);

/// Translates kernels to SPIR-V and into the cache, for as long as `goOn` says so before each. That needs no
/// device, and the first translation of a process takes some 70 ms more than any later one: worth doing while
/// the device opens.
void prepareMesher(const std::string& field, const std::function<bool()>& goOn);

/// Everything the kernels write. Made empty; runMesher sizes it.
struct MesherBuffers {
    Buffer vertices;   ///< gpu::MeshVertex each
    Buffer colors;     ///< vec3 each, if asked for
    Buffer triangles;  ///< three uint32 indices each
    Buffer counts;     ///< gpu::MesherCounts; `draw` in it are the arguments for vkCmdDrawIndexedIndirect
    Buffer seen;       ///< the same for the host, where that does not see `counts`
    Buffer points;     ///< of dual contouring: gpu::MeshVertex on each active edge
    FieldLists field;  ///< of its families
    Buffer table, patchTable, patchList, uses, corners, pinched, blockList, blockAlive, blockSums, rows,
        brickList, links, planes, sums, edges, vertexList, stripList;
    uint32_t brickCapacity = 0, vertexCapacity = 0, triangleCapacity = 0;
};

struct MesherResult {
    uint32_t vertices = 0, triangles = 0;
    uint32_t quads = 0;    ///< of dual contouring: the first triangles are these, two and two
    uint32_t pinches = 0;  ///< of dual contouring: places where two patches met twice, and were parted
    std::vector<uint32_t> addedTo = {};  ///< of each triangle behind these: the quad that it is a part of
    uint32_t bricks = 0;                 ///< that were sampled
    bool capped = false;                 ///< the surface was closed at the region's boundary
    float rim = 0;                       ///< metres: vertices that close it keep off other sides by so much
    MeshMethod method = MeshMethod::marchingCubes;
    bool colors = false;       ///< there is one at each vertex
    bool creases = false;      ///< vertices on creases are to be doubled (creases.h)
    bool undecimated = false;  ///< a decimation left all triangles, or more than it was to
    int runs = 1;              ///< of the kernels; more than one if buffers had to grow
    std::vector<StageTime> stages;
};

/// Polygonises the field over the region into `buffers`, of which vertices and colours may still be being
/// written when it returns (commands.h: send). Errors: a region without cells or with too many,
/// cells too small for the precision of positions, a surface too large to number
/// (Error::Code::tooMuchSurface: smaller tiles of the region may do). Throws SystemError if
/// memory runs out.
Result<MesherResult> runMesher(const Device& device, MesherPipelines& pipelines, MesherBuffers& buffers,
                               const MesherConfig& config);

/// Copies the last mesh to the host, vertex for vertex.
Mesh downloadMesh(const Device& device, const MesherBuffers& buffers, const MesherResult& result);

}  // namespace fw
