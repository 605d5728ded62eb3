#include "runtime/export/animated.h"

#include <utility>

#include "runtime/export/formats.h"

namespace fw {

Done checkAnimatedPath(const std::string& path, const ExportOptions& options) {
    if (!isGltf(path))
        return Error{.message =
                         "meshes that take turns are a .glb or .gltf file; of another format export each "
                         "frame into a folder",
                     .file = path};
    if (options.manifold)
        return Error{.message = "a mesh that takes turns is not marked as a solid: leave that out",
                     .file = path};
    return done();
}

AnimatedGltf::AnimatedGltf(GltfScene scene_, const std::string& name) : scene(std::move(scene_)) {
    scene.addNode({{"name", name}});
}

Result<AnimatedGltf> AnimatedGltf::open(const std::string& path, const ExportOptions& options) {
    if (const Done fine = checkAnimatedPath(path, options); !fine) return fine.error();
    Result<GltfScene> scene = GltfScene::open(path, options);
    if (!scene) return scene.error();
    return AnimatedGltf(std::move(*scene), objectName(path, options));
}

Done AnimatedGltf::add(const Mesh& mesh, double seconds, const std::string& name) {
    std::optional<std::size_t> next;
    if (!mesh.indices.empty()) {
        const Result<std::size_t> added = scene.addMesh(mesh, name);
        if (!added) return added.error();
        next = *added;
        if (*next == turns.size()) {
            turns.emplace_back();
            scene.addNode({{"name", name}, {"mesh", *next}}, 0);
        }
    }
    if (next != shown) {
        if (shown) turns[*shown].seconds.push_back(float(seconds));
        if (next) turns[*next].seconds.push_back(float(seconds));
        shown = next;
    }
    return done();
}

Result<ExportedFiles> AnimatedGltf::end(double seconds) {
    std::vector<GltfTrack> tracks;
    for (std::size_t mesh = 0; mesh < turns.size(); ++mesh) {
        GltfTrack track{
            .node = mesh + 1, .path = "scale", .steps = true, .times = turns[mesh].seconds, .values = {}};
        const bool first = track.times.front() == 0.0f;
        for (std::size_t i = 0; i < track.times.size(); ++i)
            track.values.insert(track.values.end(), 3, i % 2 == 0 ? 1.0f : 0.0f);
        if (!first) {
            track.times.insert(track.times.begin(), 0.0f);
            track.values.insert(track.values.begin(), 3, 0.0f);
            scene.setNode(track.node, "scale", {0, 0, 0});
        }
        // That of the last turn says how long the whole is.
        if (turns[mesh].there()) {
            track.times.push_back(float(seconds));
            track.values.insert(track.values.end(), 3, 1.0f);
        }
        tracks.push_back(std::move(track));
    }
    if (!tracks.empty()) scene.addAnimation("frames", tracks);
    return scene.end();
}

}  // namespace fw
