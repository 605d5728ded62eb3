// glTF 2.0: one node, one mesh, a primitive and a material for each part of it, and where it has no parts
// one. Primitives share all vertices; their indices follow each other in one view.
//
// The JSON comes from tinygltf. The binary part is streamed beside it, block after block (positions, normals,
// colours, indices), straight from the mesh's arrays: tinygltf would hold it two more times. Colours are
// normalised 16-bit RGBA, because 8 bits of linear light band visibly in the dark and floats take twice the
// room.
//
// Parts, and not a texture of roughness and what else there is textures for: an index of refraction and an
// absorption have none, and a viewer needs to know nothing but materials.
//
// Some things the core cannot say. An emission above 1: KHR_materials_emissive_strength says it. That light
// passes through: KHR_materials_transmission, _ior and _volume say it. The last asks how thick the solid is,
// for viewers that follow no rays within: the mean length of lines through it. An index of refraction below 1
// it cannot say; 1 is written. That a mesh with doubled vertices is a solid: on request EXT_mesh_manifold
// says it, with one more primitive over the same positions, whose indices are those of all parts but for
// those that a sparse accessor replaces; its two parts stand once more as accessors, for programs that merge
// vertices by them.
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"
#include "runtime/mesh/materials.h"

namespace fw {
namespace {

/// Adds EXT_mesh_manifold. The accessors that the document has are those of its primitives, which have the
/// triangles behind each other in one view; the solid has them all.
void addManifold(nlohmann::json& document, const GltfLayout& layout) {
    using nlohmann::json;
    json& accessors = document["accessors"];
    json& object = document["meshes"][0];
    const json& primitive = object["primitives"][0];
    json solid = {{"attributes", {{"POSITION", primitive["attributes"]["POSITION"]}}},
                  {"indices", primitive["indices"]},
                  {"mode", TINYGLTF_MODE_TRIANGLES}};
    json extension;
    json indices = accessors[primitive["indices"].get<std::size_t>()];
    indices["count"] = layout.indices;
    const auto addIndices = [&](const json& accessor) {
        accessors.push_back(accessor);
        solid["indices"] = accessors.size() - 1;
    };
    if (layout.merges > 0) {
        json sparse = {{"count", layout.merges}};
        uint64_t offset = layout.bytes() - layout.merges * (4 + layout.indexSize());
        const auto part = [&](const char* accessorName, const char* sparseName, const json& componentType,
                              uint64_t bytes) {
            json& views = document["bufferViews"];
            views.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
            offset += bytes;
            accessors.push_back({{"bufferView", views.size() - 1},
                                 {"componentType", componentType},
                                 {"count", layout.merges},
                                 {"type", "SCALAR"}});
            extension[accessorName] = accessors.size() - 1;
            sparse[sparseName] = {{"bufferView", views.size() - 1}};
        };
        part("mergeIndices", "indices", TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, layout.merges * 4);
        sparse["indices"]["componentType"] = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        part("mergeValues", "values", indices["componentType"], layout.merges * layout.indexSize());
        json merged = indices;
        merged["sparse"] = sparse;
        addIndices(merged);
    } else if (object["primitives"].size() > 1) {
        addIndices(indices);
    }
    extension["manifoldPrimitive"] = solid;
    object["extensions"]["EXT_mesh_manifold"] = extension;
    document["extensionsUsed"].push_back("EXT_mesh_manifold");
}

/// Within 0..1; NaN: 0.
double unit(float value) { return value > 0.0f ? std::min(value, 1.0f) : 0.0f; }
std::vector<double> unit(glm::vec3 v) { return {unit(v.x), unit(v.y), unit(v.z)}; }

/// At least 0 and finite; NaN: 0.
float positive(float value) {
    return value > 0.0f ? std::min(value, std::numeric_limits<float>::max()) : 0.0f;
}
glm::vec3 positive(glm::vec3 v) { return {positive(v.x), positive(v.y), positive(v.z)}; }

using Extension = tinygltf::Value::Object;

tinygltf::Value numberOf(double value) { return tinygltf::Value(value); }

/// By Beer and Lambert exp(-absorption * length) of light is left: color^(length / distance), with the
/// distance after which 1/e is left of the colour that is lost soonest. So no number is too small or too
/// large, however much is absorbed.
Extension volumeOf(glm::vec3 absorption, float thickness) {
    Extension volume{{"thicknessFactor", numberOf(thickness)}};
    const glm::dvec3 lost(positive(absorption));
    const double most = std::max({lost.x, lost.y, lost.z});
    if (most == 0.0) return volume;
    tinygltf::Value::Array color;
    for (int i = 0; i < 3; ++i) color.push_back(numberOf(std::exp(-lost[i] / most)));
    volume["attenuationDistance"] = numberOf(1.0 / most);
    volume["attenuationColor"] = tinygltf::Value(color);
    return volume;
}

tinygltf::Material materialOf(const Material& from, glm::vec3 baseColor, float thickness) {
    tinygltf::Material material;
    material.pbrMetallicRoughness.baseColorFactor = unit(baseColor);
    material.pbrMetallicRoughness.baseColorFactor.push_back(1.0);
    material.pbrMetallicRoughness.roughnessFactor = unit(from.roughness);
    material.pbrMetallicRoughness.metallicFactor = unit(from.metallic);
    const glm::vec3 emission = positive(from.emission);
    const float strength = std::max({1.0f, emission.x, emission.y, emission.z});
    material.emissiveFactor = {emission.x / strength, emission.y / strength, emission.z / strength};
    const auto extend = [&](const char* name, Extension extension) {
        material.extensions[name] = tinygltf::Value(std::move(extension));
    };
    if (strength > 1.0f)
        extend("KHR_materials_emissive_strength", {{"emissiveStrength", numberOf(strength)}});
    if (const double transmission = unit(from.transmission); transmission > 0.0) {
        extend("KHR_materials_transmission", {{"transmissionFactor", numberOf(transmission)}});
        extend("KHR_materials_ior", {{"ior", numberOf(std::max(1.0f, positive(from.ior)))}});
        extend("KHR_materials_volume", volumeOf(from.absorption, thickness));
    }
    return material;
}

uint16_t unit16(float value) {
    return value > 0.0f ? static_cast<uint16_t>(std::min(value, 1.0f) * 65535.0f + 0.5f)
                        : uint16_t{0};  // NaN: 0
}

}  // namespace

GltfLayout gltfLayout(const Mesh& mesh, const Merges* merges) {
    return {.vertices = mesh.positions.size(),
            .indices = mesh.indices.size(),
            .normals = !mesh.normals.empty(),
            .colors = !mesh.colors.empty(),
            .textured = mesh.textures != nullptr,
            .solid = merges != nullptr,
            .merges = merges ? merges->entries.size() : 0,
            .thickness = transmits(mesh) ? sizeOf(mesh).meanChord() : 0.0f};
}

void writeGltfBinary(const Mesh& mesh, const GltfLayout& layout, const Merges* merges, OutputFile& file) {
    const bool asShorts = layout.shortIndices();
    file.write(std::span(mesh.positions));
    file.write(std::span(mesh.normals));
    writeGltfColors(mesh, file);
    if (layout.textured) {
        file.write(std::span(mesh.uvs));
        file.write(std::span(mesh.tangents));
    }
    writeGltfIndices(mesh.indices, asShorts, file);
    if (!merges) return;
    assert(mesh.indices.size() % 2 == 0);  // of a solid; so the entries lie at a multiple of 4
    file.write(std::span(merges->entries));
    writeGltfIndices(merges->vertices, asShorts, file);
}

std::string gltfJson(const Mesh& mesh, const GltfLayout& layout, const Bounds& bounds,
                     const std::string& name, const std::string& uri,
                     const std::vector<TextureImage>& images) {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = generatorName();

    uint64_t offset = 0;
    const auto addView = [&](uint64_t bytes, int target) {
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = offset;
        view.byteLength = bytes;
        view.target = target;
        model.bufferViews.push_back(view);
        offset += bytes;
        return static_cast<int>(model.bufferViews.size()) - 1;
    };
    const auto addAccessor = [&](int view, int componentType, int type,
                                 uint64_t count) -> tinygltf::Accessor& {
        tinygltf::Accessor accessor;
        accessor.bufferView = view;
        accessor.componentType = componentType;
        accessor.type = type;
        accessor.count = count;
        return model.accessors.emplace_back(accessor);
    };
    const auto lastAccessor = [&] { return static_cast<int>(model.accessors.size()) - 1; };

    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    tinygltf::Accessor& positions =
        addAccessor(addView(layout.vertices * 12, TINYGLTF_TARGET_ARRAY_BUFFER),
                    TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, layout.vertices);
    // A float is a double exactly and the JSON holds doubles that read back exactly.
    positions.minValues = {bounds.min.x, bounds.min.y, bounds.min.z};
    positions.maxValues = {bounds.max.x, bounds.max.y, bounds.max.z};
    primitive.attributes["POSITION"] = lastAccessor();
    if (layout.normals) {
        addAccessor(addView(layout.vertices * 12, TINYGLTF_TARGET_ARRAY_BUFFER),
                    TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, layout.vertices);
        primitive.attributes["NORMAL"] = lastAccessor();
    }
    if (layout.colors) {
        addAccessor(addView(layout.vertices * 8, TINYGLTF_TARGET_ARRAY_BUFFER),
                    TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, layout.vertices)
            .normalized = true;
        primitive.attributes["COLOR_0"] = lastAccessor();
    }
    if (layout.textured) {
        addAccessor(addView(layout.vertices * 8, TINYGLTF_TARGET_ARRAY_BUFFER), TINYGLTF_COMPONENT_TYPE_FLOAT,
                    TINYGLTF_TYPE_VEC2, layout.vertices);
        primitive.attributes["TEXCOORD_0"] = lastAccessor();
        addAccessor(addView(layout.vertices * 16, TINYGLTF_TARGET_ARRAY_BUFFER),
                    TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4, layout.vertices);
        primitive.attributes["TANGENT"] = lastAccessor();
    }
    const int indexView = addView(layout.indices * layout.indexSize(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    std::set<std::string> extensions;
    tinygltf::Mesh object;
    object.name = name;
    const glm::vec3 baseColor = layout.colors ? glm::vec3(1.0f) : mesh.baseColor;
    uint64_t written = 0;
    const auto addPart = [&](const Material& of, uint64_t indices) {
        tinygltf::Accessor& accessor =
            addAccessor(indexView,
                        layout.shortIndices() ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                              : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                        TINYGLTF_TYPE_SCALAR, indices);
        accessor.byteOffset = written * layout.indexSize();
        written += indices;
        primitive.indices = lastAccessor();
        primitive.material = static_cast<int>(model.materials.size());
        object.primitives.push_back(primitive);
        tinygltf::Material material = materialOf(of, baseColor, layout.thickness);
        material.name = partName(mesh, name, model.materials.size());
        for (const auto& extension : material.extensions) extensions.insert(extension.first);
        model.materials.push_back(material);
    };
    if (mesh.parts.empty()) addPart(mesh.material, layout.indices);
    for (const MeshPart& part : mesh.parts) addPart(part.material, 3 * part.triangles);
    model.extensionsUsed.assign(extensions.begin(), extensions.end());
    model.meshes.push_back(object);
    tinygltf::Node node;
    node.name = name;
    node.mesh = 0;
    model.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes = {0};
    model.scenes.push_back(scene);
    model.defaultScene = 0;

    std::ostringstream text;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, text, false, false);
    // tinygltf derives a buffer from bytes that it holds; ours are not in memory, so the buffer is named
    // here.
    auto document = nlohmann::json::parse(text.str());
    document["buffers"][0]["byteLength"] = layout.bytes();
    if (layout.solid) addManifold(document, layout);
    if (!images.empty()) {
        const TextureNumbers numbers =
            addTextures(document, images, uri.empty() ? std::optional(layout.bytes()) : std::nullopt);
        showTextures(document, *mesh.textures, numbers);
        if (uri.empty()) document["buffers"][0]["byteLength"] = layout.bytes() + bytesOf(images);
    }
    if (!uri.empty()) document["buffers"][0]["uri"] = uri;
    return uri.empty() ? document.dump() : document.dump(2) + "\n";
}

void writeGltfColors(const Mesh& mesh, OutputFile& file) {
    const auto formatColors = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i, out += 8) {
            const glm::vec3 c = mesh.colors[i];
            const std::array<uint16_t, 4> rgba = {unit16(c.x), unit16(c.y), unit16(c.z), 65535};
            std::memcpy(out, rgba.data(), 8);
        }
        return out;
    };
    writeBlocks(mesh.colors.size(), 8, formatColors, file);
}

