// Writes particles to a file of points, which a particle_file reads again, place for place and bit for bit,
// if there are any.
//
// Formats: .ply, binary, with the properties x y z vx vy vz id; .csv, whose first line names these columns;
// .xyz and .txt, the same seven numbers in each line, between blanks; .vtk, legacy and binary, for ParaView;
// .bgeo, as partio and Houdini have it. Metres, +Y up, metres a second. The file appears whole or not at all
// (output_file.h).
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

struct ParticlePoints {
    std::vector<glm::vec3> places, velocities;  ///< as many of both
    std::vector<uint32_t> ids;                  ///< a number for each, which stays its own
};

/// The endings of such files.
inline constexpr const char* kPointEndings[] = {".ply", ".vtk", ".bgeo", ".csv", ".xyz", ".txt"};

/// Refuses, before any work is done, a path with another ending.
Done checkPointsPath(const std::string& path);

/// Whether the file there begins as one that was written with this ending.
bool isWholePoints(const std::string& path);

/// No point at all makes a file without points. Errors name the path: as checkPointsPath(), an unwritable
/// folder, a full disk. `kept` is called once the file is there.
Done exportPoints(const ParticlePoints& points, const std::string& path,
                  const std::function<void()>& kept = {});

}  // namespace fw
