#include "runtime/measure/readers.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace fw {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxJsonBytes = 16u << 20;  // ours has about 1 KiB
constexpr int kMaxJsonDepth = 64;
constexpr const char* kInstances = "EXT_mesh_gpu_instancing";

/// nlohmann's parser keeps its own stack, but its destructor and callers recurse: bound the depth beforehand.
bool tooDeep(std::string_view text) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMaxJsonDepth) return true;
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return false;
}

/// The member as a count or index; `fallback` if it is absent; nothing if it is not a whole number >= 0.
std::optional<uint64_t> whole(const json& object, const char* key,
                              std::optional<uint64_t> fallback = std::nullopt) {
    if (!object.is_object()) return std::nullopt;
    const auto member = object.find(key);
    if (member == object.end()) return fallback;
    if (!member->is_number_unsigned()) return std::nullopt;
    return member->get<uint64_t>();
}

/// The entry `index` of the array named `key`; nullptr if there is none or it is not an object.
const json* entry(const json& document, const char* key, uint64_t index) {
    const auto array = document.find(key);
    if (array == document.end() || !array->is_array() || index >= array->size()) return nullptr;
    const json& value = (*array)[index];
    return value.is_object() ? &value : nullptr;
}

/// The data of an accessor: `count` elements, `stride` bytes apart, the last one whole inside `bytes`.
struct Elements {
    Bytes bytes;
    uint64_t count = 0, stride = 0;
    uint64_t componentType = 0;
    bool normalized = false;

    /// The vector at a place of `count`; whole numbers as the core specification and KHR_mesh_quantization
    /// have them.
    glm::vec3 vector(uint64_t i) const {
        if (componentType == kFloat) return load<glm::vec3>(bytes, i * stride);
        glm::vec3 v;
        for (uint64_t k = 0; k < 3; ++k) v[int(k)] = component(i * stride, k);
        return v;
    }
    static constexpr uint64_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                              kUnsignedInt = 5125, kFloat = 5126;
    static uint64_t bytesOf(uint64_t componentType) {
        switch (componentType) {
            case kByte:
            case kUnsignedByte: return 1;
            case kShort:
            case kUnsignedShort: return 2;
            case kUnsignedInt:
            case kFloat: return 4;
            default: return 0;
        }
    }

  private:
    float component(uint64_t at, uint64_t k) const {
        const auto signedShare = [&](float value, float most) {
            return normalized ? std::max(value / most, -1.0f) : value;
        };
        switch (componentType) {
            case kByte: return signedShare(load<int8_t>(bytes, at + k), 127.0f);
            case kUnsignedByte: return signedShare(load<uint8_t>(bytes, at + k), 255.0f);
            case kShort: return signedShare(load<int16_t>(bytes, at + 2 * k), 32767.0f);
            case kUnsignedShort: return signedShare(load<uint16_t>(bytes, at + 2 * k), 65535.0f);
            default: return float(load<uint32_t>(bytes, at + 4 * k));
        }
    }
};

constexpr const char* kMeshCode = "EXT_meshopt_compression";
/// Its coder makes at most so many bytes of one: 2 bits for 16 bytes that are all the same.
constexpr uint64_t kMostOfACode = 64;

struct GltfReader {
    const json& document;
    const std::vector<Bytes>& buffers;
    const Fault& fault;
    /// Of the vertices of the accessor that was read last: the parts of a mesh mostly share theirs.
    std::optional<uint64_t> numbered = {};
    std::vector<uint32_t> numbers = {};
    glm::mat4 transform{1.0f};                                    ///< of the node that is read
    std::map<uint64_t, std::vector<unsigned char>> decoded = {};  ///< views, by their number

