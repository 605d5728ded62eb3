#include "runtime/export/compress.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace fw {
namespace {

using nlohmann::json;

enum ComponentType : int { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

constexpr const char *kCode = "EXT_meshopt_compression", *kInstances = "EXT_mesh_gpu_instancing";

/// What an array of a vertex's numbers is stored as.
struct Stored {
    int type;             ///< of a component
    std::size_t numbers;  ///< a vertex has
    std::size_t stride;   ///< bytes from one to the next, a multiple of 4
};

Stored storedAs(const std::string& attribute) {
    if (attribute == "POSITION") return {kUnsignedShort, 3, 8};
    if (attribute == "NORMAL") return {kByte, 3, 4};
    if (attribute == "TANGENT") return {kByte, 4, 4};
    if (attribute.starts_with("TEXCOORD")) return {kUnsignedShort, 2, 4};
    assert(attribute == "COLOR_0");
    return {kUnsignedShort, 4, 8};
}

/// The cube from which a mesh's positions are steps.
struct Steps {
    glm::vec3 from{0.0f};
    float side = 1.0f;
};

template <class T>
T nearestStep(float value, float most) {
    return static_cast<T>(std::lround(std::clamp(value, most == 127.0f ? -1.0f : 0.0f, 1.0f) * most));
}

class GltfCompressor {
  public:
    GltfCompressor(json& document_, const std::vector<unsigned char>& given)
        : document(document_), from(given), oldViews(document_["bufferViews"]) {}

    std::vector<unsigned char> run() {
        meshopt_encodeVertexVersion(0);
        meshopt_encodeIndexVersion(1);
        document["bufferViews"] = json::array();
        std::vector<Steps> steps;
        for (const json& mesh : document["meshes"]) steps.push_back(mesh_(mesh));
        place(steps);
        keepTheRest();
        json whole = {{"byteLength", to.size()}};
        document["buffers"] = {whole,
                               {{"byteLength", decoded}, {"extensions", {{kCode, {{"fallback", true}}}}}}};
        for (const char* list : {"extensionsUsed", "extensionsRequired"})
            for (const char* extension : {"KHR_mesh_quantization", kCode})
                document[list].push_back(extension);
        return std::move(to);
    }

  private:
    /// All numbers of an accessor, each element at its place.
    const unsigned char* elements(const json& accessor) const {
        const json& view = oldViews[accessor["bufferView"].get<std::size_t>()];
        assert(!view.contains("byteStride"));
        return from.data() + view.value("byteOffset", std::size_t{0}) +
               accessor.value("byteOffset", std::size_t{0});
    }

    std::vector<uint32_t> indicesOf(const json& accessor) const {
        std::vector<uint32_t> indices(accessor["count"].get<std::size_t>());
        const unsigned char* at = elements(accessor);
        if (accessor["componentType"] == int(kUnsignedInt)) {
            std::memcpy(indices.data(), at, indices.size() * 4);
            return indices;
        }
        assert(accessor["componentType"] == int(kUnsignedShort));
        for (std::size_t i = 0; i < indices.size(); ++i) {
            uint16_t index;
            std::memcpy(&index, at + 2 * i, 2);
            indices[i] = index;
        }
        return indices;
    }

    /// Adds an array in meshoptimizer's code; its view's number.
    std::size_t addCode(std::span<const unsigned char> code, std::size_t count, std::size_t stride,
                        bool triangles) {
        json view = {{"buffer", 1},
                     {"byteOffset", decoded},
                     {"byteLength", count * stride},
                     {"target", triangles ? 34963 : 34962},
                     {"extensions",
                      {{kCode,
                        {{"buffer", 0},
                         {"byteOffset", to.size()},
                         {"byteLength", code.size()},
                         {"byteStride", stride},
                         {"count", count},
                         {"mode", triangles ? "TRIANGLES" : "ATTRIBUTES"}}}}}};
        if (!triangles) view["byteStride"] = stride;
        decoded += (count * stride + 3) / 4 * 4;
        to.insert(to.end(), code.begin(), code.end());
        to.resize((to.size() + 3) / 4 * 4);
        document["bufferViews"].push_back(std::move(view));
        return document["bufferViews"].size() - 1;
    }

    /// Writes one vertex's numbers of the attribute to `out`.
    static void quantize(const Stored& stored, const Steps& steps, bool position, const float* in,
                         unsigned char* out) {
        for (std::size_t i = 0; i < stored.numbers; ++i) {
            const float value = position ? (in[i] - steps.from[int(i)]) / steps.side : in[i];
            if (stored.type == kByte) {
                out[i] = static_cast<unsigned char>(nearestStep<int8_t>(value, 127.0f));
            } else {
                const auto step = nearestStep<uint16_t>(value, 65535.0f);
                std::memcpy(out + 2 * i, &step, 2);
            }
        }
    }

