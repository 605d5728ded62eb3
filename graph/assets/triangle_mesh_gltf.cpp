// glTF 2.0: tinygltf takes the JSON and the buffers apart, what refers to what is checked and read here.
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "graph/assets/triangle_mesh.h"
#include "graph/base/asset_file.h"

namespace fw {

namespace {

constexpr std::size_t kMostUngiven = 65536;  // elements that are zero for want of data
constexpr int kDeepest = 64;                 // JSON within JSON: the library's functions call themselves
constexpr FileKind kBufferFile = {.noun = "buffer", .mostBytes = kMeshFile.mostBytes};

// Required extensions that change no triangle.
constexpr std::string_view kHarmless[] = {
    "KHR_mesh_quantization", "KHR_texture_transform", "KHR_texture_basisu",
    "KHR_lights_punctual",   "EXT_mesh_manifold",     "EXT_texture_webp",
    "EXT_texture_avif",      "MSFT_texture_dds",      "KHR_xmp_json_ld"};

bool isHarmless(const std::string& extension) {
    return std::ranges::find(kHarmless, extension) != std::end(kHarmless) ||
           extension.starts_with("KHR_materials_");
}

/// What makes reading end: thrown within this file only.
struct Fault {
    std::string what;
};
[[noreturn]] void fail(const std::string& what) { throw Fault{what}; }

template <class T>
const T& at(const std::vector<T>& all, int index, const std::string& what) {
    if (index < 0 || std::size_t(index) >= all.size())
        fail("refers to " + what + " " + std::to_string(index) + ", which it does not have");
    return all[std::size_t(index)];
}

/// The deepest that brackets are within one another, outside strings.
int depthOf(std::string_view json) {
    int depth = 0, deepest = 0;
    bool inString = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (inString) {
            i += c == '\\';
            inString = c != '"';
        } else if (c == '"') {
            inString = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return deepest;
}

uint32_t wordAt(std::string_view bytes, std::size_t offset) {
    uint32_t word = 0;
    if (offset + 4 <= bytes.size()) std::memcpy(&word, bytes.data() + offset, 4);
    return word;
}

bool isBinary(std::string_view bytes) { return bytes.starts_with("glTF"); }

// ---- Files beside it

struct Folder {
    const std::string& file;  // whose folder it is
    std::string problem;      // with the last buffer that could not be read
};

bool readBeside(std::vector<unsigned char>* out, std::string* problem, const std::string& uri, void* folder) {
    auto& beside = *static_cast<Folder*>(folder);
    const Result<Asset> asset = openAsset(beside.file, uri, kBufferFile);
    const Result<std::string> bytes = asset ? asset->read() : asset.error();
    if (!bytes) {
        beside.problem = bytes.error().message;
        *problem += beside.problem;
        return false;
    }
    out->assign(bytes->begin(), bytes->end());
    return true;
}

/// Pictures are not looked at.
bool takeNoPicture(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                   int, void*) {
    return true;
}

/// Of the whole file, ahead of all else: version and required extensions tell why the rest may be strange.
void checkAsset(const nlohmann::json& root) {
    const auto find = [](const nlohmann::json& object, const char* name) {
        return object.is_object() && object.contains(name) ? object[name] : nlohmann::json();
    };
    const nlohmann::json asset = find(root, "asset"), needed = find(asset, "minVersion");
    const nlohmann::json version = find(asset, "version");
    const auto text = [](const nlohmann::json& value) {
        return value.is_string() ? value.get<std::string>() : "";
    };
    const bool first = !asset.is_object() && find(root, "meshes").is_object();  // glTF 1.0 has objects there
    if (first || (version.is_string() && !text(version).starts_with("2.")))
        fail("is of glTF version " + inQuotes(first ? "1.0" : text(version)) +
             ", and only 2.0 is read: convert it");
    if (needed.is_string() && text(needed) != "2.0")
        fail("needs glTF version " + inQuotes(text(needed)) + ", and only 2.0 is read");
    const nlohmann::json extensions = find(root, "extensionsRequired");
    for (const nlohmann::json& each : extensions.is_array() ? extensions : nlohmann::json::array()) {
        const std::string extension = text(each);
        if (isHarmless(extension)) continue;
        const bool packed =
            extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression";
        fail("needs the extension " + inQuotes(extension) +
             (packed ? ", a compression that is not read: export it without" : ", which is not read"));
    }
}

/// Numbers that the library would take for 0 where they are something else.
void checkNumbers(const nlohmann::json& root) {
    const auto check = [](const nlohmann::json& object, const std::string& of,
                          std::initializer_list<const char*> names) {
        if (!object.is_object()) return;
        for (const char* name : names)
            if (object.contains(name) && !object[name].is_number_unsigned())
                fail("has " + of + "\"" + name + "\": " +
                     inOneLine(object[name].dump(-1, ' ', true, nlohmann::json::error_handler_t::replace),
                               40) +
                     ", which is no whole number from 0 on");
    };
    const auto each = [&](const char* array, const char* noun, std::initializer_list<const char*> names) {
        if (!root.is_object() || !root.contains(array) || !root[array].is_array()) return;
        for (std::size_t i = 0; i < root[array].size(); ++i) {
            const nlohmann::json& object = root[array][i];
            const std::string of = noun + (" " + std::to_string(i)) + " with ";
            check(object, of, names);
            if (!object.is_object() || !object.contains("sparse") || !object["sparse"].is_object()) continue;
            check(object["sparse"], of, {"count"});
            for (const char* part : {"indices", "values"})
                if (object["sparse"].contains(part))
                    check(object["sparse"][part], of, {"bufferView", "byteOffset", "componentType"});
        }
    };
    check(root, "", {"scene"});
    each("buffers", "buffer", {"byteLength"});
    each("bufferViews", "buffer view", {"buffer", "byteOffset", "byteLength", "byteStride"});
    each("accessors", "accessor", {"bufferView", "byteOffset", "count", "componentType"});
    each("nodes", "node", {"mesh"});
}

tinygltf::Model parse(const MeshFile& file) {
    const std::string_view bytes = file.bytes;
    const bool binary = isBinary(bytes);
    std::string_view json = bytes;
    if (binary) {
        if (bytes.size() >= 8 && wordAt(bytes, 4) != 2)
            fail("is of version " + std::to_string(wordAt(bytes, 4)) +
                 " of the binary form, and only 2 is read");
        if (bytes.size() < 20 || wordAt(bytes, 8) > bytes.size()) fail("is cut off: copy it again");
        json = bytes.substr(20, std::min<std::size_t>(wordAt(bytes, 12), bytes.size() - 20));
    }
    if (json.starts_with("\xEF\xBB\xBF")) json.remove_prefix(3);
    if (depthOf(json) > kDeepest) fail("is nested too deeply to be a glTF file");

    const nlohmann::json root = nlohmann::json::parse(json, nullptr, false);
    checkAsset(root);
    checkNumbers(root);
    tinygltf::TinyGLTF loader;
    Folder folder{file.file, {}};
    loader.SetFsCallbacks(
        {[](const std::string&, void*) { return true; }, [](const std::string& path, void*) { return path; },
         readBeside,
         [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; },
         &folder});
    loader.SetImageLoader(takeNoPicture, nullptr);
    tinygltf::Model model;
    std::string problem, warning;
    const auto length = unsigned(binary ? bytes.size() : json.size());
    const bool fine =
        binary ? loader.LoadBinaryFromMemory(&model, &problem, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()), length, "")
               : loader.LoadASCIIFromString(&model, &problem, &warning, json.data(), length, "");
    if (!fine && !folder.problem.empty()) fail("cannot be read: " + folder.problem);
    if (!fine) fail("is no valid glTF 2.0 file: " + inOneLine(problem, 200));
    return model;
}

// ---- Accessors

/// Sizes in bytes; 0 if there is no such type.
std::size_t bytesOf(int componentType) {
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
        default: return 0;
    }
}

template <class T>
T read(const unsigned char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

double component(const unsigned char* from, int type, bool normalized) {
    const auto whole = [&](auto value) {
        if (!normalized) return double(value);
        return std::max(double(value) / double(std::numeric_limits<decltype(value)>::max()), -1.0);
    };
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return whole(read<int8_t>(from));
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return whole(read<uint8_t>(from));
        case TINYGLTF_COMPONENT_TYPE_SHORT: return whole(read<int16_t>(from));
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return whole(read<uint16_t>(from));
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return whole(read<uint32_t>(from));
        default: return double(read<float>(from));
    }
}

class Reader {
  public:
    Reader(const tinygltf::Model& model_) : model(model_) {}

