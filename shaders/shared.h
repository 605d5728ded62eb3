// Structs and constants that shaders and C++ share; both include this file. Everything is laid out as scalars
// (4-byte alignment), which is what C++ does with these members and what `scalar` blocks do in GLSL.
#ifndef FW_SHARED_H
#define FW_SHARED_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace fw::gpu {
using uint = uint32_t;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;
using ivec3 = glm::ivec3;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
#endif

#define FIELD_PARAMETERS 15  // binding of the live parameters, in every shader that includes field.glsl
#define FIELD_IMAGES \
    14  // binding of the images that the field samples, likewise; no shader has another there

#define FIELD_VOLUMES 16  // and of its volumes

#define FIELD_HEADS 12  // bindings of the lists of members that matter at a place, in shaders that prune
#define FIELD_LISTS 11
#define FIELD_TABLES 9  // binding of the members' numbers

// ---- Mesher
// ------------------------------------------------------------------------------------------------------
// Words used: sample, a grid point; cell, between eight samples; brick, 8^3 cells; block, 8^3 bricks; row, 8
// bricks along x; plane, the 9x9 samples of a brick at one z; strip, 4x8 cells (x, y) of a brick at one z.

#define MESHER_VERTEX_CHUNK 8388608u  // vertices that one dispatch writes: 16 bytes each make 128 MiB
#define MESHER_TRIANGLE_CHUNK \
    11000000u                       // triangles that one dispatch starts: 12 bytes each and some slack, ditto
#define MESHER_QUAD_CHUNK 5500000u  // edges that one dispatch makes two triangles each of
#define MESHER_CHUNKS 16            // dispatches at most: 2 GiB, the largest allocation
#define MESHER_GROUP_BRICKS 8       // bricks of a group: of one work group of the kernels over planes
#define MESHER_GROUP_STRIPS 128     // strips of one such group: 16 a brick
#define MESHER_GROUP_LINKS 64       // bricks and vertices of one work group of the kernels over those
#define MESHER_GROUP_VERTICES 64

#define MESHER_PLACES 73  // boxes of a block that have lists of members: of 64^3, of 32^3 and of 16^3 cells

// What every mesher kernel is told.
struct MesherPush {
    vec3 origin;        // of the region, metres
    vec3 cellSize;      // metres along each axis
    uvec3 cells;        // of the region
    float margin;       // an interval this close to zero counts as reaching it
    uvec3 blocks;       // of the tile and the bricks beyond its far faces; the grid has one layer of outside
                        // samples around the region
    float nudge;        // least distance of a vertex from the ends of its grid edge, in cells
    uint blocksListed;  // 1: the blocks to look into are listed; 0: all are meant
    uint brickCapacity;
    uint vertexCapacity;
    uint triangleCapacity;
    uint chunk;      // of vertices or triangles, for kernels that run once a chunk
    uint listStart;  // where lists of members begin (field.glsl); 0: all places have the whole list
    uvec3 begin;     // first brick of the tile, at a corner of a block; 0 where the region is one tile
    uvec3 end;  // bricks from here on along an axis are the next tile's: they lend the edges on the far face
};

struct DispatchArguments {
    uint x, y, z;
};

// Places in MesherCounts::groups.
#define MESHER_BLOCKS 0   // a work group for each block
#define MESHER_COMPACT 1  // the same, none if there are too many bricks
#define MESHER_LINKS 2    // over bricks
#define MESHER_BRICKS 3   // over bricks
#define MESHER_EDGES 4    // over active edges, one for each chunk
#define MESHER_TRIANGLES \
    (MESHER_EDGES + MESHER_CHUNKS)  // over groups of bricks, one for each chunk of triangles
#define MESHER_VERTICES (MESHER_TRIANGLES + MESHER_CHUNKS)  // over vertices, one for each chunk
#define MESHER_QUADS (MESHER_VERTICES + MESHER_CHUNKS)      // over active edges, one for each chunk of quads
#define MESHER_GROUPS (MESHER_QUADS + MESHER_CHUNKS)

// What the kernels count, and the arguments of the indirect dispatches and of the draw that follow.
struct MesherCounts {
    uint blocks;  // that may hold surface
    uint bricks;  // the same
    uint caps;    // not 0 if the surface was closed at the region's boundary
    uint leaks;   // not 0 if surface runs on into a brick that was culled: the mesh is then not usable
    uint edges;   // that cross the surface
    uint vertices;
    uint triangles;
    uint pinched;  // of dual contouring: quads that meet another along two edges at once
    uint listed;   // entries that the lists of members take
    DispatchArguments groups[MESHER_GROUPS];
    uint groupStart[MESHER_CHUNKS + 1];  // first group of bricks of each chunk of triangles
    uint draw[5];                        // arguments of vkCmdDrawIndexedIndirect
};

// A vertex of the mesh as the device stores it; the normal is octahedral, two 16-bit signed fractions.
struct MeshVertex {
    vec3 position;
    uint normal;
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
