#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace fw::bench {

struct VolumeTask {
    std::span<const glm::vec3> positions;
    std::span<const uint32_t> indices;
    double cell;  ///< metres
    float band;   ///< cells from the surface that get distances, both ways
    int threads;
};

/// Milliseconds that it took; 0 if nothing was made.
using MeshToVolume = double(const VolumeTask& task);

}  // namespace fw::bench