void writeGltfIndices(std::span<const uint32_t> indices, bool asShorts, OutputFile& file) {
    if (!asShorts) {
        file.write(indices);
        return;
    }
    const auto narrow = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i, out += 2) {
            const auto index = static_cast<uint16_t>(indices[i]);
            std::memcpy(out, &index, 2);
        }
        return out;
    };
    writeBlocks(indices.size(), 2, narrow, file);
}

bool writeGlbHead(std::string json, uint64_t bytes, OutputFile& file) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const uint64_t padded = (bytes + 3) / 4 * 4;
    const uint64_t total = 12 + 8 + json.size() + (bytes > 0 ? 8 + padded : 0);
    if (total > 0xffffffffu) return false;
    const std::array<uint32_t, 5> head = {0x46546C67, 2, static_cast<uint32_t>(total),
                                          static_cast<uint32_t>(json.size()),
                                          0x4E4F534A};  // "glTF", version, length; length, "JSON"
    const std::array<uint32_t, 2> chunk = {static_cast<uint32_t>(padded), 0x004E4942};  // length, "BIN"
    file.write(std::span<const uint32_t>(head));
    file.write(json);
    if (bytes > 0) file.write(std::span<const uint32_t>(chunk));
    return true;
}

void writeGlbEnd(uint64_t bytes, OutputFile& file) { file.write("\0\0\0", (4 - bytes % 4) % 4); }

