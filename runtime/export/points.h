// Writes particles to a file of points, which a particle_file reads again, place for place and bit for bit,
// if there are any.
//
// Formats: .ply, binary, with the properties x y z vx vy vz; .csv, whose first line names these columns; .xyz
// and .txt, the same six numbers in each line, between blanks. Metres, +Y up, metres a second. The file
// appears whole or not at all (output_file.h).
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

struct ParticlePoints {
    std::vector<glm::vec3> places, velocities;  ///< as many of both
};

/// The endings of such files.
inline constexpr const char* kPointEndings[] = {".ply", ".csv", ".xyz", ".txt"};

/// Refuses, before any work is done, a path with another ending.
Done checkPointsPath(const std::string& path);

/// No point at all makes a file without points. Errors name the path: as checkPointsPath(), an unwritable
/// folder, a full disk.
Done exportPoints(const ParticlePoints& points, const std::string& path);

}  // namespace fw
