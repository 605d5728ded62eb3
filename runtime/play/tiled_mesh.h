// A region's mesh in tiles, each meshed by itself: memory is bounded by a few tiles.
//
// The whole in one file: all tiles are meshed once to count what each has and to number the vertices that
// they share, then again, each written where it belongs. That is sooner than to write and read them in
// between, for meshing takes less time than the disk. A part of the mesh, which another machine may make,
// is left on disk tile by tile, and what is done stays done.
//
// Tiles are whole blocks of the region's grid, about as large as asked for; the last along an axis takes what
// is left. The files are named by tile, and each says by a key what it belongs to; one of something else is
// made again.
#pragma once

#include <functional>

#include "graph/base/algorithm_version.h"
#include "runtime/export/tile_file.h"
#include "runtime/play/session.h"

namespace fw {

inline constexpr int kLeastTile = 64;  ///< cells a side
/// A tile's side unless it is asked otherwise: the fastest of 256, 512 and 1,024 (docs/benchmarks.md), and
/// too few bricks for what the mesher can number.
inline constexpr int kTileCells = 256;
/// Cells along the longest side above which tiles are the way, where they can be had.
inline constexpr int kMostUntiled = 1024;

/// Refuses what cannot be meshed in tiles: stages.
Done checkTiles(const Program& program);

struct TilePlan {
    CellGrid grid;
    int tileCells = 0;
    std::vector<MesherTile> tiles;  ///< x fastest
};

/// Tiles of about `tileCells` cells a side, a multiple of kLeastTile, from half to one and a half of it;
/// fewer where the grid has fewer.
TilePlan planTiles(const CellGrid& grid, int tileCells);

/// Equal where a tile of the session's program, meshed as `request` has it, has the same bytes.
uint64_t tileKey(const Session& session, const MeshRequest& request, const TilePlan& plan,
                 uint32_t algorithms = kAlgorithmVersion);

/// Where tile `index` goes in the folder of the tiles' files.
std::string tilePath(const std::string& folder, const TilePlan& plan, std::size_t index);

/// Whether that tile is there, whole and of this key.
std::optional<TileRecord> doneTile(const std::string& folder, const TilePlan& plan, uint64_t key,
                                   std::size_t index);

/// The whole mesh, whose pieces are the tiles, meshed anew at each load. `session` and what it meshes must
/// stay as they are. `counting` is called before each tile is counted; false ends the work. Errors: as
/// Session::polygonise, as TileJoin, a vertex that is not finite, the end by `counting`.
struct CountedTiles {
    MeshPieces mesh;
    bool capped = false;
};
Result<CountedTiles> countTiles(Session& session, const MeshRequest& request, const TilePlan& plan,
                                const std::function<bool(std::size_t tile)>& counting = {});

/// Meshes tile `index` and writes its file. `request` is that of the whole. Errors: as Session::polygonise, a
/// vertex that is not finite, what writing meets.
Result<TileRecord> meshTile(Session& session, const MeshRequest& request, const TilePlan& plan, uint64_t key,
                            std::size_t index, const std::string& folder, const std::atomic<bool>* cancel);

/// Removes the tiles' files that are in the folder, of whatever size of tile, and the folder if nothing else
/// is in it.
void removeTiles(const std::string& folder);

}  // namespace fw
