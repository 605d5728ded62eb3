// Charts: connected pieces of a mesh that are nearly flat, each to be laid flat by projection to a plane.
//
// Which triangles go together is what the field's normals say, which are smooth where triangles are slivers:
// all of a chart are within a cone about its axis. First regions grow one after the other, in a narrow cone
// about the normal of where they begin; then, as in variational shape approximation (Cohen-Steiner, Alliez
// and Desbrun 2004), all grow at once from their best triangles about their mean normals, the nearest normal
// first, some times over. Deviations: who has no room in any cone founds a region of its own, so there is no
// number of regions to choose; and small regions join a neighbour that they are not turned from too far, as a
// whole or triangle by triangle.
//
// What is guaranteed: every triangle has one chart; seen along the axis none is turned over, or so oblique
// that less than kLeastCosine of its area is seen, but those of no area; and no two cover the same texel of
// a raster as fine as kOverlapRaster squared for the whole mesh: those that would, where a surface winds over
// itself, found charts of their own.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace fw {

inline constexpr float kLeastCosine = 0.3f;
inline constexpr int kOverlapRaster = 4096;

struct Charts {
    std::vector<uint32_t> ofTriangle;
    std::vector<glm::vec3> axes;  ///< of each chart, unit length, outward
    std::size_t count() const { return axes.size(); }
};

Charts chartsOf(const Mesh& mesh);

/// Makes new charts of triangles that had others, with the same axes: one for those that hang together.
void splitOff(Charts& charts, const Mesh& mesh, const std::vector<uint32_t>& triangles);

/// Two directions of the plane that an axis stands upon: right, up and axis are right-handed.
struct ChartPlane {
    glm::vec3 right, up;
};
ChartPlane planeOf(glm::vec3 axis);

/// The triangle beyond each edge, that from corner i on at i; kNoTriangle at a border. Vertices are known by
/// their numbers, so what is doubled along a crease is a border.
inline constexpr uint32_t kNoTriangle = ~0u;
std::vector<uint32_t> neighboursOf(const Mesh& mesh);

}  // namespace fw
