// A mesh laid flat: every place of it has a place of its own in a square texture.
//
// Charts (charts.h) are projected to their planes, each scaled by what the projection takes of its area, and
// packed (pack.h). Vertices on the borders of charts are doubled: one copy for each fan of triangles about it
// that are of one chart and joined by edges, so that tangents (tangents.h) are one to a vertex.
//
// What is guaranteed: all coordinates are in 0 .. 1, with v running down as in glTF; no two triangles cover
// the same middle of a texel of a raster of kFinestRaster; none is turned over, so that seen from
// outside u runs right where v runs down.
#pragma once

#include <span>

#include "graph/base/result.h"
#include "runtime/textures/charts.h"

namespace fw {

inline constexpr int kFinestRaster = 4096;

struct Unwrapping {
    Mesh mesh = {};      ///< as it was, with uvs; vertices keep their places, copies follow behind
    Charts charts = {};  ///< of its triangles, in their order
    int gutter = 0;      ///< least texels between two charts
    double covered = 0;  ///< share of the texture
};

/// For a texture of `size` x `size` texels. `scales` has for each triangle how large it is to be there beside
/// others, the same for all that hang together; none: 1. Errors: more charts than so few texels have room
/// for.
Result<Unwrapping> unwrap(Mesh mesh, int size, std::span<const float> scales = {});

}  // namespace fw