    /// What a view holds in meshoptimizer's code.
    Result<Bytes> decode(uint64_t number, const json& code) {
        if (const auto there = decoded.find(number); there != decoded.end()) return Bytes(there->second);
        const auto buffer = whole(code, "buffer"), start = whole(code, "byteOffset", 0),
                   length = whole(code, "byteLength"), stride = whole(code, "byteStride"),
                   count = whole(code, "count");
        if (!buffer || *buffer >= buffers.size() || !start || !length || !stride || !count || *stride == 0 ||
            *stride > 256)
            return fault("compressed data is malformed");
        const Bytes& bytes = buffers[*buffer];
        if (*start > bytes.size() || *length > bytes.size() - *start)
            return fault("compressed data leaves its buffer");
        const Bytes from = bytes.subspan(*start, *length);
        if (*count > (kMostOfACode * from.size() + 4096) / *stride)
            return fault("compressed data is too short for what it is said to hold");
        const json mode = code.value("mode", json());
        const bool triangles = mode == "TRIANGLES";
        std::vector<unsigned char> to(*count * *stride);
        int failed = 1;
        if (triangles && *count % 3 == 0 && (*stride == 2 || *stride == 4))
            failed = meshopt_decodeIndexBuffer(to.data(), *count, *stride, from.data(), from.size());
        else if (mode == "ATTRIBUTES" && *stride % 4 == 0 && !code.contains("filter"))
            failed = meshopt_decodeVertexBuffer(to.data(), *count, *stride, from.data(), from.size());
        if (failed) return fault("compressed data cannot be decoded");
        return Bytes(decoded.emplace(number, std::move(to)).first->second);
    }

    Result<Elements> elements(uint64_t index, const std::string& type) {
        const json* accessor = entry(document, "accessors", index);
        if (!accessor) return fault("an accessor is missing");
        if (accessor->contains("sparse")) return fault("sparse accessors are not read back");
        if (accessor->value("type", json()) != json(type)) return fault("an accessor is not of type " + type);
        Elements found;
        found.componentType = whole(*accessor, "componentType").value_or(0);
        found.normalized = accessor->value("normalized", json()) == json(true);
        const uint64_t componentBytes = Elements::bytesOf(found.componentType);
        if (componentBytes == 0) return fault("an accessor has an unknown component type");
        const uint64_t elementBytes = componentBytes * (type == "VEC4" ? 4 : type == "VEC3" ? 3 : 1);
        const auto viewIndex = whole(*accessor, "bufferView");
        const auto count = whole(*accessor, "count");
        const auto offset = whole(*accessor, "byteOffset", 0);
        const json* view = viewIndex ? entry(document, "bufferViews", *viewIndex) : nullptr;
        if (!view || !count || !offset || *count == 0)
            return fault("an accessor lacks its view or its count");
        const auto extensions = view->find("extensions");
        const json* code = nullptr;
        if (extensions != view->end() && extensions->is_object() && extensions->contains(kMeshCode))
            code = &(*extensions)[kMeshCode];
        const auto buffer = code ? std::optional<uint64_t>(0) : whole(*view, "buffer");
        const auto start = code ? std::optional<uint64_t>(0) : whole(*view, "byteOffset", 0);
        const auto length = whole(*view, "byteLength");
        const auto stride = whole(*view, "byteStride", elementBytes);
        if (!buffer || (!code && *buffer >= buffers.size()) || !start || !length || !stride ||
            *stride < elementBytes || *stride > 252)
            return fault("a buffer view is malformed");
        const Result<Bytes> stored = code ? decode(*viewIndex, *code) : Result<Bytes>(buffers[*buffer]);
        if (!stored) return stored.error();
        const Bytes& bytes = *stored;
        if (*start > bytes.size() || *length > bytes.size() - *start)
            return fault("a buffer view leaves its buffer");
        if (*offset > *length || elementBytes > *length - *offset ||
            *count - 1 > (*length - *offset - elementBytes) / *stride)
            return fault("an accessor leaves its buffer view");
        found.bytes = bytes.subspan(*start + *offset, *length - *offset);
        found.count = *count;
        found.stride = *stride;
        return found;
    }

    Done number(uint64_t position, Welder& welder) {
        if (numbered == position) return done();
        const Result<Elements> points = elements(position, "VEC3");
        if (!points) return points.error();
        numbered.reset();
        numbers.resize(points->count);
        welder.expect(points->count);
        for (uint64_t i = 0; i < points->count; ++i) {
            const auto p = glm::vec3(transform * glm::vec4(points->vector(i), 1.0f));
            if (!finite(p)) return fault("vertex " + std::to_string(i) + " is not finite");
            numbers[i] = welder.add(p);
        }
        numbered = position;
        return done();
    }