    void attribute(const std::string& name, json& accessor, const Steps& steps,
                   const std::vector<uint32_t>& places, std::size_t count) {
        const Stored stored = storedAs(name);
        std::vector<unsigned char> packed(count * stored.stride);
        const unsigned char* at = elements(accessor);
        const bool floats = accessor["componentType"] == int(kFloat);
        const std::size_t size = floats ? stored.numbers * 4 : stored.stride;
        for (std::size_t vertex = 0; vertex < places.size(); ++vertex) {
            if (places[vertex] == ~0u) continue;
            unsigned char* out = &packed[places[vertex] * stored.stride];
            if (!floats) {
                std::memcpy(out, at + vertex * size, size);
                continue;
            }
            std::array<float, 4> numbers{};
            std::memcpy(numbers.data(), at + vertex * size, size);
            quantize(stored, steps, name == "POSITION", numbers.data(), out);
        }
        if (name == "POSITION") {
            std::array<uint16_t, 3> least{65535, 65535, 65535}, greatest{};
            for (std::size_t vertex = 0; vertex < count; ++vertex)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    uint16_t step;
                    std::memcpy(&step, &packed[vertex * stored.stride + 2 * axis], 2);
                    least[axis] = std::min(least[axis], step);
                    greatest[axis] = std::max(greatest[axis], step);
                }
            accessor["min"] = least, accessor["max"] = greatest;
        }
        std::vector<unsigned char> code(meshopt_encodeVertexBufferBound(count, stored.stride));
        code.resize(
            meshopt_encodeVertexBuffer(code.data(), code.size(), packed.data(), count, stored.stride));
        accessor["bufferView"] = addCode(code, count, stored.stride, false);
        accessor["componentType"] = stored.type;
        accessor["normalized"] = true;
        accessor["count"] = count;
        accessor.erase("byteOffset");
    }

    /// The primitives that have the same vertices: numbered anew, together.
    void vertices(const json& attributes, const std::vector<const json*>& primitives, const Steps& steps) {
        json& accessors = document["accessors"];
        const std::size_t vertexCount = accessors[attributes["POSITION"].get<std::size_t>()]["count"];
        std::vector<std::vector<uint32_t>> lists;
        std::vector<uint32_t> all;
        for (const json* primitive : primitives) {
            std::vector<uint32_t> list = indicesOf(accessors[(*primitive)["indices"].get<std::size_t>()]);
            meshopt_optimizeVertexCache(list.data(), list.data(), list.size(), vertexCount);
            all.insert(all.end(), list.begin(), list.end());
            lists.push_back(std::move(list));
        }
        std::vector<uint32_t> places(vertexCount);
        const std::size_t count =
            meshopt_optimizeVertexFetchRemap(places.data(), all.data(), all.size(), vertexCount);
        for (const auto& [name, accessor] : attributes.items())
            attribute(name, accessors[accessor.get<std::size_t>()], steps, places, count);
        const std::size_t size = count <= 65535 ? 2 : 4;
        for (std::size_t i = 0; i < lists.size(); ++i) {
            std::vector<uint32_t>& list = lists[i];
            for (uint32_t& index : list) index = places[index];
            std::vector<unsigned char> code(meshopt_encodeIndexBufferBound(list.size(), count));
            code.resize(meshopt_encodeIndexBuffer(code.data(), code.size(), list.data(), list.size()));
            json& accessor = accessors[(*primitives[i])["indices"].get<std::size_t>()];
            accessor["bufferView"] = addCode(code, list.size(), size, true);
            accessor["componentType"] = size == 2 ? int(kUnsignedShort) : int(kUnsignedInt);
            accessor.erase("byteOffset");
        }
    }

