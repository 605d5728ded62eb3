// The paths of light that a picture was left with when its making was ended, so that the same wish goes on.
//
// They lie in a file beside the picture, which goes when the picture is written. It is written whole or not
// at all, now and then; what was traced after the last time is traced again.
#pragma once

#include "runtime/play/player.h"

namespace fw {

class KeptPaths {
  public:
    /// Of the picture `output` of what the player shows now with these options.
    KeptPaths(const std::string& output, const Player& player, const RenderOptions& options);

    /// Those that are there; none if they are of another picture, or more than it is to have, or the file is
    /// not whole.
    PathSums read() const;
    /// Error: the file cannot be written.
    Done write(const PathSums& sums) const;
    void remove() const;

  private:
    std::string path;
    uint64_t key;        ///< of all that the picture depends on
    int samples;         ///< that it is to have
    std::size_t floats;  ///< of its sums
};

}  // namespace fw
