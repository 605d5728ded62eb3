// Places of particles made elsewhere: the vertices of a PLY or OBJ file, or a text with a place in each line.
//
// Lifetime: as meshes (triangle_mesh.h).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

inline constexpr std::size_t kMostFileParticles = 4'000'000;

struct ParticlePlaces {
    std::vector<glm::vec3> places;  ///< metres, finite, at least one
    std::string file;               ///< absolute path
    uint64_t hash = 0;              ///< of the places
};
using ParticlePlacesPtr = std::shared_ptr<const ParticlePlaces>;

/// Reads a file of the kind kParticleFile (file_kind.h): a mesh's, with faces or not, or a text with three
/// numbers in each line, between blanks, commas or semicolons, the first ones or those in the columns that a
/// first line names x, y and z; other columns and lines that begin with # are passed over. `path` is relative
/// to the folder of the file `graphPath`, as openAsset() has it. The Error has a message only.
Result<ParticlePlacesPtr> readParticlePlaces(const std::string& graphPath, const std::string& path);

/// Of the bytes of such a file, whose name's end tells the format.
Result<std::vector<glm::vec3>> parseParticlePlaces(const std::string& bytes, const std::string& path);

}  // namespace fw