    Steps mesh_(const json& mesh) {
        glm::vec3 least(INFINITY), greatest(-INFINITY);
        std::map<std::string, std::vector<const json*>> sets;  // by their attributes
        for (const json& primitive : mesh["primitives"]) {
            sets[primitive["attributes"].dump()].push_back(&primitive);
            const json& accessor =
                document["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
            for (int axis = 0; axis < 3; ++axis) {
                least[axis] = std::min(least[axis], accessor["min"][std::size_t(axis)].get<float>());
                greatest[axis] = std::max(greatest[axis], accessor["max"][std::size_t(axis)].get<float>());
            }
        }
        const glm::vec3 size = greatest - least;
        const float side = std::max({size.x, size.y, size.z});
        const Steps steps{least, side > 0.0f ? side : 1.0f};
        for (const auto& [attributes, primitives] : sets)
            vertices(json::parse(attributes), primitives, steps);
        return steps;
    }

    /// A node's move and size, which come to be those of its mesh's cube in it.
    static void placeIn(const Steps& cube, glm::vec4 turn, glm::vec3& move, glm::vec3& size) {
        move += glm::quat(turn.w, turn.x, turn.y, turn.z) * (size * cube.from);
        size *= cube.side;
    }

    /// Each instance's transform is the outer one: the cube goes into all of them.
    void placeInstances(const json& attributes, const Steps& cube) {
        const auto number = [&](const char* key) { return attributes[key].get<std::size_t>(); };
        json& moves = document["accessors"][number("TRANSLATION")];
        json& sizes = document["accessors"][number("SCALE")];
        const unsigned char* const turns = elements(document["accessors"][number("ROTATION")]);
        const auto count = moves["count"].get<std::size_t>();
        std::vector<glm::vec3> move(count), size(count);
        std::memcpy(move.data(), elements(moves), count * sizeof(glm::vec3));
        std::memcpy(size.data(), elements(sizes), count * sizeof(glm::vec3));
        for (std::size_t i = 0; i < count; ++i) {
            glm::vec4 turn;
            std::memcpy(&turn, turns + i * sizeof turn, sizeof turn);
            placeIn(cube, turn, move[i], size[i]);
        }
        for (const auto& [accessor, values] : {std::pair(&moves, &move), std::pair(&sizes, &size)}) {
            (*accessor)["bufferView"] = addPlain(values->data(), count * sizeof(glm::vec3));
            placed.insert(std::size_t(accessor - &document["accessors"][0]));
        }
    }

    /// Adds bytes as they are; their view's number.
    std::size_t addPlain(const void* bytes, std::size_t size) {
        document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", to.size()}, {"byteLength", size}});
        const auto* first = static_cast<const unsigned char*>(bytes);
        to.insert(to.end(), first, first + size);
        to.resize((to.size() + 3) / 4 * 4);
        return document["bufferViews"].size() - 1;
    }

    /// Puts the meshes' cubes into the nodes that show them.
    void place(const std::vector<Steps>& steps) {
        std::set<std::size_t> moving;
        for (const json& animation : document.value("animations", json::array()))
            for (const json& channel : animation["channels"])
                moving.insert(channel["target"]["node"].get<std::size_t>());
        json& nodes = document["nodes"];
        for (std::size_t i = 0, count = nodes.size(); i < count; ++i) {
            if (!nodes[i].contains("mesh")) continue;
            const auto mesh = nodes[i]["mesh"].get<std::size_t>();
            if (const auto extensions = nodes[i].find("extensions");
                extensions != nodes[i].end() && extensions->contains(kInstances)) {
                placeInstances((*extensions)[kInstances]["attributes"], steps[mesh]);
                continue;
            }
            const bool free = !moving.contains(i) && !nodes[i].contains("children");
            std::size_t node = i;
            if (!free) {
                node = nodes.size();
                nodes.push_back({{"name", nodes[i].value("name", std::string()) + "_mesh"}, {"mesh", mesh}});
                nodes[i].erase("mesh");
                nodes[i]["children"].push_back(node);
            }
            const auto numbers = [&](const char* key, auto none) {
                if (const auto own = nodes[node].find(key); own != nodes[node].end())
                    for (std::size_t k = 0; k < own->size(); ++k) none[int(k)] = (*own)[k].get<float>();
                return none;
            };
            glm::vec3 move = numbers("translation", glm::vec3(0)), size = numbers("scale", glm::vec3(1));
            placeIn(steps[mesh], numbers("rotation", glm::vec4(0, 0, 0, 1)), move, size);
            nodes[node]["translation"] = {move.x, move.y, move.z};
            nodes[node]["scale"] = {size.x, size.y, size.z};
        }
    }

    /// Pictures, times and transforms stay what they are.
    void keepTheRest() {
        std::map<std::size_t, std::size_t> numbers;
        const auto keep = [&](json& user) {
            const auto old = user["bufferView"].get<std::size_t>();
            const auto [number, fresh] = numbers.emplace(old, document["bufferViews"].size());
            user["bufferView"] = number->second;
            if (!fresh) return;
            json view = oldViews[old];
            const auto first = from.begin() + std::ptrdiff_t(view.value("byteOffset", std::size_t{0}));
            view["byteOffset"] = to.size();
            to.insert(to.end(), first, first + view["byteLength"].get<std::ptrdiff_t>());
            to.resize((to.size() + 3) / 4 * 4);
            document["bufferViews"].push_back(std::move(view));
        };
        std::set<std::size_t> arrays;  // of meshes, which are in code by now
        for (const json& mesh : document["meshes"])
            for (const json& primitive : mesh["primitives"]) {
                arrays.insert(primitive["indices"].get<std::size_t>());
                for (const auto& attribute : primitive["attributes"])
                    arrays.insert(attribute.get<std::size_t>());
            }
        for (std::size_t i = 0; i < document["accessors"].size(); ++i)
            if (!arrays.contains(i) && !placed.contains(i)) keep(document["accessors"][i]);
        if (document.contains("images"))
            for (json& image : document["images"])
                if (image.contains("bufferView")) keep(image);
    }

    json& document;
    const std::vector<unsigned char>& from;
    const json oldViews;
    std::vector<unsigned char> to;
    std::size_t decoded = 0;       ///< bytes that a decoder makes of them
    std::set<std::size_t> placed;  ///< accessors of instances that have the meshes' cubes in them
};

}  // namespace

void compressGltf(json& document, std::vector<unsigned char>& bytes) {
    bytes = GltfCompressor(document, bytes).run();
}

}  // namespace fw
