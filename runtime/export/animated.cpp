#include "runtime/export/animated.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <utility>

#include "runtime/export/fingerprint.h"
#include "runtime/export/formats.h"

namespace fw {

namespace {

/// Adds `by` to the number under the key, if there is one.
void shift(nlohmann::json& object, const char* key, std::size_t by) {
    if (const auto found = object.find(key); found != object.end()) *found = found->get<std::size_t>() + by;
}

/// What the file holds of a mesh, and no name.
std::string contentOf(const Mesh& mesh, const nlohmann::json& part) {
    Fingerprint content;
    content.add(std::span(mesh.positions));
    content.add(std::span(mesh.normals));
    content.add(std::span(mesh.colors));
    content.add(std::span(mesh.indices));
    const std::string text =
        nlohmann::json{part["meshes"][0]["primitives"], part["materials"], part["accessors"]}.dump();
    content.add(text.data(), text.size());
    return content.uuid();
}

}  // namespace

Done checkAnimatedPath(const std::string& path, const ExportOptions& options) {
    const std::string ending = lowerExtension(path);
    if (ending != ".glb" && ending != ".gltf")
        return Error{.message =
                         "meshes that take turns are a .glb or .gltf file; of another format export each "
                         "frame into a folder",
                     .file = path};
    if (options.manifold)
        return Error{.message = "a mesh that takes turns is not marked as a solid: leave that out",
                     .file = path};
    return done();
}

AnimatedGltf::AnimatedGltf(std::string path_, ExportOptions options_, OutputFile binary_)
    : path(std::move(path_)), options(std::move(options_)), binary(std::move(binary_)) {
    document = {{"asset", {{"generator", generatorName()}, {"version", "2.0"}}},
                {"scene", 0},
                {"scenes", {{{"nodes", {0}}}}},
                {"nodes", {{{"name", objectName(path, options)}}}}};
}

Result<AnimatedGltf> AnimatedGltf::open(const std::string& path, const ExportOptions& options) {
    if (const Done fine = checkAnimatedPath(path, options); !fine) return fine.error();
    const std::string beside = exportedPaths(path).back();
    Result<OutputFile> binary = OutputFile::open(beside == path ? path + ".bin" : beside, options.cancel);
    if (!binary) return binary.error();
    return AnimatedGltf(path, options, std::move(*binary));
}

/// Adds a document with one mesh, whose bytes come behind those that are there.
void AnimatedGltf::join(nlohmann::json part) {
    const auto count = [&](const char* list) { return document.contains(list) ? document[list].size() : 0; };
    const std::size_t views = count("bufferViews"), accessors = count("accessors");
    for (nlohmann::json& view : part["bufferViews"]) {
        view["byteOffset"] = view.value("byteOffset", std::size_t{0}) + binary.size();
        document["bufferViews"].push_back(std::move(view));
    }
    for (nlohmann::json& accessor : part["accessors"]) {
        shift(accessor, "bufferView", views);
        document["accessors"].push_back(std::move(accessor));
    }
    std::vector<std::size_t> numbers;  // of its materials in the whole
    for (nlohmann::json& material : part["materials"]) {
        const auto [found, fresh] = materials.emplace(material.dump(), count("materials"));
        if (fresh) {
            material["name"] = objectName(path, options) + "_" + std::to_string(found->second + 1);
            document["materials"].push_back(std::move(material));
        }
        numbers.push_back(found->second);
    }
    nlohmann::json& mesh = part["meshes"][0];
    for (nlohmann::json& primitive : mesh["primitives"]) {
        for (nlohmann::json& attribute : primitive["attributes"])
            attribute = attribute.get<std::size_t>() + accessors;
        shift(primitive, "indices", accessors);
        if (primitive.contains("material"))
            primitive["material"] = numbers.at(primitive["material"].get<std::size_t>());
    }
    for (const nlohmann::json& extension : part.value("extensionsUsed", nlohmann::json::array()))
        if (nlohmann::json& used = document["extensionsUsed"];
            std::find(used.begin(), used.end(), extension) == used.end())
            used.push_back(extension);
    document["nodes"].push_back({{"name", mesh["name"]}, {"mesh", count("meshes")}});
    document["meshes"].push_back(std::move(mesh));
}

Done AnimatedGltf::add(const Mesh& given, double seconds, const std::string& name) {
    std::optional<std::size_t> next;
    if (!given.indices.empty()) {
        const Result<Bounds> bounds = checkMesh(given, path);
        if (!bounds) return bounds.error();
        const std::optional<Mesh> repaired = withUnitNormals(given);
        const Mesh& mesh = repaired ? *repaired : given;
        const GltfLayout layout = gltfLayout(mesh);
        nlohmann::json part = nlohmann::json::parse(gltfJson(mesh, layout, *bounds, name, {}));
        for (nlohmann::json& material : part["materials"])
            material.erase("name");  // the mesh's, whichever that is
        const auto [found, fresh] = known.emplace(contentOf(mesh, part), turns.size());
        next = found->second;
        if (fresh) {
            join(std::move(part));
            writeGltfBinary(mesh, layout, nullptr, binary);
            binary.write("\0\0\0", (4 - binary.size() % 4) % 4);
            turns.emplace_back();
        }
    }
    if (next != shown) {
        if (shown) turns[*shown].seconds.push_back(float(seconds));
        if (next) turns[*next].seconds.push_back(float(seconds));
        shown = next;
    }
    if (binary.good()) return done();
    return binary.finish();
}

std::size_t AnimatedGltf::addFloats(const std::vector<float>& values, const char* type) {
    const std::size_t parts = type == std::string_view("VEC3") ? 3 : 1;
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(float)}});
    nlohmann::json accessor = {{"bufferView", document["bufferViews"].size() - 1},
                               {"componentType", 5126},  // FLOAT
                               {"count", values.size() / parts},
                               {"type", type}};
    if (parts == 1) accessor["min"] = {values.front()}, accessor["max"] = {values.back()};
    document["accessors"].push_back(std::move(accessor));
    binary.write(std::span(values));
    return document["accessors"].size() - 1;
}

