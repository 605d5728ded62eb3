// The one function of the module that holds OpenVDB, libfieldwright-vdb.so.
//
// A module, because OpenVDB takes 40 ms to be loaded, which no other export and no other command should pay
// for: runtime/export/vdb.cpp loads it when the first level set is made.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>

namespace fw {

struct LevelSetWish {
    std::span<const glm::vec3> positions;  ///< metres
    std::span<const uint32_t> indices;     ///< three a triangle, of a closed surface
    /// Metres from a point to the nearest triangle; called from several threads.
    std::function<double(const glm::dvec3&)> distance;
    float voxel;  ///< its side, metres
    std::string name, generator;
    const std::atomic<bool>* cancel;  ///< may be null
};

/// Puts the bytes of a .vdb file into `out`, none if it was cancelled. False: `out` says why there are none.
using MakeLevelSet = bool(const LevelSetWish& wish, std::string& out);

}  // namespace fw

extern "C" fw::MakeLevelSet fieldwrightLevelSet;
