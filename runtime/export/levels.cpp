// Levels of detail as one glTF.
#include "runtime/export/formats.h"
#include "runtime/export/gltf_scene.h"

namespace fw {

Result<ExportedFiles> exportLevels(std::span<const Mesh> levels, const std::string& path,
                                   const ExportOptions& options) {
    if (const Done fine = checkLevelsPath(path, options); !fine) return fine.error();
    Result<GltfScene> scene = GltfScene::open(path, options);
    if (!scene) return scene.error();
    const std::size_t whole = scene->addNode({{"name", scene->name()}});
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const std::string name = levelName(path, options, i);
        const Done added = options.placement.isNone()
                               ? scene->addShown(levels[i], name, whole)
                               : scene->addShown(placed(levels[i], options.placement), name, whole);
        if (!added) return added.error();
    }
    return scene->end();
}

Done checkLevelsPath(const std::string& path, const ExportOptions& options) {
    const auto refuse = [&](const char* message) { return Error{.message = message, .file = path}; };
    if (const Done known = checkExportPath(path, options); !known) return known.error();
    if (!isGltf(path))
        return refuse("levels of detail are in .glb and .gltf alone: leave them out, or choose one of them");
    if (options.manifold || options.parts)
        return refuse("levels of detail are neither marked as solids nor parted: choose one");
    return done();
}

std::string levelName(const std::string& path, const ExportOptions& options, std::size_t level) {
    return objectName(path, options) + "_LOD" + std::to_string(level);
}

}  // namespace fw
