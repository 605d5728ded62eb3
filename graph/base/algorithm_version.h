// kAlgorithmVersion: the version of the algorithms whose results are stored on disk and used again later.
//
// These stored results carry it: particle caches, unfinished renders (*.paths), baked meshes in the cache
// folder, and the tiles and parts of large meshes. A result with a different version is not used.
//
// Raise it by one with any change by which the same document gives other stored values: of simulations, of
// the paths of light, of baking meshes, of meshing, or of the values of nodes and operations. Do not raise it
// for a change of speed. A change of a file's format has a version in that format.
#pragma once

#include <cstdint>

namespace fw {

inline constexpr uint32_t kAlgorithmVersion = 1;

}  // namespace fw
