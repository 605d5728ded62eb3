#include "runtime/export/gltf_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>

#include "runtime/export/compress.h"
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
    content.add(std::span(mesh.uvs));
    content.add(std::span(mesh.tangents));
    content.add(std::span(mesh.indices));
    const std::string text =
        nlohmann::json{part["meshes"][0]["primitives"], part["materials"], part["accessors"]}.dump();
    content.add(text.data(), text.size());
    return content.uuid();
}

std::string contentOf(const MeshTextures& textures) {
    Fingerprint content;
    for (const auto* pixels : {&textures.baseColor, &textures.surface, &textures.normal, &textures.emission})
        content.add(std::span(*pixels));
    content.add(std::span(&textures.emissionStrength, 1));
    return content.uuid();
}

}  // namespace

GltfScene::GltfScene(std::string path_, ExportOptions options_, OutputFile binary_)
    : path(std::move(path_)), options(std::move(options_)), binary(std::move(binary_)) {
    document = {{"asset", {{"generator", generatorName()}, {"version", "2.0"}}},
                {"scene", 0},
                {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
}

Result<GltfScene> GltfScene::open(const std::string& path, const ExportOptions& options) {
    const std::string beside = exportedPaths(path).back();
    const bool scratch = beside == path || options.compress;
    Result<OutputFile> binary = OutputFile::open(scratch ? path + ".bin" : beside, options.cancel);
    if (!binary) return binary.error();
    return GltfScene(path, options, std::move(*binary));
}

/// Adds a document with one mesh, whose bytes come behind those that are there.
void GltfScene::join(nlohmann::json part) {
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
            if (!material.contains("name"))
                material["name"] = name() + "_" + std::to_string(found->second + 1);
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
    document["meshes"].push_back(std::move(mesh));
}

Result<TextureNumbers> GltfScene::texturesOf(const std::shared_ptr<const MeshTextures>& given) {
    if (given == lastTextures) return lastNumbers;
    const auto [found, fresh] = textures.emplace(contentOf(*given), TextureNumbers());
    if (fresh) {
        const std::vector<TextureImage> made = textureImages(*given, path, textures.size() - 1);
        const bool inBuffer = lowerExtension(path) == ".glb";
        found->second = addTextures(document, made, inBuffer ? std::optional(binary.size()) : std::nullopt);
        if (inBuffer) {
            for (const TextureImage& image : made) binary.write(image.png);
            binary.write("\0\0\0", (4 - binary.size() % 4) % 4);
        } else {
            Result<std::vector<OutputFile>> opened = openImages(path, made, options);
            if (!opened) return opened.error();
            std::ranges::move(*opened, std::back_inserter(images));
            for (const TextureImage& image : made)
                imagePaths.push_back((std::filesystem::path(path).parent_path() / image.file).string());
        }
    }
    lastTextures = given;
    return lastNumbers = found->second;
}

Result<std::size_t> GltfScene::addMesh(const Mesh& given, const std::string& name) {
    const Result<Bounds> bounds = checkMesh(given, path);
    if (!bounds) return bounds.error();
    const std::optional<Mesh> repaired = withUnitNormals(given);
    const Mesh& mesh = repaired ? *repaired : given;
    const GltfLayout layout = gltfLayout(mesh);
    nlohmann::json part = nlohmann::json::parse(gltfJson(mesh, layout, *bounds, name, {}));
    for (std::size_t i = 0; i < part["materials"].size(); ++i)
        if ((mesh.parts.empty() ? mesh.materialName : mesh.parts[i].name).empty())
            part["materials"][i].erase("name");  // the mesh's, whichever that is
    if (mesh.textures) {
        const Result<TextureNumbers> numbers = texturesOf(mesh.textures);
        if (!numbers) return numbers.error();
        showTextures(part, *mesh.textures, *numbers);
    }
    const auto [found, fresh] = known.emplace(contentOf(mesh, part), known.size());
    if (fresh) {
        join(std::move(part));
        writeGltfBinary(mesh, layout, nullptr, binary);
        binary.write("\0\0\0", (4 - binary.size() % 4) % 4);
    }
    if (!binary.good())
        if (const Done written = finished(); !written) return written.error();
    return found->second;
}

std::size_t GltfScene::addNode(nlohmann::json node, std::optional<std::size_t> parent) {
    const std::size_t number = document.contains("nodes") ? document["nodes"].size() : 0;
    document["nodes"].push_back(std::move(node));
    (parent ? document["nodes"][*parent]["children"] : document["scenes"][0]["nodes"]).push_back(number);
    return number;
}

Done GltfScene::addShown(const Mesh& mesh, const std::string& name, std::optional<std::size_t> parent) {
    const Result<std::size_t> added = addMesh(mesh, name);
    if (!added) return added.error();
    addNode({{"name", name}, {"mesh", *added}}, parent);
    return done();
}

std::string GltfScene::name() const { return objectName(path, options); }

void GltfScene::setNode(std::size_t node, const char* key, nlohmann::json value) {
    document["nodes"][node][key] = std::move(value);
}

std::size_t GltfScene::addFloats(const std::vector<float>& values, std::size_t parts) {
    constexpr const char* kElementTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(float)}});
    nlohmann::json accessor = {{"bufferView", document["bufferViews"].size() - 1},
                               {"componentType", 5126},  // FLOAT
                               {"count", values.size() / parts},
                               {"type", kElementTypes[parts - 1]}};
    if (parts == 1) accessor["min"] = {values.front()}, accessor["max"] = {values.back()};
    document["accessors"].push_back(std::move(accessor));
    binary.write(std::span(values));
    return document["accessors"].size() - 1;
}

