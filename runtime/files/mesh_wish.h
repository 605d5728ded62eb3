// A mesh file as it is wished for, by a command or in a dialog: what parts, textures and levels it has, and
// how it is written.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/export/export.h"
#include "runtime/mesh/materials.h"
#include "runtime/textures/textured.h"

namespace fw {

inline constexpr int kMostLevels = 8;  ///< of detail

struct MeshWish {
    bool manifold = false, compress = false, parts = false;  ///< as ExportOptions has them
    bool splitMaterials = false;                             ///< faces are cut where materials meet
    std::optional<int> textures = {};  ///< texels along a side of those that are baked; none: no textures
    int lods = 1;                      ///< levels of detail in the file, the mesh itself among them
    PlacementWish placement = {};

    bool operator==(const MeshWish&) const = default;
};

/// Refuses, before any work is done, what a file of that path cannot have; `measured` as of
/// checkExportPath().
Done checkWish(const MeshWish& wish, const std::string& path, bool measured = false);

/// Refuses what a mesh that is made in tiles cannot have. Whether the format can be written so,
/// checkPiecesPath() tells.
Done checkTilesWish(const MeshWish& wish, const std::string& path);

/// The files that there may be in the end.
std::vector<std::string> wishedPaths(const MeshWish& wish, const std::string& path);

/// What parts a file of that path has of its mesh.
MaterialParts partsOf(const MeshWish& wish, const std::string& path);

/// How it is written, but for its placement.
ExportOptions writingOf(const MeshWish& wish);

/// The levels of detail, or the one mesh, with textures baked from the program on the host, if there are to
/// be some and the mesh has triangles. Errors: as of textured().
Result<std::vector<Mesh>> withTextures(const MeshWish& wish, std::vector<Mesh> levels, const Program& program,
                                       const TextureStage& starts = {});
Result<Mesh> withTextures(const MeshWish& wish, Mesh mesh, const Program& program);

/// Writes the levels of detail, or the one mesh; `options` are those of writingOf(), and more. Errors: as of
/// exportMesh().
Result<ExportedFiles> exportWished(const MeshWish& wish, std::span<const Mesh> levels,
                                   const std::string& path, const ExportOptions& options);

}  // namespace fw
