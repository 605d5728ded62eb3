#include "runtime/export/texture_files.h"

#include <stb/stb_image_write.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <string_view>

#include "graph/base/parallel.h"
#include "runtime/export/formats.h"

namespace fw {
namespace {

constexpr char kBaseColor[] = "base_color", kSurface[] = "occlusion_roughness_metallic", kNormal[] = "normal",
               kEmission[] = "emission", kRoughness[] = "roughness", kMetallic[] = "metallic";

bool isObj(const std::string& path) { return lowerExtension(path) == ".obj"; }

std::vector<const char*> rolesOf(const std::string& path) {
    if (isObj(path)) return {kBaseColor, kRoughness, kMetallic, kNormal, kEmission};
    return {kBaseColor, kSurface, kNormal, kEmission};
}

std::string fileOf(const std::string& path, const char* role, std::size_t set) {
    const std::string number = set == 0 ? "" : std::to_string(set + 1) + "_";
    return std::filesystem::path(path).stem().string() + "_" + lowerExtension(path).substr(1) + "_" + number +
           role + ".png";
}

std::string pngOf(const std::vector<uint8_t>& pixels, int size, int channels) {
    std::string png;
    const auto append = [](void* to, void* data, int bytes) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), std::size_t(bytes));
    };
    // The encoder's only failure: it has no memory left.
    if (!stbi_write_png_to_func(append, &png, size, size, channels, pixels.data(), channels * size))
        throw std::bad_alloc();
    return png;
}

std::vector<uint8_t> channelOf(const std::vector<uint8_t>& pixels, std::size_t channel) {
    std::vector<uint8_t> one(pixels.size() / 3);
    for (std::size_t i = 0; i < one.size(); ++i) one[i] = pixels[3 * i + channel];
    return one;
}

}  // namespace

bool hasTextures(const std::string& path) {
    const ExportFormat* format = exportFormat(path);
    return format && format->parts;
}

std::vector<TextureImage> textureImages(const MeshTextures& textures, const std::string& path,
                                        std::size_t set) {
    std::vector<TextureImage> images;
    for (const char* role : rolesOf(path))
        if (role != kEmission || !textures.emission.empty())
            images.push_back({role, fileOf(path, role, set), {}});
    forBlocks(images.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
        const std::string_view role = images[i].role;
        const bool one = role == kRoughness || role == kMetallic;
        images[i].png = one ? pngOf(channelOf(textures.surface, role == kRoughness ? 1 : 2), textures.size, 1)
                            : pngOf(role == kBaseColor  ? textures.baseColor
                                    : role == kNormal   ? textures.normal
                                    : role == kEmission ? textures.emission
                                                        : textures.surface,
                                    textures.size, 3);
    });
    return images;
}

uint64_t bytesOf(const std::vector<TextureImage>& images) {
    uint64_t bytes = 0;
    for (const TextureImage& image : images) bytes += image.png.size();
    return bytes;
}

std::vector<std::string> texturePaths(const std::string& path) {
    std::vector<std::string> paths;
    if (!hasTextures(path) || lowerExtension(path) == ".glb") return paths;
    for (const char* role : rolesOf(path))
        paths.push_back((std::filesystem::path(path).parent_path() / fileOf(path, role, 0)).string());
    return paths;
}

TextureNumbers addTextures(nlohmann::json& document, const std::vector<TextureImage>& images,
                           std::optional<uint64_t> inBuffer) {
    using nlohmann::json;
    TextureNumbers numbers;
    document["samplers"] = {{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33071}}};
    for (const TextureImage& image : images) {
        json entry = {{"name", image.role}};
        if (inBuffer) {
            document["bufferViews"].push_back(
                {{"buffer", 0}, {"byteOffset", *inBuffer}, {"byteLength", image.png.size()}});
            *inBuffer += image.png.size();
            entry["bufferView"] = document["bufferViews"].size() - 1;
            entry["mimeType"] = "image/png";
        } else {
            entry["uri"] = percentEncoded(image.file);
        }
        document["images"].push_back(entry);
        document["textures"].push_back({{"sampler", 0}, {"source", document["images"].size() - 1}});
        numbers[image.role] = document["textures"].size() - 1;
    }
    return numbers;
}

void showTextures(nlohmann::json& document, const MeshTextures& textures, const TextureNumbers& numbers) {
    using nlohmann::json;
    const auto shown = [&](const char* role) { return json{{"index", numbers.at(role)}}; };
    const float strength = textures.emissionStrength;
    for (json& material : document["materials"]) {
        material["pbrMetallicRoughness"] = {{"baseColorTexture", shown(kBaseColor)},
                                            {"metallicRoughnessTexture", shown(kSurface)}};
        material["occlusionTexture"] = shown(kSurface);
        material["normalTexture"] = shown(kNormal);
        if (textures.emission.empty()) continue;
        material["emissiveTexture"] = shown(kEmission);
        const double factor = std::min(strength, 1.0f);
        material["emissiveFactor"] = {factor, factor, factor};
        if (strength <= 1.0f) continue;
        material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
        json& used = document["extensionsUsed"];
        if (std::ranges::find(used, "KHR_materials_emissive_strength") == used.end())
            used.push_back("KHR_materials_emissive_strength");
    }
}

std::string textureLines(const MeshTextures& textures, const std::vector<TextureImage>& images) {
    std::string lines = "Kd 1 1 1\nPr 1\nPm 1\n";
    if (!textures.emission.empty()) {
        const std::string strength = std::to_string(textures.emissionStrength);
        lines += "Ke " + strength + " " + strength + " " + strength + "\n";
    }
    for (const TextureImage& image : images) {
        const std::string_view role = image.role;
        const char* key = role == kBaseColor   ? "map_Kd "
                          : role == kRoughness ? "map_Pr "
                          : role == kMetallic  ? "map_Pm "
                          : role == kEmission  ? "map_Ke "
                                               : "norm ";
        lines += key + image.file + "\n";
    }
    return lines;
}

}  // namespace fw
