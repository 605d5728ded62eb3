// The frames of a timeline as numbered mesh files (frames.h).
//
// All frames are made on one grid, that of the player (player.h): so a surface that rests keeps its triangles
// while others move. A frame is the same bytes in whatever order frames are made. A frame whose solid is
// empty is a file without triangles.
#pragma once

#include <future>

#include "runtime/export/export.h"
#include "runtime/play/frames.h"

namespace fw {

/// Files of a format, ".glb".
FrameFiles meshFrames(const std::string& folder, const std::string& ending, const FrameRange& frames,
                      bool overwrite);

/// Writes meshes on a thread of its own, so that the next is made meanwhile; one at a time. Lifetime: the
/// destructor waits, so that what is written from must have been there before.
class WrittenBehind {
  public:
    using Write = std::function<Done()>;

    /// Waits for the one before, whose Error it returns, and begins with this.
    Done begin(Write write);
    /// Waits for the last.
    Done end();

  private:
    std::future<Done> running;
};

}  // namespace fw
