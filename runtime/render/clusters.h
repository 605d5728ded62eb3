// Which of a mesh's triangles a pass draws.
//
// Triangles that follow each other in the mesh lie together, for it is made brick by brick; 64 of them are a
// cluster. A pass leaves out the clusters beside its picture and those that face away: the mesh is closed, so
// what faces away is behind what faces the eye, unless the eye is within the solid. After Haar and Aaltonen,
// "GPU-driven rendering pipelines" (2015); the normals are bounded by a box where they have a cone, which
// takes one pass over a cluster less.
//
// Lifetime: pipelines serve all meshes, buffers grow with them. A pass's list is overwritten by the next.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>

#include "runtime/mesher/mesher.h"
// after mesher.h
#include "shaders/render/render.h"

namespace fw {

struct Clusters {
    Pipeline bound, cull, gather;
    Buffer clusters, seen, counts, indices;
    uint32_t triangles = 0;
    bool whole = false;               ///< the mesh is larger than kernels can see at once: all of it is drawn
    std::optional<uint64_t> content;  ///< number of the mesh that the boxes are of
};

Clusters createClusters(const Device& device);

/// Makes the boxes of a mesh's clusters, unless they are of that `content` already.
void boundClusters(Commands& commands, Clusters& clusters, const MesherBuffers& mesh, uint32_t triangles,
                   uint64_t content);

/// Lists what is seen through `clip`, which looks from `eye` (w 1: a place; w 0: along a direction), into
/// the draw of indicesOf(), with its arguments in `counts`. `backs`: also what faces away. There is at least
/// one triangle.
void cullClusters(Commands& commands, Clusters& clusters, const MesherBuffers& mesh, const glm::mat4& clip,
                  const glm::vec4& eye, bool backs);

/// The indices of what is drawn.
const Buffer& indicesOf(const Clusters& clusters, const MesherBuffers& mesh);

}  // namespace fw
