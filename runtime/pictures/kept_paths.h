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

    KeptPaths(const KeptPaths&) = delete;

    /// The picture of these options, which must not outlive this, goes on from the paths that are there, and
    /// keeps its own; `kept` hears how many whenever that was done. How many there were: 0 if they are of
    /// another picture, or more than it is to have, or the file is not whole.
    int goOn(RenderOptions& render, std::function<void(int paths)> kept = {});
    void remove() const;

  private:
    PathSums read() const;
    /// Error: the file cannot be written.
    Done write() const;

    std::string path;
    uint64_t key;        ///< of all that the picture depends on
    int samples;         ///< that it is to have
    std::size_t floats;  ///< of its sums
    PathSums sums = {};
};

}  // namespace fw