void AnimatedGltf::addAnimation(float end) {
    nlohmann::json samplers = nlohmann::json::array(), channels = nlohmann::json::array();
    for (std::size_t mesh = 0; mesh < turns.size(); ++mesh) {
        std::vector<float> times = turns[mesh].seconds, scales;
        const bool first = times.front() == 0.0f;
        for (std::size_t i = 0; i < times.size(); ++i)
            scales.insert(scales.end(), 3, i % 2 == 0 ? 1.0f : 0.0f);
        if (!first) times.insert(times.begin(), 0.0f), scales.insert(scales.begin(), 3, 0.0f);
        // That of the last turn says how long the whole is.
        if (turns[mesh].there()) times.push_back(end), scales.insert(scales.end(), 3, 1.0f);
        if (!first) document["nodes"][mesh + 1]["scale"] = {0, 0, 0};
        const std::size_t input = addFloats(times, "SCALAR"), output = addFloats(scales, "VEC3");
        samplers.push_back({{"input", input}, {"interpolation", "STEP"}, {"output", output}});
        channels.push_back({{"sampler", mesh}, {"target", {{"node", mesh + 1}, {"path", "scale"}}}});
        document["nodes"][0]["children"].push_back(mesh + 1);
    }
    document["animations"] = {{{"name", "frames"}, {"samplers", samplers}, {"channels", channels}}};
}

Result<ExportedFiles> AnimatedGltf::end(double seconds) {
    if (!turns.empty()) addAnimation(float(seconds));
    return lowerExtension(path) == ".glb" ? writeGlb() : writeGltf();
}

Result<ExportedFiles> AnimatedGltf::writeGltf() {
    if (binary.size() > 0)
        document["buffers"] = {
            {{"byteLength", binary.size()},
             {"uri", percentEncoded(std::filesystem::path(exportedPaths(path).back()).filename().string())}}};
    Result<OutputFile> file = OutputFile::open(path, options.cancel);
    if (!file) return file.error();
    file->write(document.dump());
    return commitAll(path, options, *file, &binary);
}

Result<ExportedFiles> AnimatedGltf::writeGlb() {
    if (binary.size() > 0) document["buffers"] = {{{"byteLength", binary.size()}}};
    if (const Done whole = binary.finish(); !whole) return whole.error();
    Result<OutputFile> file = OutputFile::open(path, options.cancel);
    if (!file) return file.error();
    if (!writeGlbHead(document.dump(), binary.size(), *file))
        return Error{.message = "the frames exceed the 4 GiB of a GLB: write .gltf, or fewer of them",
                     .file = path};
    std::ifstream from(binary.place(), std::ios::binary);
    std::vector<char> piece(4 << 20);
    for (uint64_t left = binary.size(); left > 0 && file->good();) {
        const auto size = std::size_t(std::min<uint64_t>(left, piece.size()));
        if (!from.read(piece.data(), std::streamsize(size)))
            return Error{.message = "cannot read what was written before", .file = binary.place()};
        file->write(piece.data(), size);
        left -= size;
    }
    return commitAll(path, options, *file, nullptr);
}

}  // namespace fw
