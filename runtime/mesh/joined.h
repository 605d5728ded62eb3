// Several meshes as one.
#pragma once

#include <span>

#include "runtime/mesh/mesh.h"

namespace fw {

/// The vertices of all meshes, which have normals and no textures, one mesh's behind those of the one before;
/// and their triangles by materials: those of one name that are alike become one part. Where one has colours
/// at its vertices and another has none, that one's base colour is at all of its vertices.
Mesh joined(std::span<const Mesh> meshes);

}  // namespace fw