void GltfScene::addAnimation(const char* name, const std::vector<GltfTrack>& tracks) {
    nlohmann::json samplers = nlohmann::json::array(), channels = nlohmann::json::array();
    std::map<std::vector<float>, std::size_t> inputs;  // times that tracks have in common stand once
    for (const GltfTrack& track : tracks) {
        const auto [input, fresh] = inputs.emplace(track.times, 0);
        if (fresh) input->second = addFloats(track.times, 1);
        const std::size_t output = addFloats(track.values, track.values.size() / track.times.size());
        channels.push_back(
            {{"sampler", samplers.size()}, {"target", {{"node", track.node}, {"path", track.path}}}});
        samplers.push_back({{"input", input->second},
                            {"interpolation", track.steps ? "STEP" : "LINEAR"},
                            {"output", output}});
    }
    document["animations"].push_back({{"name", name}, {"samplers", samplers}, {"channels", channels}});
}

/// Its error is that of the file asked for, for nobody knows the other.
Done GltfScene::finished() {
    Done whole = binary.finish();
    if (whole || lowerExtension(path) == ".gltf") return whole;
    Error error = whole.error();
    error.file = path;
    return error;
}

void GltfScene::addInstances(std::size_t node, const std::vector<float>& moves,
                             const std::vector<float>& turns, const std::vector<float>& sizes) {
    document["nodes"][node]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", addFloats(moves, 3)},
        {"ROTATION", addFloats(turns, 4)},
        {"SCALE", addFloats(sizes, 3)}};
    // Who does not know it shows the mesh once, at a place where there may be none.
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        if (nlohmann::json& names = document[list];
            std::find(names.begin(), names.end(), "EXT_mesh_gpu_instancing") == names.end())
            names.push_back("EXT_mesh_gpu_instancing");
}

/// What was written so far, of a file that is whole.
Done GltfScene::readBinary(const std::function<Done(std::span<const unsigned char>)>& take) {
    if (const Done whole = finished(); !whole) return whole.error();
    std::ifstream from(binary.place(), std::ios::binary);
    std::vector<unsigned char> piece(4 << 20);
    for (uint64_t left = binary.size(); left > 0;) {
        const auto size = std::size_t(std::min<uint64_t>(left, piece.size()));
        if (!from.read(reinterpret_cast<char*>(piece.data()), std::streamsize(size)))
            return Error{.message = "cannot read what was written before", .file = binary.place()};
        if (const Done taken = take(std::span(piece).first(size)); !taken) return taken.error();
        left -= size;
    }
    return done();
}

Result<ExportedFiles> GltfScene::end() {
    if (options.compress && binary.size() > 0) return writeCompressed();
    if (binary.size() > 0) document["buffers"] = {{{"byteLength", binary.size()}}};
    if (lowerExtension(path) == ".gltf") return writeGltf(binary);
    const auto copy = [&](OutputFile& file) {
        return readBinary([&](std::span<const unsigned char> bytes) {
            file.write(bytes.data(), bytes.size());
            return done();
        });
    };
    return writeGlb(binary.size(), copy);
}

Result<ExportedFiles> GltfScene::writeCompressed() {
    std::vector<unsigned char> bytes;
    bytes.reserve(binary.size());
    const Done read = readBinary([&](std::span<const unsigned char> piece) {
        bytes.insert(bytes.end(), piece.begin(), piece.end());
        return done();
    });
    if (!read) return read.error();
    compressGltf(document, bytes);
    const auto write = [&](OutputFile& file) { return file.write(bytes.data(), bytes.size()), done(); };
    if (lowerExtension(path) == ".glb") return writeGlb(bytes.size(), write);
    Result<OutputFile> beside = OutputFile::open(exportedPaths(path).back(), options.cancel);
    if (!beside) return beside.error();
    (void)write(*beside);
    return writeGltf(*beside);
}

Result<ExportedFiles> GltfScene::commit(OutputFile& file, OutputFile* beside) {
    Result<ExportedFiles> files = commitAll(path, options, file, beside, images);
    if (files) std::ranges::copy(imagePaths, std::back_inserter(files->paths));
    return files;
}

Result<ExportedFiles> GltfScene::writeGltf(OutputFile& beside) {
    if (beside.size() > 0)
        document["buffers"][0]["uri"] =
            percentEncoded(std::filesystem::path(exportedPaths(path).back()).filename().string());
    Result<OutputFile> file = OutputFile::open(path, options.cancel);
    if (!file) return file.error();
    file->write(document.dump());
    return commit(*file, &beside);
}

Result<ExportedFiles> GltfScene::writeGlb(uint64_t bytes, const std::function<Done(OutputFile&)>& write) {
    Result<OutputFile> file = OutputFile::open(path, options.cancel);
    if (!file) return file.error();
    if (!writeGlbHead(document.dump(), bytes, *file))
        return Error{.message = "the meshes exceed the 4 GiB of a GLB: write .gltf, or fewer of them",
                     .file = path};
    if (const Done written = write(*file); !written) return written.error();
    writeGlbEnd(bytes, *file);
    return commit(*file, nullptr);
}

}  // namespace fw
