// The writers behind exportMesh, one a file format. Internal to runtime/export.
//
// Each takes a mesh that exportMesh has checked (not empty, indices in range, coordinates finite, normals of
// unit length or none) and open files, appends everything, and leaves the commit to the caller. A writer
// looks at `file.good()` between chunks and returns early when it is false.
#pragma once

#include <atomic>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "runtime/export/export.h"
#include "runtime/export/texture_files.h"
#include "runtime/system/output_file.h"

namespace fw {

/// Least and greatest coordinates over all vertices.
struct Bounds {
    glm::vec3 min, max;
};

/// Its bounds, of a mesh that can be written to `path`. Errors: too many vertices, an index out of range, a
/// coordinate that is not finite.
Result<Bounds> checkMesh(const Mesh& mesh, const std::string& path);
/// The mesh with those normals replaced that are no unit vectors; none if all are.
std::optional<Mesh> withUnitNormals(const Mesh& mesh);
/// What the object in a file is called.
std::string objectName(const std::string& path, const ExportOptions& options);
/// The name without blanks, control characters and broken UTF-8: names stand on a line of their own in OBJ.
std::string printable(std::string name);
/// A file's name as a URI.
std::string percentEncoded(const std::string& name);
/// Gives the files their names, if options.examine() finds nothing wrong: `file`, and the one beside it.
/// `images` get theirs before; their bytes count, and their names are for the caller to add.
Result<ExportedFiles> commitAll(const std::string& path, const ExportOptions& options, OutputFile& file,
                                OutputFile* beside, std::span<OutputFile> images = {});

/// Where the triangles of a solid have another vertex than those of its mesh: entry `entries[i]` of the
/// indices is `vertices[i]`, which lies at the same place. Entries ascend.
struct Merges {
    std::vector<uint32_t> entries, vertices;
};

/// The files of images that stand beside a mesh file of that path, written but without their names; none of a
/// GLB, which holds them.
Result<std::vector<OutputFile>> openImages(const std::string& path, const std::vector<TextureImage>& images,
                                           const ExportOptions& options);

/// How much there is of what a glTF holds.
struct GltfLayout {
    uint64_t vertices = 0, indices = 0;
    bool normals = false, colors = false;
    bool textured = false;  ///< with uvs and tangents
    bool solid = false;     ///< said to be one
    uint64_t merges = 0;    ///< then: vertices that the solid has in place of others
    float thickness = 0;    ///< of what light passes through, metres
    /// 65535 is the restart value and may not be an index.
    bool shortIndices() const { return vertices <= 65535; }
    uint64_t indexSize() const { return shortIndices() ? 2 : 4; }
    uint64_t bytes() const {
        return vertices * (12 + (normals ? 12 : 0) + (colors ? 8 : 0) + (textured ? 24 : 0)) +
               indices * indexSize() + merges * (4 + indexSize());
    }
};
/// The JSON with the materials of `mesh`, whose other arrays are not looked at. Its one buffer has the given
/// uri, or none where the binary part follows in the same file: all positions, normals, colours, uvs,
/// tangents, then indices. `images` are the mesh's textures; without them its materials show none.
std::string gltfJson(const Mesh& mesh, const GltfLayout& layout, const Bounds& bounds,
                     const std::string& name, const std::string& uri,
                     const std::vector<TextureImage>& images = {});
GltfLayout gltfLayout(const Mesh& mesh, const Merges* merges = nullptr);
/// The binary part.
void writeGltfBinary(const Mesh& mesh, const GltfLayout& layout, const Merges* merges, OutputFile& file);
/// All of a GLB before its binary part of so many bytes; false, and nothing is written, if the whole would
/// exceed the format's 4 GiB.
bool writeGlbHead(std::string json, uint64_t bytes, OutputFile& file);
void writeGlbEnd(uint64_t bytes, OutputFile& file);
void writeGltfColors(const Mesh& mesh, OutputFile& file);
void writeGltfIndices(std::span<const uint32_t> indices, bool asShorts, OutputFile& file);

/// With `merges`, glTF says that the mesh is a solid. Both writers return false if the parts exceed what the
/// format can count (4 GiB in a GLB). `images` are those of textureImages().
bool writeGlb(const Mesh& mesh, const Bounds& bounds, const std::string& name, const Merges* merges,
              const std::vector<TextureImage>& images, OutputFile& file);
/// `binaryUri` is the name of the binary file beside the glTF, as it stands in the JSON.
void writeGltf(const Mesh& mesh, const Bounds& bounds, const std::string& name, const Merges* merges,
               const std::string& binaryUri, const std::vector<TextureImage>& images, OutputFile& file,
               OutputFile& binary);
/// A scene with one node of that name and no mesh; as a GLB, or as text.
void writeEmptyGltf(const std::string& name, bool binary, OutputFile& file);
/// `libraryName` is the name of the material file beside the OBJ.
void writeObj(const Mesh& mesh, const std::string& name, const std::string& libraryName,
              const Placement& placement, const std::vector<TextureImage>& images, OutputFile& file,
              OutputFile& library);
/// Its parts, for meshes that come in pieces, each of whose faces have vertices of it or of one before: the
/// material and the head, then what names the material, vertices, and faces, which are numbered in the whole.
void writeObjHead(const Mesh& material, bool colors, const std::string& name, const std::string& libraryName,
                  const Placement& placement, OutputFile& file, OutputFile& library,
                  const std::vector<TextureImage>& images = {});
void writeObjMaterial(const std::string& name, OutputFile& file);
void writeObjVertices(const Mesh& mesh, OutputFile& file);
void writeObjFaces(const Mesh& mesh, std::size_t firstTriangle, std::size_t count, OutputFile& file);
void writePly(const Mesh& mesh, OutputFile& file);
void writeStl(const Mesh& mesh, const Placement& placement, OutputFile& file);
/// Of a vertex with its normal, and of a face.
inline constexpr uint64_t kPlyVertexBytes = 27, kPlyFaceBytes = 13;
/// Their parts, for meshes that come in pieces: the header, then all vertices, then all triangles.
void writePlyHeader(uint64_t vertices, uint64_t triangles, bool normals, OutputFile& file);
void writePlyVertices(const Mesh& mesh, OutputFile& file);
void writePlyFaces(const Mesh& mesh, OutputFile& file);
void writeStlHeader(uint64_t triangles, const Placement& placement, OutputFile& file);
void writeStlFacets(const Mesh& mesh, OutputFile& file);
/// `solid` is the mesh with equal positions merged. Returns why it failed, if that is not in `file`.
std::string write3mf(const Mesh& mesh, const WeldedMesh& solid, const std::string& name,
                     const std::atomic<bool>* cancel, OutputFile& file);
/// `voxel` is the length of a voxel's side in metres. Returns the same.
std::string writeVdb(const WeldedMesh& solid, float voxel, const std::string& name,
                     const std::atomic<bool>* cancel, OutputFile& file);

/// What a part's material is called: by its own name; else as the mesh, and where there are several with its
/// number from 1.
std::string partName(const Mesh& mesh, const std::string& name, std::size_t part);

/// "Fieldwright 0.1.0"
std::string generatorName();

/// 0..1 linear to 0..255 sRGB, rounded to nearest.
unsigned char encodeSrgb(float linear);

}  // namespace fw
