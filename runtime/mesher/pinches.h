// Dual contouring's last step: faces of the grid over which one patch of surface runs twice on either side.
//
// Such a face has its two inside corners on a diagonal, and both its segments belong to one patch in both
// cells. Each segment is crossed by an edge of the mesh between the two patches' vertices, so that one edge
// would have four triangles. A vertex put into each of these two edges, in the middle of its segment, parts
// them. It happens where the surface folds at the scale of a cell (in a smoothed noise at 0.5 % of the
// edges, in models hardly ever), so the host does it, for the quads that the device has listed.
#pragma once

#include "runtime/mesher/mesher.h"

namespace fw {

struct Addition {
    uint32_t vertices = 0, triangles = 0;
};

struct Parting {
    uint32_t vertices = 0;        ///< that were added
    std::vector<uint32_t> quads;  ///< of each triangle that was added: the quad that it was a part of
};

/// The most that parting adds, if so many quads are listed.
Addition mostOfPinches(uint32_t quads);

/// Parts them, behind the vertices and triangles that `counts` tells; the buffers have room for that. The
/// result does not depend on the order in which they were listed.
Parting partPinches(const Device& device, MesherBuffers& buffers, const gpu::MesherCounts& counts);

}  // namespace fw