bool writeGlb(const Mesh& mesh, const Bounds& bounds, const std::string& name, const Merges* merges,
              const std::vector<TextureImage>& images, OutputFile& file) {
    const GltfLayout layout = gltfLayout(mesh, merges);
    const uint64_t bytes = layout.bytes() + bytesOf(images);
    if (!writeGlbHead(gltfJson(mesh, layout, bounds, name, {}, images), bytes, file)) return false;
    writeGltfBinary(mesh, layout, merges, file);
    for (const TextureImage& image : images) file.write(image.png);
    writeGlbEnd(bytes, file);
    return true;
}

void writeGltf(const Mesh& mesh, const Bounds& bounds, const std::string& name, const Merges* merges,
               const std::string& binaryUri, const std::vector<TextureImage>& images, OutputFile& file,
               OutputFile& binary) {
    const GltfLayout layout = gltfLayout(mesh, merges);
    file.write(gltfJson(mesh, layout, bounds, name, binaryUri, images));
    writeGltfBinary(mesh, layout, merges, binary);
}

void writeEmptyGltf(const std::string& name, bool binary, OutputFile& file) {
    const std::string json = nlohmann::json{
        {"asset", {{"generator", generatorName()}, {"version", "2.0"}}},
        {"nodes", {{{"name", name}}}},
        {"scene", 0},
        {"scenes",
         {{{"nodes", {0}}}}}}.dump();
    if (binary)
        writeGlbHead(json, 0, file);
    else
        file.write(json);
}

}  // namespace fw
