// Levels of detail: the same surface in fewer and fewer triangles.
//
// Each level has a quarter of the triangles of the one before: half as many along each way, so that it looks
// alike where it is half as large on the screen. It is made of the one before, by decimate(), which keeps
// solids closed and borders of colours where they are.
#pragma once

#include <functional>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace fw {

inline constexpr std::size_t kLevelQuotient = 4;

/// Up to so many levels behind `finest`, which has no parts; fewer if no more triangles can go. Vertices that
/// were doubled along creases are one in them. `labels` gives what decimate() takes of a level.
std::vector<Mesh> coarserLevels(const Mesh& finest, std::size_t count,
                                const std::function<std::vector<uint32_t>(const Mesh&)>& labels);

}  // namespace fw
