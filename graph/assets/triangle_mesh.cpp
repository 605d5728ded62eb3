#include "graph/assets/triangle_mesh.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <iterator>

#include "graph/base/asset_file.h"
#include "graph/base/hash.h"

namespace fw {

namespace {

using Reader = Result<TriangleMesh> (*)(const MeshFile& file);
/// Of each of kMeshFile's endings.
constexpr Reader kReaders[] = {readGltfMesh, readGltfMesh, readObjMesh, readStlMesh, readPlyMesh};
static_assert(std::size(kReaders) == std::size(kMeshEndings));

/// Leaves out vertices that no triangle has.
void dropUnused(TriangleMesh& mesh) {
    constexpr uint32_t kUnused = ~0u;
    std::vector<uint32_t> places(mesh.positions.size(), kUnused);
    for (uint32_t index : mesh.indices) places[index] = 0;
    uint32_t used = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (places[v] == kUnused) continue;
        mesh.positions[used] = mesh.positions[v];
        if (!mesh.colors.empty()) mesh.colors[used] = mesh.colors[v];
        places[v] = used++;
    }
    mesh.positions.resize(used);
    if (!mesh.colors.empty()) mesh.colors.resize(used);
    for (uint32_t& index : mesh.indices) index = places[index];
}

uint64_t hashOf(const TriangleMesh& mesh) {
    uint64_t hash = 0xcbf29ce484222325u;
    const auto mix = [&](uint64_t word) { hash = mixed(hash, word); };
    mix(uint32_t(mesh.positions.size()));
    for (const std::vector<glm::vec3>* of : {&mesh.positions, &mesh.colors})
        for (const glm::vec3& p : *of)
            for (int k = 0; k < 3; ++k) mix(std::bit_cast<uint32_t>(p[k]));
    for (uint32_t index : mesh.indices) mix(index);
    return hash ^ hash >> 32;
}

}  // namespace

Error meshProblem(const MeshFile& file, const std::string& what) {
    return fileProblem(file.path, file.kind, what);
}

Result<TriangleMesh> parseTriangleMesh(const MeshFile& file) {
    const auto ending = std::ranges::find(kMeshEndings, endingOf(file.path));
    if (ending == std::end(kMeshEndings)) return wrongEnding(file.path, kMeshFile);
    if (file.bytes.empty()) return meshProblem(file, "is an empty file");
    Result<TriangleMesh> mesh = kReaders[ending - kMeshEndings](file);
    if (!mesh) return mesh;
    if (mesh->indices.empty()) return meshProblem(file, "has no faces");
    dropUnused(*mesh);
    mesh->file = file.file;
    mesh->hash = hashOf(*mesh);
    return mesh;
}

std::vector<std::string> piecesOfMesh(const std::string& file) {
    const std::string ending = endingOf(file);
    if (ending != ".gltf" && ending != ".obj") return {};
    const Result<Asset> asset = openAsset(file, std::filesystem::path(file).filename().string(), kMeshFile);
    const Result<std::string> bytes = asset ? asset->read() : asset.error();
    if (!bytes) return {};
    return ending == ".gltf" ? gltfPieces(*bytes) : objPieces(*bytes);
}

Result<TriangleMeshPtr> readTriangleMesh(const std::string& graphPath, const std::string& path) {
    return readAsset<TriangleMesh>(
        graphPath, path, kMeshFile,
        [&](const std::string& bytes, const std::string& file) -> Result<TriangleMeshPtr> {
            Result<TriangleMesh> mesh = parseTriangleMesh({bytes, path, file});
            if (!mesh) return mesh.error();
            return TriangleMeshPtr(std::make_shared<const TriangleMesh>(std::move(*mesh)));
        });
}

}  // namespace fw
