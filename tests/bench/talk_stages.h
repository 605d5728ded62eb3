// The meshing stages of the talk, on its dense grid: what the sparse mesher is compared with on the same
// device.
//
// Matt Swoboda, "Advanced Procedural Rendering in DirectX 11", slides "Geometry Shader Marching Cubes" to
// "Generating Geometry" and "Performance". Three ways, each of which ends in a pass that draws depth alone:
//   everyCell       a point per cell goes through a geometry shader that emits the cell's triangles; every
//   pass again compactedCells  a 3-D histopyramid of active cells is built once; a pass draws a point per
//   active cell,
//                   indirectly, through the same geometry shader
//   indexed         one vertex per active edge, its number kept in a lookup volume, then indices through that
//   lookup;
//                   two histopyramids give the places, dispatches and the indexed draw are indirect
// Deviations: volumes and pyramids lie in storage buffers, since mip chains of 3-D textures cannot be written
// on every device; the histopyramid is walked in the vertex shader in front of the geometry shader (the same
// number of walks); the index pass has an invocation per triangle, not per cell; the case table is this
// project's.
//
// Lifetime: pipelines and buffers live with one TalkStages, for one field, size and device.
#pragma once

#include <string_view>
#include <vector>

#include "runtime/gpu/commands.h"
#include "runtime/mesh/mesh.h"
#include "shaders/bench/talk.h"

namespace fw::bench {

enum class TalkWay { everyCell, compactedCells, indexed };
inline constexpr std::array kTalkWays = {TalkWay::everyCell, TalkWay::compactedCells, TalkWay::indexed};

struct TalkOptions {
    int cells = 128;  ///< along each edge; a power of two
    float half = 1;   ///< of the cube [-half, half]^3, metres; the surface must stay clear of its faces
    std::string_view field = {};  ///< GLSL that answers "field.glsl"; empty: the default field
    int imageSize = 1024;         ///< pixels along an edge of the depth image
};

struct TalkStages {
    const Device& device;
    TalkGrid grid = {};
    // Compute.
    Pipeline sample = {}, activity = {}, counts = {}, reduce = {}, arguments = {}, vertices = {},
             indices = {};
    // Graphics.
    Pipeline drawEvery = {}, drawActive = {}, drawIndexed = {}, captureEvery = {}, captureActive = {};
    Buffer sampleBuffer = {}, caseBuffer = {}, cellPyramid = {}, vertexPyramid = {}, argumentBuffer = {};
    Buffer lookupBuffer = {}, vertexBuffer = {}, indexBuffer = {};
    Image depth = {};
};

/// Needs a device with geometry shaders that may write buffers; throws SystemError where it has none.
TalkStages createTalkStages(const Device& device, const TalkOptions& options);

/// Records what a way does once per change of the field, as named stages.
void recordGeneration(Commands& commands, const TalkStages& stages, TalkWay way);

/// Records a depth pass over what was generated, as one stage, "pass".
void recordPass(Commands& commands, const TalkStages& stages, TalkWay way);

/// A pipeline that draws any indexed mesh in such a pass: `floatsPerVertex` from position to position.
Pipeline createMeshPass(const Device& device, uint32_t floatsPerVertex);

/// Records a depth pass over another mesh: VkDrawIndexedIndirectCommand at `offset` of `arguments`.
void recordMeshPass(Commands& commands, const TalkStages& stages, const Pipeline& pass,
                    const Buffer& meshVertices, const Buffer& meshIndices, const Buffer& arguments,
                    VkDeviceSize offset);

/// The triangles that a way draws: runs its generation, then captures the geometry shader's output (three
/// vertices of their own a triangle, in no particular order) or reads the indexed mesh.
Mesh captureMesh(const TalkStages& stages, TalkWay way);

/// The depths of the last pass, row by row; 0 where nothing was drawn, 1 nearest.
std::vector<float> readDepth(const TalkStages& stages);

}  // namespace fw::bench
