// Light from all around, as a picture has it: environment maps.
//
// The picture is equirectangular: its width is once around, its height from straight up to straight down, and
// its middle lies towards -z, with +x on the right. Texels are linear radiance. What is not a number, or
// negative, is 0; what is too bright for single precision's squares is kMostRadiance.
//
// Lifetime: maps are shared and never change. A file that has not changed since it was last read is not read
// again while anybody holds its map.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

/// Of a map as it is kept: a larger one is halved until it fits.
inline constexpr int kMostEnvironmentWidth = 4096;
/// Of the file.
inline constexpr int kMostEnvironmentSide = 16384;
inline constexpr float kMostRadiance = 1e6f;

using Radiance = std::array<float, 3>;

struct EnvironmentMap {
    int width = 1, height = 1;
    std::vector<Radiance> texels;  ///< rows from the top
    std::string file = {};         ///< absolute path; empty if it was not read from one
};
using EnvironmentMapPtr = std::shared_ptr<const EnvironmentMap>;

/// The map with texels of two by two as one; of an odd row or column the last is left out, unless it is all.
EnvironmentMap halved(const EnvironmentMap& map);

/// Reads the bytes of a file of the kind kEnvironmentFile (file_kind.h): Radiance's .hdr, OpenEXR, or a
/// picture in sRGB, of at most `mostSide` by half as many texels. Radiance that is negative or no number is
/// 0. The Error has a message only, with the path.
Result<EnvironmentMap> parseEnvironment(const std::string& bytes, const std::string& path,
                                        int mostSide = kMostEnvironmentSide);

/// Reads such a file.
/// Path and Error as for readImage().
Result<EnvironmentMapPtr> readEnvironment(const std::string& graphPath, const std::string& path);

}  // namespace fw
