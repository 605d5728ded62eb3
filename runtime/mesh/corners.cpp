#include "runtime/mesh/corners.h"

#include <algorithm>

namespace fw {

Corners cornersOf(std::span<const uint32_t> indices, std::size_t vertices) {
    Corners corners;
    corners.start.assign(vertices + 1, 0);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        if (collapsed(&indices[i])) continue;
        for (std::size_t k = 0; k < 3; ++k) ++corners.start[indices[i + k] + 1];
    }
    for (std::size_t v = 1; v < corners.start.size(); ++v) corners.start[v] += corners.start[v - 1];
    corners.corner.resize(corners.start.back());
    // Filling moves each start to its end, which is the next one's start: shifted back afterwards.
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        if (collapsed(&indices[i])) continue;
        for (std::size_t k = 0; k < 3; ++k)
            corners.corner[corners.start[indices[i + k]]++] = static_cast<uint32_t>(i + k);
    }
    std::copy_backward(corners.start.begin(), corners.start.end() - 1, corners.start.end());
    corners.start[0] = 0;
    return corners;
}

}  // namespace fw