    Done primitive(const json& part, Welder& welder, std::vector<uint32_t>& indices) {
        if (whole(part, "mode", 4) != std::optional<uint64_t>(4))
            return fault("only triangle lists are read back");
        const auto attributes = part.find("attributes");
        const auto position = attributes != part.end() ? whole(*attributes, "POSITION") : std::nullopt;
        if (!position) return fault("a primitive has no positions");
        if (const Done read = number(*position, welder); !read) return read;
        if (!part.contains("indices")) {
            indices.insert(indices.end(), numbers.begin(),
                           numbers.begin() + static_cast<long>(numbers.size() / 3 * 3));
            return done();
        }
        const auto accessor = whole(part, "indices");
        if (!accessor) return fault("a primitive's indices are malformed");
        const Result<Elements> list = elements(*accessor, "SCALAR");
        if (!list) return list.error();
        if (list->componentType != Elements::kUnsignedByte &&
            list->componentType != Elements::kUnsignedShort && list->componentType != Elements::kUnsignedInt)
            return fault("indices are not whole numbers");
        if (list->count % 3 != 0) return fault("the number of indices is no multiple of three");
        indices.reserve(indices.size() + list->count);
        for (uint64_t i = 0; i < list->count; ++i) {
            const std::size_t at = i * list->stride;
            const uint32_t index =
                list->componentType == Elements::kUnsignedByte    ? load<uint8_t>(list->bytes, at)
                : list->componentType == Elements::kUnsignedShort ? load<uint16_t>(list->bytes, at)
                                                                  : load<uint32_t>(list->bytes, at);
            if (index >= numbers.size())
                return fault("index " + std::to_string(i) + " names a vertex that is not there");
            indices.push_back(numbers[index]);
        }
        return done();
    }
};

Result<json> parseDocument(const Bytes& bytes, const Fault& fault) {
    if (bytes.size() > kMaxJsonBytes) return fault("its JSON is larger than 16 MiB");
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (tooDeep(text)) return fault("its JSON is nested deeper than 64");
    json document = json::parse(text, nullptr, false);
    if (!document.is_object()) return fault("its JSON is malformed");
    const json* asset = document.contains("asset") ? &document["asset"] : nullptr;
    if (!asset || !asset->is_object() || asset->value("version", json()) != json("2.0"))
        return fault("it is not of glTF version 2.0");
    for (const json& extension : document.value("extensionsRequired", json::array()))
        if (extension != kMeshCode && extension != kInstances && extension != "KHR_mesh_quantization")
            return fault("it requires an extension that is not read back");
    return document;
}

/// The member as so many numbers; nothing if it is malformed.
template <std::size_t N>
std::optional<std::array<float, N>> numbersOf(const json& node, const char* key,
                                              std::array<float, N> fallback) {
    const auto member = node.find(key);
    if (member == node.end()) return fallback;
    if (!member->is_array() || member->size() != N) return std::nullopt;
    for (std::size_t i = 0; i < N; ++i) {
        if (!(*member)[i].is_number()) return std::nullopt;
        fallback[i] = (*member)[i].get<float>();
    }
    return fallback;
}

/// Whether the node's name ends as that of a level of detail behind the finest, _LOD1 and on: it stands where
/// that one does.
bool isCoarserLevel(const json& node) {
    const auto name = node.find("name");
    if (name == node.end() || !name->is_string()) return false;
    const auto& text = name->get_ref<const std::string&>();
    const std::size_t last = text.rfind("_LOD");
    if (last == std::string::npos) return false;
    const std::string_view number = std::string_view(text).substr(last + 4);
    return !number.empty() && number != "0" &&
           number.find_first_not_of("0123456789") == std::string_view::npos;
}

glm::mat4 transformOf(glm::vec3 move, glm::vec4 turn, glm::vec3 size) {
    glm::mat4 transform = glm::mat4_cast(glm::quat(turn.w, turn.x, turn.y, turn.z));
    for (int axis = 0; axis < 3; ++axis) transform[axis] *= size[axis];
    transform[3] = glm::vec4(move, 1.0f);
    return transform;
}

/// The nodes of the scene, and what of meshes they show.
struct SceneReader {
    GltfReader reader;
    Welder welder{1024};
    WeldedMesh welded = {};
    uint64_t visited = 0;

