// A mesh with textures: unwrapped (unwrap.h), with tangents (tangents.h), baked (bake.h).
//
// Levels of detail share their textures, in which each has charts of its own: so the normals of each are told
// in the frame of its own triangles, all have the field's detail, and no chart is stretched by triangles that
// went. A level is shown where it is half as large on the screen as the one before, and has half the texels a
// metre: all together take a third more room than the first.
#pragma once

#include <functional>
#include <vector>

#include "graph/base/result.h"
#include "graph/compile/program.h"
#include "runtime/mesh/mesh.h"

namespace fw {

inline constexpr int kLeastTexture = 64, kMostTexture = 8192;  ///< texels along a side

/// Called as a stage of the work starts: "unwrap", then "bake".
using TextureStage = std::function<void(const char* stage)>;

/// The mesh, which has normals, with uvs, tangents and textures of so many texels a side, and without the
/// colours that it had at its vertices. Triangles and parts keep their order. Errors: unwrap()'s, and of a
/// mesh without triangles.
Result<Mesh> textured(Mesh mesh, const Program& program, int size, const TextureStage& starts = {});

/// Levels of detail of one mesh, the finest first, that share one set of textures; as textured().
Result<std::vector<Mesh>> texturedLevels(std::vector<Mesh> levels, const Program& program, int size,
                                         const TextureStage& starts = {});

}  // namespace fw
