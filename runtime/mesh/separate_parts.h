// A mesh as the solids of which it consists.
#pragma once

#include <vector>

#include "runtime/mesh/mesh.h"

namespace fw {

/// Meshes that touch nowhere, not even at a point, in the order of their first triangles; each has its own
/// vertices, and the materials that its triangles have. Together they have all triangles, in their order.
std::vector<Mesh> separateParts(const Mesh& mesh);

}  // namespace fw
