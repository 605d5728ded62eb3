// Particles made elsewhere: the vertices of a PLY or OBJ file, the points of a VTK or BGEO file, or a text
// with a place in each line; and numbered sequences of such files.
//
// A sequence is named by a path whose file name has the number's digits as a run of '#', or as "%d" or
// "%04d": "splash/####.ply". File n is what there is at the time n / fps and until the next; where a number
// lacks, the nearest before lasts, and before the first there is the first.
//
// Lifetime: as meshes (triangle_mesh.h).
#pragma once

#include <memory>

#include "graph/assets/file_points.h"
#include "graph/base/box.h"

namespace fw {

struct ParticlePlaces : FilePoints {
    std::string file = {};  ///< absolute path
    uint64_t hash = 0;      ///< of all that it holds
};
using ParticlePlacesPtr = std::shared_ptr<const ParticlePlaces>;

/// Reads a file of the kind kParticleFile (file_kind.h): a mesh's, with faces or not; points with velocities
/// and numbers; or a text with three numbers in each line, between blanks, commas or semicolons, the first
/// ones or those in the columns that a first line names x, y and z (and vx, vy, vz, and id); other columns
/// and lines that begin with # are passed over. Places are finite, and there is one at least. `path` is
/// relative to the folder of the file `graphPath`, as openAsset() has it. The Error has a message only.
Result<ParticlePlacesPtr> readParticlePlaces(const std::string& graphPath, const std::string& path);

/// Of the bytes of such a file, whose name's end tells the format.
Result<FilePoints> parseParticlePlaces(const std::string& bytes, const std::string& path);

struct ParticleSequence {
    std::string graphPath, before, after;  ///< of the number in the path
    std::size_t digits = 1;                ///< at least
    std::vector<long> numbers = {};        ///< of the files that are there, ascending; at least one
    Box bounds = {};                       ///< of the places in some of them, evenly spread, and both ends
    std::string file = {};                 ///< absolute path of the first
    uint64_t hash = 0;                     ///< of the path, the numbers and those files

    std::string path(long number) const;
    /// The number of the file that is shown then.
    long numberAt(double seconds, double framesPerSecond) const;
};
using ParticleSequencePtr = std::shared_ptr<const ParticleSequence>;

/// Whether the path names a sequence rather than a file.
bool namesSequence(std::string_view path);

/// Looks which files of a sequence are there, and into some of them. Errors, with a message only: none is; as
/// readParticlePlaces().
Result<ParticleSequencePtr> readParticleSequence(const std::string& graphPath, const std::string& path);

}  // namespace fw
