// What is done to a mesh in device memory after the mesher made it: smoothing, subdivision, normals.
//
// From Matt Swoboda's "Advanced Procedural Rendering in DirectX 11" (GDC 2012), "Meshing Improvements":
//  * A counting sort buckets triangles by vertex: an atomic count, which gives each corner its place in the
//    bucket, prefix sums over the counts, a scatter. What is stored for a corner are the vertices before and
//    after it in its triangle: the next ones are the ends of the vertex's edges, for the mesh is closed and
//    oriented.
//  * Laplacian smoothing moves a vertex to (4 v + sum of neighbours) / (4 + number of neighbours).
//    What is as round as a small ball stays, since that would shrink to nothing: after Löschner, Böttcher,
//    Jeske and Bender, "Weighted Laplacian Smoothing for Surface Reconstruction of Particle-based Fluids"
//    (2023), who weigh a vertex by the particles around; here it is by how round the mesh is, its mean
//    curvature, averaged over some rings of neighbours so that bumps cancel out.
//  * Subdivision splits each edge by a new vertex, and makes four triangles of each.
//  * Normals are means over the triangles of a vertex, weighted by their area.
// Deviations: atomics give buckets in any order, so nothing depends on it: sums are taken in integers
// (shaders/mesh/exact_sum.glsl), and an edge's number is that of its lower vertex and its rank there. The
// same input gives the same bytes on every run. Subdivision may lead new vertices onto the field. Decimation
// is the host's (decimate.h), and so is leaving out crumbs (mesh/crumbs.h).
//
// Meshes are closed, oriented and manifold, with at most 4096 triangles at a vertex, and stay so.
//
// Lifetime: pipelines serve all fields, but for that which leads vertices onto one; buffers grow with the
// mesh, and trade places with those of the mesher.
#pragma once

#include <functional>
#include <span>

#include "graph/compile/mesh_recipe.h"
#include "runtime/gpu/counting_sort.h"
#include "runtime/mesher/mesher.h"

#include "shaders/mesh/stages.h"  // after shared.h

namespace fw {

struct MeshStagePipelines {
    KeyCounting counting;
    Pipeline scatter, smooth, smoothSparing, roundness, spread, normals, edges, split, splitColored;
    Pipeline project;  ///< of a field: createProjection()
};

/// Without `project`.
MeshStagePipelines createMeshStagePipelines(const Device& device);
/// `field` is the text that answers #include "field.glsl".
Pipeline createProjection(const Device& device, std::string_view field);

struct MeshStageBuffers {
    Buffer vertices, colors, triangles;  ///< what a stage writes, traded for the mesh's own
    CountingSortBuffers corners;         ///< by vertex
    Buffer next, previous;               ///< of each corner, by vertex
    Buffer placed, roundness[2];         ///< of sparing: the vertices as they were, and how round it is there
    Buffer edgeCounts, edgeStarts;       ///< edges that begin at a vertex, to one of a higher number
};

struct MeshStageConfig {
    const MeshStagePipelines* pipelines = nullptr;
    glm::vec3 lo{-1.0f}, hi{1.0f};  ///< the region that was meshed
    float cellSize = 0;             ///< metres; how small a part may become depends on it
    FieldBuffers field = {};        ///< as MesherConfig's
    /// In place of the field's kernel, where the host evaluates the field (project_host.h).
    std::function<void(const gpu::MeshPush& push, std::span<gpu::MeshVertex> vertices)> projectOnHost = {};
    /// Does a stage of decimation on the host: whether it changed the mesh.
    std::function<bool(Mesh& mesh, const MeshStage& stage)> decimate = {};
    bool timed = false;
};

/// Copies a mesh to the device, vertex for vertex.
void uploadMesh(const Device& device, MesherBuffers& buffers, const Mesh& mesh, MesherResult& result);

/// Runs the stages on the mesh in `mesh`, and tells `result` what it has become; times go to its stages.
/// Errors: more triangles or vertices than the device can bind as a whole, or than 2^24 triangles.
Done runMeshStages(const Device& device, MeshStageBuffers& buffers, MesherBuffers& mesh, MesherResult& result,
                   std::span<const MeshStage> stages, const MeshStageConfig& config);

}  // namespace fw
