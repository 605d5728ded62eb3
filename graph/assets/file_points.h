// What files of particles hold, and the readers of their formats.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/result.h"

namespace fw {

/// Velocities and numbers are as many as places, or none.
struct FilePoints {
    std::vector<glm::vec3> places = {}, velocities = {};  ///< metres, metres a second
    std::vector<uint32_t> ids = {};
};

inline constexpr std::size_t kMostFileParticles = 4'000'000;

/// What an array of a file may be called for particles to be found by it: in any case of letters.
bool namesVelocity(std::string_view name);
bool namesId(std::string_view name);

/// Of a PLY file: its vertices, with velocities in vx, vy and vz and numbers in id, if it has them.
Result<FilePoints> readPlyPoints(std::string_view bytes, const std::string& path);

/// Of a legacy VTK file, as text or binary: the points of a dataset of any kind, with the vectors and scalars
/// that name velocities and ids. `path` names it in errors.
Result<FilePoints> readVtkPoints(std::string_view bytes, const std::string& path);

/// Of "Bgeo" version 5, Houdini's geometry as it was before version 12, which partio reads and writes.
Result<FilePoints> readBgeoPoints(std::string_view bytes, const std::string& path);

}  // namespace fw