    TriangleMesh run() {
        const std::vector<int> roots = rootNodes();
        std::vector<bool> seen(model.nodes.size());
        std::vector<std::pair<int, glm::dmat4>> open;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root)
            open.emplace_back(*root, glm::dmat4(1));
        while (!open.empty()) {
            const auto [index, parent] = open.back();
            open.pop_back();
            const tinygltf::Node& node = at(model.nodes, index, "node");
            if (seen[std::size_t(index)])
                fail("has node " + std::to_string(index) + " below two nodes, or below itself");
            seen[std::size_t(index)] = true;
            const glm::dmat4 whole = parent * transformOf(node);
            if (node.mesh >= 0)
                for (const tinygltf::Primitive& primitive : at(model.meshes, node.mesh, "mesh").primitives)
                    add(primitive, whole);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                open.emplace_back(*child, whole);
        }
        if (mesh.indices.empty()) fail("has no triangles in its scene");
        if (!colored) mesh.colors.clear();
        return std::move(mesh);
    }

  private:
    std::vector<int> rootNodes() const {
        if (!model.scenes.empty() || model.defaultScene >= 0)
            return at(model.scenes, std::max(model.defaultScene, 0), "scene").nodes;
        std::vector<int> roots;
        std::vector<bool> below(model.nodes.size());
        for (const tinygltf::Node& node : model.nodes)
            for (int child : node.children) {
                at(model.nodes, child, "node");
                below[std::size_t(child)] = true;
            }
        for (std::size_t i = 0; i < below.size(); ++i)
            if (!below[i]) roots.push_back(int(i));
        return roots;
    }

