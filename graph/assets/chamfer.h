// Edges of a solid cut flat, on a grid on which its distances are measured.
//
// A chamfer of radius r is the plane through where a ball of that radius, rolled along the edge inside,
// touches the two faces: at a right angle it leaves each face r from the edge. With the faces' signed
// distances a and b at a place and the cosine c between their normals its signed distance is
//
//     (a + b + r (1 - c)) / sqrt(2 + 2 c),
//
// and the solid is what lies within it too. Of a smooth face with radii of curvature above 2 r nothing is
// cut.
//
// The faces around a sample are the planes through the nearest points of samples inside, taken from where
// they lie the most nearly below it, so that the cut of flat faces is exact wherever the grid's samples lie.
// Two of them cut a sample only if the solid has their edge next to it, which is known from distances behind
// that.
//
// Edges sharper than 45 degrees are left: the ball would touch their faces far from the edge. Where an edge
// ends at another one that runs inwards its cut ends unevenly, within some cells.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "graph/assets/volume.h"

namespace fw {

/// Cuts the edges that stand out, by a radius in metres, of what was measured: of each sample the distance,
/// metres, the direction away from the surface and the nearest point, cells, in the order of
/// VolumeGrid::index(). Those within twice the radius of an edge change.
void chamferEdges(const VolumeGrid& grid, double radius, std::span<const glm::vec3> nearest,
                  std::span<float> distances, std::span<glm::vec3> gradients);

}  // namespace fw
