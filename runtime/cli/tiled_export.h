// `fieldwright export` in tiles, straight into the mesh file. Of a part, --tile i/n, tiles that are done lie
// in the folder OUTPUT.tiles until the part is there, so that the same command goes on after it was stopped.
#pragma once

#include "runtime/cli/mesh_graph.h"

namespace fw::cli {

/// Where the tiles of a mesh lie until it is there.
inline std::string tilesFolder(const std::string& output) { return output + ".tiles"; }

/// Says that tiles stay for the next time, if some do in the folder; if none does, removes it.
void sayWhatIsKept(const std::string& folder);

/// Refuses options that do not go with tiles.
Done checkTiledExport(const ExportOptions& options);

/// Whether options, method and stages allow tiles.
bool canBeTiled(const ExportOptions& options, const OpenedGraph& opened);

/// Whether they do, and so many cells are wanted that tiles are the way.
bool wantsTiles(const ExportOptions& options, const OpenedGraph& opened);

/// Whether the mesh can be made in so many shares; if not, says why. The exit status.
int checkShares(const ExportOptions& options, const OpenedGraph& opened, uint32_t shares);

/// The export from there on; the exit status.
int exportTiles(const ExportOptions& options, OpenedGraph opened, Progress& progress);

}  // namespace fw::cli