    Done mesh(const json& of, const glm::mat4& transform) {
        if (!of.is_object() || !of.contains("primitives") || !of["primitives"].is_array())
            return reader.fault("a mesh has no primitives");
        reader.transform = transform;
        reader.numbered.reset();
        const std::size_t before = welded.indices.size();
        for (const json& part : of["primitives"]) {
            if (!part.is_object()) return reader.fault("a primitive is malformed");
            if (Done read = reader.primitive(part, welder, welded.indices); !read) return read;
        }
        if (glm::determinant(glm::mat3(transform)) < 0.0f)  // then they wind the other way, and show the same
            for (std::size_t i = before; i < welded.indices.size(); i += 3)
                std::swap(welded.indices[i + 1], welded.indices[i + 2]);
        return done();
    }

    /// The mesh at each place that the node's instances have.
    Done instances(const json& of, const json& attributes, const glm::mat4& transform) {
        std::array<std::optional<Elements>, 3> read;
        constexpr std::array<const char*, 3> kNames = {"TRANSLATION", "ROTATION", "SCALE"};
        for (std::size_t i = 0; i < 3; ++i) {
            if (!attributes.is_object() || !attributes.contains(kNames[i])) continue;
            const auto number = whole(attributes, kNames[i]);
            if (!number) return reader.fault("instances are malformed");
            const Result<Elements> list = reader.elements(*number, i == 1 ? "VEC4" : "VEC3");
            if (!list) return list.error();
            if (list->componentType != Elements::kFloat)
                return reader.fault("instances that are no floats are not read back");
            read[i] = *list;
        }
        uint64_t count = 0;
        for (const auto& list : read)
            if (list) {
                if (count != 0 && count != list->count) return reader.fault("instances are malformed");
                count = list->count;
            }
        for (uint64_t i = 0; i < count; ++i) {
            const glm::vec3 move = read[0] ? read[0]->vector(i) : glm::vec3(0),
                            size = read[2] ? read[2]->vector(i) : glm::vec3(1);
            const glm::vec4 turn =
                read[1] ? load<glm::vec4>(read[1]->bytes, i * read[1]->stride) : glm::vec4(0, 0, 0, 1);
            if (Done shown = mesh(of, transform * transformOf(move, turn, size)); !shown) return shown;
        }
        return done();
    }

    Done node(uint64_t number, const glm::mat4& parent, int depth) {
        const json* of = entry(reader.document, "nodes", number);
        if (!of) return reader.fault("a node is missing");
        if (depth > kMaxJsonDepth || ++visited > reader.document["nodes"].size())
            return reader.fault("its nodes are no tree, or a deep one");
        if (isCoarserLevel(*of)) return done();
        if (of->contains("matrix")) return reader.fault("nodes with matrices are not read back");
        const auto move = numbersOf<3>(*of, "translation", {0, 0, 0}),
                   size = numbersOf<3>(*of, "scale", {1, 1, 1});
        const auto turn = numbersOf<4>(*of, "rotation", {0, 0, 0, 1});
        if (!move || !size || !turn) return reader.fault("a node's transform is malformed");
        const auto vector = [](const std::array<float, 3>& v) { return glm::vec3(v[0], v[1], v[2]); };
        const glm::mat4 transform =
            parent *
            transformOf(vector(*move), {(*turn)[0], (*turn)[1], (*turn)[2], (*turn)[3]}, vector(*size));
        if (const auto shown = of->find("mesh"); shown != of->end()) {
            const json* named =
                shown->is_number_unsigned() ? entry(reader.document, "meshes", *shown) : nullptr;
            if (!named) return reader.fault("a node's mesh is missing");
            const json extensions = of->value("extensions", json::object());
            const bool many = extensions.is_object() && extensions.contains(kInstances) &&
                              extensions[kInstances].is_object();
            Done read = many
                            ? instances(*named, extensions[kInstances].value("attributes", json()), transform)
                            : mesh(*named, transform);
            if (!read) return read;
        }
        return nodes(*of, "children", transform, depth + 1);
    }

    Done nodes(const json& holder, const char* key, const glm::mat4& parent, int depth) {
        const auto list = holder.find(key);
        if (list == holder.end()) return done();
        if (!list->is_array()) return reader.fault("a list of nodes is malformed");
        for (const json& number : *list) {
            if (!number.is_number_unsigned()) return reader.fault("a list of nodes is malformed");
            if (Done read = node(number, parent, depth); !read) return read;
        }
        return done();
    }
};

