// Writes a mesh to a file of the format that the file's extension names.
//
// Why it is built as it is: a mesh of 256 cells a side holds 600,000 triangles and the whole process has 0.25
// s, so the writers hand the mesh's own arrays to the system where the format allows and format the rest in
// small chunks. No copy of the file is held in memory, but by the libraries that write 3MF and OpenVDB.
//
// What is guaranteed: the file appears under its name whole or not at all (output_file.h). On any failure the
// temporary file is removed and a file that stood there before is as it was. glTF and OBJ have a second file
// (.bin, .mtl), and with textures some more: a rename for each, the file asked for last.
//
// How lengths and axes stand in a file is told by placement.h. Colours: glTF holds them linear, as its
// specification asks; PLY, OBJ, MTL and 3MF hold them sRGB-encoded, as the programs that read them expect.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "runtime/export/placement.h"
#include "runtime/measure/read_back.h"
#include "runtime/mesh/materials.h"
#include "runtime/mesh/mesh.h"

namespace fw {

struct ExportOptions {
    std::string name = {};  ///< of the object inside the file; the file's stem if empty
    float cellSize = 0.0f;  ///< of the grid that the mesh was made on, metres: a voxel of a level set is as
                            ///< large; 0: a 128th of the mesh's longest side
    bool manifold =
        false;  ///< of glTF: say which vertices are one, so that it is a solid (EXT_mesh_manifold)
    bool compress = false;     ///< of glTF: few bits a number, in meshoptimizer's code (compress.h)
    bool parts = false;        ///< of glTF: what touches nowhere is a node of its own
    Placement placement = {};  ///< of the mesh in the file
    bool splitMaterials =
        false;  ///< the mesh was cut where materials meet; of formats that have a material for each part
    bool mayBeEmpty = false;  ///< a mesh without triangles is a file without any, and no error
    const std::atomic<bool>* cancel =
        nullptr;  ///< read between chunks of at most 4 MiB; true ends the export
    /// Called with the files, whole, before they replace what has their names; an Error ends the export.
    std::function<Done(const StoredMesh&)> examine = {};
    std::function<void()> kept =
        {};  ///< called once all files have their names, as OutputFile::commit() does
};

/// What an export left on disk.
struct ExportedFiles {
    std::vector<std::string> paths;  ///< the file asked for, then the one beside it if the format has one,
                                     ///< then those of its textures
    uint64_t bytes = 0;              ///< of all of them
};

/// Writes `mesh` to `path`; the extension (one of exportFormats(), in any case) picks the format.
/// Errors name the path: unknown extension, empty mesh, index or coordinate out of range, unwritable folder,
/// full disk, cancelled, no closed solid where the format asks for one. Normals that are not unit vectors are
/// replaced by those of the triangles around.
Result<ExportedFiles> exportMesh(const Mesh& mesh, const std::string& path,
                                 const ExportOptions& options = {});

/// Levels of detail as one .glb or .gltf: a node for each under one, the finest first, which share textures
/// and materials. Their names end as many programs that import them look for: lamp_LOD0. `options` as of
/// exportMesh. Errors: as of it and checkLevelsPath().
Result<ExportedFiles> exportLevels(std::span<const Mesh> levels, const std::string& path,
                                   const ExportOptions& options = {});
/// Refuses, before any work is done, paths of other formats, and options that do not go with levels.
Done checkLevelsPath(const std::string& path, const ExportOptions& options);
/// What a level is called in a file of that path.
std::string levelName(const std::string& path, const ExportOptions& options, std::size_t level);

/// A mesh too large for memory, given piece by piece. Its vertices are those of the pieces in their order.
struct MeshPieces {
    enum Part {
        numbered,  ///< the piece's vertices: positions, normals, and colours if there are some; and its
                   ///< triangles, as indices into the vertices of the whole mesh
        corners    ///< all that the triangles need: positions, and indices into those
    };
    Mesh material;                    ///< of which only the material counts
    glm::vec3 least{0}, greatest{0};  ///< coordinates over all vertices
    uint64_t vertexCount = 0, triangleCount = 0;
    bool colors = false;
    SolidSize size;  ///< of what light passes through; else 0
    std::size_t count = 0;
    /// Called for one piece at a time, on a thread of the caller's choice.
    std::function<Result<Mesh>(std::size_t piece, Part part)> load;
};

/// As exportMesh, with two pieces in memory at a time: each is loaded once, in order, while the one before is
/// written to its places in the file. Errors also: a format that cannot be written so (3MF), what load()
/// says, more triangles than the format can count, pieces that are not as large together as was said.
Result<ExportedFiles> exportPieces(const MeshPieces& pieces, const std::string& path,
                                   const ExportOptions& options = {});
/// Refuses, before any work is done, a path that exportPieces cannot write.
Done checkPiecesPath(const std::string& path);

/// The files that exportMesh writes for this path: it, then the one beside it if the format has one.
std::vector<std::string> exportedPaths(const std::string& path);

/// What exportMesh can write.
struct ExportFormat {
    const char* ending;      ///< ".glb"
    const char* about;       ///< what it is good for, some words
    bool manifold = false;   ///< whether ExportOptions::manifold is for it
    bool measurable = true;  ///< whether it holds triangles, which a report measures
    bool parts = false;      ///< whether it holds more than one material, Mesh::parts
};
std::span<const ExportFormat> exportFormats();
/// That of the path's ending; nullptr if it is none of them.
const ExportFormat* exportFormat(const std::string& path);

/// Whether that of the path's ending is glTF.
bool isGltf(const std::string& path);

/// Refuses, before any work is done, a path whose extension exportMesh does not know; the message lists those
/// it does. Also options that the format does not have; `measured` says that a report is wanted of the file.
Done checkExportPath(const std::string& path, const ExportOptions& options = {}, bool measured = false);

}  // namespace fw
