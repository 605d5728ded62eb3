// A mesh's textures as PNG: in a GLB, or as files beside a glTF or an OBJ.
//
// glTF has one picture for occlusion, roughness and metallic, in red, green and blue. A .mtl has one for
// each, and a word for none of occlusion. Files are called by the mesh file's whole name, so that a glTF and
// an OBJ of one stem keep theirs apart: lamp_gltf_base_color.png.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace fw {

struct TextureImage {
    const char* role;  ///< "base_color"
    std::string file;  ///< its name
    std::string png;
};

/// Those that a file of that path, whose format hasTextures(), has.
std::vector<TextureImage> textureImages(const MeshTextures& textures, const std::string& path);

/// Whether the format of that path holds textures.
bool hasTextures(const std::string& path);

/// Files of textures that a mesh file of that path may have beside it; none of a GLB.
std::vector<std::string> texturePaths(const std::string& path);

/// Makes the materials of a glTF show the textures, which lie in its buffer behind all else, or in files.
void addTextures(nlohmann::json& document, const MeshTextures& textures,
                 const std::vector<TextureImage>& images, bool inBuffer);

/// The lines of a .mtl that name the images, for each of its materials.
std::string textureLines(const MeshTextures& textures, const std::vector<TextureImage>& images);

}  // namespace fw
