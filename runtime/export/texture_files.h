// A mesh's textures as PNG: in a GLB, or as files beside a glTF or an OBJ.
//
// glTF has one picture for occlusion, roughness and metallic, in red, green and blue. A .mtl has one for
// each, and a word for none of occlusion. Files are called by the mesh file's whole name, so that a glTF and
// an OBJ of one stem keep theirs apart: lamp_gltf_base_color.png. A file of several meshes may have more than
// one set of textures: the second's are lamp_gltf_2_base_color.png.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace fw {

struct TextureImage {
    const char* role;  ///< "base_color"
    std::string file;  ///< its name
    std::string png;
};

/// Those that a file of that path, whose format hasTextures(), has; of its set of that number, from 0.
std::vector<TextureImage> textureImages(const MeshTextures& textures, const std::string& path,
                                        std::size_t set = 0);

uint64_t bytesOf(const std::vector<TextureImage>& images);

/// Whether the format of that path holds textures.
bool hasTextures(const std::string& path);

/// Files of one set of textures that a mesh file of that path may have beside it; none of a GLB.
std::vector<std::string> texturePaths(const std::string& path);

/// A glTF's textures by the roles of their images.
using TextureNumbers = std::map<std::string_view, std::size_t>;

/// Adds the images to a glTF as textures. They lie in its buffer from that byte on, one behind the other; or
/// in files.
TextureNumbers addTextures(nlohmann::json& document, const std::vector<TextureImage>& images,
                           std::optional<uint64_t> inBuffer);

/// Makes the materials of a glTF, which may be part of the one that has the textures, show them.
void showTextures(nlohmann::json& document, const MeshTextures& textures, const TextureNumbers& numbers);

/// The lines of a .mtl that name the images, for each of its materials.
std::string textureLines(const MeshTextures& textures, const std::vector<TextureImage>& images);

}  // namespace fw
