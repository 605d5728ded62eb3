// Distances through a grid by handing on nearest points (graph/assets/mesh_field.h, with the theory): for
// meshes and for particles.
#pragma once

#include "runtime/gpu/commands.h"

namespace fw {

Pipeline createSweep(const Device& device);

/// Records sweeps along all axes, forwards and backwards. `state` has a texel of four words for each of the
/// samples, along x, then y, then z: its nearest point, in cells, as bits of floats, of which the first is
/// BAKE_UNREACHED where none is known; and BAKE_INSIDE with any number, which is handed on as well.
void recordSweeps(Commands& commands, const Pipeline& sweep, const Buffer& state, const glm::ivec3& size);

}  // namespace fw
