// The writers behind exportMesh, one a file format. Internal to runtime/export.
//
// Each takes a mesh that exportMesh has checked (not empty, indices in range, coordinates finite, normals of
// unit length or none) and open files, appends everything, and leaves the commit to the caller. A writer
// looks at `file.good()` between chunks and returns early when it is false.
#pragma once

#include <atomic>
#include <glm/vec3.hpp>
#include <string>

#include "runtime/export/output_file.h"
#include "runtime/export/read_back.h"
#include "runtime/mesh.h"

namespace fw {

/// Least and greatest coordinates over all vertices.
struct Bounds {
    glm::vec3 min, max;
};

/// Where the triangles of a solid have another vertex than those of its mesh: entry `entries[i]` of the
/// indices is `vertices[i]`, which lies at the same place. Entries ascend.
struct Merges {
    std::vector<uint32_t> entries, vertices;
};

/// With `merges`, glTF says that the mesh is a solid. Both writers return false if the parts exceed what the
/// format can count (4 GiB in a GLB).
bool writeGlb(const Mesh& mesh, const Bounds& bounds, const std::string& name, const Merges* merges,
              OutputFile& file);
/// `binaryUri` is the name of the binary file beside the glTF, as it stands in the JSON.
void writeGltf(const Mesh& mesh, const Bounds& bounds, const std::string& name, const Merges* merges,
               const std::string& binaryUri, OutputFile& file, OutputFile& binary);
/// `libraryName` is the name of the material file beside the OBJ.
void writeObj(const Mesh& mesh, const std::string& name, const std::string& libraryName, OutputFile& file,
              OutputFile& library);
void writePly(const Mesh& mesh, OutputFile& file);
void writeStl(const Mesh& mesh, OutputFile& file);
/// `solid` is the mesh with equal positions merged. Returns why it failed, if that is not in `file`.
std::string write3mf(const Mesh& mesh, const WeldedMesh& solid, const std::string& name,
                     const std::atomic<bool>* cancel, OutputFile& file);
/// `voxel` is the length of a voxel's side in metres. Returns the same.
std::string writeVdb(const WeldedMesh& solid, float voxel, const std::string& name,
                     const std::atomic<bool>* cancel, OutputFile& file);

/// The ending of a path's name with its point, in small letters: ".glb".
std::string lowerExtension(const std::string& path);

/// "Fieldwright 0.1.0"
std::string generatorName();

/// 0..1 linear to 0..255 sRGB, rounded to nearest.
unsigned char encodeSrgb(float linear);

}  // namespace fw
