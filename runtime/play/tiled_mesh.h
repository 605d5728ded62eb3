// A region's mesh in tiles, each meshed by itself and left on disk: memory is bounded by one tile, and what
// is done stays done.
//
// Tiles are whole blocks of the region's grid, about as large as asked for; the last along an axis takes what
// is left. The files are named by tile, and each says by a key what it belongs to; one of something else is
// made again.
#pragma once

#include "runtime/export/tile_file.h"
#include "runtime/play/session.h"

namespace fw {

inline constexpr int kLeastTile = 64;  ///< cells a side

struct TilePlan {
    CellGrid grid;
    int tileCells = 0;
    std::vector<MesherTile> tiles;  ///< x fastest
};

/// Tiles of about `tileCells` cells a side, a multiple of kLeastTile, from half to one and a half of it;
/// fewer where the grid has fewer.
TilePlan planTiles(const CellGrid& grid, int tileCells);

/// Equal where a tile of the session's program has the same bytes.
uint64_t tileKey(const Session& session, const TilePlan& plan);

/// Where tile `index` goes in the folder of the tiles' files.
std::string tilePath(const std::string& folder, const TilePlan& plan, std::size_t index);

/// Whether that tile is there, whole and of this key.
std::optional<TileRecord> doneTile(const std::string& folder, const TilePlan& plan, uint64_t key,
                                   std::size_t index);

/// Meshes tile `index` and writes its file. `request` is that of the whole. Errors: as Session::polygonise, a
/// vertex that is not finite, what writing meets.
Result<TileRecord> meshTile(Session& session, const MeshRequest& request, const TilePlan& plan, uint64_t key,
                            std::size_t index, const std::string& folder, const std::atomic<bool>* cancel);

/// Removes the tiles' files that are in the folder, of whatever size of tile, and the folder if nothing else
/// is in it.
void removeTiles(const std::string& folder);

}  // namespace fw
