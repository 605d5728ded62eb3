// A mesh with textures: unwrapped (unwrap.h), with tangents (tangents.h), baked (bake.h).
#pragma once

#include <functional>

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

}  // namespace fw
