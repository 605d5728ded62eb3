// What the kernels of runtime/stages/mesh_stages.h share with C++. After shared.h.
#ifndef FW_MESH_STAGES_H
#define FW_MESH_STAGES_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define MESH_GROUP 64                // vertices or triangles of a work group
#define MESH_MOST_MOVED 0.25         // of its edge's length that a new vertex may be moved,
#define MESH_MOST_MOVED_ON_SIDE 0.1  // and within a side of the region

struct MeshPush {
    uint vertices;  // that a kernel over vertices is about,
    uint first;     // and the first of them, of project.comp
    uint triangles;
    float unit;    // of what is summed (exact_sum.glsl): a power of two; metres, of normals square metres
    vec3 lo, hi;   // the region, at whose sides the solid is closed,
    float rim;     // and how near to a side, metres, the vertices are that close it
    float still;   // metres: smoothing leaves a vertex that has all its neighbours within them,
    float spare;   // and one where the mesh is as round as a ball of this radius; 0: none;
    float within;  // none gets farther from where it was
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
