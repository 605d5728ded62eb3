#include "runtime/files/mesh_wish.h"

#include <algorithm>
#include <iterator>

#include "runtime/export/texture_files.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace {

Done checkTextures(int size, const std::string& path) {
    const auto refuse = [&](std::string message) {
        return Error{.message = std::move(message), .file = path};
    };
    if (!hasTextures(path))
        return refuse("textures are in .glb, .gltf and .obj alone: leave --textures out for " +
                      lowerExtension(path) + ", or choose one of them");
    if (size < kLeastTexture || size > kMostTexture || (size & (size - 1)) != 0)
        return refuse("--textures " + std::to_string(size) + ": a texture's side is a power of two from " +
                      std::to_string(kLeastTexture) + " to " + std::to_string(kMostTexture) + " texels");
    return done();
}

}  // namespace

Done checkWish(const MeshWish& wish, const std::string& path, bool measured) {
    const ExportOptions options = writingOf(wish);
    if (const Done fine = checkExportPath(path, options, measured); !fine) return fine;
    if (const auto known = placementOf(path, *lengthUnit("m"), wish.placement); !known) return known.error();
    if (wish.textures)
        if (const Done fine = checkTextures(*wish.textures, path); !fine) return fine;
    return wish.lods > 1 ? checkLevelsPath(path, options) : done();
}

Done checkTilesWish(const MeshWish& wish, const std::string& path) {
    const auto refuse = [&](const char* message) { return Error{.message = message, .file = path}; };
    if (wish.manifold)
        return refuse(
            "--manifold holds the whole mesh in memory, which tiles are there to avoid: leave it out");
    if (wish.compress || wish.parts)
        return refuse(
            "--compress and --parts hold the whole mesh in memory, which tiles are there to avoid: leave "
            "them out");
    if (wish.splitMaterials)
        return refuse(
            "--split-materials is for a mesh that is made as a whole: leave it out, or --tiles and "
            "--tile");
    if (wish.textures)
        return refuse(
            "--textures is for a mesh that is made as a whole: leave it out, or --tiles and --tile");
    if (wish.lods > 1)
        return refuse("--lods is for a mesh that is made as a whole: leave it out, or --tiles and --tile");
    return done();
}

std::vector<std::string> wishedPaths(const MeshWish& wish, const std::string& path) {
    std::vector<std::string> paths = exportedPaths(path);
    if (wish.textures) std::ranges::copy(texturePaths(path), std::back_inserter(paths));
    return paths;
}

MaterialParts partsOf(const MeshWish& wish, const std::string& path) {
    if (!exportFormat(path)->parts) return MaterialParts::none;
    if (wish.textures) return MaterialParts::besideTextures;
    return wish.splitMaterials ? MaterialParts::cut : MaterialParts::whole;
}

ExportOptions writingOf(const MeshWish& wish) {
    return {.manifold = wish.manifold,
            .compress = wish.compress,
            .parts = wish.parts,
            .splitMaterials = wish.splitMaterials};
}

Result<std::vector<Mesh>> withTextures(const MeshWish& wish, std::vector<Mesh> levels, const Program& program,
                                       const TextureStage& starts) {
    if (!wish.textures || levels[0].indices.empty()) return levels;
    if (levels.size() == 1) {  // nothing is to be joined and parted again
        Result<Mesh> one = textured(std::move(levels[0]), program, *wish.textures, starts);
        if (!one) return one.error();
        levels[0] = std::move(*one);
        return levels;
    }
    return texturedLevels(std::move(levels), program, *wish.textures, starts);
}

Result<Mesh> withTextures(const MeshWish& wish, Mesh mesh, const Program& program) {
    if (!wish.textures || mesh.indices.empty()) return mesh;
    return textured(std::move(mesh), program, *wish.textures);
}

Result<ExportedFiles> exportWished(const MeshWish& wish, std::span<const Mesh> levels,
                                   const std::string& path, const ExportOptions& options) {
    if (wish.lods > 1 && !levels[0].indices.empty()) return exportLevels(levels, path, options);
    return exportMesh(levels[0], path, options);
}

}  // namespace fw
