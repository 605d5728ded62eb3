#include "runtime/measure/readers.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace fw {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxJsonBytes = 16u << 20;  // ours has about 1 KiB
constexpr int kMaxJsonDepth = 64;

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
};

struct GltfReader {
    const json& document;
    const std::vector<Bytes>& buffers;
    const Fault& fault;
    /// Of the vertices of the accessor that was read last: the parts of a mesh mostly share theirs.
    std::optional<uint64_t> numbered = {};
    std::vector<uint32_t> numbers = {};

    Result<Elements> elements(uint64_t index, const std::string& type) const {
        const json* accessor = entry(document, "accessors", index);
        if (!accessor) return fault("an accessor is missing");
        if (accessor->contains("sparse")) return fault("sparse accessors are not read back");
        if (accessor->value("type", json()) != json(type)) return fault("an accessor is not of type " + type);
        Elements found;
        found.componentType = whole(*accessor, "componentType").value_or(0);
        const uint64_t componentBytes = found.componentType == 5121                                  ? 1
                                        : found.componentType == 5123                                ? 2
                                        : found.componentType == 5125 || found.componentType == 5126 ? 4
                                                                                                     : 0;
        if (componentBytes == 0) return fault("an accessor has an unknown component type");
        const uint64_t elementBytes = componentBytes * (type == "VEC3" ? 3 : 1);
        const auto viewIndex = whole(*accessor, "bufferView");
        const auto count = whole(*accessor, "count");
        const auto offset = whole(*accessor, "byteOffset", 0);
        const json* view = viewIndex ? entry(document, "bufferViews", *viewIndex) : nullptr;
        if (!view || !count || !offset || *count == 0)
            return fault("an accessor lacks its view or its count");
        const auto buffer = whole(*view, "buffer");
        const auto start = whole(*view, "byteOffset", 0);
        const auto length = whole(*view, "byteLength");
        const auto stride = whole(*view, "byteStride", elementBytes);
        if (!buffer || *buffer >= buffers.size() || !start || !length || !stride || *stride < elementBytes ||
            *stride > 252)
            return fault("a buffer view is malformed");
        const Bytes& bytes = buffers[*buffer];
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
        if (points->componentType != 5126) return fault("positions are not floats");
        numbered.reset();
        numbers.resize(points->count);
        welder.expect(points->count);
        for (uint64_t i = 0; i < points->count; ++i) {
            const auto p = load<glm::vec3>(points->bytes, i * points->stride);
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
        if (list->componentType == 5126) return fault("indices are not whole numbers");
        if (list->count % 3 != 0) return fault("the number of indices is no multiple of three");
        indices.reserve(indices.size() + list->count);
        for (uint64_t i = 0; i < list->count; ++i) {
            const std::size_t at = i * list->stride;
            const uint32_t index = list->componentType == 5121   ? load<uint8_t>(list->bytes, at)
                                   : list->componentType == 5123 ? load<uint16_t>(list->bytes, at)
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
    if (document.contains("extensionsRequired")) return fault("it requires extensions");
    return document;
}

Result<WeldedMesh> readMeshes(const json& document, const std::vector<Bytes>& buffers, const Fault& fault) {
    const auto nodes = document.find("nodes");
    if (nodes != document.end() && nodes->is_array())
        for (const json& node : *nodes)
            for (const char* key : {"matrix", "translation", "rotation", "scale"})
                if (node.is_object() && node.contains(key))
                    return fault("nodes with transforms are not read back");
    const auto meshes = document.find("meshes");
    WeldedMesh welded;
    Welder welder(1024);
    GltfReader reader{document, buffers, fault};
    if (meshes == document.end() || !meshes->is_array()) return fault("it holds no mesh");
    for (const json& mesh : *meshes) {
        if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array())
            return fault("a mesh has no primitives");
        for (const json& part : mesh["primitives"]) {
            if (!part.is_object()) return fault("a primitive is malformed");
            if (Done read = reader.primitive(part, welder, welded.indices); !read) return read.error();
        }
    }
    welded.positions = welder.take();
    return welded;
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
    if (!buffer || (*document)["buffers"].size() != 1) return fault("it does not have exactly one buffer");
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
