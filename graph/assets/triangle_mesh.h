// Triangle meshes made elsewhere: read from files, for fields and for the output.
//
// A mesh is taken as its file has it: nothing is welded, closed or turned. What its topology is, and what
// that means for a field, is found where a field is made of it.
//
// Lifetime: meshes are shared and never change. A file that has not changed since it was last read is not
// read again while any graph holds its mesh.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/asset_file.h"
#include "graph/base/result.h"

namespace fw {

inline constexpr std::size_t kMostMeshTriangles = 20'000'000;       ///< of one mesh
inline constexpr std::size_t kMostMeshVertices = 3 * 20'000'000ul;  ///< of one mesh

/// Right-handed, +Y up, metres; triangles wind counter-clockwise seen from outside, if they wind at all.
struct TriangleMesh {
    std::vector<glm::vec3> positions;  ///< finite
    std::vector<uint32_t> indices;     ///< three a triangle, at least one triangle
    std::vector<glm::vec3> colors;     ///< base colour at each vertex, linear sRGB, 0 to 1; or none
    std::string file;                  ///< absolute path
    uint64_t hash = 0;                 ///< of all but the file's name
};
using TriangleMeshPtr = std::shared_ptr<const TriangleMesh>;

/// What a format's reader is given: the file's bytes, its path as the graph has it, and where it lies.
struct MeshFile {
    const std::string& bytes;
    const std::string& path;
    const std::string& file;
    FileKind kind = kMeshFile;  ///< what messages call it
};

/// The readers of each format. A PLY file may be without faces. Errors, with a message only: what is
/// damaged, missing or beyond the limits, and in a glTF file what is of a version or an extension that is not
/// read.
Result<TriangleMesh> readGltfMesh(
    const MeshFile& file);  ///< 2.0: the default scene, with its nodes' transforms
Result<TriangleMesh> readObjMesh(const MeshFile& file);
Result<TriangleMesh> readStlMesh(const MeshFile& file);
Result<TriangleMesh> readPlyMesh(const MeshFile& file);

/// The format's reader, chosen by the path's ending; then without the vertices that no triangle has.
Result<TriangleMesh> parseTriangleMesh(const MeshFile& file);

/// Reads a file of the kind kMeshFile (file_kind.h). `path` is relative to the folder of the file
/// `graphPath`, as openAsset() has it. The Error has a message only.
Result<TriangleMeshPtr> readTriangleMesh(const std::string& graphPath, const std::string& path);

/// The other files that a mesh's file names, buffers of a glTF file and materials of an OBJ file, as paths
/// from its folder: what goes where it goes. None if it cannot be read.
std::vector<std::string> piecesOfMesh(const std::string& file);
/// Those of a format, in its bytes.
std::vector<std::string> gltfPieces(std::string_view bytes);
std::vector<std::string> objPieces(std::string_view bytes);

/// "the mesh 'a.glb' " and what is wrong with it.
Error meshProblem(const MeshFile& file, const std::string& what);

}  // namespace fw