    static glm::dmat4 transformOf(const tinygltf::Node& node) {
        const auto is = [](const std::vector<double>& numbers, std::size_t count) {
            if (!numbers.empty() && numbers.size() != count) fail("has a transform of the wrong length");
            return numbers.size() == count;
        };
        glm::dmat4 whole(1);
        if (is(node.matrix, 16)) {
            for (int i = 0; i < 16; ++i) whole[i / 4][i % 4] = node.matrix[std::size_t(i)];
        } else {
            if (is(node.rotation, 4)) {
                const glm::dquat turn(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
                whole = glm::mat4_cast(glm::normalize(turn));
            }
            if (is(node.scale, 3))
                for (int i = 0; i < 3; ++i) whole[i] *= node.scale[std::size_t(i)];
            if (is(node.translation, 3))
                for (int i = 0; i < 3; ++i) whole[3][i] = node.translation[std::size_t(i)];
        }
        for (int i = 0; i < 16; ++i)
            if (!std::isfinite(whole[i / 4][i % 4])) fail("has a transform that is not finite");
        return whole;
    }

    /// Bytes of a buffer view from an offset on, at least `size` of them.
    std::span<const unsigned char> view(int index, std::size_t offset, std::size_t size) const {
        const tinygltf::BufferView& view = at(model.bufferViews, index, "buffer view");
        const std::vector<unsigned char>& bytes = at(model.buffers, view.buffer, "buffer").data;
        if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
            fail("has buffer view " + std::to_string(index) + " beyond the end of its buffer");
        if (offset > view.byteLength || size > view.byteLength - offset)
            fail("has an accessor beyond the end of buffer view " + std::to_string(index));
        return std::span(bytes).subspan(view.byteOffset + offset, view.byteLength - offset);
    }

    /// Numbers of an accessor, `width` an element; sparse ones put in their places.
    std::vector<double> numbers(int index, std::size_t width, bool asWhole) const {
        const tinygltf::Accessor& accessor = at(model.accessors, index, "accessor");
        const std::size_t component_ = bytesOf(accessor.componentType), count = accessor.count;
        const auto components =
            std::size_t(std::max(tinygltf::GetNumComponentsInType(uint32_t(accessor.type)), 0));
        if (component_ == 0 || components < width)
            fail("has accessor " + std::to_string(index) + " of a type that does not fit its use");
        if (count > kMostMeshVertices)
            fail("has accessor " + std::to_string(index) + " of more elements than can be read");
        const auto given = std::size_t(std::max(accessor.sparse.isSparse ? accessor.sparse.count : 0, 0));
        if (accessor.bufferView < 0 && count > given + kMostUngiven)
            fail("has accessor " + std::to_string(index) + " of " + std::to_string(count) +
                 " elements without data");
        const std::size_t element = component_ * components;
        std::vector<double> result(count * width);
        const auto fill = [&](std::span<const unsigned char> bytes, std::size_t stride, auto place,
                              std::size_t n) {
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t k = 0; k < width; ++k)
                    result[place(i) * width + k] =
                        component(bytes.data() + i * stride + k * component_, accessor.componentType,
                                  accessor.normalized && !asWhole);
        };
        if (accessor.bufferView >= 0 && count > 0) {
            const std::size_t told = at(model.bufferViews, accessor.bufferView, "buffer view").byteStride;
            const std::size_t stride = told > 0 ? told : element;
            if (stride < element || stride > 252u + element) fail("has a stride that cannot be");
            fill(
                view(accessor.bufferView, accessor.byteOffset, stride * (count - 1) + element), stride,
                [](std::size_t i) { return i; }, count);
        }
        if (accessor.sparse.isSparse) {
            const auto& sparse = accessor.sparse;
            const std::size_t size = bytesOf(sparse.indices.componentType);
            const bool whole = size > 0 && sparse.indices.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT;
            if (!whole || sparse.count < 0 || std::size_t(sparse.count) > count)
                fail("has sparse accessor " + std::to_string(index) +
                     " with more or other numbers than can be");
            const auto n = std::size_t(sparse.count);
            const auto places =
                view(sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset), n * size);
            const auto values =
                view(sparse.values.bufferView, std::size_t(sparse.values.byteOffset), n * element);
            fill(
                values, element,
                [&](std::size_t i) {
                    const double place =
                        component(places.data() + i * size, sparse.indices.componentType, false);
                    if (!(place >= 0 && place < double(count)))
                        fail("has sparse accessor " + std::to_string(index) + " with an index out of range");
                    return std::size_t(place);
                },
                n);
        }
        return result;
    }

    /// What vertices are made from.
    struct Source {
        std::map<std::string, int> attributes;
        glm::dvec3 base;
        glm::dmat4 whole;
        bool operator==(const Source&) const = default;
    };

    void add(const tinygltf::Primitive& primitive, const glm::dmat4& whole) {
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode > TINYGLTF_MODE_TRIANGLE_FAN) fail("has a primitive of mode " + std::to_string(mode));
        if (mode < TINYGLTF_MODE_TRIANGLES) return;  // points and lines
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return;
        if (primitive.extensions.contains("KHR_draco_mesh_compression") &&
            at(model.accessors, position->second, "accessor").bufferView < 0)
            fail("is packed by Draco, a compression that is not read: export it without");
        const tinygltf::Accessor& accessor = at(model.accessors, position->second, "accessor");
        if (accessor.type != TINYGLTF_TYPE_VEC3) fail("has positions that are no vectors of three");
        const Source source{primitive.attributes, baseOf(primitive), whole};
        if (source != last) addVertices(position->second, source);
        last = source;
        addTriangles(primitive, mode, glm::determinant(glm::dmat3(whole)) < 0);
    }

    void addVertices(int position, const Source& source) {
        const std::vector<double> places = numbers(position, 3, false);
        const std::size_t count = places.size() / 3;
        first = mesh.positions.size();
        if (first + count > kMostMeshVertices) fail("has more vertices than can be read");
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec4 p =
                source.whole * glm::dvec4(places[3 * i], places[3 * i + 1], places[3 * i + 2], 1);
            const glm::vec3 narrow(p);
            for (int k = 0; k < 3; ++k)
                if (!std::isfinite(narrow[k])) fail("has a vertex that is not finite");
            mesh.positions.push_back(narrow);
        }
        addColors(source, count);
    }

    glm::dvec3 baseOf(const tinygltf::Primitive& primitive) {
        if (primitive.material < 0) return glm::dvec3(1);
        colored = true;
        const auto& factor =
            at(model.materials, primitive.material, "material").pbrMetallicRoughness.baseColorFactor;
        return factor.size() >= 3 ? glm::dvec3(factor[0], factor[1], factor[2]) : glm::dvec3(1);
    }

    void addColors(const Source& source, std::size_t count) {
        const auto color = source.attributes.find("COLOR_0");
        std::vector<double> own;
        if (color != source.attributes.end()) {
            own = numbers(color->second, 3, false);
            if (own.size() != 3 * count) fail("has more or fewer colours than positions");
            colored = true;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 mine =
                own.empty() ? glm::dvec3(1) : glm::dvec3(own[3 * i], own[3 * i + 1], own[3 * i + 2]);
            const glm::dvec3 product = mine * source.base;
            glm::vec3 kept;
            for (int k = 0; k < 3; ++k) kept[k] = product[k] >= 0 ? float(std::min(product[k], 1.0)) : 0.0f;
            mesh.colors.push_back(kept);
        }
    }

    void addTriangles(const tinygltf::Primitive& primitive, int mode, bool mirrored) {
        const std::size_t vertices = mesh.positions.size() - first;
        std::vector<uint32_t> order;
        if (primitive.indices >= 0) {
            const int type = at(model.accessors, primitive.indices, "accessor").componentType;
            if (type == TINYGLTF_COMPONENT_TYPE_FLOAT) fail("has indices that are no whole numbers");
            for (double index : numbers(primitive.indices, 1, true)) {
                if (!(index >= 0 && index < double(vertices)))
                    fail("has index " + std::to_string(int64_t(index)) + " with " + std::to_string(vertices) +
                         " vertices");
                order.push_back(uint32_t(index));
            }
        } else {
            for (uint32_t i = 0; i < vertices; ++i) order.push_back(i);
        }
        const bool list = mode == TINYGLTF_MODE_TRIANGLES, strip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
        const std::size_t count = list ? order.size() / 3 : order.size() < 3 ? 0 : order.size() - 2;
        if (mesh.indices.size() / 3 + count > kMostMeshTriangles) fail("has more triangles than can be read");
        for (std::size_t t = 0; t < count; ++t) {
            std::array<uint32_t, 3> corners =
                list    ? std::array{order[3 * t], order[3 * t + 1], order[3 * t + 2]}
                : strip ? std::array{order[t], order[t + 1 + t % 2], order[t + 2 - t % 2]}
                        : std::array{order[t + 1], order[t + 2], order[0]};
            if (mirrored) std::swap(corners[1], corners[2]);
            for (uint32_t corner : corners) mesh.indices.push_back(uint32_t(first) + corner);
        }
    }

    const tinygltf::Model& model;
    TriangleMesh mesh;
    std::size_t first = 0;       // vertex of those that were added last,
    std::optional<Source> last;  // from this: the parts of a mesh mostly share theirs
    bool colored = false;
};

/// With what a URI writes as %20 as it is.
std::string decoded(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned char byte = 0;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(&uri[i + 1], &uri[i + 1] + 2, byte, 16).ptr == &uri[i + 1] + 2)
            text += static_cast<char>(byte), i += 2;
        else
            text += uri[i];
    }
    return text;
}

}  // namespace

std::vector<std::string> gltfPieces(std::string_view json) {
    if (json.starts_with("\xEF\xBB\xBF")) json.remove_prefix(3);
    if (depthOf(json) > kDeepest) return {};
    const nlohmann::json root = nlohmann::json::parse(json, nullptr, false);
    if (!root.is_object() || !root.contains("buffers") || !root["buffers"].is_array()) return {};
    std::vector<std::string> pieces;
    for (const nlohmann::json& buffer : root["buffers"]) {
        if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
        const std::string uri = buffer["uri"];
        if (!uri.starts_with("data:")) pieces.push_back(decoded(uri));
    }
    return pieces;
}

Result<TriangleMesh> readGltfMesh(const MeshFile& file) {
    try {
        const tinygltf::Model model = parse(file);
        return Reader(model).run();
    } catch (const Fault& fault) { return meshProblem(file, fault.what); }
}

}  // namespace fw