Result<WeldedMesh> readMeshes(const json& document, const std::vector<Bytes>& buffers, const Fault& fault) {
    const auto meshes = document.find("meshes");
    if (meshes == document.end() || !meshes->is_array()) return fault("it holds no mesh");
    SceneReader scene{{document, buffers, fault}};
    const json* shown = entry(document, "scenes", whole(document, "scene", 0).value_or(0));
    if (shown) {
        if (Done read = scene.nodes(*shown, "nodes", glm::mat4(1.0f), 0); !read) return read.error();
    } else {
        for (const json& mesh : *meshes)
            if (Done read = scene.mesh(mesh, glm::mat4(1.0f)); !read) return read.error();
    }
    scene.welded.positions = scene.welder.take();
    return std::move(scene.welded);
}

}  // namespace

Result<WeldedMesh> readGlb(const Bytes& bytes, const Fault& fault) {
    if (bytes.size() < 20 || load<uint32_t>(bytes, 0) != 0x46546C67) return fault("not a GLB");
    if (load<uint32_t>(bytes, 4) != 2) return fault("not a GLB of version 2");
    if (load<uint32_t>(bytes, 8) != bytes.size())
        return fault("the length in its header is not that of the file");
    const uint64_t jsonBytes = load<uint32_t>(bytes, 12);
    if (load<uint32_t>(bytes, 16) != 0x4E4F534A || jsonBytes > bytes.size() - 20)
        return fault("its JSON chunk is malformed");
    const Result<json> document = parseDocument(bytes.subspan(20, jsonBytes), fault);
    if (!document) return document.error();
    std::vector<Bytes> buffers;
    if (const Bytes rest = bytes.subspan(20 + jsonBytes); !rest.empty()) {
        if (rest.size() < 8 || load<uint32_t>(rest, 4) != 0x004E4942 ||
            load<uint32_t>(rest, 0) > rest.size() - 8)
            return fault("its binary chunk is malformed");
        buffers.push_back(rest.subspan(8, load<uint32_t>(rest, 0)));
    }
    return readMeshes(*document, buffers, fault);
}

Result<WeldedMesh> readGltf(const Bytes& bytes, const StoredMesh& mesh, const Fault& fault) {
    const Result<json> document = parseDocument(bytes, fault);
    if (!document) return document.error();
    const json* buffer = entry(*document, "buffers", 0);
    const json required = document->value("extensionsRequired", json::array());
    const bool coded = std::find(required.begin(), required.end(), kMeshCode) != required.end();
    // Then there is one more, that a decoder fills.
    if (!buffer || (*document)["buffers"].size() != (coded ? 2 : 1))
        return fault("it does not have exactly one buffer");
    const auto uri = buffer->find("uri");
    if (uri == buffer->end() || !uri->is_string()) return fault("its buffer names no file");
    std::string name;
    const auto& encoded = uri->get_ref<const std::string&>();
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    for (std::size_t i = 0; i < encoded.size(); ++i) {
        if (encoded[i] == '%' && i + 2 < encoded.size() && digit(encoded[i + 1]) >= 0 &&
            digit(encoded[i + 2]) >= 0) {
            name += static_cast<char>(digit(encoded[i + 1]) * 16 + digit(encoded[i + 2]));
            i += 2;
        } else {
            name += encoded[i];
        }
    }
    if (name.empty() || name.find_first_of(std::string_view("/\\:\0", 4)) != std::string::npos)
        return fault("its buffer is not a file beside it");
    MappedFile binary;
    const std::string place =
        mesh.beside.empty() ? (std::filesystem::path(mesh.name).parent_path() / name).string() : mesh.beside;
    if (const std::string failure = binary.open(place); !failure.empty())
        return fault("cannot read its buffer '" + name + "': " + failure);
    const auto length = whole(*buffer, "byteLength");
    if (!length || *length > binary.bytes().size()) return fault("its buffer is shorter than stated");
    return readMeshes(*document, {binary.bytes().subspan(0, *length)}, fault);
}

}  // namespace fw
