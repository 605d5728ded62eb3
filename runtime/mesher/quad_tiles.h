// Which tile each quad of dual contouring is of.
//
// A quad stands about an edge of the grid, and is of the tile in which that edge starts. Its corners are in
// the cells about the edge, some of them perhaps in the tile before, so up to eight tiles have a vertex. The
// mesher makes a tile a brick larger all round (mesher.h): whatever shares a vertex with a quad of the tile
// is there, so that each tile can tell by itself which others have a vertex, and shades creases as they do.
#pragma once

#include <vector>

#include "runtime/mesher/mesher.h"

namespace fw {

inline constexpr uint8_t kOwnTile = 13, kNoTile = 27;

/// Of each triangle of the last mesh which of 27 tiles it is of, this one and those about it (x fastest), or
/// kNoTile: a part of a quad at the rim, whose other corners mean nothing. `tile`, of a region of that many
/// cells, is what was meshed.
std::vector<uint8_t> tilesOfTriangles(const Device& device, const MesherBuffers& buffers,
                                      const MesherResult& result, const MesherTile& tile, glm::ivec3 cells);

}  // namespace fw
