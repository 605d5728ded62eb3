// What the kernels of runtime/mesher share with C++. After shared.h.
#ifndef FW_MESHER_H
#define FW_MESHER_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

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

// Bindings; 9, 11, 12 and 14 to 16 are the field's.
#define MESHER_AT_COUNTS 0  // MesherCounts
#define MESHER_AT_BLOCK_LIST 1
#define MESHER_AT_BLOCK_ALIVE 2
#define MESHER_AT_ROWS 3
#define MESHER_AT_SUMS 4  // of blocks, then of groups of bricks
#define MESHER_AT_BRICK_LIST 5
#define MESHER_AT_LINKS 6
#define MESHER_AT_PLANES 7
#define MESHER_AT_EDGES 8  // the edge -> vertex lookup
#define MESHER_AT_VERTEX_LIST 10
#define MESHER_AT_MESH 13    // the chunk of vertices or triangles that is written
#define MESHER_AT_POINTS 17  // of dual contouring: on the active edges
#define MESHER_AT_TABLE 18   // marching_cubes_table.h
#define MESHER_AT_STRIP_LIST 19
#define MESHER_AT_PATCH_LIST 20
#define MESHER_AT_CORNERS 21  // of quads; or, where these are written, the edges of patches
#define MESHER_AT_PINCHED 22
#define MESHER_AT_VERTICES 23  // all of them, to be read
#define MESHER_AT_COLORS 24

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
    uvec3 begin;     // brick from which bricks are numbered, at a corner of a block
    uvec3 first;     // first brick of the tile; 0 where the region is one tile
    uvec3 end;  // bricks from here on along an axis are the next tile's: they lend the edges on the far face
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

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
