// One glTF of many nodes and meshes: frames that take turns, parts that move, levels of detail.
//
// A mesh that comes again, byte for byte, is in the file once, and so are a material and a set of textures;
// nodes refer to meshes by number. The meshes are written as they come, one behind the other, and the JSON in
// the end; of a GLB, which begins with the JSON, they lie in a temporary file until then.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/export/export.h"
#include "runtime/export/texture_files.h"
#include "runtime/system/output_file.h"

namespace fw {

/// Values of a node's property at times that ascend, seconds.
struct GltfTrack {
    std::size_t node = 0;
    const char* path = "translation";  ///< "rotation" (x, y, z, w), "scale"
    bool steps = false;                ///< values jump; else they are interpolated
    std::vector<float> times, values;
};

class GltfScene {
  public:
    /// `path` ends with .glb or .gltf. Errors: an unwritable folder. `options` as of exportMesh, but for
    /// `manifold`.
    static Result<GltfScene> open(const std::string& path, const ExportOptions& options = {});

    /// The number of the mesh, which has triangles; `name` is its, if it has not come before. Errors: as of
    /// exportMesh().
    Result<std::size_t> addMesh(const Mesh& mesh, const std::string& name);
    /// The number of the node, which is as the JSON says: a child of `parent`, or at the top.
    std::size_t addNode(nlohmann::json node, std::optional<std::size_t> parent = {});
    /// The mesh, and a node that shows it; both have the name. Errors: as of exportMesh().
    Done addShown(const Mesh& mesh, const std::string& name, std::optional<std::size_t> parent = {});
    /// All tracks, of one at least, play together.
    void addAnimation(const char* name, const std::vector<GltfTrack>& tracks);
    void setNode(std::size_t node, const char* key, nlohmann::json value);
    /// Shows the node's mesh at places within the node, in place of once there (EXT_mesh_gpu_instancing):
    /// three numbers of a place, a turn's four and three sizes each.
    void addInstances(std::size_t node, const std::vector<float>& moves, const std::vector<float>& turns,
                      const std::vector<float>& sizes);
    /// What the object in the file is called.
    std::string name() const;

    /// The file appears. Errors: a GLB of more than 4 GiB, a full disk.
    Result<ExportedFiles> end();

  private:
    GltfScene(std::string path, ExportOptions options, OutputFile binary);
    void join(nlohmann::json part);
    /// The numbers of textures, which are added if they have not come before.
    Result<TextureNumbers> texturesOf(const std::shared_ptr<const MeshTextures>& textures);
    std::size_t addFloats(const std::vector<float>& values, std::size_t parts);
    Done finished();
    Done readBinary(const std::function<Done(std::span<const unsigned char>)>& take);
    Result<ExportedFiles> commit(OutputFile& file, OutputFile* beside);
    Result<ExportedFiles> writeCompressed();
    Result<ExportedFiles> writeGltf(OutputFile& beside);
    Result<ExportedFiles> writeGlb(uint64_t bytes, const std::function<Done(OutputFile&)>& write);

    std::string path;
    ExportOptions options;
    OutputFile binary;  ///< the buffer's bytes; in a GLB and compressed, before they have their places
    nlohmann::json document;
    std::map<std::string, std::size_t> materials;      ///< by their JSON
    std::map<std::string, std::size_t> known;          ///< meshes by their content
    std::map<std::string, TextureNumbers> textures;    ///< by their content
    std::shared_ptr<const MeshTextures> lastTextures;  ///< of the mesh before; most meshes share them
    TextureNumbers lastNumbers;
    std::vector<OutputFile> images;  ///< beside a .gltf
    std::vector<std::string> imagePaths;
};

}  // namespace fw
