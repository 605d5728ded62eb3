// Textures of a mesh, read from the field that the mesh was made of.
//
// Each texel has a place on the mesh, which Newton's steps along the field's gradient lead to the surface
// itself: so a coarse mesh shows what the field has. There the field says base colour, roughness, metallic
// and emission, and its gradient the normal, which is told in the tangents that the mesh has there. A place
// that would go farther than `reach`, or to where the surface faces the other way, stays.
//
// How much of the sky is seen, weighted by the cosine, is asked along kRays directions at a coarser grid,
// each for a cone of its width: along it the field is compared with how wide the cone is there, with what a
// plane would have taken as nothing. So there is no noise, and what is thinner than the steps may be missed.
// It takes the field for a distance, as far as its gradient at the surface says.
//
// The field is evaluated on the host, on tapes (graph/evaluate/tape.h) shortened for tiles of the texture,
// on all processors; the result does not depend on how many there are.
#pragma once

#include "graph/compile/program.h"
#include "runtime/textures/texels.h"

namespace fw {

struct BakeOptions {
    float reach = 0;   ///< from the mesh to the surface at most, metres
    float radius = 0;  ///< of occlusion: what is farther away hides nothing, metres
};

inline constexpr int kRays = 32;

/// Of the mesh, which has uvs, normals and tangents, on the texels that were found for it.
MeshTextures bakeTextures(const Unwrapping& unwrapping, const Texels& texels, const Program& program,
                          const BakeOptions& options);

}  // namespace fw
