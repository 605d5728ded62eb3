// One glTF whose meshes take turns: each is there while it is its turn, and has no size otherwise.
//
// Core glTF has no other way to show and hide: the scale of each mesh's node is 1 or 0, and jumps (STEP). A
// mesh that comes again, byte for byte, is in the file once, and its node has more than one turn. A program
// that plays nothing shows the first one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/export/gltf_scene.h"

namespace fw {

/// Refuses paths that end otherwise than .glb or .gltf, and options that do not go with meshes that take
/// turns.
Done checkAnimatedPath(const std::string& path, const ExportOptions& options);

class AnimatedGltf {
  public:
    /// Errors: as checkAnimatedPath(), an unwritable folder. `options` as of exportMesh, but for `examine`.
    static Result<AnimatedGltf> open(const std::string& path, const ExportOptions& options = {});

    /// The next turn begins at so many seconds, later than the one before; of a mesh without triangles
    /// nothing is there. `name` is the mesh's, if it has not come yet. Errors: as of exportMesh().
    Done add(const Mesh& mesh, double seconds, const std::string& name);

    /// The last turn ends at so many seconds; the file appears. Errors: a GLB of more than 4 GiB, a full
    /// disk.
    Result<ExportedFiles> end(double seconds);

  private:
    /// The times at which a mesh comes and goes, in turn.
    struct Turns {
        std::vector<float> seconds;
        bool there() const { return seconds.size() % 2 == 1; }
    };

    AnimatedGltf(GltfScene scene, const std::string& name);

    GltfScene scene;
    std::vector<Turns> turns;  ///< of each mesh
    std::optional<std::size_t> shown;
};

}  // namespace fw
