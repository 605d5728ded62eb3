// glTF 2.0, core features only: one node, one mesh, one primitive, one material.
//
// The JSON comes from tinygltf. The binary part is streamed beside it, block after block (positions, normals,
// colours, indices), straight from the mesh's arrays: tinygltf would hold it two more times. Colours are
// normalised 16-bit RGBA, because 8 bits of linear light band visibly in the dark and floats take twice the
// room.
//
// Two things the core cannot say. An emission above 1: KHR_materials_emissive_strength says it. That a mesh
// with doubled vertices is a solid: on request EXT_mesh_manifold says it, with a second primitive over the
// same positions, whose indices are the first's but for those that a sparse accessor replaces; its two parts
// stand once more as accessors, for programs that merge vertices by them.
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"

namespace fw {
namespace {

GltfLayout layoutOf(const Mesh& mesh, const Merges* merges) {
    return {.vertices = mesh.positions.size(),
            .indices = mesh.indices.size(),
            .normals = !mesh.normals.empty(),
            .colors = !mesh.colors.empty(),
            .solid = merges != nullptr,
            .merges = merges ? merges->entries.size() : 0};
}

/// Adds EXT_mesh_manifold. The accessors that the document has are those of its one primitive.
void addManifold(nlohmann::json& document, const GltfLayout& layout) {
    using nlohmann::json;
    json& accessors = document["accessors"];
    json& object = document["meshes"][0];
    const json& primitive = object["primitives"][0];
    json solid = {{"attributes", {{"POSITION", primitive["attributes"]["POSITION"]}}},
                  {"indices", primitive["indices"]},
                  {"mode", TINYGLTF_MODE_TRIANGLES}};
    json extension;
    if (layout.merges > 0) {
        const json indices = accessors[primitive["indices"].get<std::size_t>()];
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
        accessors.push_back(merged);
        solid["indices"] = accessors.size() - 1;
    }
    extension["manifoldPrimitive"] = solid;
    object["extensions"]["EXT_mesh_manifold"] = extension;
    document["extensionsUsed"].push_back("EXT_mesh_manifold");
}

tinygltf::Material materialOf(const Mesh& mesh, bool colors) {
    tinygltf::Material material;
    const glm::vec3 color = colors ? glm::vec3(1.0f) : mesh.baseColor;
    material.pbrMetallicRoughness.baseColorFactor = {std::clamp(color.x, 0.0f, 1.0f),
                                                     std::clamp(color.y, 0.0f, 1.0f),
                                                     std::clamp(color.z, 0.0f, 1.0f), 1.0};
    material.pbrMetallicRoughness.roughnessFactor = std::clamp(mesh.roughness, 0.0f, 1.0f);
    material.pbrMetallicRoughness.metallicFactor = std::clamp(mesh.metallic, 0.0f, 1.0f);
    const glm::vec3 emission = glm::max(mesh.emission, glm::vec3(0.0f));
    const float strength = std::max({1.0f, emission.x, emission.y, emission.z});
    material.emissiveFactor = {emission.x / strength, emission.y / strength, emission.z / strength};
    if (strength > 1.0f) {
        tinygltf::Value::Object value{{"emissiveStrength", tinygltf::Value(static_cast<double>(strength))}};
        material.extensions["KHR_materials_emissive_strength"] = tinygltf::Value(value);
    }
    return material;
}

uint16_t unit16(float value) {
    return value > 0.0f ? static_cast<uint16_t>(std::min(value, 1.0f) * 65535.0f + 0.5f)
                        : uint16_t{0};  // NaN: 0
}

void writeBinary(const Mesh& mesh, const Merges* merges, OutputFile& file) {
    const bool asShorts = layoutOf(mesh, merges).shortIndices();
    file.write(std::span(mesh.positions));
    file.write(std::span(mesh.normals));
    writeGltfColors(mesh, file);
    writeGltfIndices(mesh.indices, asShorts, file);
    if (!merges) return;
    assert(mesh.indices.size() % 2 == 0);  // of a solid; so the entries lie at a multiple of 4
    file.write(std::span(merges->entries));
    writeGltfIndices(merges->vertices, asShorts, file);
}

}  // namespace

std::string gltfJson(const Mesh& mesh, const GltfLayout& layout, const Bounds& bounds,
                     const std::string& name, const std::string& uri) {
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
    primitive.material = 0;
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
    addAccessor(
        addView(layout.indices * layout.indexSize(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER),
        layout.shortIndices() ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
        TINYGLTF_TYPE_SCALAR, layout.indices);
    primitive.indices = lastAccessor();

    tinygltf::Material material = materialOf(mesh, layout.colors);
    material.name = name;
    for (const auto& extension : material.extensions) model.extensionsUsed.push_back(extension.first);
    model.materials.push_back(material);
    tinygltf::Mesh object;
    object.name = name;
    object.primitives.push_back(primitive);
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

bool writeGlbHead(const Mesh& mesh, const GltfLayout& layout, const Bounds& bounds, const std::string& name,
                  OutputFile& file) {
    std::string json = gltfJson(mesh, layout, bounds, name, {});
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const uint64_t padded = (layout.bytes() + 3) / 4 * 4;
    const uint64_t total = 12 + 8 + json.size() + 8 + padded;
    if (total > 0xffffffffu) return false;
    const std::array<uint32_t, 5> head = {0x46546C67, 2, static_cast<uint32_t>(total),
                                          static_cast<uint32_t>(json.size()),
                                          0x4E4F534A};  // "glTF", version, length; length, "JSON"
    const std::array<uint32_t, 2> chunk = {static_cast<uint32_t>(padded), 0x004E4942};  // length, "BIN"
    file.write(std::span<const uint32_t>(head));
    file.write(json);
    file.write(std::span<const uint32_t>(chunk));
    return true;
}

void writeGlbEnd(const GltfLayout& layout, OutputFile& file) {
    file.write("\0\0\0", (4 - layout.bytes() % 4) % 4);
}

bool writeGlb(const Mesh& mesh, const Bounds& bounds, const std::string& name, const Merges* merges,
              OutputFile& file) {
    const GltfLayout layout = layoutOf(mesh, merges);
    if (!writeGlbHead(mesh, layout, bounds, name, file)) return false;
    writeBinary(mesh, merges, file);
    writeGlbEnd(layout, file);
    return true;
}

void writeGltf(const Mesh& mesh, const Bounds& bounds, const std::string& name, const Merges* merges,
               const std::string& binaryUri, OutputFile& file, OutputFile& binary) {
    file.write(gltfJson(mesh, layoutOf(mesh, merges), bounds, name, binaryUri));
    writeBinary(mesh, merges, binary);
}

}  // namespace fw
